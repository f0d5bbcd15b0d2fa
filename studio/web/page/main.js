// The studio: messages of the server on one side, what the visitor sees and does on the other.

import { showAcross } from "./across.js";
import { showBelief } from "./belief.js";
import { Busy } from "./busy.js";
import { drawBar, rowColour, temperatureColour, useRange, useTable } from "./colours.js";
import { Controls, readable } from "./controls.js";
import { say } from "./say.js";
import { Link } from "./link.js";
import { Plot } from "./plot.js";
import { Scene } from "./scene.js";

const KEPT = 3000; // samples that the plots remember
const SHOWN = 8000; // ms that a problem stays on the screen

const element = (id) => document.getElementById(id);
const CURVES = ["voltage", "drop", "force"]; // a pair each, left and right, in the order of a frame's rows
const memory = { time: [], rows: [] };
const busy = new Busy(element("busy"));
const pace = { wall: 0, time: 0 };
let materials = [];
let mode = "T";
let posteriors = [];
let again = null; // what to set up once more after the connection was lost
let newest = null; // the frame that is to be shown next: those that came before it are not

let scene = null;
try {
  scene = new Scene(element("scene"));
} catch {
  element("flat").hidden = false;
}

const slow = scene?.slow ?? true;
const plots = {
  voltage: new Plot(element("voltage"), { scale: 1e3, least: 0.5, slow }),
  drop: new Plot(element("drop"), { least: 0.5, slow }),
  force: new Plot(element("force"), { least: 2, slow }),
};

const link = new Link({ hello, scene: sceneCame, begin, frame, posterior, chosen, csv, problem, lost });
const controls = new Controls((...what) => link.send(...what));
element("retry").addEventListener("click", () => {
  again = controls.choices;
  element("lost").hidden = true;
  document.body.dataset.state = "connecting";
  link.open();
});
window.studio = { link, memory, frames: 0, shown: 0, scene };
link.open();

function hello(message) {
  useTable(message.table);
  controls.offer(message);
  element("lost").hidden = true;
  if (again) link.send("choose", again);
  again = null;
}

function sceneCame(message) {
  useRange(...message.colours);
  drawBar(element("bar"));
  element("low").textContent = `${Math.round(message.colours[0])} °C`;
  element("high").textContent = `${Math.round(message.colours[1])} °C`;
  materials = message.rows;
  showBelief(element("belief"), posteriors, materials);
  scene?.show(message.shapes);
  mode = message.choices.mode;
  chosen(message);
  element("names").replaceChildren(...materials.map((name, row) => {
    const title = Object.assign(document.createElement("p"), { textContent: readable(name) });
    title.style.setProperty("--row", rowColour(row));
    title.append(document.createElement("small"));
    return title;
  }));
}

function chosen({ choices, seen }) {
  controls.chosen(choices, link.answered(seen));
}

function begin() {
  newest = null;
  memory.time = [];
  memory.rows = [];
  posteriors = [];
  showBelief(element("belief"), posteriors, materials);
  pace.wall = 0;
  for (const plot of Object.values(plots)) plot.reset();
}

function frame(message) {
  window.studio.frames++;
  document.body.dataset.state = message.busy ? "busy" : "live";
  busy.show(message.busy && readable(message.busy));
  if (link.answered(message.seen)) controls.controlled(message.controls);
  if (!message.rows) return;
  say(element("time"), `${message.time.toFixed(2)} s`);
  showPace(message);
  remember(message.curves);
  if (!newest) requestAnimationFrame(show);
  newest = message;
}

function show(now) {
  if (!newest) return; // another grasp has begun since
  const { rows } = newest;
  newest = null;
  window.studio.shown++;
  controls.now = rows[0];
  scene?.update(rows.map(({ poses, celsius }) => ({
    poses,
    colours: Object.fromEntries(Object.entries(celsius).map(([part, value]) => [part, temperatureColour(value)])),
  })), now);
  CURVES.forEach((name, at) => {
    plots[name].draw(memory.time, memory.rows.flatMap((row, number) => row.slice(2 * at, 2 * at + 2).map((values, side) => (
      { values, colour: rowColour(number), dashed: side === 1 }))).filter(({ values }) => values.length));
  });
  showAcross(element("across"), rows, mode);
  rows.forEach(({ ending, state }, row) => {
    const note = element("names").children[row]?.lastChild;
    if (note) say(note, ending || state);
  });
  const costs = rows.map(({ cost }) => cost).filter(Boolean);
  say(element("cost"), described(costs));
  element("cost").title = [...new Set(costs.map(({ rung }) => rung))].join("\n"); // for those who know the names
}

function described(costs) {
  if (!costs.length) return "";
  const models = costs.map(({ states, multiply_adds: adds }) => (
    `Heat model: a network of ${states} states, ${adds} multiply-adds a sample`));
  const { heat, all } = costs[0];
  return `${[...new Set(models)].join("\n")}\nHeat takes ${Math.round(1e6 * heat)} of a step’s ${Math.round(1e6 * all)} µs`;
}

function remember({ time, rows }) {
  if (!time) return;
  memory.time.push(...time);
  rows.forEach((curves, row) => {
    memory.rows[row] ??= curves.map(() => []);
    curves.forEach((values, at) => memory.rows[row][at].push(...(values ?? [])));
  });
  const extra = memory.time.length - KEPT;
  if (extra > KEPT) {
    memory.time.splice(0, extra);
    for (const row of memory.rows) for (const values of row) values.splice(0, extra);
  }
}

// How fast time passes, over a second of the wall's.
function showPace({ time, controls: { playing, speed } }) {
  const now = performance.now();
  if (!playing || time < pace.time || !pace.wall) Object.assign(pace, { wall: now, time });
  if (now - pace.wall < 1000) {
    if (!playing) say(element("pace"), "paused");
    return;
  }
  const rate = (1000 * (time - pace.time)) / (now - pace.wall);
  element("pace").textContent = rate > 0.9 * speed ? `at ${speed} ×` : rate > 0 ? `at ${rate.toFixed(2)} ×, slower than asked` : "";
  Object.assign(pace, { wall: now, time });
}

function posterior({ row, ...found }) {
  posteriors[row] = found;
  showBelief(element("belief"), posteriors, materials);
}

function csv({ name, text }) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  const anchor = Object.assign(document.createElement("a"), { href: address, download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

let hiding = 0;
function problem({ text }) {
  const note = element("problem");
  note.textContent = text[0].toUpperCase() + text.slice(1);
  note.hidden = false;
  clearTimeout(hiding);
  hiding = setTimeout(() => { note.hidden = true; }, SHOWN);
}

function lost(title, text) {
  document.body.dataset.state = "lost";
  busy.show("");
  element("lost-title").textContent = title;
  element("lost-text").textContent = text;
  element("lost").hidden = false;
  element("retry").focus();
}

// What the voltage alone tells of the material: a bar a candidate, and the verdict.

import { rowColour } from "./colours.js";
import { readable } from "./controls.js";

const SHOWN = 5;

export function showBelief(holder, posteriors, materials) {
  while (holder.children.length < materials.length) holder.append(document.createElement("div"));
  while (holder.children.length > materials.length) holder.lastChild.remove();
  materials.forEach((material, row) => {
    const one = holder.children[row];
    one.className = "chance";
    one.style.setProperty("--row", rowColour(row));
    const found = posteriors[row];
    if (!found || found.verdict === "no_touch") {
      one.replaceChildren(verdict(found ? "Nothing is touched yet." : "The studio is learning how the materials feel. The first time takes a while."));
      return;
    }
    one.replaceChildren(...found.likely.slice(0, SHOWN).flatMap(([name, chance]) => bar(name, chance, name === material)),
      verdict(`${found.message[0].toUpperCase()}${found.message.slice(1)}.`));
  });
}

function bar(name, chance, right) {
  const title = Object.assign(document.createElement("b"), { textContent: readable(name) });
  if (right) title.className = "true";
  const length = document.createElement("i");
  length.style.width = `${100 * chance}%`;
  const share = Object.assign(document.createElement("u"), { textContent: `${Math.round(100 * chance)} %` });
  return [title, length, share];
}

function verdict(text) {
  return Object.assign(document.createElement("p"), { className: "verdict", textContent: text });
}

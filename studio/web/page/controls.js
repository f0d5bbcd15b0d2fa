// The form: what the visitor sets becomes messages, what the server holds is shown again.

const OWN_SIZE = ["heavy box", "mesh"];
const DRIVERS = { scripted: ["Script", "Closes, lifts by 5 cm, holds"], sliders: ["Hand", "Your sliders"],
  feeling: ["Feel", "Lifts what feels like metal with more force"], trained: ["Learnt", "A trained network"] };
const PERIOD = 50; // ms between messages of one slider

export const readable = (name) => name.replaceAll("_", " ");
const element = (id) => document.getElementById(id);

export class Controls {
  #sliders = {};
  #choices = {};
  #resting = new Map(); // sliders that sent something less than PERIOD ago -> what to send then, or null

  constructor(send) {
    this.send = send;
    const choose = (id, content) => element(id).addEventListener("change", () => send("choose", content()));
    const materials = () => ({ materials: [element("material").value, element("other").value].filter(Boolean) });
    choose("material", materials);
    choose("other", materials);
    choose("shape", () => ({ shape: element("shape").value }));
    element("mode").addEventListener("change", (event) => send("choose", { mode: event.target.value }));
    element("driver").addEventListener("change", (event) => this.#drive(event.target.value));
    element("csv").addEventListener("click", () => send("csv"));
    element("again").addEventListener("click", () => send("again"));
    element("step").addEventListener("click", () => send("step"));
    element("play").addEventListener("click", () => send("control", { playing: element("play").getAttribute("aria-pressed") !== "true" }));
    element("speed").addEventListener("change", () => send("control", { speed: Number(element("speed").value) }));
    document.querySelector("form").addEventListener("submit", (event) => event.preventDefault());
  }

  // What there is to choose from.
  offer(hello) {
    this.#choices = hello.choices;
    fill(element("material"), groups(hello));
    fill(element("other"), [["", [["", "with nothing"]]], ...groups(hello)]);
    const pairs = (names) => names.map((name) => [name, readable(name)]);
    this.everyday = hello.everyday;
    fill(element("shape"), [["", pairs(hello.shapes.filter((name) => !this.everyday.includes(name)))], ["Everyday objects", pairs(this.everyday)]]);
    fill(element("speed"), [["", hello.speeds.map((speed) => [speed, `${speed} ×`])]]);
    element("driver").replaceChildren(...hello.drivers.map((name) => radio("driver", name, ...DRIVERS[name])));
    for (const holder of document.querySelectorAll("[data-range]")) {
      this.#sliders[holder.dataset.range] = this.#slider(holder, hello.ranges[holder.dataset.range]);
    }
    for (const name of hello.fixed) this.#disable(name);
    this.chosen(hello.choices);
  }

  // What the server holds of an episode's choices; the form shows it where the visitor has set nothing since.
  chosen(choices, answered = true) {
    this.#choices = choices;
    if (!answered) return;
    [element("material").value, element("other").value] = [choices.materials[0], choices.materials[1] ?? ""];
    element("shape").value = choices.shape;
    check("mode", choices.mode);
    for (const [name, slider] of Object.entries(this.#sliders)) if (name in choices) slider.set(choices[name]);
    const everyday = this.everyday.includes(choices.shape); // has a material, a size and a temperature of its own
    this.#sliders.width.holder.hidden = everyday || OWN_SIZE.includes(choices.shape);
    for (const id of ["material", "other"]) element(id).closest("label").hidden = everyday;
    this.#sliders.object_temperature.holder.hidden = everyday;
  }

  get choices() {
    return this.#choices;
  }

  // What the server holds of the controls.
  controlled(controls) {
    const play = element("play");
    play.textContent = controls.playing ? "Pause" : "Play";
    play.setAttribute("aria-pressed", controls.playing);
    element("speed").value = controls.speed;
    check("driver", controls.driver);
    this.#suit(controls.driver);
    for (const [name, slider] of Object.entries(this.#sliders)) {
      if (name in controls && !slider.held && !this.#resting.get(name)) slider.set(controls[name]);
    }
  }

  // Shows the sliders that a driver heeds.
  #suit(driver) {
    for (const holder of document.querySelectorAll("[data-hand]")) holder.hidden = driver !== "sliders";
    this.#sliders.force.holder.hidden = !["scripted", "sliders"].includes(driver);
  }

  // By hand it goes on from where the gripper is, which may be a hair beyond what can be set.
  #drive(driver) {
    this.#suit(driver);
    const content = { driver };
    for (const name of driver === "sliders" && this.now ? ["opening", "height"] : []) {
      content[name] = this.#sliders[name].within(this.now[name]);
    }
    this.send("control", content);
  }

  #slider(holder, range) {
    const { kind, label } = holder.dataset;
    const name = holder.dataset.range;
    holder.className = "slider";
    const input = document.createElement("input");
    const output = document.createElement("output");
    const title = document.createElement("span");
    title.textContent = label;
    const id = `range-${name}`;
    Object.assign(input, { type: "range", id, ...(range.log ? { min: 0, max: 1, step: 0.01 } : { min: range.low, max: range.high, step: range.step }) });
    input.setAttribute("aria-label", `${label}, ${range.unit}`);
    holder.replaceChildren(title, input, output);
    const place = (value) => (range.log ? Math.log(value / range.low) / Math.log(range.high / range.low) : value);
    const value = () => (range.log ? twoDigits(range.low * (range.high / range.low) ** input.value) : Number(input.value));
    const show = (number) => {
      output.textContent = `${Number((number * range.scale).toPrecision(3))} ${range.unit}`;
      input.setAttribute("aria-valuetext", output.textContent);
    };
    const within = (number) => Math.min(Math.max(number, range.low), range.high);
    const slider = { holder, within, held: false, releasing: 0, set: (number) => {
      input.value = place(number);
      show(number);
    } };
    const send = (when) => this.send(kind, { [name]: within(value()) }, when);
    input.addEventListener("input", (event) => {
      show(value());
      clearTimeout(slider.releasing);
      slider.held = true;
      if (kind === "control") this.#seldom(name, () => send(event.timeStamp));
    });
    input.addEventListener("change", (event) => {
      if (kind === "choose") send(event.timeStamp);
      slider.releasing = setTimeout(() => { slider.held = false; }, 300);
    });
    return slider;
  }

  // At once, or where that was done a moment ago, what came last when PERIOD has passed.
  #seldom(name, send) {
    if (this.#resting.has(name)) {
      this.#resting.set(name, send);
      return;
    }
    send();
    this.#resting.set(name, null);
    setTimeout(() => {
      const next = this.#resting.get(name);
      this.#resting.delete(name);
      if (next) this.#seldom(name, next);
    }, PERIOD);
  }

  #disable(name) {
    const slider = this.#sliders[name];
    const owner = slider?.holder.querySelector("input") ?? element(name);
    if (owner) (owner.closest("label, .slider, .segments") ?? owner).dataset.fixed = "";
  }
}

function groups({ materials, seed }) {
  const pairs = (names) => names.map((name) => [name, readable(name)]);
  const others = materials.filter((name) => !seed.includes(name));
  return [["Ten of the paper", pairs(seed)], ["All others", pairs(others)]].filter(([, names]) => names.length);
}

function fill(select, parts) {
  const options = (pairs) => pairs.map(([value, text]) => new Option(text, value));
  select.replaceChildren(...parts.flatMap(([title, pairs]) => {
    if (!title) return options(pairs);
    const group = document.createElement("optgroup");
    group.label = title;
    group.append(...options(pairs));
    return [group];
  }));
}

function radio(name, value, text, title) {
  const label = document.createElement("label");
  const input = Object.assign(document.createElement("input"), { type: "radio", name, value });
  const span = Object.assign(document.createElement("span"), { textContent: text });
  label.title = title;
  label.append(input, span);
  return label;
}

function check(name, value) {
  const input = document.querySelector(`input[name="${name}"][value="${value}"]`);
  if (input) input.checked = true;
}

const twoDigits = (value) => Number(value.toPrecision(2));

// Temperatures from thermostat to thermostat through both contacts, as a band of colours with its figures.

import { css, inkOn, temperatureColour } from "./colours.js";
import { say } from "./say.js";

const NAMES = {
  T: ["thermostat", "sensor’s face", "object’s face", "object"],
  O: ["thermostat", "its face", "element’s face", "object"],
};

export function showAcross(holder, rows, mode) {
  const names = [...NAMES[mode], ...NAMES[mode].slice(0, 3).reverse()];
  if (holder.children.length !== rows.length + 1) {
    holder.replaceChildren(...rows.map(() => band("across", "i")), band("across-key", "span"));
  }
  rows.forEach(({ across }, row) => {
    holder.children[row].hidden = !across;
    const { children } = holder.children[row];
    across?.forEach((celsius, at) => {
      const colour = temperatureColour(celsius);
      say(children[at], celsius.toFixed(1));
      if (children[at].dataset.colour === css(colour)) return;
      children[at].dataset.colour = css(colour);
      children[at].style.background = css(colour);
      children[at].style.color = inkOn(colour);
    });
  });
  names.forEach((name, at) => say(holder.lastChild.children[at], name));
  holder.lastChild.hidden = !rows[0]?.across;
}

function band(name, kind) {
  const holder = Object.assign(document.createElement("div"), { className: name });
  for (let k = 0; k < 7; k++) holder.append(document.createElement(kind));
  return holder;
}

// Temperatures from thermostat to thermostat through both contacts, as a band of colours with its figures.

import { css, inkOn, rowColour, temperatureColour } from "./colours.js";

const NAMES = ["thermostat", "sensor", "face", "object", "face", "sensor", "thermostat"];

export function showAcross(holder, rows) {
  if (holder.children.length !== rows.length + 1) {
    holder.replaceChildren(...rows.map(() => band("across", "i", NAMES.map(() => ""))), band("across-key", "span", NAMES));
  }
  rows.forEach(({ across }, row) => {
    const cells = holder.children[row].children;
    holder.children[row].style.setProperty("--row", rowColour(row));
    holder.children[row].hidden = !across;
    across?.forEach((celsius, at) => {
      const colour = temperatureColour(celsius);
      cells[at].textContent = celsius.toFixed(1);
      cells[at].style.background = css(colour);
      cells[at].style.color = inkOn(colour);
    });
  });
  holder.lastChild.hidden = !rows[0]?.across;
}

function band(name, kind, texts) {
  const holder = Object.assign(document.createElement("div"), { className: name });
  holder.append(...texts.map((textContent) => Object.assign(document.createElement(kind), { textContent })));
  return holder;
}

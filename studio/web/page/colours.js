// Colours: of temperatures, by the table that the server sends, and of the two rows.

let table = [[0, 0, 0]];
let low = 20;
let high = 40;

export function useTable(hex) {
  table = hex.map((one) => [1, 3, 5].map((at) => parseInt(one.slice(at, at + 2), 16) / 255));
}

export function useRange(from, to) {
  [low, high] = [from, to];
}

// sRGB in 0..1; beyond the range the end colours.
export function temperatureColour(celsius) {
  const place = Math.min(Math.max((celsius - low) / (high - low), 0), 1) * (table.length - 1);
  const at = Math.min(Math.floor(place), table.length - 2);
  const share = place - at;
  return table[at].map((value, channel) => value + share * (table[at + 1][channel] - value));
}

export function css([red, green, blue]) {
  return `rgb(${Math.round(255 * red)} ${Math.round(255 * green)} ${Math.round(255 * blue)})`;
}

// Black or white, whichever reads on the colour.
export function inkOn([red, green, blue]) {
  return 0.21 * red ** 2.2 + 0.72 * green ** 2.2 + 0.07 * blue ** 2.2 > 0.2 ? "#111" : "#fff";
}

export function drawBar(canvas) {
  const context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; x++) {
    context.fillStyle = css(temperatureColour(low + ((high - low) * x) / (canvas.width - 1)));
    context.fillRect(x, 0, 1, canvas.height);
  }
}

export const rowColour = (row) => (row === 0 ? "var(--first)" : "var(--second)");

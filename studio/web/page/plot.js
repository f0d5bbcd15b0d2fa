// One live plot: curves against time, the last seconds of them, on an axis that grows and shrinks with what is shown.

const WINDOW = 10; // s
const LEFT = 34;
const RIGHT = 8;
const TOP = 6;
const BOTTOM = 17;

export class Plot {
  #shown = [0, 1]; // the value axis

  // scale: shown units in one of what is given. least: the smallest range of the value axis.
  // slow: whether a graphics card is only played by the processor, which draws lines better itself.
  constructor(canvas, { scale = 1, least = 1, slow = false } = {}) {
    Object.assign(this, { canvas, scale, least });
    this.context = canvas.getContext("2d", { willReadFrequently: slow });
  }

  // time: s. curves: {values, colour, dashed}.
  draw(time, curves) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!width || !height) return;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const style = getComputedStyle(this.canvas);
    const [ink, line] = [style.getPropertyValue("--soft"), style.getPropertyValue("--line")];
    const now = time.length ? time[time.length - 1] : 0;
    const end = Math.max(WINDOW, now);
    const begin = end - WINDOW;
    const first = lowerBound(time, begin);
    const [low, high] = this.#range(curves, first);
    const x = (t) => LEFT + ((t - begin) / WINDOW) * (width - LEFT - RIGHT);
    const y = (v) => height - BOTTOM - ((v - low) / (high - low)) * (height - TOP - BOTTOM);
    const c = this.context;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = `11px ${style.fontFamily}`;
    c.lineWidth = 1;
    c.strokeStyle = line;
    c.fillStyle = ink;
    c.textAlign = "right";
    c.textBaseline = "middle";
    const step = niceStep(high - low, Math.max(2, (height - TOP - BOTTOM) / 26));
    for (let value = Math.ceil(low / step - 1e-9) * step; value <= high + 1e-9; value += step) {
      rule(c, LEFT, y(value), width - RIGHT, y(value));
      c.fillText(decimals(value, step), LEFT - 6, y(value));
    }
    c.textAlign = "center";
    c.textBaseline = "alphabetic";
    for (let t = Math.ceil(begin / 2) * 2; t <= end; t += 2) {
      if (x(t) < width - 12) c.fillText(t === 0 ? "0 s" : String(t), x(t), height - 3);
    }
    c.save();
    c.beginPath();
    c.rect(LEFT, 0, width - LEFT, height - BOTTOM + 2);
    c.clip();
    c.lineJoin = "round";
    for (const curve of curves) {
      c.strokeStyle = style.getPropertyValue(curve.colour.slice(4, -1));
      c.lineWidth = curve.dashed ? 1.3 : 2;
      c.setLineDash(curve.dashed ? [5, 4] : []);
      c.beginPath();
      const stride = Math.max(1, Math.floor((time.length - first) / (2 * width)));
      for (let k = first, gap = true; k < time.length; k += stride) {
        const value = curve.values[k];
        if (value !== null) c[gap ? "moveTo" : "lineTo"](x(time[k]), y(value * this.scale));
        gap = value === null;
      }
      c.stroke();
    }
    c.restore();
    c.setLineDash([]);
  }

  // The values shown and zero, with some room; it only shrinks where it has become far too large.
  #range(curves, first) {
    let [low, high] = [0, 0];
    for (const { values } of curves) {
      for (let k = first; k < values.length; k++) {
        const value = values[k] * this.scale;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (high - low < this.least) high = low + this.least;
    const room = 0.08 * (high - low);
    const wanted = [low < 0 ? low - room : 0, high + room];
    const [a, b] = this.#shown;
    const tooLarge = b - a > 2.5 * (wanted[1] - wanted[0]);
    if (tooLarge || wanted[0] < a || wanted[1] > b) {
      const step = niceStep(wanted[1] - wanted[0], 4);
      this.#shown = [Math.floor(wanted[0] / step + 1e-9) * step, Math.ceil(wanted[1] / step - 1e-9) * step];
    }
    return this.#shown;
  }

  reset() {
    this.#shown = [0, this.least];
  }
}

function rule(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, Math.round(y0) + 0.5);
  context.lineTo(x1, Math.round(y1) + 0.5);
  context.stroke();
}

// 1, 2 or 5 times a power of ten, so that a range has about that many steps.
function niceStep(range, count) {
  const raw = range / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999);
}

function decimals(value, step) {
  return (Math.abs(value) < step / 2 ? 0 : value).toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
}

function lowerBound(sorted, value) {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

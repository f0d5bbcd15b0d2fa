// A camera that circles a point: drag, pinch, wheel, or the arrow keys. Matrices are column-major, as WebGL has them.

const START = { azimuth: -1.17, elevation: 0.3, distance: 0.37, target: [0, 0, 0.066] };
const LIMITS = { elevation: [-0.1, 1.45], distance: [0.16, 1.2] };

export class Camera {
  #fingers = new Map();
  #apart = 0;

  constructor(canvas, moved) {
    Object.assign(this, START);
    const change = (values) => {
      Object.assign(this, values);
      for (const [name, [low, high]] of Object.entries(LIMITS)) this[name] = Math.min(Math.max(this[name], low), high);
      moved();
    };
    canvas.addEventListener("pointerdown", (event) => {
      this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
      this.#apart = 0;
    });
    const lifted = (event) => this.#fingers.delete(event.pointerId);
    canvas.addEventListener("pointerup", lifted);
    canvas.addEventListener("pointercancel", lifted);
    canvas.addEventListener("pointermove", (event) => {
      const last = this.#fingers.get(event.pointerId);
      if (!last) return;
      this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
      if (this.#fingers.size === 2) {
        const [a, b] = [...this.#fingers.values()];
        const apart = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (this.#apart) change({ distance: (this.distance * this.#apart) / apart });
        this.#apart = apart;
        return;
      }
      change({
        azimuth: this.azimuth - (event.clientX - last[0]) * 0.008,
        elevation: this.elevation + (event.clientY - last[1]) * 0.006,
      });
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      change({ distance: this.distance * Math.exp(event.deltaY * 0.001) });
    }, { passive: false });
    canvas.addEventListener("dblclick", () => change(START));
    canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] }[event.key];
      if (!turn) return;
      event.preventDefault();
      change({ azimuth: this.azimuth + turn[0], elevation: this.elevation + turn[1] });
    });
  }

  get eye() {
    const { azimuth, elevation, distance, target } = this;
    const flat = distance * Math.cos(elevation);
    return [target[0] + flat * Math.cos(azimuth), target[1] + flat * Math.sin(azimuth), target[2] + distance * Math.sin(elevation)];
  }

  // In a narrow picture the gripper's width must fit, in a wide one its height.
  matrix(aspect) {
    const half = Math.tan(0.36) * Math.max(1, 0.78 / aspect);
    return multiplied(perspective(half, aspect, 0.02, 4), lookAt(this.eye, this.target));
  }
}

function perspective(half, aspect, near, far) {
  const depth = near - far;
  return [1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, (far + near) / depth, -1, 0, 0, (2 * far * near) / depth, 0];
}

export function orthographic(width, near, far) {
  return [1 / width, 0, 0, 0, 0, 1 / width, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1];
}

export function lookAt(eye, target) {
  const back = unit(eye.map((value, k) => value - target[k]));
  const right = unit([-back[1], back[0], 0]); // z is up
  const up = [
    back[1] * right[2] - back[2] * right[1],
    back[2] * right[0] - back[0] * right[2],
    back[0] * right[1] - back[1] * right[0],
  ];
  const along = (axis) => -(axis[0] * eye[0] + axis[1] * eye[1] + axis[2] * eye[2]);
  return [
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    along(right), along(up), along(back), 1,
  ];
}

export function multiplied(a, b) {
  const product = [];
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      product.push(sum);
    }
  }
  return product;
}

export function unit(v) {
  const length = Math.hypot(...v) || 1;
  return v.map((value) => value / length);
}

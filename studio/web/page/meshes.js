// Triangles of MuJoCo's shapes in their body's frame: Float32Array of (position 3, normal 3) a corner.

const BEVEL = 0.0012; // m
const ROUND = 40; // corners of a circle

export function triangles(shape) {
  const corners = [];
  const add = (position, normal) => corners.push(place(position, normal, shape));
  ({ box, cylinder, sphere, mesh })[shape.kind](shape, add);
  return new Float32Array(corners.flat());
}

function place(position, normal, { place: origin, turn }) {
  const p = turned(turn, position);
  return [p[0] + origin[0], p[1] + origin[1], p[2] + origin[2], ...turned(turn, normal)];
}

// v turned by the unit quaternion (w, x, y, z).
export function turned([w, x, y, z], v) {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
}

// A box with rounded edges: a point of a face's grid is carried to the nearest point of the rounded surface.
function box({ size }, add) {
  const bevel = Math.min(BEVEL, 0.3 * Math.min(...size));
  const along = size.map((half) => [-half, -half + bevel, half - bevel, half]);
  const corner = (p) => {
    const inner = p.map((value, k) => Math.min(Math.max(value, bevel - size[k]), size[k] - bevel));
    const out = p.map((value, k) => value - inner[k]);
    const length = Math.hypot(...out);
    const normal = out.map((value) => value / length);
    add(inner.map((value, k) => value + bevel * normal[k]), normal);
  };
  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const side of [-1, 1]) {
      const point = (i, j) => {
        const p = [0, 0, 0];
        p[axis] = side * size[axis];
        p[u] = along[u][side > 0 ? i : 3 - i];
        p[v] = along[v][j];
        return p;
      };
      for (let i = 0; i < 3; i++) {
        for (let j = 0; j < 3; j++) {
          for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) corner(point(i + a, j + b));
        }
      }
    }
  }
}

function cylinder({ size: [radius, half] }, add) {
  for (let k = 0; k < ROUND; k++) {
    const [a, b] = [k, k + 1].map((one) => (2 * Math.PI * one) / ROUND).map((angle) => [Math.cos(angle), Math.sin(angle)]);
    const at = ([c, s], z) => [radius * c, radius * s, z];
    for (const [one, z] of [[a, -half], [b, -half], [b, half], [a, -half], [b, half], [a, half]]) add(at(one, z), [...one, 0]);
    for (const side of [-1, 1]) {
      const [first, second] = side > 0 ? [a, b] : [b, a];
      for (const p of [[0, 0, side * half], at(first, side * half), at(second, side * half)]) add(p, [0, 0, side]);
    }
  }
}

function sphere({ size: [radius] }, add) {
  const rows = ROUND / 2;
  const at = (i, j) => {
    const [down, around] = [(Math.PI * i) / rows, (2 * Math.PI * j) / ROUND];
    return [Math.sin(down) * Math.cos(around), Math.sin(down) * Math.sin(around), Math.cos(down)];
  };
  for (let i = 0; i < rows; i++) {
    for (let j = 0; j < ROUND; j++) {
      for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) {
        const normal = at(i + a, j + b);
        add(normal.map((value) => radius * value), normal);
      }
    }
  }
}

function mesh({ vertices }, add) {
  for (let k = 0; k < vertices.length; k += 9) {
    const [a, b, c] = [0, 3, 6].map((at) => vertices.slice(k + at, k + at + 3));
    const [u, v] = [b, c].map((p) => p.map((value, i) => value - a[i]));
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...normal) || 1;
    for (const p of [a, b, c]) add(p, normal.map((value) => value / length));
  }
}

// The gripper and its object in WebGL 2, one picture a row, side by side. It draws when something has changed.

import { Camera, lookAt, multiplied, orthographic, unit } from "./camera.js";
import { triangles } from "./meshes.js";
import { Pace } from "./pace.js";
import { fragment, SHADOW, VERTEX } from "./shaders.js";

const LIGHT = unit([0.35, -0.55, 1]);
const LAMP = multiplied(orthographic(0.26, 0.05, 1.2), lookAt(LIGHT.map((value, k) => 0.6 * value + [0, 0, 0.06][k]), [0, 0, 0.06]));
const FINE = { antialias: true, shadow: 1024, taps: 4 }; // shadow: pixels a side
const PLAIN = { antialias: false, shadow: 512, taps: 1 }; // without a graphics card, where the processor plays one
const PLAYED = /swiftshader|llvmpipe|softpipe|software|basic render/i; // by these

export class Scene {
  #shapes = [];
  #rows = [];
  #waiting = false;

  // Throws where there is no WebGL 2. slow: whether there is no graphics card.
  constructor(canvas) {
    this.slow = played();
    this.quality = this.slow ? PLAIN : FINE;
    const gl = canvas.getContext("webgl2", { antialias: this.quality.antialias });
    if (!gl) throw new Error("no WebGL 2");
    Object.assign(this, { canvas, gl, pace: new Pace(gl) });
    this.#start();
    this.camera = new Camera(canvas, () => this.redraw());
    new ResizeObserver(() => this.redraw()).observe(canvas);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      const shapes = this.#shapes.map(({ shape }) => shape);
      this.#start();
      this.#shapes = [];
      this.show(shapes);
    });
  }

  #start() {
    const { gl } = this;
    this.surface = program(gl, VERTEX, fragment(this.quality.taps));
    this.shadow = program(gl, VERTEX, SHADOW);
    this.dark = shadowMap(gl, this.quality.shadow);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  show(shapes) {
    const { gl } = this;
    for (const { buffer, array } of this.#shapes) {
      gl.deleteBuffer(buffer);
      gl.deleteVertexArray(array);
    }
    const ordered = [...shapes].sort((a, b) => b.alpha - a.alpha); // what can be seen through comes last
    this.#shapes = ordered.map((shape) => ({ shape, ...upload(gl, triangles(shape)) }));
    this.#rows = []; // the last ones were of other shapes
  }

  // rows: {poses, colours}, colours: part -> sRGB in 0..1. now: of the picture of the page that is being made.
  update(rows, now) {
    this.#rows = rows;
    if (!this.#waiting) this.#draw(now);
  }

  redraw() {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame((now) => {
      this.#waiting = false;
      this.#draw(now);
    });
  }

  #draw(now) {
    const { gl, canvas, pace, quality } = this;
    if (!pace.may(now)) return this.redraw();
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * pace.detail;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * ratio));
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    pace.begin(now);
    gl.clearColor(0, 0, 0, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const share = Math.floor(width / Math.max(this.#rows.length, 1));
    this.#rows.forEach((row, at) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.dark.frame);
      gl.viewport(0, 0, quality.shadow, quality.shadow);
      gl.clear(gl.DEPTH_BUFFER_BIT);
      gl.useProgram(this.shadow.program);
      gl.uniformMatrix4fv(this.shadow.at.camera, false, LAMP);
      for (const one of this.#shapes) this.#place(this.shadow, one, row);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.viewport(at * share, 0, share, height);
      const { at: uniform } = this.surface;
      gl.useProgram(this.surface.program);
      gl.uniformMatrix4fv(uniform.camera, false, this.camera.matrix(share / height));
      gl.uniformMatrix4fv(uniform.lamp, false, LAMP);
      gl.uniform3fv(uniform.eye, this.camera.eye);
      gl.uniform3fv(uniform.light, LIGHT);
      gl.bindTexture(gl.TEXTURE_2D, this.dark.texture);
      for (const one of this.#shapes) {
        const celsius = row.colours[one.shape.part];
        gl.uniform3fv(uniform.colour, (celsius ?? one.shape.colour).map((value) => value ** 2.2));
        gl.uniform1f(uniform.gloss, celsius ? 0.15 : one.shape.gloss);
        gl.uniform1f(uniform.flatness, celsius ? 0.7 : 0);
        gl.uniform1f(uniform.alpha, one.shape.alpha);
        gl.depthMask(one.shape.alpha === 1);
        this.#place(this.surface, one, row);
      }
      gl.depthMask(true);
    });
    pace.end();
  }

  #place({ at }, { shape, array, count }, { poses }) {
    const { gl } = this;
    const pose = poses[shape.body];
    gl.uniform3f(at.place, pose[0], pose[1], pose[2]);
    gl.uniform4f(at.turn, pose[3], pose[4], pose[5], pose[6]);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.TRIANGLES, 0, count);
  }
}

// Asked of a canvas that is thrown away, for what a canvas is drawn with is settled when it is made.
function played() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const names = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl?.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER) ?? "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return PLAYED.test(name);
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(`shader: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  const at = {};
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k++) {
    const { name } = gl.getActiveUniform(made, k);
    at[name] = gl.getUniformLocation(made, name);
  }
  return { program: made, at };
}

function shadowMap(gl, side) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, side, side);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.drawBuffers([gl.NONE]);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, frame };
}

function upload(gl, corners) {
  const array = gl.createVertexArray();
  const buffer = gl.createBuffer();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
  for (const at of [0, 1]) {
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, 12 * at);
  }
  return { array, buffer, count: corners.length / 6 };
}

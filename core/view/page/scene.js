// The gripper and its object in WebGL 2, one picture a row, side by side. It draws when something has changed.

import { Camera, lookAt, multiplied, orthographic, unit } from "./camera.js";
import { triangles } from "./meshes.js";
import { FRAGMENT, SHADOW, VERTEX } from "./shaders.js";

const LIGHT = unit([0.35, -0.55, 1]);
const LAMP = multiplied(orthographic(0.26, 0.05, 1.2), lookAt(LIGHT.map((value, k) => 0.6 * value + [0, 0, 0.06][k]), [0, 0, 0.06]));
const SHADOW_SIDE = 1024; // pixels
const SLOW = 45; // ms a frame, above which the picture becomes coarser
const COARSEST = 0.5; // of the screen's pixels

export class Scene {
  #shapes = [];
  #rows = [];
  #waiting = false;
  #detail = 1;
  #late = 0;
  #last = 0;

  // Throws where there is no WebGL 2.
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: false });
    if (!gl) throw new Error("no WebGL 2");
    Object.assign(this, { canvas, gl });
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
    this.surface = program(gl, VERTEX, FRAGMENT);
    this.shadow = program(gl, VERTEX, SHADOW);
    this.dark = shadowMap(gl);
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
    this.redraw();
  }

  // rows: {poses, colours}, colours: part -> sRGB in 0..1.
  update(rows) {
    this.#rows = rows;
    this.redraw();
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
    const { gl, canvas } = this;
    this.#adapt(now);
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * this.#detail;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * ratio));
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.clearColor(0, 0, 0, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const share = Math.floor(width / Math.max(this.#rows.length, 1));
    this.#rows.forEach((row, at) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.dark.frame);
      gl.viewport(0, 0, SHADOW_SIDE, SHADOW_SIDE);
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
        gl.uniform3fv(uniform.colour, celsius ?? one.shape.colour);
        gl.uniform1f(uniform.gloss, celsius ? 0.15 : one.shape.gloss);
        gl.uniform1f(uniform.flatness, celsius ? 0.7 : 0);
        gl.uniform1f(uniform.alpha, one.shape.alpha);
        gl.depthMask(one.shape.alpha === 1);
        this.#place(this.surface, one, row);
      }
      gl.depthMask(true);
    });
  }

  #place({ at }, { shape, array, count }, { poses }) {
    const { gl } = this;
    const pose = poses[shape.body];
    gl.uniform3f(at.place, pose[0], pose[1], pose[2]);
    gl.uniform4f(at.turn, pose[3], pose[4], pose[5], pose[6]);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.TRIANGLES, 0, count);
  }

  // Without a graphics card the picture is what keeps the page from being quick.
  #adapt(now) {
    const spent = now - this.#last;
    this.#last = now;
    if (spent > 400) return; // nothing was to be drawn
    this.#late = spent > SLOW ? this.#late + 1 : Math.max(this.#late - 1, 0);
    if (this.#late > 20 && this.#detail > COARSEST) {
      this.#detail = Math.max(this.#detail - 0.25, COARSEST);
      this.#late = 0;
    }
  }
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

function shadowMap(gl) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_SIDE, SHADOW_SIDE);
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

// How often and how finely the 3-D picture is drawn, by how long the last ones took. A graphics card draws it in no time;
// a processor that plays one would keep the rest of the page waiting, and pictures would queue.

const QUICK = 25; // ms, below which every picture may be drawn
const SHARE = 0.5; // of the time that slower ones may take
const SLOW = 45; // ms, above which they become coarser
const PATIENCE = 10; // pictures until they do
const COARSEST = 0.5; // of the screen's pixels along a side
const LONGEST = 1000; // ms that one is waited for: a hidden tab's may never be told to be done

export class Pace {
  detail = 1; // of the screen's pixels along a side
  #begun = 0;
  #fence = null;
  #took = 0; // ms, smoothed
  #late = 0;

  constructor(gl) {
    this.gl = gl;
  }

  // Whether the last picture is done, and was long enough ago. now: ms.
  may(now) {
    const { gl } = this;
    if (this.#fence) {
      const done = gl.getSyncParameter(this.#fence, gl.SYNC_STATUS) !== gl.UNSIGNALED;
      if (!done && now - this.#begun < LONGEST) return false;
      gl.deleteSync(this.#fence);
      this.#fence = null;
      this.#took += 0.2 * (Math.min(now - this.#begun, LONGEST) - this.#took);
      this.#adapt();
    }
    return this.#took < QUICK || now - this.#begun >= this.#took / SHARE;
  }

  begin(now) {
    this.#begun = now;
  }

  end() {
    this.#fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }

  #adapt() {
    this.#late = this.#took > SLOW ? this.#late + 1 : 0;
    if (this.#late < PATIENCE) return;
    this.detail = Math.max(this.detail - 0.25, COARSEST);
    this.#late = 0;
  }
}

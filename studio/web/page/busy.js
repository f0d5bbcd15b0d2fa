// What the visitor waits for, and how long already: the server is silent while it prepares a grasp.

import { say } from "./say.js";

const LONG = 3; // s, after which it is said why

export class Busy {
  #since = 0;
  #ticking = 0;

  constructor(element) {
    this.element = element;
  }

  // what: is prepared; nothing where that is done.
  show(what) {
    this.element.hidden = !what;
    if (!what || what !== this.what) clearInterval(this.#ticking);
    if (what && what !== this.what) {
      this.#since = performance.now();
      this.#ticking = setInterval(() => this.#tick(), 250);
    }
    this.what = what;
    if (what) this.#tick();
  }

  #tick() {
    const seconds = Math.floor((performance.now() - this.#since) / 1000);
    const why = seconds < LONG ? "" : ` ${seconds} s. Its heat model is computed once, then kept.`;
    say(this.element, `Preparing ${this.what} …${why}`);
  }
}

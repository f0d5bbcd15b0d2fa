// The connection to the visitor's session. `on` has a function for each kind of message, and `lost(title, text)`.

const TITLES = { 1001: "The studio has stopped", 1008: "The studio has closed the connection",
  1011: "The simulation has ended", 1013: "The studio is full" };

export class Link {
  #socket = null;
  #number = 0;
  #sent = new Map(); // number -> when, of messages that no frame has answered yet
  #why = "";

  constructor(on) {
    this.on = on;
    this.latencies = []; // ms from an input until what it did was handed to the screen, the newest ones
  }

  open() {
    const address = new URL("socket", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    address.search = "";
    this.#why = "";
    this.#number = 0;
    this.#sent.clear();
    const socket = new WebSocket(address);
    this.#socket = socket;
    socket.onmessage = (event) => this.#hear(JSON.parse(event.data));
    socket.onclose = (event) => this.#closed(event);
  }

  // Whether the server had everything that was sent when it had `seen`: what it tells of its state is what the visitor
  // set last.
  answered(seen) {
    return seen >= this.#number;
  }

  // when: ms, of the input that asks for it.
  send(what, content = {}, when = performance.now()) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return;
    const id = ++this.#number;
    this.#sent.set(id, when);
    this.#socket.send(JSON.stringify({ do: what, id, ...content }));
  }

  #hear(message) {
    if (message.kind === "ended") this.#why = message.text;
    else this.on[message.kind]?.(message);
    if (message.kind !== "frame" || !this.#sent.size) return;
    // The picture after the one that shows it begins when that one has been handed on.
    requestAnimationFrame(() => requestAnimationFrame(() => this.#answered(message.seen)));
  }

  #answered(seen) {
    for (const [id, when] of this.#sent) {
      if (id > seen) break;
      this.#sent.delete(id);
      this.latencies.push(performance.now() - when);
      if (this.latencies.length > 500) this.latencies.shift();
    }
  }

  #closed(event) {
    const title = TITLES[event.code] ?? "The connection is lost";
    const text = this.#why || (event.code === 1006 || event.code === 1001
      ? "The server on the other end does not answer. Is `thermograsp view` still running?"
      : event.reason || "The server closed it.");
    this.on.lost(title, text[0].toUpperCase() + text.slice(1) + (/[.?!]$/.test(text) ? "" : "."));
  }
}

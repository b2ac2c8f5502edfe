// A run through a turn or a cycle: a button that plays and pauses, and a dial, which place the cursor of the pictures.

import { html } from "./svg.js";

export class Run {
  #dial;
  #play;
  #text;
  #cursor;
  #root;
  #end;
  #seconds;
  #frame = null;

  /** `label` is what the dial is; the cursor is that of all pictures that follow, from 0 to `end()`, in so many seconds;
      `spoken(at)` is a place in words. */
  constructor(root, label, cursor, { text = "Run", end = () => 360, steps = 360, seconds = 6, spoken = (at) => `${Math.round(at)} degrees` } = {}) {
    this.#root = root;
    this.#cursor = cursor;
    this.#end = end;
    this.#seconds = seconds;
    this.#text = text;
    this.#dial = html("input", { type: "range", min: 0, max: steps, step: 1, value: 0, "aria-label": label, oninput: () => cursor.place((Number(this.#dial.value) / steps) * end()) });
    this.#play = html("button", { type: "button", text, onclick: () => (this.#frame === null ? this.#start() : this.#stop()) });
    root.classList.add("run");
    root.replaceChildren(this.#play, this.#dial);
    cursor.watch((at) => {
      if (at === null) return;
      this.#dial.value = Math.round((at / end()) * steps);
      this.#dial.setAttribute("aria-valuetext", spoken(at));
    });
  }

  #start() {
    this.#play.textContent = "Pause";
    let last = performance.now();
    let at = this.#cursor.at ?? 0;
    const step = (now) => {
      at = (at + ((now - last) / 1000 / this.#seconds) * this.#end()) % this.#end();
      last = now;
      this.#cursor.place(Number(at.toFixed(1)));
      // a view that is not shown does not run
      if (this.#root.offsetParent === null) this.#stop();
      else this.#frame = requestAnimationFrame(step);
    };
    this.#frame = requestAnimationFrame(step);
  }

  #stop() {
    cancelAnimationFrame(this.#frame);
    this.#frame = null;
    this.#play.textContent = this.#text;
  }
}

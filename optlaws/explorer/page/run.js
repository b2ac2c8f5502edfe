// A run through the turn: a button that plays and pauses, and a dial, which place the cursor of the pictures.

import { html } from "./svg.js";

const SPEED = 60; // degrees a second

export class Run {
  #dial;
  #play;
  #cursor;
  #root;
  #frame = null;

  /** `name` is what turns; the cursor is that of all pictures that follow. */
  constructor(root, name, cursor) {
    this.#root = root;
    this.#cursor = cursor;
    this.#dial = html("input", { type: "range", min: 0, max: 360, step: 1, value: 0, "aria-label": `Angle of ${name}, degrees`, oninput: () => cursor.place(Number(this.#dial.value)) });
    this.#play = html("button", { type: "button", text: "Run", onclick: () => (this.#frame === null ? this.#start() : this.#stop()) });
    root.classList.add("run");
    root.replaceChildren(this.#play, this.#dial);
    cursor.watch((at) => {
      if (at === null) return;
      this.#dial.value = at;
      this.#dial.setAttribute("aria-valuetext", `${Math.round(at)} degrees`);
    });
  }

  #start() {
    this.#play.textContent = "Pause";
    let last = performance.now();
    let angle = this.#cursor.at ?? 0;
    const step = (now) => {
      angle = (angle + (SPEED * (now - last)) / 1000) % 360;
      last = now;
      this.#cursor.place(Number(angle.toFixed(1)));
      // a view that is not shown does not run
      if (this.#root.offsetParent === null) this.#stop();
      else this.#frame = requestAnimationFrame(step);
    };
    this.#frame = requestAnimationFrame(step);
  }

  #stop() {
    cancelAnimationFrame(this.#frame);
    this.#frame = null;
    this.#play.textContent = "Run";
  }
}

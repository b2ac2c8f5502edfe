// The segments of a motion as bars above its curves; the joints between them are dragged, or moved by keys.

import { scale } from "./axes.js";
import { BOX } from "./panel.js";
import { html, sized } from "./svg.js";
import { number } from "./units.js";

const NARROW = 7; // pixels a letter of a name takes

export class Strip {
  element = html("div", { class: "strip", role: "group", "aria-label": "Segments of the motion" });
  #joints = [];
  #moved;
  #rested;
  #chosen;
  #x = null;
  #last = null;
  #step;
  #size;
  #shown = null;

  /** `moved(i, at)` asks for the end of segment i at a place, where ends can be moved; `chosen(i)` is a click on a bar. */
  constructor({ moved = null, rested = () => {}, chosen, step = 1 }) {
    this.#step = step;
    this.#moved = moved;
    this.#rested = rested;
    this.#chosen = chosen;
    this.#size = sized(this.element, () => this.#shown && this.show(...this.#shown));
  }

  show({ segments = [], range, unit }, span) {
    this.#shown = [{ segments, range, unit }, span];
    const [width] = this.#size();
    this.#x = scale(span, [BOX.left, width - BOX.right]);
    const x = (value) => Math.min(width - BOX.right, Math.max(BOX.left, this.#x(value)));
    const names = JSON.stringify(segments.map(({ name }) => name));
    if (names !== this.#last) this.#build(segments);
    this.#last = names;
    [...this.element.querySelectorAll(".bar")].forEach((bar, i) => {
      const [from, to] = segments[i].at.map(x);
      Object.assign(bar.style, { left: `${from}px`, width: `${to - from}px` });
      bar.firstElementChild.hidden = to - from < NARROW * segments[i].name.length;
      bar.title = `${segments[i].name}: ${number(segments[i].at[0], unit)} to ${number(segments[i].at[1], unit)}`;
    });
    this.#joints.forEach((joint, i) => {
      const at = segments[i].at[1];
      joint.hidden = at < span[0] || at > span[1];
      joint.style.left = `${x(at)}px`;
      const values = { "aria-valuemin": segments[i].at[0], "aria-valuemax": segments[i + 1]?.at[1] ?? range[1], "aria-valuenow": at, "aria-valuetext": number(at, unit) };
      for (const [name, value] of Object.entries(values)) joint.setAttribute(name, value);
    });
  }

  #build(segments) {
    const bars = segments.map(({ name }, i) => html("button", { type: "button", class: "bar", tabindex: "-1", onclick: () => this.#chosen(i) }, html("span", { text: name })));
    this.#joints = this.#moved ? segments.slice(0, -1).map(({ name }, i) => this.#joint(name, segments[i + 1].name, i)) : [];
    this.element.replaceChildren(...bars, ...this.#joints);
  }

  #joint(before, after, i) {
    const joint = html("div", { class: "joint-handle", role: "slider", tabindex: "0", "aria-label": `Where ${before} ends and ${after} begins` });
    const to = (at) => {
      const [least, most] = ["aria-valuemin", "aria-valuemax"].map((name) => Number(joint.getAttribute(name)));
      const round = Number((Math.round(at / this.#step) * this.#step).toPrecision(9));
      this.#moved(i, Math.min(most - this.#step, Math.max(least + this.#step, round)));
    };
    joint.addEventListener("pointerdown", (event) => {
      joint.setPointerCapture(event.pointerId);
      joint.focus();
      event.preventDefault();
    });
    joint.addEventListener("pointermove", (event) => joint.hasPointerCapture(event.pointerId) && to(this.#x.back(event.clientX - this.element.getBoundingClientRect().left)));
    joint.addEventListener("pointerup", () => this.#rested());
    joint.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (!step) return;
      event.preventDefault();
      to(Number(joint.getAttribute("aria-valuenow")) + step * this.#step);
    });
    return joint;
  }
}

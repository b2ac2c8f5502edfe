// The law and its derivatives, one below the other over k, with their peaks marked; several laws in one picture.

import { frame, label, scale, ticks } from "./axes.js";
import { html, path, svg } from "./svg.js";

const NAMES = { a: "displacement a", b: "velocity b", c: "acceleration c", d: "power d", j: "jerk j" };
const BOX = { left: 50, right: 14, top: 18, bottom: 6 };
const FOOT = 34;
const LETTER = 17;

export class Curves {
  #root;
  #drawn = [];
  #views = [];
  #active = 0;

  constructor(root) {
    this.#root = root;
    new ResizeObserver(() => this.#draw()).observe(root);
    root.addEventListener("pointermove", (event) => this.#read(event));
    root.addEventListener("pointerleave", () => this.#read(null));
  }

  show(views, active) {
    this.#views = views;
    this.#active = active;
    this.#draw();
  }

  #draw() {
    const width = this.#root.clientWidth - 16;
    const letters = Object.keys(NAMES);
    const height = Math.max(86, Math.floor((this.#root.clientHeight - 16 - FOOT) / letters.length));
    if (width < 100) return;
    const x = scale([0, 1], [BOX.left, width - BOX.right]);
    this.#drawn = letters.map((letter, i) => this.#panel(letter, width, height, x, i === letters.length - 1));
    this.#root.replaceChildren(...this.#drawn.map((panel) => panel.element));
    const view = this.#views[this.#active];
    if (view?.refused && !this.#views.some((one) => one?.curves)) this.#root.append(html("div", { class: "nothing" }, html("strong", { text: view.refused.word }), html("span", { text: "there is nothing to draw" })));
  }

  #panel(letter, width, height, x, last) {
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    const laws = this.#views.map((view, i) => ({ view, i })).filter(({ view }) => view && view.curves);
    const values = laws.flatMap(({ view }) => view.curves[letter].filter((one) => one !== null));
    const [low, high] = [Math.min(0, ...values), Math.max(letter === "a" ? 1 : 0, ...values)];
    // room for what is written above and below peaks
    const size = ((high - low || 1) * LETTER) / (box.bottom - box.top - 2 * LETTER);
    const y = scale([low < 0 ? low - size : low, high + (letter === "a" ? 0.2 : 1) * size], [box.bottom, box.top]);
    const element = svg("svg", { class: "curve", width, height: height + (last ? FOOT : 0), role: "img", "aria-label": this.#told(letter) });
    const xs = [0, 0.25, 0.5, 0.75, 1];
    element.append(frame(box, x, y, { xs, ys: ticks(low, high, 4), xlabels: last, xname: last ? "dimensionless time k" : "" }));
    element.append(svg("text", { class: "title", x: box.left, y: 13, text: NAMES[letter] }));
    if (letter === "j" && this.#views[this.#active]?.constants?.some(({ name, value }) => name === "J" && value === null)) element.append(svg("text", { class: "limit-name", x: box.left + 50, y: 13, text: "without bound: c jumps" }));
    for (const { view, i } of laws.toSorted((one, other) => (one.i === this.#active) - (other.i === this.#active))) {
      const places = view.curves.k.map((k, n) => (view.curves[letter][n] === null ? null : [x(k), y(view.curves[letter][n])]));
      element.append(svg("path", { class: `line law-${i}${i === this.#active ? " active" : ""}`, d: path(places) }));
    }
    const view = this.#views[this.#active];
    if (view && view.peaks) for (const peak of view.peaks[letter] ?? []) element.append(this.#peak(peak, x, y, box));
    const cursor = svg("line", { class: "cursor", y1: box.top, y2: box.bottom, visibility: "hidden" });
    const reading = svg("text", { class: "reading", x: box.right, y: 13, "text-anchor": "end" });
    element.append(cursor, reading);
    return { element, letter, x, cursor, reading };
  }

  #peak(peak, x, y, box) {
    const at = [x(peak.k), y(peak.value)];
    const above = peak.value > 0;
    const anchor = at[0] > box.right - 60 ? "end" : at[0] < box.left + 60 ? "start" : "middle";
    const height = at[1] + (above ? -7 : 16);
    const shift = anchor === "middle" ? 0 : anchor === "start" ? 7 : -7;
    return svg(
      "g",
      { class: `peak law-${this.#active}` },
      svg("circle", { cx: at[0].toFixed(1), cy: at[1].toFixed(1), r: 3 }),
      svg("text", { x: (at[0] + shift).toFixed(1), y: height.toFixed(1), "text-anchor": anchor, text: peak.text }),
    );
  }

  #told(letter) {
    const view = this.#views[this.#active];
    if (!view || !view.peaks) return `${NAMES[letter]}: no law to draw`;
    const peaks = (view.peaks[letter] ?? []).map((peak) => `${peak.text} at k = ${label(peak.k)}`);
    return `${NAMES[letter]} over k${peaks.length ? `: ${peaks.join(", ")}` : ""}`;
  }

  /** A line through all panels at the pointer, with the values there. */
  #read(event) {
    const view = this.#views[this.#active];
    const panel = event && this.#drawn.find(({ element }) => element.contains(event.target));
    for (const { cursor, reading, letter, x } of this.#drawn) {
      if (!panel || !view || !view.curves) {
        cursor.setAttribute("visibility", "hidden");
        reading.textContent = "";
        continue;
      }
      const k = Math.min(1, Math.max(0, x.back(event.clientX - panel.element.getBoundingClientRect().left)));
      const n = view.curves.k.reduce((best, one, i) => (Math.abs(one - k) < Math.abs(view.curves.k[best] - k) ? i : best), 0);
      const at = x(view.curves.k[n]).toFixed(1);
      cursor.setAttribute("x1", at);
      cursor.setAttribute("x2", at);
      cursor.setAttribute("visibility", "visible");
      const value = view.curves[letter][n];
      reading.textContent = value === null ? "" : `${letter}(${label(view.curves.k[n])}) = ${label(value)}`;
    }
  }
}

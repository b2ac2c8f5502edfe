// A picture of lines over two axes with handles: each is dragged along one of them, by the pointer or by arrow keys.
//
// A picture has {x, y, lines, marks, labels, zones, handles, told}. An axis is {name, range, log}; a line {points, name,
// title}, `name` being its classes; a mark {at, name, title}; a label {at, text, name, anchor}; a zone {from, to, name} of x;
// a handle {key, at, along, low, high, step, label, text, name}. `told` is the picture in words.

import { frame, scale, ticks } from "./axes.js";
import { path, sized, svg } from "./svg.js";

const BOX = { left: 58, right: 16, top: 14, bottom: 44 };
const HALO = 13;

/** A scale of an axis; a logarithmic one has round ticks of its own. */
function scaled({ range, log = false }, ends) {
  if (!log) return scale(range, ends);
  const linear = scale(range.map(Math.log10), ends);
  const to = (value) => linear(Math.log10(value));
  to.back = (pixel) => 10 ** linear.back(pixel);
  return to;
}

const PARTS = [[1, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]]; // of a power of ten
const APART = 44; // pixels between the middles of two labels

/** Round ticks of an axis; of a logarithmic one as many as have room for their labels. */
function marked({ range: [low, high], log = false }, count, to) {
  if (!log) return ticks(low, high, count);
  const powers = Array.from({ length: Math.ceil(Math.log10(high)) - Math.floor(Math.log10(low)) + 1 }, (_, i) => 10 ** (Math.floor(Math.log10(low)) + i));
  const sets = PARTS.map((parts) => powers.flatMap((power) => parts.map((part) => Number((part * power).toPrecision(3)))).filter((value) => value >= low && value <= high));
  return sets.find((found) => found.every((value, i) => i === 0 || Math.abs(to(value) - to(found[i - 1])) >= APART)) ?? sets.at(-1);
}

/** A range around values with room for what is written; 0 is in it unless `free`. */
export function spanOf(values, { free = false, room = 0.08 } = {}) {
  const known = values.filter((value) => value !== null && Number.isFinite(value));
  const [low, high] = [Math.min(...known, ...(free ? [] : [0])), Math.max(...known, ...(free ? [] : [0]))];
  const more = room * (high - low || Math.abs(high) || 1);
  return [low < 0 || free ? low - more : low, high > 0 || free ? high + more : high];
}

export class Chart {
  #root;
  #size;
  #moved;
  #shown = null;
  #svg = svg("svg", { class: "plane chart" });
  #back = svg("g", { role: "img" });
  #handles = new Map();
  #dragged = null;
  #x = null;
  #y = null;

  /** `moved(key, value)` is called while a handle moves, and with null when it rests. */
  constructor(root, moved) {
    this.#root = root;
    this.#moved = moved;
    this.#svg.append(this.#back);
    root.append(this.#svg);
    this.#size = sized(root, () => this.#draw());
    this.#svg.addEventListener("pointermove", (event) => this.#move(event));
    this.#svg.addEventListener("pointerup", () => this.#release());
    this.#svg.addEventListener("pointercancel", () => this.#release());
  }

  show(picture) {
    this.#shown = picture;
    this.#draw();
  }

  #draw() {
    const [width, height] = this.#size();
    this.#svg.toggleAttribute("hidden", !this.#shown);
    if (!this.#shown || width < 120 || height < 90) return;
    const { x, y, lines = [], marks = [], labels = [], zones = [], handles = [], told } = this.#shown;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    this.#x = scaled(x, [box.left, box.right]);
    this.#y = scaled(y, [box.bottom, box.top]);
    for (const [name, value] of Object.entries({ width, height })) this.#svg.setAttribute(name, value);
    this.#back.setAttribute("aria-label", told);
    const at = ([one, other]) => [this.#x(one), this.#y(other)];
    const clipped = `clip-${this.#root.id}`;
    const inner = svg("g", { "clip-path": `url(#${clipped})` });
    for (const { from, to, name } of zones) inner.append(svg("rect", { class: name, x: this.#x(from), width: Math.max(1, this.#x(to) - this.#x(from)), y: box.top, height: box.bottom - box.top }));
    for (const { points, name, title } of lines) inner.append(svg("path", { class: name, d: path(points.map((one) => (one === null || one.includes(null) ? null : at(one)))) }, title ? svg("title", { text: title }) : null));
    for (const { at: place, name, title } of marks) inner.append(svg("circle", { class: name, cx: at(place)[0].toFixed(1), cy: at(place)[1].toFixed(1), r: 3.2 }, title ? svg("title", { text: title }) : null));
    const written = labels.map(({ at: place, text, name = "", anchor = "start", up = 5 }) => svg("text", { class: name, x: at(place)[0].toFixed(1), y: Math.max(box.top + 10, at(place)[1] - up).toFixed(1), "text-anchor": anchor, text }));
    this.#back.replaceChildren(
      svg("clipPath", { id: clipped }, svg("rect", { x: box.left, y: box.top, width: Math.max(1, box.right - box.left), height: Math.max(1, box.bottom - box.top) })),
      frame(box, this.#x, this.#y, { xs: marked(x, 7, this.#x), ys: marked(y, 5, this.#y), xname: x.name, yname: y.name }),
      inner,
      svg("g", { class: "names", "aria-hidden": "true" }, ...written),
    );
    this.#drawHandles(handles, box);
  }

  /** Handles stay while they are dragged or have the focus: they are moved, not made again. */
  #drawHandles(handles, box) {
    const kept = new Set(handles.map(({ key }) => key));
    for (const [key, { element }] of this.#handles) {
      if (kept.has(key)) continue;
      element.remove();
      this.#handles.delete(key);
    }
    for (const handle of handles) {
      const known = this.#handles.get(handle.key) ?? this.#made(handle);
      known.handle = handle;
      const [x, y] = [this.#x(handle.at[0]), this.#y(handle.at[1])];
      const inside = [Math.min(Math.max(x, box.left), box.right), Math.min(Math.max(y, box.top), box.bottom)];
      known.element.setAttribute("transform", `translate(${inside[0].toFixed(1)} ${inside[1].toFixed(1)})`);
      known.element.setAttribute("class", `handle along-${handle.along} ${handle.name ?? "law-0"}`);
      const attributes = {
        "aria-label": handle.label, "aria-orientation": handle.along === "x" ? "horizontal" : "vertical", "aria-valuemin": handle.low,
        "aria-valuemax": handle.high, "aria-valuenow": handle.at[handle.along === "x" ? 0 : 1], "aria-valuetext": handle.text,
      };
      for (const [name, value] of Object.entries(attributes)) known.element.setAttribute(name, value);
      known.element.querySelector("title").textContent = `${handle.label}: ${handle.text}`;
      const across = handle.along === "x";
      const line = { x1: 0, x2: across ? 0 : box.right - inside[0], y1: 0, y2: across ? box.bottom - inside[1] : 0 };
      for (const [name, value] of Object.entries(line)) known.element.querySelector(".guide").setAttribute(name, value);
    }
  }

  #made({ key }) {
    const element = svg("g", { tabindex: "0", role: "slider", "data-key": key }, svg("title"), svg("line", { class: "guide" }), svg("circle", { class: "halo", r: HALO }), svg("circle", { class: "dot", r: 6 }));
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.#svg.setPointerCapture(event.pointerId);
      this.#dragged = key;
      element.focus({ preventScroll: true });
      event.preventDefault();
    });
    element.addEventListener("keydown", (event) => this.#key(event, key));
    this.#svg.append(element);
    const known = { element };
    this.#handles.set(key, known);
    return known;
  }

  #move(event) {
    const handle = this.#handles.get(this.#dragged)?.handle;
    if (!handle) return;
    const corner = this.#svg.getBoundingClientRect();
    this.#to(handle, handle.along === "x" ? this.#x.back(event.clientX - corner.left) : this.#y.back(event.clientY - corner.top));
  }

  #release() {
    if (this.#dragged !== null) this.#moved(this.#dragged, null);
    this.#dragged = null;
  }

  #to({ key, low, high, step }, value) {
    const kept = Math.min(high, Math.max(low, value));
    const round = Math.min(high, Math.max(low, Math.round(kept / step) * step));
    this.#moved(key, Number(round.toPrecision(9)));
  }

  #key(event, key) {
    const { handle } = this.#handles.get(key);
    const step = handle.step * (event.shiftKey ? 100 : 10);
    const steps = { ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step, PageDown: -10 * step, PageUp: 10 * step };
    const now = handle.at[handle.along === "x" ? 0 : 1];
    if (event.key === "Home") this.#to(handle, handle.low);
    else if (event.key === "End") this.#to(handle, handle.high);
    else if (event.key in steps) this.#to(handle, now + steps[event.key]);
    else return;
    event.preventDefault();
  }
}

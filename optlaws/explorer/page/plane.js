// The plane of two constants: front, limit, standard laws, Savin's families, and the laws of the study; one is dragged.

import { frame, scale, ticks } from "./axes.js";
import { path, renew, sized, svg } from "./svg.js";

const BOX = { left: 58, right: 16, top: 12, bottom: 44 };
const HALO = 13;
const WRITTEN = 165; // pixels that the name of the limit takes
const STEPS = { B: 0.001, C: 0.01, D: 0.01, J: 0.1 };

/** A bound is rounded up: the law that has the value keeps it. */
const rounded = (value, step, up) => Number(((up ? Math.ceil(value / step - 1e-9) : Math.round(value / step)) * step).toPrecision(8));

/** Whether two pieces of writing, or a mark and one, are in each other's way. */
const overlap = (one, other) => Math.abs(one.y - other.y) < 11 && one.left < other.right && one.right > other.left;

export class Plane {
  #root;
  #size;
  #svg = svg("svg", { class: "plane" });
  #back = svg("g");
  #points = svg("g");
  #handle = svg("g", { class: "handle", tabindex: "0", role: "slider" }, svg("circle", { class: "halo", r: HALO }), svg("circle", { class: "dot", r: 6 }));
  #tip = svg("text", { class: "tip", "aria-hidden": "true" });
  #asked;
  #moved;
  #picked;
  #front = null;
  #laws = [];
  #active = 0;
  #x = null;
  #y = null;
  #dragging = false;

  /** `asked(x)` is what the active law is asked now: an answer may be on its way. */
  constructor(root, asked, moved, picked) {
    this.#root = root;
    this.#asked = asked;
    this.#moved = moved;
    this.#picked = picked;
    this.#svg.append(this.#back, this.#points, this.#handle, this.#tip);
    root.append(this.#svg);
    this.#size = sized(root, () => this.#draw());
    this.#svg.addEventListener("pointerdown", (event) => this.#grasp(event));
    this.#svg.addEventListener("pointermove", (event) => this.#dragging && this.#move(event));
    this.#svg.addEventListener("pointerup", () => this.#release());
    this.#svg.addEventListener("pointercancel", () => this.#release());
    this.#handle.addEventListener("keydown", (event) => this.#key(event));
  }

  showFront({ series = [], ...front }) {
    const curve = (name) => series.filter((one) => one.name === name).flatMap(({ at, values }) => at.map((x, i) => [x, values[i]]).filter(([, y]) => y !== null));
    this.#front = { ...front, line: curve("front"), best: curve("best possible") };
    this.#draw();
  }

  /** `laws` are {asked, view}; `asked` is the value of x that the active one is asked to have, or null. */
  showLaws(laws, active) {
    this.#laws = laws;
    this.#active = active;
    this.#drawLaws();
  }

  #draw() {
    const [width, height] = this.#size();
    if (!this.#front || width < 120 || height < 120) return;
    const { x, y, ranges } = this.#front;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    this.#x = scale(ranges[0], [box.left, box.right]);
    this.#y = scale(ranges[1], [box.bottom, box.top]);
    this.#svg.setAttribute("width", width);
    this.#svg.setAttribute("height", height);
    this.#svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const clip = svg("clipPath", { id: "plane-clip" }, svg("rect", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
    const lines = svg("g", { "clip-path": "url(#plane-clip)" });
    const at = ([one, other]) => [this.#x(one), this.#y(other)];
    if (this.#front.best.length) lines.append(svg("path", { class: "limit", d: path(this.#front.best.map(at)) }));
    for (const { line } of this.#front.families) lines.append(svg("path", { class: "family", d: path(line.map(at)) }));
    lines.append(svg("path", { class: this.#front.proven ? "front" : "front local", d: path(this.#front.line.map(at)) }));
    // what is not proven is no curve but the laws that were found
    if (!this.#front.proven) for (const [cx, cy] of this.#front.line.map(at)) lines.append(svg("circle", { class: "front-point", cx: cx.toFixed(1), cy: cy.toFixed(1), r: 2.2 }));
    const names = { xs: ticks(...ranges[0], 7), ys: ticks(...ranges[1], 6), xname: `${NAMES[x]} ${x}`, yname: `${NAMES[y]} ${y}` };
    renew(this.#back, clip, frame(box, this.#x, this.#y, names), lines, this.#names(box), ...this.#known(box));
    this.#drawLaws();
  }

  #inside([x, y], box) {
    return x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
  }

  /** The names of the families, at the last of their points within the picture, and of the best possible. */
  #names(box) {
    const group = svg("g", { class: "names", "aria-hidden": "true" });
    const at = ([x, y]) => [this.#x(x), this.#y(y)];
    for (const { name, line } of this.#front.families) {
      const place = line.map(at).findLast((one) => this.#inside(one, { ...box, top: box.top + 12, right: box.right - 14 }));
      if (place) group.append(svg("text", { class: "family-name", x: place[0] + 5, y: place[1] + 4, text: name }));
    }
    const best = this.#front.best.map(at).filter((one) => this.#inside(one, box));
    // no smooth law lies below and before the best possible: there is room
    const place = best[Math.floor(best.length * 0.22)];
    if (place && place[0] > box.left + WRITTEN) group.append(svg("text", { class: "limit-name", x: place[0] - 8, y: place[1] + 14, "text-anchor": "end", text: "best possible with any law of this order" }));
    return group;
  }

  #known(box) {
    const places = this.#front.known.map(({ at }) => [this.#x(at[0]), this.#y(at[1])]);
    const [shown, written] = [[], []];
    for (const { name, at, text, named } of this.#front.known) {
      const place = [this.#x(at[0]), this.#y(at[1])];
      if (!this.#inside(place, box)) continue;
      const tell = () => this.#tell(text, place, box);
      const pick = (event) => {
        event.stopPropagation();
        this.#picked(name);
      };
      const point = svg(
        "g",
        {
          class: "known", tabindex: shown.length ? "-1" : "0", role: "button", "aria-label": `${text}. Compare`,
          onpointerenter: tell, onfocus: tell, onpointerleave: () => this.#tell(""), onblur: () => this.#tell(""),
          onpointerdown: (event) => event.stopPropagation(), onclick: pick,
          onkeydown: (event) => this.#walk(event, pick),
        },
        svg("circle", { class: "halo", cx: place[0], cy: place[1], r: 9 }),
        svg("circle", { class: "mark", cx: place[0], cy: place[1], r: 3.2 }),
      );
      const end = place[0] > box.right - 120;
      const space = { left: end ? place[0] - 6 * name.length - 7 : place[0] + 5, right: end ? place[0] - 5 : place[0] + 6 * name.length + 7, y: place[1] };
      const free = !written.some((one) => overlap(one, space)) && !places.some(([left, y]) => overlap({ left, right: left, y }, space));
      if (named && free) {
        written.push(space);
        point.append(svg("text", { x: place[0] + (end ? -7 : 7), y: place[1] + 4, "text-anchor": end ? "end" : "start", text: name }));
      }
      shown.push(point);
    }
    return shown;
  }

  /** Standard laws are one stop of the tabulator: arrows go from one to the next. */
  #walk(event, pick) {
    const all = [...this.#svg.querySelectorAll(".known")];
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter" || event.key === " ") pick(event);
    else if (step) all[(all.indexOf(event.currentTarget) + step + all.length) % all.length].focus();
    else return;
    event.preventDefault();
  }

  #tell(text, place = [0, 0], box = null) {
    this.#tip.textContent = text;
    if (!text) return;
    const end = place[0] > (box.left + box.right) / 2;
    this.#tip.setAttribute("x", place[0] + (end ? -8 : 8));
    this.#tip.setAttribute("y", Math.max(box.top + 12, place[1] - 10));
    this.#tip.setAttribute("text-anchor", end ? "end" : "start");
  }

  #drawLaws() {
    if (!this.#x) return;
    const { x, y } = this.#front;
    this.#points.replaceChildren();
    this.#laws.forEach(({ view }, i) => {
      const place = this.#place(view, x, y);
      if (i === this.#active || place === null) return;
      this.#points.append(svg("circle", { class: `point law-${i}`, cx: place[0], cy: place[1], r: 5 }));
    });
    this.#drawHandle(x, y);
  }

  #place(view, x, y) {
    const of = (name) => view?.constants?.find((one) => one.name === name)?.value;
    const [first, second] = [of(x), of(y)];
    return first == null || second == null ? null : [this.#x(first), this.#y(second)];
  }

  #drawHandle(x, y) {
    const law = this.#laws[this.#active];
    const height = Number(this.#svg.getAttribute("height"));
    const width = Number(this.#svg.getAttribute("width"));
    let place = this.#place(law?.view, x, y);
    const none = Boolean(law?.view?.refused);
    if (none && typeof law.asked === "number") place = [this.#x(law.asked), height - BOX.bottom];
    this.#handle.setAttribute("visibility", place ? "visible" : "hidden");
    if (!place) return;
    const kept = [Math.min(Math.max(place[0], BOX.left), width - BOX.right), Math.min(Math.max(place[1], BOX.top), height - BOX.bottom)];
    this.#handle.setAttribute("transform", `translate(${kept[0].toFixed(1)} ${kept[1].toFixed(1)})`);
    this.#handle.setAttribute("class", `handle law-${this.#active}${none ? " none" : ""}${law.movable ? "" : " fixed"}`);
    const text = none ? "no such law" : law.view.constants.filter(({ name }) => name === x || name === y).map((one) => `${one.name} = ${one.text}`).join(", ");
    const [low, high] = this.#front.ranges[0];
    const attributes = { "aria-label": `The law in the plane: ${x}`, "aria-valuemin": low, "aria-valuemax": high, "aria-valuenow": law.asked ?? "", "aria-valuetext": text };
    for (const [name, value] of Object.entries(attributes)) this.#handle.setAttribute(name, value);
  }

  #grasp(event) {
    if (event.button !== 0 || !this.#laws[this.#active]?.movable) return;
    this.#svg.setPointerCapture(event.pointerId);
    this.#dragging = true;
    // a click on the law itself moves nothing
    if (!this.#handle.contains(event.target)) this.#move(event);
    this.#handle.focus({ preventScroll: true });
    event.preventDefault();
  }

  #move(event) {
    this.#to(this.#x.back(event.clientX - this.#svg.getBoundingClientRect().left));
  }

  #release() {
    if (this.#dragging) this.#moved(null);
    this.#dragging = false;
  }

  #to(value) {
    const [low, high] = this.#front.ranges[0];
    this.#moved(rounded(Math.min(high, Math.max(low, value)), STEPS[this.#front.x], this.#front.x !== "B"), this.#front.x, this.#front.y);
  }

  #key(event) {
    const law = this.#laws[this.#active];
    const step = STEPS[this.#front?.x] * (event.shiftKey ? 100 : 10);
    const steps = { ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step, PageDown: -10 * step, PageUp: 10 * step };
    if (!law?.movable || !(event.key in steps)) return;
    event.preventDefault();
    const from = this.#asked(this.#front.x) ?? law.view.constants.find((one) => one.name === this.#front.x).value;
    this.#to(from + steps[event.key]);
  }
}

export const NAMES = { B: "peak velocity", C: "peak acceleration", D: "peak power", J: "peak jerk", rms_c: "rms acceleration" };


// A picture over two axes: lines, marks, labels, standard things that can be picked, and handles that are dragged along one
// axis or both, by the pointer or by arrow keys.
//
// A picture has {x, y, zones, lines, marks, labels, picks, points, handles, told, of}. An axis is {name, range, log}; a zone
// {from, to, name} of x; a line {points, name, title, closed}, `name` being its classes; a mark {at, name, title, r}; a label
// {at, text, name, anchor, up, aside, room} with the pixels that must be free on its left; a pick {key, at, text, named}, whose key is
// written beside it where `named` says so and there is room; a point is a mark that moves; a handle {key, at, along, low, high,
// step, label, text, name} and perhaps {from, up, anywhere, fixed}: a function of where keys go from, whether it is rounded up, whether the
// whole picture drags it, whether nothing does. `told` is the picture in words. All but points and handles are drawn once for
// an object `of`.

import { frame, scale, ticks } from "./axes.js";
import { path, renew, sized, svg } from "./svg.js";

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

/** Whether two pieces of writing, or a mark and one, are in each other's way. */
const overlap = (one, other) => Math.abs(one.y - other.y) < 11 && one.left < other.right && one.right > other.left;

const within = (value, low, high) => Math.min(high, Math.max(low, value));

export class Chart {
  #root;
  #size;
  #moved;
  #picked;
  #shown = null;
  #drawn = []; // what the ground is drawn of
  #svg = svg("svg", { class: "plane chart" });
  #back = svg("g", { role: "img" });
  #picks = svg("g");
  #points = svg("g");
  #tip = svg("text", { class: "tip", "aria-hidden": "true" });
  #handles = new Map();
  #dragged = null;
  #box = null;
  #x = null;
  #y = null;

  /** `moved(key, value)` is called while a handle moves, and with null when it rests; `picked(key)` when something is. */
  constructor(root, moved, picked = () => {}) {
    this.#root = root;
    this.#moved = moved;
    this.#picked = picked;
    this.#svg.append(this.#back, this.#picks, this.#points, this.#tip);
    root.append(this.#svg);
    this.#size = sized(root, () => this.#draw());
    this.#svg.addEventListener("pointerdown", (event) => this.#graspAnywhere(event));
    this.#svg.addEventListener("pointermove", (event) => this.#move(event));
    this.#svg.addEventListener("pointerup", () => this.#release());
    this.#svg.addEventListener("pointercancel", () => this.#release());
  }

  show(picture) {
    this.#shown = picture;
    this.#draw();
  }

  #at = ([one, other]) => [this.#x(one), this.#y(other)];

  #draw() {
    const [width, height] = this.#size();
    this.#svg.toggleAttribute("hidden", !this.#shown);
    if (!this.#shown || width < 120 || height < 90) return;
    const { points = [], handles = [], told = "", of = {} } = this.#shown;
    const drawn = [of, width, height];
    if (drawn.some((one, i) => one !== this.#drawn[i])) this.#ground(width, height);
    this.#drawn = drawn;
    this.#back.setAttribute("aria-label", told);
    this.#points.replaceChildren(...points.map((point) => this.#mark(point)));
    this.#drawHandles(handles);
  }

  #ground(width, height) {
    const { x, y, lines = [], marks = [], labels = [], zones = [], picks = [] } = this.#shown;
    const box = (this.#box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom });
    this.#x = scaled(x, [box.left, box.right]);
    this.#y = scaled(y, [box.bottom, box.top]);
    for (const [name, value] of Object.entries({ width, height })) this.#svg.setAttribute(name, value);
    const clipped = `clip-${this.#root.id}`;
    const inner = svg("g", { "clip-path": `url(#${clipped})` });
    for (const { from, to, name } of zones) inner.append(svg("rect", { class: name, x: this.#x(from), width: Math.max(1, this.#x(to) - this.#x(from)), y: box.top, height: box.bottom - box.top }));
    for (const { points, name, title, closed } of lines) inner.append(svg("path", { class: name, d: `${path(points.map((one) => (one === null || one.includes(null) ? null : this.#at(one))))}${closed ? "Z" : ""}` }, title ? svg("title", { text: title }) : null));
    inner.append(...marks.map((mark) => this.#mark(mark)));
    const written = labels.filter(({ at, room = 0 }) => this.#x(at[0]) - room >= box.left).map((label) => this.#label(label));
    this.#back.replaceChildren(
      svg("clipPath", { id: clipped }, svg("rect", { x: box.left, y: box.top, width: Math.max(1, box.right - box.left), height: Math.max(1, box.bottom - box.top) })),
      frame(box, this.#x, this.#y, { xs: marked(x, 7, this.#x), ys: marked(y, 5, this.#y), xname: x.name, yname: y.name }),
      inner,
      svg("g", { class: "names", "aria-hidden": "true" }, ...written),
    );
    renew(this.#picks, ...this.#drawPicks(picks));
  }

  /** A label stands above its place, below it where there is no room; `aside` is how far it stands on its side. */
  #label({ at, text, name = "", anchor = "start", up = 5, aside = 0 }) {
    const [x, y] = this.#at(at);
    const above = y - up >= this.#box.top + 12 || !aside ? Math.max(this.#box.top + 10, y - up) : y + 18;
    return svg("text", { class: name, x: (x + (anchor === "end" ? -aside : aside)).toFixed(1), y: above.toFixed(1), "text-anchor": anchor, text });
  }

  #mark({ at, name, title, r = 3.2 }) {
    const [x, y] = this.#at(at);
    return svg("circle", { class: name, cx: x.toFixed(1), cy: y.toFixed(1), r }, title ? svg("title", { text: title }) : null);
  }

  // --- what can be picked ---

  #drawPicks(picks) {
    const { left, right, top, bottom } = this.#box;
    const known = picks.map((pick) => ({ ...pick, place: this.#at(pick.at) }));
    const written = [];
    return known.filter(({ place: [x, y] }) => x >= left && x <= right && y >= top && y <= bottom).map(({ key, text, named, place }, i) => {
      const tell = () => this.#tell(text, place);
      const leave = () => this.#tell("");
      const point = svg(
        "g",
        {
          class: "known", tabindex: i ? "-1" : "0", role: "button", "aria-label": `${text}. Compare`,
          onpointerenter: tell, onfocus: tell, onpointerleave: leave, onblur: leave,
          onpointerdown: (event) => event.stopPropagation(), onclick: () => this.#picked(key), onkeydown: (event) => this.#walk(event, key),
        },
        svg("circle", { class: "halo", cx: place[0], cy: place[1], r: 9 }),
        svg("circle", { class: "mark", cx: place[0], cy: place[1], r: 3.2 }),
      );
      const end = place[0] > right - 120;
      const space = { left: end ? place[0] - 6 * key.length - 7 : place[0] + 5, right: end ? place[0] - 5 : place[0] + 6 * key.length + 7, y: place[1] };
      const free = !written.some((one) => overlap(one, space)) && !known.some(({ place: [x, y] }) => overlap({ left: x, right: x, y }, space));
      if (named && free) {
        written.push(space);
        point.append(svg("text", { x: place[0] + (end ? -7 : 7), y: place[1] + 4, "text-anchor": end ? "end" : "start", text: key }));
      }
      return point;
    });
  }

  /** What can be picked is one stop of the tabulator: arrows go from one to the next. */
  #walk(event, key) {
    const all = [...this.#picks.children];
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter" || event.key === " ") this.#picked(key);
    else if (step) all[(all.indexOf(event.currentTarget) + step + all.length) % all.length].focus();
    else return;
    event.preventDefault();
  }

  #tell(text, [x, y] = [0, 0]) {
    this.#tip.textContent = text;
    const end = x > (this.#box.left + this.#box.right) / 2;
    const attributes = { x: x + (end ? -8 : 8), y: Math.max(this.#box.top + 12, y - 10), "text-anchor": end ? "end" : "start" };
    for (const [name, value] of Object.entries(attributes)) this.#tip.setAttribute(name, value);
  }

  // --- handles ---

  /** Handles stay while they are dragged or have the focus: they are moved, not made again. */
  #drawHandles(handles) {
    const box = this.#box;
    const kept = new Set(handles.map(({ key }) => key));
    for (const [key, { element }] of this.#handles) {
      if (kept.has(key)) continue;
      element.remove();
      this.#handles.delete(key);
    }
    for (const handle of handles) {
      const known = this.#handles.get(handle.key) ?? this.#made(handle);
      known.handle = handle;
      const [x, y] = this.#at(handle.at);
      const inside = [within(x, box.left, box.right), within(y, box.top, box.bottom)];
      const across = handle.along !== "y";
      known.element.setAttribute("transform", `translate(${inside[0].toFixed(1)} ${inside[1].toFixed(1)})`);
      known.element.setAttribute("class", `handle along-${handle.along} ${handle.name ?? "law-0"}${handle.fixed ? " fixed" : ""}`);
      const attributes = {
        "aria-label": handle.label, "aria-orientation": across ? "horizontal" : "vertical", "aria-valuemin": handle.low,
        "aria-valuemax": handle.high, "aria-valuenow": handle.from?.() ?? handle.at[across ? 0 : 1], "aria-valuetext": handle.text,
      };
      for (const [name, value] of Object.entries(attributes)) if (value !== undefined) known.element.setAttribute(name, value);
      known.element.querySelector("title").textContent = `${handle.label}: ${handle.text}`;
      const guided = handle.along !== "both" && !handle.anywhere;
      const line = { x1: 0, x2: across || !guided ? 0 : box.right - inside[0], y1: 0, y2: across && guided ? box.bottom - inside[1] : 0 };
      for (const [name, value] of Object.entries(line)) known.element.querySelector(".guide").setAttribute(name, value);
    }
  }

  #made({ key }) {
    const element = svg("g", { tabindex: "0", role: "slider", "data-key": key }, svg("title"), svg("line", { class: "guide" }), svg("circle", { class: "halo", r: HALO }), svg("circle", { class: "dot", r: 6 }));
    element.addEventListener("pointerdown", (event) => this.#grasp(event, key));
    element.addEventListener("keydown", (event) => this.#key(event, key));
    this.#svg.append(element);
    const known = { element };
    this.#handles.set(key, known);
    return known;
  }

  #grasp(event, key) {
    const { element, handle } = this.#handles.get(key);
    if (event.button !== 0 || handle.fixed) return;
    this.#svg.setPointerCapture(event.pointerId);
    this.#dragged = key;
    element.focus({ preventScroll: true });
    event.preventDefault();
  }

  /** A click on a handle moves nothing; one beside the handle of the whole picture moves it there. */
  #graspAnywhere(event) {
    const key = [...this.#handles].find(([, { handle }]) => handle.anywhere)?.[0];
    if (key === undefined || this.#dragged !== null) return;
    this.#grasp(event, key);
    this.#move(event);
  }

  #move(event) {
    const handle = this.#handles.get(this.#dragged)?.handle;
    if (!handle) return;
    const corner = this.#svg.getBoundingClientRect();
    const place = [this.#x.back(event.clientX - corner.left), this.#y.back(event.clientY - corner.top)];
    this.#to(handle, { x: place[0], y: place[1], both: place }[handle.along]);
  }

  #release() {
    if (this.#dragged !== null) this.#moved(this.#dragged, null);
    this.#dragged = null;
  }

  #to({ key, along, low, high, step, up = false }, value) {
    const round = (one, by) => Number(((up ? Math.ceil(one / by - 1e-9) : Math.round(one / by)) * by).toPrecision(9));
    if (along === "both") this.#moved(key, value.map((one, i) => round(one, step[i])));
    else this.#moved(key, within(round(within(value, low, high), step), low, high));
  }

  #key(event, key) {
    const { handle } = this.#handles.get(key);
    const sign = { ArrowLeft: [-1, 0], ArrowDown: [0, -1], ArrowRight: [1, 0], ArrowUp: [0, 1], PageDown: [-10, 0], PageUp: [10, 0] }[event.key];
    if (handle.fixed) return;
    if (handle.along === "both") {
      if (!sign) return;
      this.#to(handle, handle.at.map((one, i) => one + sign[i] * handle.step[i] * (event.shiftKey ? 10 : 1)));
    } else if (event.key === "Home") this.#to(handle, handle.low);
    else if (event.key === "End") this.#to(handle, handle.high);
    else if (sign) this.#to(handle, (handle.from?.() ?? handle.at[handle.along === "x" ? 0 : 1]) + (sign[0] + sign[1]) * handle.step * (event.shiftKey ? 100 : 10));
    else return;
    event.preventDefault();
  }
}

// The timing diagram of axes: a row for each, moves as bars that are dragged, and what interlocks say between rows.

import { frame, scale, ticksIn } from "./axes.js";
import { moved, roomOf } from "./instants.js";
import { html, path, renew, sized, svg } from "./svg.js";
import { variableOf, written as inUnits } from "./units.js";

const BOX = { left: 84, right: 16, top: 8, foot: 40 };
const TURN = [0, 360];
const ROW = { least: 58, most: 92, name: 15 };
const ABOUT = 276; // pixels that all rows take where they can
const EDGE = 7; // pixels at the ends of a bar by which it is made longer or shorter
const SHORT = 30; // a bar of fewer pixels is moved only

export class Timing {
  #root;
  #size;
  #svg;
  #shown = null;
  #study = null;
  #changed;
  #x = null;
  #drag = null;
  #keyed = null;
  #cursor = svg("line", { class: "cursor run" });
  #angle = null;
  #marks = [];
  #states = [];

  /** `changed(row, segments)` is told the segments of a row whose bar was moved; null is that it is taken or let go. */
  constructor(root, changed) {
    this.#root = root;
    this.#changed = changed;
    this.#svg = svg("svg", { class: "curve timing", role: "group", "aria-label": "Timing diagram" });
    this.#svg.addEventListener("pointermove", (event) => this.#drag && this.#pull(event));
    for (const kind of ["pointerup", "pointercancel"]) this.#svg.addEventListener(kind, () => this.#release());
    this.#size = sized(root, () => this.#draw());
  }

  /** An answer of the axes for a study, the status of each interlock, where it is known, and whether it is the last one. */
  show(answer, study, states = [], last = true) {
    if (last) this.#keyed = null;
    this.#shown = answer;
    this.#study = study;
    this.#states = states;
    this.#draw();
  }

  /** The cursor stands at an angle of the master. */
  turn(angle) {
    this.#angle = angle;
    for (const mark of [this.#cursor, ...this.#marks.map(({ mark }) => mark)]) mark.setAttribute("visibility", angle === null ? "hidden" : "visible");
    if (!this.#x || angle === null) return;
    const at = this.#x(angle).toFixed(1);
    this.#cursor.setAttribute("x1", at);
    this.#cursor.setAttribute("x2", at);
    for (const { row, y, mark } of this.#marks) {
      mark.setAttribute("cx", at);
      mark.setAttribute("cy", y(valueAt(this.#shown.at, row.values, angle)).toFixed(1));
    }
  }

  #draw() {
    const width = this.#size()[0] - 16;
    if (!this.#shown || width < 100) return;
    if (this.#shown.refused) {
      this.#root.replaceChildren(html("div", { class: "nothing" }, html("strong", { text: this.#shown.refused.word }), html("span", { text: "there is nothing to draw" })));
      return;
    }
    const { rows, unit } = this.#shown;
    const each = Math.min(ROW.most, Math.max(ROW.least, Math.floor(ABOUT / rows.length)));
    const height = BOX.top + each * rows.length + BOX.foot;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.foot };
    this.#x = scale(TURN, [box.left, box.right]);
    this.#svg.setAttribute("width", width);
    this.#svg.setAttribute("height", height);
    const scales = rows.map(({ values }, i) => {
      const top = BOX.top + each * i;
      const [low, high] = [Math.min(...values), Math.max(...values)];
      return scale(low < high ? [low, high] : [low - 1, low + 1], [top + each - 4, top + ROW.name + 3]);
    });
    this.#marks = rows.map((row, i) => ({ row, y: scales[i], mark: svg("circle", { class: `point law-${i % 4}`, r: 4 }) }));
    for (const name of ["y1", "y2"]) this.#cursor.setAttribute(name, name === "y1" ? box.top : box.bottom);
    renew(
      this.#svg,
      frame(box, this.#x, scales[0], { xs: ticksIn(unit, TURN, 8), ys: [], xname: variableOf(this.#shown), unit }),
      ...rows.map((row, i) => this.#row(row, i, scales[i], box, each)),
      ...this.#shown.arrows.flatMap((arrow) => this.#arrow(arrow, scales)),
      this.#cursor,
      ...this.#marks.map(({ mark }) => mark),
    );
    if (this.#svg.parentNode !== this.#root) this.#root.replaceChildren(this.#svg);
    this.turn(this.#angle);
  }

  #row(row, i, y, box, each) {
    const top = BOX.top + each * i;
    const group = svg("g", { class: `row law-${i % 4}` });
    group.append(svg("line", { class: "grid", x1: 0, x2: box.right, y1: top + each, y2: top + each }));
    group.append(svg("text", { class: "title", translate: "no", x: 4, y: top + each / 2, text: shortened(row.name, 12) }, svg("title", { text: row.name })));
    group.append(svg("text", { x: 4, y: top + each / 2 + 15, text: row.stroke }));
    const line = svg("path", { class: "line active", d: path(this.#shown.at.map((at, k) => [this.#x(at), y(row.values[k])])) });
    group.append(...row.bars.filter(({ moves }) => moves).map((bar, place) => this.#bar(row, i, bar, place, top, each)), line);
    return group;
  }

  /** A bar is known by its place among the moves of its axis, which dwells that come and go do not change. */
  #bar(row, i, bar, place, top, each) {
    const number = row.bars.indexOf(bar);
    const [from, to] = [this.#x(bar.from), this.#x(bar.to)];
    const angle = (value) => inUnits({ value: Number(value.toFixed(2)), unit: "deg", digits: 5 });
    const text = `${bar.name} ${angle(bar.to - bar.from)}`;
    const edges = to - from >= SHORT ? [["start", from], ["stop", to - EDGE]] : [];
    const group = svg(
      "g",
      {
        class: "timing-bar", tabindex: 0, role: "slider", "data-key": `bar ${i} ${place}`,
        "aria-label": `${row.name}: ${bar.name}`, "aria-valuemin": 0, "aria-valuemax": 360, "aria-valuenow": Number(bar.from.toFixed(2)),
        "aria-valuetext": `from ${angle(bar.from)} to ${angle(bar.to)}`,
        onkeydown: (event) => this.#key(event, i, number),
        onpointerdown: (event) => this.#grasp(event, i, number, "both"),
      },
      svg("title", { text: `${row.name}: ${text}. Drag it, or its ends; ← → move it, ↑ ↓ make it longer and shorter` }),
      svg("rect", { class: "ground", x: from, width: Math.max(1, to - from), y: top + 1, height: each - 2, rx: 3 }),
      ...edges.map(([end, x]) => svg("rect", { class: "edge", x, width: EDGE, y: top + 1, height: each - 2, onpointerdown: (event) => this.#grasp(event, i, number, end) })),
    );
    const letters = Math.floor((to - from - 6) / 6);
    if (letters > 3) group.append(svg("text", { x: from + 4, y: top + ROW.name - 3, text: shortened(text, letters) }));
    return group;
  }

  /** What interlocks say: an arrow from what comes first, or the window in which two run together. */
  #arrow({ rule, name, rows, from, to, clear, window }, scales) {
    const word = this.#states[rule] ?? (clear === false ? "broken" : "clear");
    const look = `interlock ${word}`;
    if (window) {
      const [top, bottom] = rows.map((row) => scales[row](this.#shown.rows[row].values[0])).toSorted((a, b) => a - b);
      return [svg("rect", { class: `${look} window`, x: this.#x(window[0]), width: this.#x(window[1]) - this.#x(window[0]), y: top, height: bottom - top }, svg("title", { text: `${name}: ${word}` }))];
    }
    const end = [this.#x(to[0]), scales[rows[0]](to[1])];
    const dot = ([cx, cy], r) => svg("circle", { class: look, cx: cx.toFixed(1), cy: cy.toFixed(1), r });
    if (!from) return [dot(end, 4)];
    const start = [this.#x(from[0]), scales[rows[1]](from[1])];
    const title = svg("title", { text: `${name}: ${word}` });
    return [svg("g", { class: look, role: "img", "aria-label": `${name}: ${word}` }, title, svg("path", { class: "shaft-of-arrow", d: path([start, end]) }), svg("path", { class: "head-of-arrow", d: head(start, end) }), dot(start, 3))];
  }

  #grasp(event, row, number, ends) {
    if (event.button !== 0) return;
    event.stopPropagation();
    event.preventDefault();
    this.#svg.setPointerCapture(event.pointerId);
    const bars = this.#shown.rows[row].bars;
    this.#drag = { row, number, ends, bars, study: this.#study, period: this.#shown.period, x: event.clientX };
    event.currentTarget.closest(".timing-bar").focus({ preventScroll: true });
    this.#changed(row, null);
  }

  #pull(event) {
    const { x, ends } = this.#drag;
    const by = this.#x.back(event.clientX) - this.#x.back(x);
    this.#to(this.#drag, { start: ends === "stop" ? 0 : by, stop: ends === "start" ? 0 : by }, ends);
  }

  /** The ends of a bar go by so many degrees from where they were; a pointer takes them to round instants. */
  #to({ row, number, bars, study, period }, { start, stop }, ends) {
    const { from, to } = bars[number];
    const segments = moved(study.axis[row].segment, bars, number, { start: from + start, stop: to + stop }, { ends, snaps: ends !== "keys", period });
    if (segments) this.#changed(row, segments);
  }

  #release() {
    if (this.#drag) this.#changed(this.#drag.row, null);
    this.#drag = null;
  }

  #key(event, row, number) {
    const bars = this.#shown.rows[row].bars;
    const step = roomOf(this.#study.axis[row].segment[number], this.#shown.period).step * (event.shiftKey ? 10 : 1);
    const [start, stop] = { ArrowLeft: [-step, -step], ArrowRight: [step, step], ArrowDown: [0, -step], ArrowUp: [0, step] }[event.key] ?? [];
    if (start === undefined) return;
    event.preventDefault();
    // keys that come before their answer add up
    if (this.#keyed?.row !== row || this.#keyed.number !== number) this.#keyed = { row, number, bars, study: this.#study, period: this.#shown.period, by: { start: 0, stop: 0 } };
    const { by } = this.#keyed;
    this.#keyed.by = { start: by.start + start, stop: by.stop + stop };
    this.#to(this.#keyed, this.#keyed.by, "keys");
  }
}

/** The value of a curve between its points, for a mark that runs along it. */
export function valueAt(places, values, at) {
  let [low, high] = [0, places.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle] <= at) low = middle;
    else high = middle;
  }
  const share = (at - places[low]) / (places[high] - places[low] || 1);
  return values[low] + Math.min(1, Math.max(0, share)) * (values[high] - values[low]);
}

const shortened = (text, most) => (text.length > most ? `${text.slice(0, Math.max(1, most - 1))}…` : text);

function head([x1, y1], [x2, y2]) {
  const size = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [u, v] = [(x2 - x1) / size, (y2 - y1) / size];
  const [back, half] = [9, 3.6];
  const corner = (side) => [x2 - back * u - side * half * v, y2 - back * v + side * half * u];
  return `${path([[x2, y2], corner(1), corner(-1)])}Z`;
}

// One quantity over a variable: its curves, its limits, its peaks, and what a cursor reads of it.

import { frame, label, scale, ticks, ticksIn } from "./axes.js";
import { peakMarks } from "./peak_marks.js";
import { path, svg } from "./svg.js";
import { number, variableOf } from "./units.js";

export const BOX = { left: 64, right: 14, top: 20, bottom: 6 };
export const FOOT = 34;
const ROOM = 17; // pixels above and below the curve for what is written at its peaks
const NEAR = 1.6; // limits farther out than this many peaks are out of sight
const WRITTEN = 6.6;
const LAWS = "ABCD";

/** The least and the greatest value of a limit; null is none, and a value alone is that of both sides. */
const edges = ({ value, least = -value }) => [least ?? -Infinity, value ?? Infinity];
export const titled = ({ name, unit }) => (unit ? `${name}, ${unit}` : name);

export class Panel {
  #panel;
  #series;
  #box;
  #x;
  #y;
  #shown;
  #cursor = svg("g", { class: "reading", "aria-hidden": "true" });

  /** `shown` holds the answer, the span of the variable in sight, the law that is active, where limits are broken, and a name for its parts. */
  constructor(panel, shown, { width, height, last }) {
    this.#panel = panel;
    this.#shown = shown;
    this.#series = seriesOf(panel);
    this.#box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    this.#x = scale(shown.span, [this.#box.left, this.#box.right]);
    const high = height + (last ? FOOT : 0);
    this.element = svg("svg", { class: "curve", width, height: high, viewBox: `0 0 ${width} ${high}`, role: "img", "aria-label": told(panel, shown.answer) });
    this.#draw(last);
  }

  /** The value of the variable at a place of the pointer. */
  at(clientX) {
    return this.#x.back(clientX - this.element.getBoundingClientRect().left);
  }

  /** The place of the active curve nearest to a value of the variable: there the law itself was computed. */
  nearest(value) {
    const at = this.#active?.at ?? [];
    return at.reduce((best, one) => (Math.abs(one - value) < Math.abs(best - value) ? one : best), at[0] ?? value);
  }

  get places() {
    return this.#active?.at ?? [];
  }

  get peaks() {
    return (this.#panel.peaks ?? []).map(({ at }) => at);
  }

  get #active() {
    return this.#series.find(({ law }) => law === this.#shown.active) ?? this.#series[0];
  }

  /** A line at the cursor, a dot on each curve, and their values; returns the value of the active one as text. */
  read(value) {
    this.#cursor.replaceChildren();
    const x = value === null ? NaN : this.#x(value);
    if (!(x >= this.#box.left - 0.5 && x <= this.#box.right + 0.5)) return "";
    const found = this.#series.filter(({ law }) => typeof law === "number").map((one) => ({ ...one, ...between(one, value) })).filter(({ reading }) => reading !== null);
    this.#cursor.append(svg("line", { class: "cursor", x1: x.toFixed(1), x2: x.toFixed(1), y1: this.#box.top, y2: this.#box.bottom }));
    for (const { law, reading } of found) this.#cursor.append(svg("circle", { class: `point law-${law}`, cx: x.toFixed(1), cy: this.#y(reading).toFixed(1), r: 3 }));
    const own = found.find((one) => one.law === this.#active.law);
    const room = (this.#box.right - this.#box.left) / WRITTEN - titled(this.#panel).length - 2;
    const unit = this.#panel.unit ? ` ${this.#panel.unit}` : "";
    const all = found.map((one) => ({ ...one, text: found.length > 1 ? `${LAWS[one.law] ?? ""} ${one.text}` : `${one.text}${unit}` }));
    const fits = all.reduce((sum, { text }) => sum + text.length + 2, 0) < room;
    const text = svg("text", { x: this.#box.right, y: 13, "text-anchor": "end" });
    (fits ? all : own ? [own] : []).forEach((one, i) => text.append(svg("tspan", { class: found.length > 1 ? `law-${one.law}` : "", text: `${i ? "  " : ""}${one.text}` })));
    this.#cursor.append(text);
    return own ? `${this.#panel.symbol ?? this.#panel.name} ${own.text}${unit}` : "";
  }

  #draw(last) {
    const { answer, name, span, segments = [] } = this.#shown;
    const box = this.#box;
    const inSight = (at) => at >= span[0] && at <= span[1];
    const known = this.#series.flatMap(({ at, values }) => values.filter((value, i) => value !== null && inSight(at[i])));
    const [low, high] = this.#reach(known);
    const room = ((high - low || 1) * ROOM) / (box.bottom - box.top - 2 * ROOM);
    this.#y = scale([low < 0 || this.#shown.zoomed ? low - room : low, high + room], [box.bottom, box.top]);
    const [x, y] = [this.#x, this.#y];
    const xs = !this.#shown.zoomed && answer.ticks ? answer.ticks : ticksIn(answer.unit, span, 8);
    this.element.append(frame(box, x, y, { xs, ys: ticks(low, high, Math.min(4, Math.max(2, Math.floor((box.bottom - box.top) / 18)))), xlabels: last, xname: last ? variableOf(answer) : "", unit: answer.unit }));
    this.element.append(svg("text", { class: "title", x: box.left, y: 13, text: titled(this.#panel) }));
    if (this.#panel.note) this.element.append(svg("text", { class: "limit-name", x: box.left + WRITTEN * (titled(this.#panel).length + 2), y: 13, text: this.#panel.note }));
    const inside = svg("clipPath", { id: `inside-${name}` }, svg("rect", { x: box.left, y: box.top - 8, width: box.right - box.left, height: box.bottom - box.top + 14 }));
    const lines = svg("g", { "clip-path": `url(#inside-${name})` });
    const { limits = [] } = this.#panel;
    const zones = this.#zones(limits);
    const broken = this.#shown.beyond.flatMap(([from, to]) => limits.map((limit) => ({ ...limit, from: Math.max(from, limit.from), to: Math.min(to, limit.to) })));
    const over = this.#zones(broken.filter(({ from, to }) => from < to));
    const clip = svg("clipPath", { id: `beyond-${name}` }, ...over);
    lines.append(...zones);
    for (const { at: [from] } of segments) if (x(from) > box.left) lines.append(svg("line", { class: "joint", x1: x(from), x2: x(from), y1: box.top, y2: box.bottom }));
    const drawn = this.#series.map(({ at, values, law, dots, name: title }) => {
      const places = at.map((one, i) => (values[i] === null ? null : [x(one), y(values[i])]));
      return { law, title, dots, d: dots ? places.filter(Boolean).map((place) => `${path([place])}h0`).join("") : path(places) };
    });
    const order = [...drawn.filter(({ law }) => law !== this.#active?.law).toReversed(), ...drawn.filter(({ law }) => law === this.#active?.law).toReversed()];
    for (const { law, d, dots, title } of order) lines.append(svg("path", { class: `line law-${law}${law === this.#active.law ? " active" : ""}${dots ? " dots" : ""}`, d }, title ? svg("title", { text: title }) : null));
    if (over.length && drawn.length) lines.append(svg("path", { class: "beyond", d: drawn[0].d, "clip-path": `url(#beyond-${name})` }));
    this.element.append(inside, clip, lines, ...peakMarks(this.#panel.peaks ?? [], (peak) => [x(peak.at), y(peak.value)], box, this.#active?.law ?? 0), this.#cursor);
  }

  /** The least and the greatest value in sight; of the whole also 0, limits near what is used of them on their side, and what the panel asks for. */
  #reach(known) {
    const { span, limits = [] } = this.#panel;
    if (this.#shown.zoomed && known.length) return [Math.min(...known), Math.max(...known)];
    const side = (sign, end) => {
      const used = Math.max(0, ...known.map((value) => sign * value));
      const near = limits.map((limit) => sign * edges(limit)[end]).filter((value) => value <= NEAR * used);
      return sign * Math.max(used, ...near, ...(span ?? []).map((value) => sign * value));
    };
    return [side(-1, 0), side(1, 1)];
  }

  /** Where the motion must not go: above and below the limits of each segment. */
  #zones(limits) {
    const [x, y, box] = [this.#x, this.#y, this.#box];
    const zone = ({ from, to }, top, bottom) => svg("rect", { class: "zone", x: x(from), width: x(to) - x(from), y: top, height: Math.max(0, bottom - top) });
    return limits.flatMap((limit) => {
      const [least, value] = edges(limit);
      const [above, below] = [Math.max(box.top, y(value)), Math.min(box.bottom, y(least))];
      const found = above > box.top ? [zone(limit, box.top, above)] : [];
      return below < box.bottom ? [...found, zone(limit, below, box.bottom)] : found;
    });
  }
}

function seriesOf({ series }) {
  return series.map((one) => ({ law: 0, ...one }));
}

/** The value at a place, exact where the curve was computed there, else of the line between its neighbours. */
function between({ at, values }, place) {
  const i = at.findIndex((one) => one >= place - 1e-9);
  if (i < 0) return { reading: null };
  if (at[i] <= place + 1e-9) return values[i] === null ? { reading: null } : { reading: values[i], text: label(values[i]) };
  if (i === 0 || values[i] === null || values[i - 1] === null) return { reading: null };
  const part = (place - at[i - 1]) / (at[i] - at[i - 1]);
  const reading = values[i - 1] + part * (values[i] - values[i - 1]);
  return { reading, text: `≈ ${label(Number(reading.toPrecision(3)))}` };
}

/** A picture in words: what it shows, its peaks with their places, and its limits. */
function told(panel, answer) {
  const series = seriesOf(panel);
  const peaks = (panel.peaks ?? []).map((peak) => `${peak.text ?? number(peak.value)} at ${number(peak.at, answer.unit)}`);
  const values = peaks.length ? [] : series.flatMap((one) => one.values).filter((value) => value !== null);
  // what is drawn is no value: between two of its places the curve may be higher
  const about = (value) => label(Number(value.toPrecision(2)));
  const drawn = values.length ? [`drawn from about ${about(Math.min(...values))} to about ${about(Math.max(...values))}`] : [];
  const range = panel.ends ? [`from ${panel.ends.map((end) => number(end)).join(" to ")}`] : drawn;
  const limits = [...new Set((panel.limits ?? []).map((limit) => edges(limit).filter(Number.isFinite).map(label).join(" to ")))].filter(Boolean);
  const words = [...peaks, ...range, ...(limits.length ? [`within ${limits.join("; ")}`] : [])];
  if (!series.length) return `${titled(panel)}: nothing to draw`;
  return `${titled(panel)} over ${variableOf(answer)}${words.length ? `: ${words.join(", ")}` : ""}`;
}

// What all pictures are drawn of, in layers over two axes: zones, lines, marks, and what is written beside them.
//
// A zone is {from, to, low, high, name, title, onclick}, of x and of y, without low or high as high as the picture; a line {points, name, title,
// closed, dots, head, within}: `name` are its classes, null among its points breaks it, `dots` are points alone, `head` makes an arrow of it, `within` are zones
// outside which it is not drawn. A mark is {at, name, title, r, size, sides, glyph, text, above}: a circle of r pixels or of a size in units of x,
// a rectangle of sides in pixels at least, or a path from its place; `text` is written beside it where there is room, and is its title elsewhere. A label is {at, text, name,
// anchor, up, aside, wide, within, title} with the pixels that must be free on its left and the part of x that it must fit in, or `free`, so that it stands where there is room.
// Lines may stand among marks, where one lies over the other.

import { path, svg } from "./svg.js";
import { number, shownUnit, written } from "./units.js";

const TURN = 360;
const LINE = 10; // pixels that a label takes

export function scale([low, high], [start, stop]) {
  const factor = (stop - start) / (high - low || 1);
  const to = (value) => start + (value - low) * factor;
  to.back = (pixel) => low + (pixel - start) / factor;
  return to;
}

/** A scale of an axis; a logarithmic one has round ticks of its own. */
export function scaled({ range, log = false }, ends) {
  if (!log) return scale(range, ends);
  const linear = scale(range.map(Math.log10), ends);
  const to = (value) => linear(Math.log10(value));
  to.back = (pixel) => 10 ** linear.back(pixel);
  return to;
}

/** Scales of x and y by one factor, with room in pixels on all sides of a box. */
export function fitted([left, right], [low, high], box, room) {
  const [width, height] = [box.right - box.left, box.bottom - box.top];
  const factor = Math.min((width - 2 * room) / (right - left || 1), (height - 2 * room) / (high - low || 1));
  const ends = (start, size, length) => [start + (size - factor * length) / 2, start + (size + factor * length) / 2];
  return [scale([left, right], ends(box.left, width, right - left)), scale([high, low], ends(box.top, height, high - low))];
}

/** About `count` round values between low and high, two at least: one alone is no scale. */
export function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10].map((factor) => factor * power);
  const ends = (step) => [Math.ceil(low / step - 1e-9), Math.floor(high / step + 1e-9)];
  const coarsest = steps.find((size) => size >= rough * 0.999);
  const step = steps.findLast((size) => size <= coarsest && ends(size)[1] > ends(size)[0]);
  const [first, last] = ends(step);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(10)));
}

const PARTS = [[1, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]]; // of a power of ten
const APART = 44; // pixels between the middles of two labels

/** Round ticks of an axis; of a logarithmic one as many as have room for their labels. */
export function marked({ range: [low, high], log = false }, count, to) {
  if (!log) return ticks(low, high, count);
  const powers = Array.from({ length: Math.ceil(Math.log10(high)) - Math.floor(Math.log10(low)) + 1 }, (_, i) => 10 ** (Math.floor(Math.log10(low)) + i));
  const sets = PARTS.map((parts) => powers.flatMap((power) => parts.map((part) => Number((part * power).toPrecision(3)))).filter((value) => value >= low && value <= high));
  return sets.find((found) => found.every((value, i) => i === 0 || Math.abs(to(value) - to(found[i - 1])) >= APART)) ?? sets.at(-1);
}

/** Round ticks of a range in the unit that is shown for its own; of a turn in degrees eighths of it. */
export function ticksIn(unit, [low, high], count) {
  const { factor } = shownUnit(unit);
  if (factor === 1 && unit === "deg" && high - low === TURN) return Array.from({ length: 9 }, (_, i) => low + (i * TURN) / 8);
  return ticks(low * factor, high * factor, count).map((value) => value / factor);
}

export function label(value) {
  return String(Number(value.toPrecision(6))).replace("-", "−");
}

/** A text of so many letters at most. */
export const shortened = (text, most) => (text.length > most ? `${text.slice(0, Math.max(1, most - 1))}…` : text);

/** A range around values with room for what is written; 0 is in it unless `free`. */
export function spanOf(values, { free = false, room = 0.08 } = {}) {
  const known = values.filter((value) => value !== null && Number.isFinite(value));
  const [low, high] = [Math.min(...known, ...(free ? [] : [0])), Math.max(...known, ...(free ? [] : [0]))];
  const more = room * (high - low || Math.abs(high) || 1);
  return [low < 0 || free ? low - more : low, high > 0 || free ? high + more : high];
}

/** Grid, ticks and names of both axes; `box` is {left, right, top, bottom} in pixels. */
export function frame(box, x, y, { xs, ys, xname, yname, xlabels = true, unit = "" }) {
  const group = svg("g", { class: "frame", "aria-hidden": "true" });
  for (const value of xs) {
    const at = x(value).toFixed(1);
    group.append(svg("line", { class: "grid", x1: at, x2: at, y1: box.top, y2: box.bottom }));
    if (xlabels) group.append(svg("text", { class: "tick", x: at, y: box.bottom + 15, "text-anchor": "middle", text: number(value, unit) }));
  }
  // where labels would touch every other one is written
  const every = ys.length > 2 && Math.abs(y(ys[1]) - y(ys[0])) < LINE ? 2 : 1;
  for (const [i, value] of ys.entries()) {
    const at = y(value);
    group.append(svg("line", { class: value === 0 ? "grid zero" : "grid", x1: box.left, x2: box.right, y1: at.toFixed(1), y2: at.toFixed(1) }));
    if (i % every === 0) group.append(svg("text", { class: "tick", x: box.left - 6, y: (at + 4).toFixed(1), "text-anchor": "end", text: label(value) }));
  }
  if (xname) group.append(svg("text", { class: "name", x: (box.left + box.right) / 2, y: box.bottom + 33, "text-anchor": "middle", text: xname }));
  if (yname) {
    const middle = (box.top + box.bottom) / 2;
    group.append(svg("text", { class: "name", x: 0, y: 0, transform: `translate(${box.left - 40} ${middle}) rotate(-90)`, "text-anchor": "middle", text: yname }));
  }
  return group;
}

const SCALE = 90; // pixels that the bar of a scale is at most long

/** The bar of the scale of a drawing in millimetres. */
export function scaleBar(box, toX) {
  const factor = toX(1) - toX(0);
  const length = ticks(0, SCALE / factor, 2).at(-1);
  const [x, y] = [box.right - 14, box.bottom - 12];
  return [
    svg("path", { class: "scale-bar", d: `M${x - factor * length} ${y - 4}v4H${x}v-4` }),
    svg("text", { x: x - factor * length - 6, y: y + 1, "text-anchor": "end", text: written({ value: length, unit: "mm", digits: 4 }) }),
  ];
}

const LETTER = 6.4;
const HIGH = 12;
const overlap = (one, other) => one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;

/** What is written in a box beside marks at [x, y] in pixels: a function of a place and a text, whose element lies over no
    mark and no other text, or which gives null where there is no room. */
function createRoom(box, marks) {
  const taken = marks.map(([x, y]) => ({ left: x - 3, right: x + 3, top: y - 3, bottom: y + 3 }));
  const inside = (space) => {
    const shift = Math.max(0, box.left + 2 - space.left) - Math.max(0, space.right - box.right + 2);
    const moved = { ...space, left: space.left + shift, right: space.right + shift };
    return moved.top < box.top - 4 || moved.bottom > box.bottom + 4 || moved.left < box.left ? null : moved;
  };
  return ([x, y], text, { above = true, name } = {}) => {
    const width = LETTER * text.length;
    const at = (left, bottom) => ({ left, right: left + width, top: bottom - HIGH, bottom });
    const heights = above ? [y - 5, y + HIGH + 6] : [y + HIGH + 6, y - 5];
    const beside = [x + 6, x - width - 6].map((left) => at(left, y + 6));
    const spaces = [...heights.map((bottom) => at(x - width / 2, bottom)), ...beside, ...heights.flatMap((bottom) => [at(x - width - 6, bottom), at(x + 6, bottom)])];
    const space = spaces.map(inside).find((one) => one && !taken.some((other) => overlap(one, other)));
    if (!space) return null;
    taken.push(space);
    return svg("text", { class: name, x: space.left.toFixed(1), y: (space.bottom - 2).toFixed(1), text });
  };
}

const titled = (title) => (title ? svg("title", { text: title }) : null);

/** The layers of a picture: what lies within the box, what is written over it, and how more is written beside its marks.
    `toX` and `toY` are pixels of values, `name` makes the layers' own names. */
export function drawLayers({ zones = [], lines = [], marks = [], labels = [] }, { box, toX, toY, name, beside = [] }) {
  const placeOf = ([one, other]) => [toX(one), toY(other)];
  const room = createRoom(box, [...marks.filter(({ at }) => at), ...beside].map(({ at }) => placeOf(at)));
  const draw = (one) => ("points" in one ? drawLine(one, { name, placeOf, zone }) : drawMark(one, placeOf, toX(1) - toX(0)));

  function zone({ from, to, low = -Infinity, high = Infinity, name = null, title, onclick }) {
    const [top, bottom] = [Math.max(box.top, toY(high)), Math.min(box.bottom, toY(low))];
    return bottom > top ? svg("rect", { class: name, x: toX(from), width: toX(to) - toX(from), y: top, height: bottom - top, onclick }, titled(title)) : null;
  }

  /** A label stands above its place, below it where there is no room; `aside` is how far it stands on its side. */
  function drawLabel({ at, text, name = "", anchor = "start", up = 5, aside = 0, title }) {
    const [x, y] = placeOf(at);
    const above = y - up >= box.top + 12 || !aside ? Math.max(box.top + 10, y - up) : y + 18;
    return svg("text", { class: name, x: (x + (anchor === "end" ? -aside : aside)).toFixed(1), y: above.toFixed(1), "text-anchor": anchor, text }, titled(title));
  }

  const plain = marks.filter(({ text }) => text === undefined);
  const read = marks.filter(({ text }) => text !== undefined).map((mark) => svg("g", { class: mark.name }, drawMark({ ...mark, name: null }, placeOf), room(placeOf(mark.at), mark.text, mark) ?? titled(mark.text)));
  const written = labels.filter(({ at, wide = 0, within, text }) => (!wide || toX(at[0]) - wide >= box.left) && (within === undefined || toX(within) - toX(0) > LETTER * text.length + 2 * HIGH)).map((one) => (one.free ? room(placeOf(one.at), one.text, one) : drawLabel(one)));
  return {
    ground: [
      svg("clipPath", { id: `inside-${name}` }, svg("rect", { x: box.left, y: box.top, width: Math.max(1, box.right - box.left), height: Math.max(1, box.bottom - box.top) })),
      svg("g", { "clip-path": `url(#inside-${name})` }, ...zones.map(zone), ...lines.map(draw), ...plain.map(draw)),
      ...read,
      svg("g", { class: "names", "aria-hidden": "true" }, ...written),
    ],
    room,
  };
}

function drawLine({ points, name, title, closed, dots, head, within }, { name: own, placeOf, zone }) {
  const places = points.map((one) => (one === null || one.includes(null) ? null : placeOf(one)));
  const d = dots ? places.filter(Boolean).map((place) => `${path([place])}h0`).join("") : `${path(places)}${closed ? "Z" : ""}`;
  if (head) return svg("g", { class: name }, titled(title), svg("path", { class: "shaft-of-arrow", d }), svg("path", { class: "head-of-arrow", d: headOf(...places) }));
  if (!within) return svg("path", { class: name, d }, titled(title));
  return svg("g", {}, svg("clipPath", { id: `${name}-${own}` }, ...within.map(zone)), svg("path", { class: name, d, "clip-path": `url(#${name}-${own})` }));
}

/** The head of an arrow from one place to another, in pixels. */
function headOf([x1, y1], [x2, y2]) {
  const size = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [u, v] = [(x2 - x1) / size, (y2 - y1) / size];
  const corner = (side) => [x2 - 9 * u - side * 3.6 * v, y2 - 9 * v + side * 3.6 * u];
  return `${path([[x2, y2], corner(1), corner(-1)])}Z`;
}

/** A mark at its place; `factor` is how many pixels one of x has. */
export function drawMark({ at, name, title, r = 3.2, size, sides, glyph }, placeOf, factor = 1) {
  const [x, y] = placeOf(at);
  if (sides) {
    const [width, height] = sides.map((side) => Math.max(side, (size ?? 0) * factor));
    return svg("rect", { class: name, x: x - width / 2, y: y - height / 2, width, height, rx: 2 });
  }
  if (glyph) return svg("path", { class: name, d: glyph, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });
  return svg("circle", { class: name, cx: x.toFixed(3), cy: y.toFixed(3), r: size === undefined ? r : Math.abs(size * factor) }, titled(title));
}

// Scales from values to pixels, round ticks, and the frame of a picture.

import { svg } from "./svg.js";
import { number, shownUnit } from "./units.js";

const TURN = 360;
const HIGH = 10; // pixels that a label takes

export function scale([low, high], [start, stop]) {
  const factor = (stop - start) / (high - low || 1);
  const to = (value) => start + (value - low) * factor;
  to.back = (pixel) => low + (pixel - start) / factor;
  return to;
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

export function label(value) {
  return String(Number(value.toPrecision(6))).replace("-", "−");
}

/** Round ticks of a range in the unit that is shown for its own; of a turn in degrees eighths of it. */
export function ticksIn(unit, [low, high], count) {
  const { factor } = shownUnit(unit);
  if (factor === 1 && unit === "deg" && high - low === TURN) return Array.from({ length: 9 }, (_, i) => low + (i * TURN) / 8);
  return ticks(low * factor, high * factor, count).map((value) => value / factor);
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
  const every = ys.length > 2 && Math.abs(y(ys[1]) - y(ys[0])) < HIGH ? 2 : 1;
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

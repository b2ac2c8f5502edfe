// Peaks on curves with their values: what is written never lies over another, nor outside its picture.

import { svg } from "./svg.js";
import { number } from "./units.js";

const LETTER = 6.4;
const HIGH = 12;
const NEAR = 6;

/** Marks of peaks at [x, y] in pixels; where there is no room for a value, its mark alone is drawn. */
export function peakMarks(peaks, place, box, law) {
  const taken = peaks.map((peak) => around(place(peak)));
  const marks = [];
  const circles = [];
  for (const peak of peaks) {
    const at = place(peak);
    if (at[0] < box.left - 0.5 || at[0] > box.right + 0.5 || circles.some(([x, y]) => Math.hypot(x - at[0], y - at[1]) < NEAR)) continue;
    circles.push(at);
    const text = peak.text ?? number(peak.value);
    const space = spaces(at, LETTER * text.length, peak.value > 0).map((one) => within(one, box)).find((one) => one && !taken.some((other) => overlap(one, other)));
    const mark = svg("g", { class: `peak law-${law}` }, svg("circle", { cx: at[0].toFixed(1), cy: at[1].toFixed(1), r: 3 }));
    if (space) {
      taken.push(space);
      mark.append(svg("text", { x: space.left.toFixed(1), y: (space.bottom - 2).toFixed(1), text }));
    } else mark.append(svg("title", { text }));
    marks.push(mark);
  }
  return marks;
}

const around = ([x, y]) => ({ left: x - 3, right: x + 3, top: y - 3, bottom: y + 3 });

/** Where a value of a width may stand, the best place first. */
function spaces([x, y], width, above) {
  const at = (left, bottom) => ({ left, right: left + width, top: bottom - HIGH, bottom });
  const [over, under] = [y - 5, y + HIGH + 6];
  const heights = above ? [over, under] : [under, over];
  const beside = [x + 6, x - width - 6].map((left) => at(left, y + 6));
  return [...heights.map((bottom) => at(x - width / 2, bottom)), ...beside, ...heights.flatMap((bottom) => [at(x - width - 6, bottom), at(x + 6, bottom)])];
}

function within(space, box) {
  const shift = Math.max(0, box.left + 2 - space.left) - Math.max(0, space.right - box.right + 2);
  const moved = { ...space, left: space.left + shift, right: space.right + shift };
  return moved.top < box.top - 4 || moved.bottom > box.bottom + 4 || moved.left < box.left ? null : moved;
}

const overlap = (one, other) => one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;

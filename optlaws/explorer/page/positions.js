// The plane of two positions: the path, what is forbidden to it, where it is nearest, and where it is now.

import { Chart } from "./chart.js";
import { html } from "./svg.js";
import { valueAt } from "./timing.js";
import { headed, shownUnit, written } from "./units.js";

const stepOf = ([low, high]) => 10 ** Math.floor(Math.log10((high - low) / 100));

export class Positions {
  #chart;
  #none = html("p", { class: "quiet" });
  #shown = null;
  #plane = null;
  #picture = null;
  #place = null;
  #angle = null;

  /** `moved(rule, corner, [x, y])` is told where a corner of a region goes, in the units of the machine; null is that it rests. */
  constructor(root, moved) {
    root.append(this.#none);
    this.#chart = new Chart(root, (key, place) => {
      const [rule, corner] = key.split(" ").map(Number);
      const back = place?.map((value, i) => Number((value / this.#factors[i]).toPrecision(9)));
      moved(rule, corner, back && this.#plane.regions.find((one) => one.rule === rule).turned ? back.toReversed() : back);
    });
  }

  get #factors() {
    return this.#plane.units.map((unit) => shownUnit(unit).factor);
  }

  /** The plane of that number of an answer, and the least clearances by their interlocks, where they are known. */
  show(answer, which, nearest = []) {
    this.#shown = answer;
    this.#plane = answer.planes?.[which] ?? answer.planes?.[0] ?? null;
    this.#none.textContent = answer.refused ? "there is nothing to draw" : "an interlock of two positions has its plane here";
    this.#none.hidden = Boolean(this.#plane);
    this.#picture = this.#plane && this.#pictured(nearest);
    this.turn(this.#angle);
  }

  turn(angle) {
    this.#angle = angle;
    this.#chart.show(this.#picture && { ...this.#picture, of: this.#picture, points: angle === null ? [] : [{ at: this.#place(angle), name: "point law-1", r: 5 }] });
  }

  #pictured(nearest) {
    const { axes, units, ranges, regions } = this.#plane;
    const factors = this.#factors;
    const at = (place) => place.map((value, i) => value * factors[i]);
    const courses = axes.map((name) => this.#shown.rows.find((row) => row.name === name).values);
    this.#place = (angle) => at(courses.map((values) => valueAt(this.#shown.at, values, angle)));
    const [x, y] = axes.map((name, i) => ({ name: headed(name, units[i]), range: ranges[i].map((value) => value * factors[i]) }));
    const near = regions.filter(({ rule }) => nearest[rule]).map((region) => ({ ...region, least: nearest[region.rule], here: this.#place(nearest[region.rule].at) }));
    const size = ranges.map(([low, high], i) => (high - low) * factors[i]);
    const middle = (x.range[0] + x.range[1]) / 2;
    return {
      x, y,
      lines: [
        ...regions.map(({ name, corners, wall }) => ({ points: (corners ?? wall).map(at), name: corners ? "zone" : "wall", title: name, closed: Boolean(corners) })),
        { points: courses[0].map((value, i) => at([value, courses[1][i]])), name: "line law-0 active" },
        ...near.filter(({ free, least }) => free && least.status !== "broken").map(({ corners, least, here }) => ({ points: [here, footOf(corners.map(at), here, size)], name: `interlock ${least.status}` })),
      ],
      marks: near.map(({ least, here }) => ({ at: here, name: `interlock ${least.status}`, r: 4.5 })),
      labels: near.map(({ least, here }) => ({ at: here, text: `${least.name}: ${written(least.value)}`, name: `tip interlock ${least.status}`, anchor: here[0] > middle ? "end" : "start", up: 8, aside: 9 })),
      handles: regions.filter(({ free }) => free).flatMap(({ rule, name, corners }) => corners.map((corner, i) => ({
        key: `${rule} ${i}`, at: at(corner), along: "both", step: at(ranges.map(stepOf)), label: `${name}: corner ${i + 1}`, text: corner.join(", "), name: "corner",
      }))),
      told: `The path in the plane of ${axes.join(" and ")}. ${regions.map(({ rule, name }) => (nearest[rule] ? `${name}: ${nearest[rule].status}, ${written(nearest[rule].value)} at ${written({ value: nearest[rule].at, unit: "deg", digits: 6 })}` : name)).join("; ")}`,
    };
  }
}

/** The place on the edge of a polygon that is nearest to a point, in shares of the picture's size. */
function footOf(corners, point, size) {
  const share = (place) => place.map((value, i) => value / size[i]);
  const [px, py] = share(point);
  const places = corners.map(share).map(([ax, ay], i, all) => {
    const [bx, by] = all[(i + 1) % all.length];
    const square = (bx - ax) ** 2 + (by - ay) ** 2 || 1;
    const part = Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / square));
    return [ax + part * (bx - ax), ay + part * (by - ay)];
  });
  const [near] = places.toSorted((one, other) => Math.hypot(one[0] - px, one[1] - py) - Math.hypot(other[0] - px, other[1] - py));
  return near.map((value, i) => value * size[i]);
}

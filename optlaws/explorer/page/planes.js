// Planes of two quantities: of two constants, with the front and the laws of the study; of two positions, with what is forbidden.

import { createChart } from "./chart.js";
import { html } from "./svg.js";
import { valueAt } from "./timing.js";
import { headed, shownUnit, written } from "./units.js";

const STEPS = { B: 0.001, C: 0.01, D: 0.01, J: 0.1 };
const WRITTEN = 165; // pixels that the name of the limit takes
const EDGE = 0.04; // of a range: a name further out would be cut

const NAMES = { B: "peak velocity", C: "peak acceleration", D: "peak power", J: "peak jerk", rms_c: "RMS acceleration" };

const valueOf = (view, name) => view?.constants?.find((one) => one.name === name);

/** `asked(x)` is what the active law is asked now: an answer may be on its way. */
export function createPlane(root, asked, moved, picked) {
  let frontShown = null;
  let ground = null;
  let lawsShown = [];
  let activeLaw = 0;
  const chart = createChart(root, (_, value) => moved(value, frontShown.x, frontShown.y), picked);

  function showFront({ series = [], ...front }) {
    const curve = (name) => series.filter((one) => one.name === name).flatMap(({ at, values }) => at.map((x, i) => [x, values[i]]).filter(([, y]) => y !== null));
    frontShown = front;
    ground = groundOf(front, curve("front"), curve("best possible"));
    draw();
  }

  /** `laws` are {asked, view}; `asked` is the value of x that the active one is asked to have, or null. */
  function showLaws(laws, active) {
    lawsShown = laws;
    activeLaw = active;
    draw();
  }

  function draw() {
    if (!frontShown) return;
    const places = lawsShown.map(({ view }) => [frontShown.x, frontShown.y].map((name) => valueOf(view, name)?.value ?? null));
    const points = places.map((at, i) => ({ at, name: `point law-${i}`, r: 5 })).filter(({ at }, i) => i !== activeLaw && !at.includes(null));
    chart.show({ ...ground, of: ground, points, handles: handles(places[activeLaw]) });
  }

  function handles(place) {
    const law = lawsShown[activeLaw];
    const none = Boolean(law?.view?.refused);
    const { x, y, ranges: [[low, high], [bottom]] } = frontShown;
    const at = none && typeof law.asked === "number" ? [law.asked, bottom] : place;
    if (!at || at.includes(null)) return [];
    const text = none ? "no such law" : [x, y].map((name) => `${name} = ${valueOf(law.view, name).text}`).join(", ");
    // a bound is rounded up: the law that has the value keeps it
    return [{
      key: "law", at, along: "x", low, high, step: STEPS[x], up: x !== "B", from: () => asked(x), anywhere: true, fixed: !law.movable,
      label: `The law in the plane: ${x}`, text, name: `law-${activeLaw}${none ? " none" : ""}`,
    }];
  }

  return { showFront, showLaws };
}

/** What of the plane does not change with the laws of the study. */
function groundOf({ x, y, ranges, proven, families, known }, front, best) {
  const inside = (edge) => (at) => at.every((value, i) => value >= ranges[i][0] && value <= ranges[i][1] - edge * (ranges[i][1] - ranges[i][0]));
  const named = families.map(({ name, line }) => ({ at: line.findLast(inside(EDGE)), text: name, name: "family-name", up: -4 })).filter(({ at }) => at);
  const shown = best.filter(inside(0));
  // no smooth law lies below and before the best possible: there is room
  const place = shown[Math.floor(shown.length * 0.22)];
  return {
    x: { name: `${NAMES[x]} ${x}`, range: ranges[0] },
    y: { name: `${NAMES[y]} ${y}`, range: ranges[1] },
    lines: [{ points: best, name: "limit" }, ...families.map(({ line }) => ({ points: line, name: "family" })), { points: front, name: proven ? "front" : "front local" }],
    // what is not proven is no curve but the laws that were found
    marks: proven ? [] : front.map((at) => ({ at, name: "front-point", r: 2.2 })),
    labels: [...named, ...(place ? [{ at: place, text: "best possible with any law of this order", name: "limit-name", anchor: "end", up: -14, wide: WRITTEN }] : [])],
    picks: known.map(({ name, at, text, named: written }) => ({ key: name, at, text, named: written })),
    told: `${NAMES[y]} over ${NAMES[x]}: the front, standard laws, and the laws of the study`,
  };
}

const stepOf = ([low, high]) => 10 ** Math.floor(Math.log10((high - low) / 100));

/** `moved(rule, corner, [x, y])` is told where a corner of a region goes, in the units of the machine; null is that it rests. */
export function createPositions(root, moved) {
  const none = html("p", { class: "quiet" });
  let shown = null;
  let plane = null;
  let picture = null;
  let place = null;
  let angleNow = null;
  root.append(none);
  const chart = createChart(root, (key, place) => {
    const [rule, corner] = key.split(" ").map(Number);
    const back = place?.map((value, i) => Number((value / factorsOf()[i]).toPrecision(9)));
    moved(rule, corner, back && plane.regions.find((one) => one.rule === rule).turned ? back.toReversed() : back);
  });

  function factorsOf() {
    return plane.units.map((unit) => shownUnit(unit).factor);
  }

  /** The plane of that number of an answer, and the least clearances by their interlocks, where they are known. */
  function show(answer, which, nearest = []) {
    shown = answer;
    plane = answer.planes?.[which] ?? answer.planes?.[0] ?? null;
    none.textContent = answer.refused ? "there is nothing to draw" : "an interlock of two positions has its plane here";
    none.hidden = Boolean(plane);
    picture = plane && pictured(nearest);
    turn(angleNow);
  }

  function turn(angle) {
    angleNow = angle;
    chart.show(picture && { ...picture, of: picture, points: angle === null ? [] : [{ at: place(angle), name: "point law-1", r: 5 }] });
  }

  function pictured(nearest) {
    const { axes, units, ranges, regions } = plane;
    const factors = factorsOf();
    const at = (place) => place.map((value, i) => value * factors[i]);
    const courses = axes.map((name) => shown.rows.find((row) => row.name === name).values);
    place = (angle) => at(courses.map((values) => valueAt(shown.at, values, angle)));
    const [x, y] = axes.map((name, i) => ({ name: headed(name, units[i]), range: ranges[i].map((value) => value * factors[i]) }));
    const near = regions.filter(({ rule }) => nearest[rule]).map((region) => ({ ...region, least: nearest[region.rule], here: place(nearest[region.rule].at) }));
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

  return { show, turn };
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

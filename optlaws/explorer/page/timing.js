// The timing diagram of axes: a row for each, moves as bars that are dragged, and what interlocks say between rows. What stands
// before and after a move grows and shrinks, the rest of the cycle stays.

import { createChart } from "./chart.js";
import { shortened } from "./layers.js";
import { html } from "./svg.js";
import { variableOf, written as inUnits } from "./units.js";

const STEPS = [1, 2, 5];
const STEPS_A_TURN = 360;

/** How many degrees of the master one of a unit is. */
function size(unit, period) {
  const turn = { s: period, ms: 1e3 * period, min: period / 60, turn: 1, rev: 1, rad: 2 * Math.PI, mrad: 2e3 * Math.PI, deg: 360, "°": 360 }[unit];
  return turn ? 360 / turn : null;
}

function parsed(segment, period) {
  const [, number, unit] = /^([\d.eE+-]+)\s*(\S+)$/.exec(String(segment?.duration ?? "").trim()) ?? [];
  const of = unit && size(unit, period);
  return of && Number.isFinite(Number(number)) ? { degrees: Number(number) * of, unit, of } : null;
}

/** The unit in which a segment is timed, and the step of its instants in degrees: a round one, about 360 a turn. */
function roomOf(segment, period) {
  const { unit = "deg", of = 1 } = parsed(segment, period) ?? {};
  const rough = 360 / STEPS_A_TURN / of;
  const power = 10 ** Math.floor(Math.log10(rough) + 1e-9);
  const round = STEPS.map((step) => step * power).findLast((step) => step <= rough * (1 + 1e-9));
  return { unit, of, step: round * of };
}

const written = (degrees, { unit, of }) => `${Number((degrees / of).toPrecision(12))} ${unit}`;

/** The segments of an axis after its bar `number` was moved to {start, stop}; null where nothing changes.
 *
 *  `bars` are the segments as they stand, each with its `from` and `to` in degrees. Dwells beside it take the difference:
 *  one that is left with nothing goes, and where there is none one comes. A move beside it is not passed.
 */
function moved(segments, bars, number, { start, stop }, { ends, snaps, period }) {
  const own = roomOf(segments[number], period);
  const dwells = (i) => bars[i] !== undefined && !bars[i].moves;
  const { from, to } = bars[number];
  const low = dwells(number - 1) ? bars[number - 1].from : from;
  const high = dwells(number + 1) ? bars[number + 1].to : to;
  const round = (at) => (snaps ? Math.round(at / own.step) * own.step : at);
  let first = ends === "stop" ? from : Math.max(low, round(start));
  if (ends === "both") first = Math.min(first, high - (to - from));
  const last = { both: first + to - from, start: to }[ends] ?? Math.min(high, round(stop));
  const nothing = own.step * 1e-6;
  const [early, late] = [first - from, to - last]; // what the dwell before it gains, and the one after it
  if (last - first < own.step / 2 || (Math.abs(early) < nothing && Math.abs(late) < nothing)) return null;
  const beside = (i, by) => {
    if (dwells(i)) return bars[i].to - bars[i].from + by < nothing ? [] : [longer(segments[i], bars[i], by, period)];
    const there = segments[i] ? [segments[i]] : [];
    if (by < nothing) return there;
    const dwell = { kind: "dwell", duration: written(by, own) };
    return i < number ? [...there, dwell] : [dwell, ...there];
  };
  const by = -early - late;
  const bar = Math.abs(by) < nothing ? segments[number] : longer(segments[number], bars[number], by, period);
  return [...segments.slice(0, Math.max(0, number - 1)), ...beside(number - 1, early), bar, ...beside(number + 1, late), ...segments.slice(number + 2)];
}

/** A segment that lasts by so many degrees longer; a dwell that takes what is left keeps doing so. */
function longer(segment, { from, to }, by, period) {
  const given = parsed(segment, period);
  if (given) return { ...segment, duration: written(given.degrees + by, given) };
  return segment.kind === "dwell" ? segment : { ...segment, duration: written(to - from + by, { unit: "deg", of: 1 }) };
}

const MARGINS = { left: 84, right: 32, top: 8, bottom: 40 };
const TURN = [0, 360];
const ROW = { least: 58, most: 92, top: 18, bottom: 4 };
const ABOUT = 276; // pixels that all rows take where they can

/** `changed(row, segments)` is told the segments of a row whose bar was moved; null is that it was let go. */
export function createTiming(root, changed) {
  let shown = null;
  let picture = null;
  let points = null; // where the rows are at an angle
  let studyShown = null;
  let dragged = null; // a bar, from where it was taken
  let keyed = null; // a bar that keys move before their answer comes, so that they add up
  let angleNow = null;
  const none = html("div", { class: "nothing", hidden: true }, html("strong"), html("span", { text: "there is nothing to draw" }));
  root.append(none);
  const chart = createChart(root, pulled);

  /** An answer of the axes for a study, the status of each interlock, where it is known, and whether it is the last one. */
  function show(answer, study, states = [], last = true) {
    if (last) keyed = null;
    shown = answer;
    studyShown = study;
    none.hidden = !answer.refused;
    none.firstElementChild.textContent = answer.refused?.word ?? "";
    picture = answer.refused ? null : pictured(states);
    turn(angleNow);
  }

  /** The cursor stands at an angle of the master. */
  function turn(angle) {
    angleNow = angle;
    chart.show(picture && { ...picture, of: picture, cursor: angle, points: angle === null ? [] : points(angle) });
  }

  function pictured(states) {
    const { rows, unit, arrows } = shown;
    const each = Math.min(ROW.most, Math.max(ROW.least, Math.floor(ABOUT / rows.length)));
    const heights = rows.map(({ values }) => {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const [top, bottom] = [ROW.top / each, 1 - ROW.bottom / each];
      return (value) => bottom - ((low < high ? (value - low) / (high - low) : 0.5) * (bottom - top));
    });
    const at = (row, place, value) => [place, row + heights[row](value)];
    points = (angle) => rows.map(({ values }, row) => ({ at: at(row, angle, valueAt(shown.at, values, angle)), name: `point law-${row % 4}`, r: 4 }));
    const status = ({ rule, clear }) => states[rule] ?? (clear === false ? "broken" : "clear");
    const said = arrows.map((arrow) => ({ ...arrow, name: `interlock ${status(arrow)}`, title: `${arrow.name}: ${status(arrow)}` }));
    const ends = said.filter(({ window }) => !window).map((one) => ({ ...one, to: at(one.rows[0], ...one.to), from: one.from && at(one.rows[1], ...one.from) }));
    const bars = rows.flatMap((row, i) => row.bars.filter(({ moves }) => moves).map((bar, place) => ({ row, i, bar, place })));
    return {
      x: { range: TURN, unit, name: variableOf(shown) },
      y: { range: [rows.length, 0], ticks: [] },
      margins: MARGINS, height: MARGINS.top + each * rows.length + MARGINS.bottom,
      zones: said.filter(({ window }) => window).map(({ window: [from, to], rows: [one, other], name, title }) => {
        const [low, high] = [one, other].map((row) => row + heights[row](rows[row].values[0]));
        return { from, to, low: Math.max(low, high), high: Math.min(low, high), name: `${name} window`, title };
      }),
      lines: [
        ...rows.map((_, i) => ({ name: "grid", points: TURN.map((end) => [end, i + 1]) })),
        ...rows.map(({ values }, i) => ({ name: `line active law-${i % 4}`, points: shown.at.map((place, k) => at(i, place, values[k])) })),
        ...ends.filter(({ from }) => from).map(({ from, to, name, title }) => ({ name, title, head: true, points: [from, to] })),
      ],
      marks: ends.map(({ from, to, name, title }) => ({ at: from ?? to, name, title, r: from ? 3 : 4 })),
      labels: rows.flatMap(({ name, cells: [stroke] }, i) => [["title", name, 0], ["", inUnits(stroke), -15]].map(([look, text, up]) => ({ at: [0, i + 0.5], text: shortened(text, 12), title: text, name: look, up, anchor: "end", aside: 6 }))),
      handles: bars.map(({ row, i, bar, place }) => ({ ...told(row, bar), key: `bar ${i} ${place}`, from: bar.from, to: bar.to, low: i + 1, high: i, name: `law-${i % 4}` })),
      told: `Timing diagram: ${[...bars.map(({ row, bar }) => `${row.name}, ${bar.name} ${told(row, bar).text}`), ...said.map(({ title }) => title)].join("; ")}`,
    };
  }

  function told({ name }, { name: move, from, to }) {
    const angle = (value) => inUnits({ value: Number(value.toFixed(2)), unit: "deg", digits: 5 });
    const short = `${move} ${angle(to - from)}`;
    return { label: `${name}: ${move}`, text: `from ${angle(from)} to ${angle(to)}`, short, title: `${name}: ${short}. Drag it, or its ends; ← → move it, ↑ ↓ make it longer and shorter` };
  }

  /** A bar is known by its place among the moves of its axis, which dwells that come and go do not change. */
  function pulled(key, pull) {
    const [row, place] = key.split(" ").slice(1).map(Number);
    if (pull === null) {
      dragged = null;
      return changed(row, null);
    }
    const { bars } = shown.rows[row];
    const begun = () => ({ key, row, bars, number: bars.indexOf(bars.filter(({ moves }) => moves)[place]), study: studyShown, period: shown.period, by: [0, 0] });
    if (!pull.keys) return to((dragged ??= begun()), pull.end === "stop" ? 0 : pull.by, pull.end === "start" ? 0 : pull.by, pull.end);
    if (keyed?.key !== key) keyed = begun();
    const { step } = roomOf(keyed.study.axis[row].segment[keyed.number], keyed.period);
    keyed.by = keyed.by.map((by, i) => by + step * pull.keys[i]);
    return to(keyed, ...keyed.by, "keys");
  }

  /** The ends of a bar go by so many degrees from where they were; a pointer takes them to round instants. */
  function to({ row, number, bars, study, period }, start, stop, ends) {
    const { from, to } = bars[number];
    const segments = moved(study.axis[row].segment, bars, number, { start: from + start, stop: to + stop }, { ends, snaps: ends !== "keys", period });
    if (segments) changed(row, segments);
  }

  return { show, turn };
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

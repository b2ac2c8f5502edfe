// Segments whose instants are moved: what stands before and after a move grows and shrinks, the rest of the cycle stays.

const STEPS = [1, 2, 5];
const ABOUT = 360; // steps a turn

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
export function roomOf(segment, period) {
  const { unit = "deg", of = 1 } = parsed(segment, period) ?? {};
  const rough = 360 / ABOUT / of;
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
export function moved(segments, bars, number, { start, stop }, { ends, snaps, period }) {
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

// The timing diagram of axes: a row for each, moves as bars that are dragged, and what interlocks say between rows. What stands
// before and after a move grows and shrinks, the rest of the cycle stays.

import { frame, scale, ticksIn } from "./chart.js";
import { draggable, html, path, renew, setAttributes, sized, svg } from "./svg.js";
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

const BOX = { left: 84, right: 16, top: 8, foot: 40 };
const TURN = [0, 360];
const ROW = { least: 58, most: 92, name: 15 };
const ABOUT = 276; // pixels that all rows take where they can
const EDGE = 7; // pixels at the ends of a bar by which it is made longer or shorter
const SHORT = 30; // a bar of fewer pixels is moved only

/** `changed(row, segments)` is told the segments of a row whose bar was moved; null is that it is taken or let go. */
export function createTiming(root, changed) {
  let shown = null;
  let studyShown = null;
  let toX = null;
  let keyed = null;
  const cursor = svg("line", { class: "cursor run" });
  let angleNow = null;
  let marks = [];
  let statesShown = [];
  const drawing = svg("svg", { class: "curve timing", role: "group", "aria-label": "Timing diagram" });
  draggable(drawing, grasp, pull, ({ row }) => changed(row, null));
  const size = sized(root, draw);

  /** An answer of the axes for a study, the status of each interlock, where it is known, and whether it is the last one. */
  function show(answer, study, states = [], last = true) {
    if (last) keyed = null;
    shown = answer;
    studyShown = study;
    statesShown = states;
    draw();
  }

  /** The cursor stands at an angle of the master. */
  function turn(angle) {
    angleNow = angle;
    for (const mark of [cursor, ...marks.map(({ mark }) => mark)]) mark.setAttribute("visibility", angle === null ? "hidden" : "visible");
    if (!toX || angle === null) return;
    const at = toX(angle).toFixed(1);
    setAttributes(cursor, { x1: at, x2: at });
    for (const { row, y, mark } of marks) setAttributes(mark, { cx: at, cy: y(valueAt(shown.at, row.values, angle)).toFixed(1) });
  }

  function draw() {
    const width = size()[0] - 16;
    if (!shown || width < 100) return;
    if (shown.refused) {
      root.replaceChildren(html("div", { class: "nothing" }, html("strong", { text: shown.refused.word }), html("span", { text: "there is nothing to draw" })));
      return;
    }
    const { rows, unit } = shown;
    const each = Math.min(ROW.most, Math.max(ROW.least, Math.floor(ABOUT / rows.length)));
    const height = BOX.top + each * rows.length + BOX.foot;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.foot };
    toX = scale(TURN, [box.left, box.right]);
    setAttributes(drawing, { width, height });
    const scales = rows.map(({ values }, i) => {
      const top = BOX.top + each * i;
      const [low, high] = [Math.min(...values), Math.max(...values)];
      return scale(low < high ? [low, high] : [low - 1, low + 1], [top + each - 4, top + ROW.name + 3]);
    });
    marks = rows.map((row, i) => ({ row, y: scales[i], mark: svg("circle", { class: `point law-${i % 4}`, r: 4 }) }));
    setAttributes(cursor, { y1: box.top, y2: box.bottom });
    renew(
      drawing,
      frame(box, toX, scales[0], { xs: ticksIn(unit, TURN, 8), ys: [], xname: variableOf(shown), unit }),
      ...rows.map((row, i) => drawRow(row, i, scales[i], box, each)),
      ...shown.arrows.flatMap((arrow) => drawArrow(arrow, scales)),
      cursor,
      ...marks.map(({ mark }) => mark),
    );
    if (drawing.parentNode !== root) root.replaceChildren(drawing);
    turn(angleNow);
  }

  function drawRow(row, i, y, box, each) {
    const top = BOX.top + each * i;
    const group = svg("g", { class: `row law-${i % 4}` });
    group.append(svg("line", { class: "grid", x1: 0, x2: box.right, y1: top + each, y2: top + each }));
    group.append(svg("text", { class: "title", translate: "no", x: 4, y: top + each / 2, text: shortened(row.name, 12) }, svg("title", { text: row.name })));
    group.append(svg("text", { x: 4, y: top + each / 2 + 15, text: row.stroke }));
    const line = svg("path", { class: "line active", d: path(shown.at.map((at, k) => [toX(at), y(row.values[k])])) });
    group.append(...row.bars.filter(({ moves }) => moves).map((bar, place) => drawBar(row, i, bar, place, top, each)), line);
    return group;
  }

  /** A bar is known by its place among the moves of its axis, which dwells that come and go do not change. */
  function drawBar(row, i, bar, place, top, each) {
    const number = row.bars.indexOf(bar);
    const [from, to] = [toX(bar.from), toX(bar.to)];
    const angle = (value) => inUnits({ value: Number(value.toFixed(2)), unit: "deg", digits: 5 });
    const text = `${bar.name} ${angle(bar.to - bar.from)}`;
    const edges = to - from >= SHORT ? [["start", from], ["stop", to - EDGE]] : [];
    const group = svg(
      "g",
      {
        class: "timing-bar", tabindex: 0, role: "slider", "data-key": `bar ${i} ${place}`,
        "aria-label": `${row.name}: ${bar.name}`, "aria-valuemin": 0, "aria-valuemax": 360, "aria-valuenow": Number(bar.from.toFixed(2)),
        "aria-valuetext": `from ${angle(bar.from)} to ${angle(bar.to)}`,
        "data-row": i, "data-number": number, onkeydown: (event) => key(event, i, number),
      },
      svg("title", { text: `${row.name}: ${text}. Drag it, or its ends; ← → move it, ↑ ↓ make it longer and shorter` }),
      svg("rect", { class: "ground", x: from, width: Math.max(1, to - from), y: top + 1, height: each - 2, rx: 3 }),
      ...edges.map(([end, x]) => svg("rect", { class: "edge", x, width: EDGE, y: top + 1, height: each - 2, "data-end": end })),
    );
    const letters = Math.floor((to - from - 6) / 6);
    if (letters > 3) group.append(svg("text", { x: from + 4, y: top + ROW.name - 3, text: shortened(text, letters) }));
    return group;
  }

  /** What interlocks say: an arrow from what comes first, or the window in which two run together. */
  function drawArrow({ rule, name, rows, from, to, clear, window }, scales) {
    const word = statesShown[rule] ?? (clear === false ? "broken" : "clear");
    const look = `interlock ${word}`;
    if (window) {
      const [top, bottom] = rows.map((row) => scales[row](shown.rows[row].values[0])).toSorted((a, b) => a - b);
      return [svg("rect", { class: `${look} window`, x: toX(window[0]), width: toX(window[1]) - toX(window[0]), y: top, height: bottom - top }, svg("title", { text: `${name}: ${word}` }))];
    }
    const end = [toX(to[0]), scales[rows[0]](to[1])];
    const dot = ([cx, cy], r) => svg("circle", { class: look, cx: cx.toFixed(1), cy: cy.toFixed(1), r });
    if (!from) return [dot(end, 4)];
    const start = [toX(from[0]), scales[rows[1]](from[1])];
    const title = svg("title", { text: `${name}: ${word}` });
    return [svg("g", { class: look, role: "img", "aria-label": `${name}: ${word}` }, title, svg("path", { class: "shaft-of-arrow", d: path([start, end]) }), svg("path", { class: "head-of-arrow", d: head(start, end) }), dot(start, 3))];
  }

  function grasp(event) {
    const bar = event.target.closest(".timing-bar");
    if (!bar) return null;
    const [row, number] = [bar.dataset.row, bar.dataset.number].map(Number);
    bar.focus({ preventScroll: true });
    changed(row, null);
    return { row, number, ends: event.target.dataset.end ?? "both", bars: shown.rows[row].bars, study: studyShown, period: shown.period, x: event.clientX };
  }

  function pull(drag, event) {
    const by = toX.back(event.clientX) - toX.back(drag.x);
    to(drag, { start: drag.ends === "stop" ? 0 : by, stop: drag.ends === "start" ? 0 : by }, drag.ends);
  }

  /** The ends of a bar go by so many degrees from where they were; a pointer takes them to round instants. */
  function to({ row, number, bars, study, period }, { start, stop }, ends) {
    const { from, to } = bars[number];
    const segments = moved(study.axis[row].segment, bars, number, { start: from + start, stop: to + stop }, { ends, snaps: ends !== "keys", period });
    if (segments) changed(row, segments);
  }

  function key(event, row, number) {
    const bars = shown.rows[row].bars;
    const step = roomOf(studyShown.axis[row].segment[number], shown.period).step * (event.shiftKey ? 10 : 1);
    const [start, stop] = { ArrowLeft: [-step, -step], ArrowRight: [step, step], ArrowDown: [0, -step], ArrowUp: [0, step] }[event.key] ?? [];
    if (start === undefined) return;
    event.preventDefault();
    // keys that come before their answer add up
    if (keyed?.row !== row || keyed.number !== number) keyed = { row, number, bars, study: studyShown, period: shown.period, by: { start: 0, stop: 0 } };
    const { by } = keyed;
    keyed.by = { start: by.start + start, stop: by.stop + stop };
    to(keyed, keyed.by, "keys");
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

const shortened = (text, most) => (text.length > most ? `${text.slice(0, Math.max(1, most - 1))}…` : text);

function head([x1, y1], [x2, y2]) {
  const size = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [u, v] = [(x2 - x1) / size, (y2 - y1) / size];
  const [back, half] = [9, 3.6];
  const corner = (side) => [x2 - back * u - side * half * v, y2 - back * v + side * half * u];
  return `${path([[x2, y2], corner(1), corner(-1)])}Z`;
}

// Curves in panels one below the other over one variable, read by one cursor, zoomed and moved together.
//
// An answer has {across, unit, note, range, ticks, panels, segments, active, symbol}: the name of the variable, its unit, what
// stands behind it, its range (a turn unless given), its ticks, its symbol, a panel for each quantity, the law whose curve is read first, and the segments of a motion,
// {name, at: [from, to]}. A panel is {name, unit, symbol, series, limits, peaks, ends, beyond, span, note}:
// `series` are its curves, each {at, values, name, law, dots}, `law` being the number of its colour, `dots` that points are drawn; `limits`
// are {from, to, value, least}, `peaks` {at, value, and text if it is no plain number}; `span` is what is in sight at least; `note` stands beside the name.
//
// Wheel, drag, + and - zoom and move; arrow keys move the cursor from place to place, Page keys from peak to peak.

import { createChart } from "./chart.js";
import { drawLayers, frame, label, scale, ticks, ticksIn } from "./layers.js";
import { button, html, sized, svg } from "./svg.js";
import { number, panelsInUnits, variableOf } from "./units.js";

/** A place along the variable of pictures that are read together: it follows the pointer, and stays where it was put. */
export function createCursor() {
  const watchers = [];
  let placed = null;
  let pointed = null;
  const here = () => pointed ?? placed;

  function tell(isPlaced) {
    for (const seen of watchers) seen(here(), isPlaced);
  }

  /** Put it somewhere: there it stays. */
  function place(at) {
    [placed, pointed] = [at, null];
    tell(true);
  }

  /** Follow the pointer; null where the pointer has left. */
  function point(at) {
    pointed = at;
    tell(false);
  }

  // `seen(at, placed)` is called whenever the cursor moves; `at` is null where there is none
  return { get at() { return here(); }, watch: (seen) => watchers.push(seen), place, point };
}

const FINEST = 1e-4; // of a range

/** The part of a range that is in sight: zoomed about a place, moved, whole again. */
function createSpan() {
  let whole = [0, 1];
  let shown = [0, 1];
  const reset = () => (shown = [...whole]);
  const move = (by) => show(shown[0] + by, shown[1] + by);

  /** Another range is shown whole; the same one as it was. */
  function of(range) {
    if (range[0] === whole[0] && range[1] === whole[1]) return;
    whole = [...range];
    reset();
  }

  /** Show so many times as much, with a place where it is. */
  function zoom(about, times) {
    const [from, to] = shown;
    const factor = Math.max(times, (FINEST * (whole[1] - whole[0])) / (to - from));
    show(about + factor * (from - about), about + factor * (to - about));
  }

  /** Bring a place into sight. */
  function reach(at) {
    const [from, to] = shown;
    if (at < from || at > to) move(at - (from + to) / 2);
  }

  function show(from, to) {
    const [low, high] = whole;
    const size = Math.min(to - from, high - low);
    const start = Math.min(Math.max(from, low), high - size);
    shown = [start, start + size];
  }

  return { get shown() { return shown; }, get zoomed() { return shown[0] > whole[0] || shown[1] < whole[1]; }, of, reset, zoom, move, reach, show };
}

const TOUCHING = 6; // pixels
const BOX = { left: 64, right: 14, top: 20, bottom: 6 };
const FOOT = 34;
const ROOM = 17; // pixels above and below the curve for what is written at its peaks
const NEAR = 1.6; // limits farther out than this many peaks are out of sight
const WRITTEN = 6.6;
const LAWS = "ABCD";

/** The least and the greatest value of a limit; null is none, and a value alone is that of both sides. */
const edges = ({ value, least = -value }) => [least ?? -Infinity, value ?? Infinity];
/** Where the motion must not go: above and below a limit. */
const zones = (limit) => {
  const [least, value] = edges(limit);
  return [{ from: limit.from, to: limit.to, low: value }, { from: limit.from, to: limit.to, high: least }].map((one) => ({ ...one, name: "zone" }));
};
const titled = ({ name, unit }) => (unit ? `${name}, ${unit}` : name);

/** One quantity over the variable: its curves, its limits, its peaks, and what a cursor reads of it. It is told the answer, the
    span of the variable in sight, the law that is active, where limits are broken, and a name for its parts. */
function createPanel(panel, { answer, span, zoomed, active, beyond, name, segments = [] }, { width, height, last }) {
  const reading = svg("g", { class: "reading", "aria-hidden": "true" });
  const series = seriesOf(panel);
  const own = series.find(({ law }) => law === active) ?? series[0];
  const places = own?.at ?? [];
  const { limits = [], peaks = [] } = panel;
  const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
  const x = scale(span, [box.left, box.right]);
  const known = series.flatMap(({ at, values }) => values.filter((value, i) => value !== null && at[i] >= span[0] && at[i] <= span[1]));
  const [low, high] = reach();
  const room = ((high - low || 1) * ROOM) / (box.bottom - box.top - 2 * ROOM);
  const y = scale([low < 0 || zoomed ? low - room : low, high + room], [box.bottom, box.top]);
  const tall = height + (last ? FOOT : 0);
  const element = svg("svg", { class: "curve", width, height: tall, viewBox: `0 0 ${width} ${tall}`, role: "img", "aria-label": told(panel, answer) }, ...parts(), reading);

  function parts() {
    const xs = !zoomed && answer.ticks ? answer.ticks : ticksIn(answer.unit, span, 8);
    const ys = ticks(low, high, Math.min(4, Math.max(2, Math.floor((box.bottom - box.top) / 18))));
    const broken = beyond.flatMap(([from, to]) => limits.map((limit) => ({ ...limit, from: Math.max(from, limit.from), to: Math.min(to, limit.to) })));
    const over = broken.filter(({ from, to }) => from < to).flatMap(zones);
    const curves = series.map(({ at, values, law, dots, name: title }) => ({
      name: `line law-${law}${law === own.law ? " active" : ""}${dots ? " dots" : ""}`, law, title, dots, points: at.map((one, i) => [one, values[i]]),
    }));
    // the first law lies above the others, the active one above all
    const order = curves.toReversed().sort((one, other) => (one.law === own.law) - (other.law === own.law));
    const joints = segments.map(({ at: [from] }) => from).filter((from) => x(from) > box.left).map((from) => ({ name: "joint", points: [box.top, box.bottom].map((end) => [from, y.back(end)]) }));
    const circles = [];
    const apart = ({ at, value }) => {
      const [left, top] = [x(at), y(value)];
      if (left < box.left - 0.5 || left > box.right + 0.5 || circles.some((one) => Math.hypot(one[0] - left, one[1] - top) < TOUCHING)) return false;
      return circles.push([left, top]);
    };
    return [
      frame(box, x, y, { xs, ys, xlabels: last, xname: last ? variableOf(answer) : "", unit: answer.unit }),
      svg("text", { class: "title", x: box.left, y: 13, text: titled(panel) }),
      panel.note ? svg("text", { class: "limit-name", x: box.left + WRITTEN * (titled(panel).length + 2), y: 13, text: panel.note }) : null,
      ...drawLayers({
        zones: limits.flatMap(zones),
        lines: [...joints, ...order, ...(over.length && curves.length ? [{ name: "beyond", points: curves[0].points, within: over }] : [])],
        marks: peaks.filter(apart).map(({ at, value, text = number(value) }) => ({ at: [at, value], name: `peak law-${own?.law ?? 0}`, r: 3, text, above: value > 0 })),
      }, { box, toX: x, toY: y, name }).ground,
    ];
  }

  /** The value of the variable at a place of the pointer. */
  const at = (clientX) => x.back(clientX - element.getBoundingClientRect().left);

  /** The place of the active curve nearest to a value of the variable: there the law itself was computed. */
  const nearest = (value) => places.reduce((best, one) => (Math.abs(one - value) < Math.abs(best - value) ? one : best), places[0] ?? value);

  /** A line at the cursor, a dot on each curve, and their values; returns the value of the active one as text. */
  function read(value) {
    reading.replaceChildren();
    const here = value === null ? NaN : x(value);
    if (!(here >= box.left - 0.5 && here <= box.right + 0.5)) return "";
    const found = series.filter(({ law }) => typeof law === "number").map((one) => ({ ...one, ...between(one, value) })).filter((one) => one.reading !== null);
    reading.append(svg("line", { class: "cursor", x1: here.toFixed(1), x2: here.toFixed(1), y1: box.top, y2: box.bottom }));
    for (const one of found) reading.append(svg("circle", { class: `point law-${one.law}`, cx: here.toFixed(1), cy: y(one.reading).toFixed(1), r: 3 }));
    const first = found.find((one) => one.law === own.law);
    const letters = (box.right - box.left) / WRITTEN - titled(panel).length - 2;
    const unit = panel.unit ? ` ${panel.unit}` : "";
    const all = found.map((one) => ({ ...one, text: found.length > 1 ? `${LAWS[one.law] ?? ""} ${one.text}` : `${one.text}${unit}` }));
    const fits = all.reduce((sum, { text }) => sum + text.length + 2, 0) < letters;
    const spans = (fits ? all : first ? [first] : []).map((one, i) => svg("tspan", { class: found.length > 1 ? `law-${one.law}` : "", text: `${i ? "  " : ""}${one.text}` }));
    reading.append(svg("text", { x: box.right, y: 13, "text-anchor": "end" }, ...spans));
    return first ? `${panel.symbol ?? panel.name} ${first.text}${unit}` : "";
  }

  /** The least and the greatest value in sight; of the whole also 0, limits near what is used of them on their side, and what the panel asks for. */
  function reach() {
    if (zoomed && known.length) return [Math.min(...known), Math.max(...known)];
    const side = (sign, end) => {
      const used = Math.max(0, ...known.map((value) => sign * value));
      const near = limits.map((limit) => sign * edges(limit)[end]).filter((value) => value <= NEAR * used);
      return sign * Math.max(used, ...near, ...(panel.span ?? []).map((value) => sign * value));
    };
    return [side(-1, 0), side(1, 1)];
  }

  return { at, nearest, places, peaks: peaks.map((peak) => peak.at), read, element };
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

const TURN = [0, 360];
const LEAST = 84;
const ZOOM = 1.5;
const CLICK = 4; // pixels within which a press is no drag

/** `strip` draws the segments above the curves: {element, show(answer, span, edges)}. */
export function createPanels(root, { cursor = createCursor(), strip = null } = {}) {
  const drawings = html("div", { class: "drawings" });
  const dial = html("input", { type: "range", class: "dial", "aria-label": "Cursor along the curves", step: "any", oninput: () => place(Number(dial.value)) });
  const value = html("output", { class: "cursor-value" });
  const buttons = {};
  let shown = null;
  let drawnPanels = [];
  const range = createSpan();
  let drag = null;
  root.classList.add("panels");
  root.tabIndex = -1;
  const tool = (name, text, title, act) => (buttons[name] = button(text, act, { title, "aria-label": title }));
  const tools = html(
    "div", { class: "panel-tools" }, dial, value,
    tool("out", "−", "Show more of the curves", () => zoom(ZOOM)),
    tool("in", "+", "Show less of the curves, larger", () => zoom(1 / ZOOM)),
    tool("whole", "whole", "Show the whole curves", reset),
  );
  root.replaceChildren(...(strip ? [strip.element] : []), drawings, tools);
  cursor.watch(read);
  root.addEventListener("keydown", key);
  const acts = { pointermove: point, pointerleave: () => cursor.point(null), pointerdown: grasp, pointerup: release, pointercancel: () => (drag = null), dblclick: reset };
  for (const [kind, act] of Object.entries(acts)) drawings.addEventListener(kind, act);
  drawings.addEventListener("wheel", wheel, { passive: false });
  const size = sized(drawings, draw);

  function show(answer) {
    shown = panelsInUnits(answer);
    draw();
  }

  /** What the cursor reads: the name, the unit and the value of each panel. */
  function readings() {
    const at = cursor.at;
    return at === null ? [] : drawnPanels.map((panel) => panel.read(at)).filter(Boolean);
  }

  /** Show a part of the range. */
  function look([from, to]) {
    range.show(from, to);
    draw();
  }

  function draw() {
    const [width, room] = size();
    if (!shown || width < 100) return;
    const nothing = shown.refused;
    root.classList.toggle("empty", Boolean(nothing));
    drawnPanels = [];
    if (nothing) {
      drawings.replaceChildren(html("div", { class: "nothing" }, html("strong", { text: nothing.word }), html("span", { text: "there is nothing to draw" })));
      return;
    }
    const answer = { range: TURN, ...shown };
    const { panels, segments } = answer;
    range.of(answer.range);
    const { shown: span, zoomed } = range;
    const height = Math.max(LEAST, Math.floor((room - FOOT) / panels.length));
    drawnPanels = panels.map((panel, i) => createPanel(
      panel,
      { answer, span, zoomed, segments, active: answer.active ?? 0, name: `${root.id}-${i}`, beyond: beyond(panel, segments ?? [], i) },
      { width, height, last: i === panels.length - 1 },
    ));
    drawings.replaceChildren(...drawnPanels.map(({ element }) => element));
    // what is scrolled is reached by keys too
    if (height * panels.length + FOOT > room) drawings.tabIndex = 0;
    else drawings.removeAttribute("tabindex");
    strip?.show(answer, span);
    [dial.min, dial.max] = span;
    root.classList.toggle("zoomed", zoomed);
    buttons.whole.disabled = buttons.out.disabled = !zoomed;
    read(cursor.at);
  }

  function read(at) {
    if (!drawnPanels.length) return;
    const texts = drawnPanels.map((panel) => panel.read(at)).filter(Boolean);
    const here = at === null ? "" : `${shown.symbol ? `${shown.symbol} = ` : ""}${number(at, shown.unit)}`;
    value.textContent = here;
    dial.value = at ?? range.shown[0];
    dial.setAttribute("aria-valuetext", at === null ? "not placed" : `${here}: ${texts.join(", ")}`);
  }

  /** Put the cursor at the place nearest to a value. */
  function place(value) {
    const panel = drawnPanels[0];
    if (panel) cursor.place(panel.nearest(value));
  }

  function under(event) {
    return drawnPanels.find(({ element }) => element.contains(event.target)) ?? (drag && drawnPanels[0]);
  }

  function within(value) {
    const [from, to] = range.shown;
    return Math.min(to, Math.max(from, value));
  }

  function point(event) {
    const panel = under(event);
    if (!panel) return;
    if (drag && range.zoomed && Math.abs(event.clientX - drag.began) >= CLICK) {
      drawings.setPointerCapture(event.pointerId);
      range.move(panel.at(drag.from) - panel.at(event.clientX));
      drag.from = event.clientX;
      drag.moved = true;
      draw();
    } else cursor.point(panel.nearest(within(panel.at(event.clientX))));
  }

  function grasp(event) {
    if (event.button === 0 && drawnPanels.length) drag = { began: event.clientX, from: event.clientX, moved: false };
  }

  function release(event) {
    const panel = under(event);
    const click = drag && !drag.moved;
    drag = null;
    if (click && panel) cursor.place(panel.nearest(within(panel.at(event.clientX))));
  }

  function wheel(event) {
    const panel = under(event);
    // at the whole range the wheel scrolls the page on
    if (!panel || (event.deltaY > 0 && !range.zoomed)) return;
    event.preventDefault();
    if (event.shiftKey) range.move((Math.sign(event.deltaY || event.deltaX) * (range.shown[1] - range.shown[0])) / 8);
    else range.zoom(within(panel.at(event.clientX)), ZOOM ** Math.sign(event.deltaY));
    draw();
  }

  function zoom(times) {
    const [from, to] = range.shown;
    const at = cursor.at;
    range.zoom(at !== null && at >= from && at <= to ? at : (from + to) / 2, times);
    draw();
  }

  function reset() {
    range.reset();
    draw();
  }

  function key(event) {
    const [from, to] = range.shown;
    const acts = { "+": () => zoom(1 / ZOOM), "-": () => zoom(ZOOM), 0: reset, Escape: () => cursor.place(null) };
    const moves = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
    const onDial = event.target === dial;
    if (event.ctrlKey || event.metaKey || event.altKey || (!onDial && !Object.hasOwn(acts, event.key))) return;
    const panel = drawnPanels[0];
    const at = cursor.at ?? from;
    const go = (value) => {
      if (value === undefined) return;
      range.reach(value);
      draw();
      cursor.place(value);
    };
    const next = (places, by) => {
      const sorted = [...new Set(places)].sort((one, other) => one - other);
      return by > 0 ? sorted.filter((one) => one > at + 1e-9)[by - 1] ?? sorted.at(-1) : sorted.findLast((one) => one < at - 1e-9) === undefined ? sorted[0] : sorted.filter((one) => one < at - 1e-9).at(by);
    };
    if (Object.hasOwn(acts, event.key)) acts[event.key]();
    else if (!panel) return;
    else if (event.key in moves) go(next(panel.places, moves[event.key] * (event.shiftKey ? 10 : 1)));
    else if (event.key === "PageUp" || event.key === "PageDown") go(next(drawnPanels.flatMap(({ peaks }) => peaks), event.key === "PageUp" ? 1 : -1));
    else if (event.key === "Home" || event.key === "End") go(event.key === "Home" ? from : to);
    else return;
    event.preventDefault();
  }

  return { show, get readings() { return readings(); }, look, cursor };
}

/** Where a panel is beyond its limits, as [from, to]: all of it, or the segments that break their own. */
function beyond(panel, segments, i) {
  if (panel.beyond !== undefined) return panel.beyond ? [[-Infinity, Infinity]] : [];
  return segments.filter(({ peaks }) => peaks?.[i - 1]?.beyond).map(({ at }) => at);
}

const STRIP = { left: BOX.left, right: BOX.right, top: 0, bottom: 0 };

/** The segments as bars above curves: `moved(i, at)` asks for the end of segment i at a place, where ends can be moved; `chosen(i)` is a click
    on a bar. */
export function createStrip({ moved = null, rested = () => {}, chosen = () => {}, step = 1 }) {
  const element = html("div", { class: "strip", role: "group", "aria-label": "Segments of the motion" });
  const chart = createChart(element, (key, at) => (at === null ? rested() : moved(Number(key), at)));

  function show({ segments = [], range, unit }, span) {
    const place = (at) => number(at, unit);
    const joint = ({ name, at: [low, at] }, i) => ({
      key: String(i), at: [at, 0.5], along: "x", low: low + step, high: (segments[i + 1]?.at[1] ?? range[1]) - step, step, keys: 1,
      label: `Where ${name} ends and ${segments[i + 1]?.name} begins`, text: place(at), name: "law-0 joint-handle",
    });
    chart.show(segments.length === 0 ? null : {
      x: { range: span }, y: { range: [0, 1] }, margins: STRIP, height: 24, bare: true,
      zones: segments.map(({ name, at: [from, to] }, i) => ({ from, to, name: "bar", title: `${name}: ${place(from)} to ${place(to)}`, onclick: () => chosen(i) })),
      labels: segments.map(({ name, at: [from, to] }) => ({ at: [(Math.max(from, span[0]) + Math.min(to, span[1])) / 2, 0.5], up: -4, anchor: "middle", text: name, name: "name", within: to - from })),
      handles: moved ? segments.slice(0, -1).map(joint).filter(({ at: [at] }) => at >= span[0] && at <= span[1]) : [],
      told: segments.map(({ name, at: [from, to] }) => `${name} ${place(from)} to ${place(to)}`).join("; "),
    });
  }

  return { element, show };
}

/** `label` is what the dial is; the cursor is that of all pictures that follow, from 0 to `end()`, in so many seconds;
    `spoken(at)` is a place in words. */
export function createRun(root, label, cursor, { text = "Run", end = () => 360, steps = 360, seconds = 6, spoken = (at) => `${Math.round(at)} degrees` } = {}) {
  let ticking = null;
  const dial = html("input", { type: "range", min: 0, max: steps, step: 1, value: 0, "aria-label": label, oninput: () => cursor.place((Number(dial.value) / steps) * end()) });
  const play = button(text, () => (ticking === null ? start() : stop()));
  root.classList.add("run");
  root.replaceChildren(play, dial);
  cursor.watch((at) => {
    if (at === null) return;
    dial.value = Math.round((at / end()) * steps);
    dial.setAttribute("aria-valuetext", spoken(at));
  });

  function start() {
    play.textContent = "Pause";
    let last = performance.now();
    let at = cursor.at ?? 0;
    const step = (now) => {
      at = (at + ((now - last) / 1000 / seconds) * end()) % end();
      last = now;
      cursor.place(Number(at.toFixed(1)));
      // a view that is not shown does not run
      if (root.offsetParent === null) stop();
      else ticking = requestAnimationFrame(step);
    };
    ticking = requestAnimationFrame(step);
  }

  function stop() {
    cancelAnimationFrame(ticking);
    ticking = null;
    play.textContent = text;
  }
}

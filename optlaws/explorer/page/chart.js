// A picture over two axes: lines, marks, labels, standard things that can be picked, and handles that are dragged along one
// axis or both, by the pointer or by arrow keys.
//
// A picture has {x, y, zones, lines, marks, labels, picks, points, handles, told, of}. An axis is {name, range, log}; a zone
// {from, to, name} of x; a line {points, name, title, closed}, `name` being its classes; a mark {at, name, title, r}; a label
// {at, text, name, anchor, up, aside, wide} with the pixels that must be free on its left, or `free`, so that it stands where there is room; a pick {key, at, text, named}, whose key is
// written beside it where `named` says so and there is room; a point is a mark that moves; a handle {key, at, along, low, high,
// step, label, text, name} and perhaps {from, up, anywhere, fixed}: a function of where keys go from, whether it is rounded up, whether the
// whole picture drags it, whether nothing does. `told` is the picture in words. All but points and handles are drawn once for
// an object `of`.

import { draggable, path, renew, setAttributes, sized, svg } from "./svg.js";
import { number, shownUnit } from "./units.js";

const TURN = 360;
const LINE = 10; // pixels that a label takes

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

const BOX = { left: 58, right: 16, top: 14, bottom: 44 };
const HALO = 13;

/** A scale of an axis; a logarithmic one has round ticks of its own. */
function scaled({ range, log = false }, ends) {
  if (!log) return scale(range, ends);
  const linear = scale(range.map(Math.log10), ends);
  const to = (value) => linear(Math.log10(value));
  to.back = (pixel) => 10 ** linear.back(pixel);
  return to;
}

const PARTS = [[1, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]]; // of a power of ten
const APART = 44; // pixels between the middles of two labels

/** Round ticks of an axis; of a logarithmic one as many as have room for their labels. */
function marked({ range: [low, high], log = false }, count, to) {
  if (!log) return ticks(low, high, count);
  const powers = Array.from({ length: Math.ceil(Math.log10(high)) - Math.floor(Math.log10(low)) + 1 }, (_, i) => 10 ** (Math.floor(Math.log10(low)) + i));
  const sets = PARTS.map((parts) => powers.flatMap((power) => parts.map((part) => Number((part * power).toPrecision(3)))).filter((value) => value >= low && value <= high));
  return sets.find((found) => found.every((value, i) => i === 0 || Math.abs(to(value) - to(found[i - 1])) >= APART)) ?? sets.at(-1);
}

/** A range around values with room for what is written; 0 is in it unless `free`. */
export function spanOf(values, { free = false, room = 0.08 } = {}) {
  const known = values.filter((value) => value !== null && Number.isFinite(value));
  const [low, high] = [Math.min(...known, ...(free ? [] : [0])), Math.max(...known, ...(free ? [] : [0]))];
  const more = room * (high - low || Math.abs(high) || 1);
  return [low < 0 || free ? low - more : low, high > 0 || free ? high + more : high];
}

const LETTER = 6.4;
const HIGH = 12;
const overlap = (one, other) => one.left < other.right && one.right > other.left && one.top < other.bottom && one.bottom > other.top;

/** What is written in a box beside marks at [x, y] in pixels: a function of a place and a text, whose element lies over no
    mark and no other text, or which gives null where there is no room. */
export function createRoom(box, marks) {
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

const within = (value, low, high) => Math.min(high, Math.max(low, value));

/** `moved(key, value)` is called while a handle moves, and with null when it rests; `picked(key)` when something is. */
export function createChart(root, moved, picked = () => {}) {
  let shown = null;
  let drawnOf = []; // what the ground is drawn of
  const drawing = svg("svg", { class: "plane chart" });
  const back = svg("g", { role: "img" });
  const picksLayer = svg("g");
  const pointsLayer = svg("g");
  const tip = svg("text", { class: "tip", "aria-hidden": "true" });
  const handleElements = new Map();
  let frameBox = null;
  let toX = null;
  let toY = null;
  const placeOf = ([one, other]) => [toX(one), toY(other)];
  drawing.append(back, picksLayer, pointsLayer, tip);
  root.append(drawing);
  const size = sized(root, draw);
  draggable(drawing, grasp, pull, (key) => moved(key, null));

  function show(picture) {
    shown = picture;
    draw();
  }

  function draw() {
    const [width, height] = size();
    drawing.toggleAttribute("hidden", !shown);
    if (!shown || width < 120 || height < 90) return;
    const { points = [], handles = [], told = "", of = {} } = shown;
    const drawn = [of, width, height];
    if (drawn.some((one, i) => one !== drawnOf[i])) ground(width, height);
    drawnOf = drawn;
    back.setAttribute("aria-label", told);
    pointsLayer.replaceChildren(...points.map(drawMark));
    drawHandles(handles);
  }

  function ground(width, height) {
    const { x, y, lines = [], marks = [], labels = [], zones = [], picks = [] } = shown;
    const box = (frameBox = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom });
    toX = scaled(x, [box.left, box.right]);
    toY = scaled(y, [box.bottom, box.top]);
    setAttributes(drawing, { width, height });
    const clipped = `clip-${root.id}`;
    const inner = svg("g", { "clip-path": `url(#${clipped})` });
    for (const { from, to, name } of zones) inner.append(svg("rect", { class: name, x: toX(from), width: Math.max(1, toX(to) - toX(from)), y: box.top, height: box.bottom - box.top }));
    for (const { points, name, title, closed } of lines) inner.append(svg("path", { class: name, d: `${path(points.map((one) => (one === null || one.includes(null) ? null : placeOf(one))))}${closed ? "Z" : ""}` }, title ? svg("title", { text: title }) : null));
    inner.append(...marks.map(drawMark));
    const room = createRoom(box, [...marks, ...picks].map(({ at }) => placeOf(at)));
    const written = labels.filter(({ at, wide = 0 }) => toX(at[0]) - wide >= box.left).map((one) => (one.free ? room(placeOf(one.at), one.text, one) : drawLabel(one)));
    back.replaceChildren(
      svg("clipPath", { id: clipped }, svg("rect", { x: box.left, y: box.top, width: Math.max(1, box.right - box.left), height: Math.max(1, box.bottom - box.top) })),
      frame(box, toX, toY, { xs: marked(x, 7, toX), ys: marked(y, 5, toY), xname: x.name, yname: y.name }),
      inner,
      svg("g", { class: "names", "aria-hidden": "true" }, ...written),
    );
    renew(picksLayer, ...drawPicks(picks, room));
  }

  /** A label stands above its place, below it where there is no room; `aside` is how far it stands on its side. */
  function drawLabel({ at, text, name = "", anchor = "start", up = 5, aside = 0 }) {
    const [x, y] = placeOf(at);
    const above = y - up >= frameBox.top + 12 || !aside ? Math.max(frameBox.top + 10, y - up) : y + 18;
    return svg("text", { class: name, x: (x + (anchor === "end" ? -aside : aside)).toFixed(1), y: above.toFixed(1), "text-anchor": anchor, text });
  }

  function drawMark({ at, name, title, r = 3.2 }) {
    const [x, y] = placeOf(at);
    return svg("circle", { class: name, cx: x.toFixed(1), cy: y.toFixed(1), r }, title ? svg("title", { text: title }) : null);
  }

  // --- what can be picked ---

  function drawPicks(picks, room) {
    const { left, right, top, bottom } = frameBox;
    const known = picks.map((pick) => ({ ...pick, place: placeOf(pick.at) }));
    return known.filter(({ place: [x, y] }) => x >= left && x <= right && y >= top && y <= bottom).map(({ key, text, named, place }, i) => {
      const tell = () => showTip(text, place);
      const leave = () => showTip("");
      return svg(
        "g",
        {
          class: "known", tabindex: i ? "-1" : "0", role: "button", "aria-label": `${text}. Compare`,
          onpointerenter: tell, onfocus: tell, onpointerleave: leave, onblur: leave,
          onpointerdown: (event) => event.stopPropagation(), onclick: () => picked(key), onkeydown: (event) => walk(event, key),
        },
        svg("circle", { class: "halo", cx: place[0], cy: place[1], r: 9 }),
        svg("circle", { class: "mark", cx: place[0], cy: place[1], r: 3.2 }),
        named ? room(place, key) : null,
      );
    });
  }

  /** What can be picked is one stop of the tabulator: arrows go from one to the next. */
  function walk(event, key) {
    const all = [...picksLayer.children];
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter" || event.key === " ") picked(key);
    else if (step) all[(all.indexOf(event.currentTarget) + step + all.length) % all.length].focus();
    else return;
    event.preventDefault();
  }

  function showTip(text, [x, y] = [0, 0]) {
    tip.textContent = text;
    const end = x > (frameBox.left + frameBox.right) / 2;
    setAttributes(tip, { x: x + (end ? -8 : 8), y: Math.max(frameBox.top + 12, y - 10), "text-anchor": end ? "end" : "start" });
  }

  // --- handles ---

  /** Handles stay while they are dragged or have the focus: they are moved, not made again. */
  function drawHandles(handles) {
    const box = frameBox;
    const kept = new Set(handles.map(({ key }) => key));
    for (const [key, { element }] of handleElements) {
      if (kept.has(key)) continue;
      element.remove();
      handleElements.delete(key);
    }
    for (const handle of handles) {
      const known = handleElements.get(handle.key) ?? createHandle(handle);
      known.handle = handle;
      const [x, y] = placeOf(handle.at);
      const inside = [within(x, box.left, box.right), within(y, box.top, box.bottom)];
      const across = handle.along !== "y";
      setAttributes(known.element, {
        transform: `translate(${inside[0].toFixed(1)} ${inside[1].toFixed(1)})`,
        class: `handle along-${handle.along} ${handle.name ?? "law-0"}${handle.fixed ? " fixed" : ""}`,
        "aria-label": handle.label, "aria-orientation": across ? "horizontal" : "vertical", "aria-valuemin": handle.low,
        "aria-valuemax": handle.high, "aria-valuenow": handle.from?.() ?? handle.at[across ? 0 : 1], "aria-valuetext": handle.text,
      });
      known.element.querySelector("title").textContent = `${handle.label}: ${handle.text}`;
      const guided = handle.along !== "both" && !handle.anywhere;
      setAttributes(known.element.querySelector(".guide"), { x1: 0, x2: across || !guided ? 0 : box.right - inside[0], y1: 0, y2: across && guided ? box.bottom - inside[1] : 0 });
    }
  }

  function createHandle({ key }) {
    const element = svg("g", { tabindex: "0", role: "slider", "data-key": key }, svg("title"), svg("line", { class: "guide" }), svg("circle", { class: "halo", r: HALO }), svg("circle", { class: "dot", r: 6 }));
    element.addEventListener("keydown", (event) => onKey(event, key));
    drawing.append(element);
    const known = { element };
    handleElements.set(key, known);
    return known;
  }

  /** A click on a handle moves nothing; one beside the handle of the whole picture moves it there. */
  function grasp(event) {
    const own = event.target.closest(".handle")?.dataset.key;
    const key = own ?? [...handleElements].find(([, { handle }]) => handle.anywhere)?.[0] ?? null;
    if (key === null || handleElements.get(key).handle.fixed) return null;
    handleElements.get(key).element.focus({ preventScroll: true });
    if (own === undefined) pull(key, event);
    return key;
  }

  function pull(key, event) {
    const handle = handleElements.get(key)?.handle;
    if (!handle) return;
    const corner = drawing.getBoundingClientRect();
    const place = [toX.back(event.clientX - corner.left), toY.back(event.clientY - corner.top)];
    moveTo(handle, { x: place[0], y: place[1], both: place }[handle.along]);
  }

  function moveTo({ key, along, low, high, step, up = false }, value) {
    const round = (one, by) => Number(((up ? Math.ceil(one / by - 1e-9) : Math.round(one / by)) * by).toPrecision(9));
    if (along === "both") moved(key, value.map((one, i) => round(one, step[i])));
    else moved(key, within(round(within(value, low, high), step), low, high));
  }

  function onKey(event, key) {
    const { handle } = handleElements.get(key);
    const sign = { ArrowLeft: [-1, 0], ArrowDown: [0, -1], ArrowRight: [1, 0], ArrowUp: [0, 1], PageDown: [-10, 0], PageUp: [10, 0] }[event.key];
    if (handle.fixed) return;
    if (handle.along === "both") {
      if (!sign) return;
      moveTo(handle, handle.at.map((one, i) => one + sign[i] * handle.step[i] * (event.shiftKey ? 10 : 1)));
    } else if (event.key === "Home") moveTo(handle, handle.low);
    else if (event.key === "End") moveTo(handle, handle.high);
    else if (sign) moveTo(handle, (handle.from?.() ?? handle.at[handle.along === "x" ? 0 : 1]) + (sign[0] + sign[1]) * handle.step * (event.shiftKey ? 100 : 10));
    else return;
    event.preventDefault();
  }

  return { show };
}

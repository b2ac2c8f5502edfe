// A picture over two axes, in the layers of layers.js, with standard things that can be picked, and handles and bars that are
// dragged, by the pointer or by arrow keys.
//
// A picture has {x, y, equal, bare, margins, height, zones, lines, marks, labels, notes, picks, points, cursor, handles, told, of}. An axis is
// {name, range, log, unit, ticks}; where `equal` is, both have one scale, with so many pixels of room around them; there and where it is
// `bare`, there is no frame. `notes` stand in a corner. A pick is {key, at, text, named}, whose key is written beside it where `named` says so and there
// is room. A point is a mark that moves, `cursor` a line at a value of x. A handle is {key, at, along, low, high, step, label, text, name} and perhaps
// {keys, from, up, anywhere, fixed}: how many steps an arrow key goes, a function of where keys go from, whether it is rounded up, whether
// the whole picture drags it, whether nothing does. A bar is a handle {key, from, to, low, high, label, text, title, short, name} over a part
// of both axes. `told` is the picture in words. All but points, cursor and handles are drawn once for an object `of`.

import { drawLayers, drawMark, fitted, frame, marked, scaleBar, scaled, shortened, ticksIn } from "./layers.js";
import { draggable, renew, setAttributes, sized, svg } from "./svg.js";

const MARGINS = { left: 58, right: 16, top: 14, bottom: 44 };
const NONE = { left: 0, right: 0, top: 0, bottom: 0 };
const HALO = 13;
const EDGE = 7; // pixels at the ends of a bar by which it is made longer or shorter
const SHORT = 30; // a bar of fewer pixels is moved only
const SIGNS = { ArrowLeft: [-1, 0], ArrowDown: [0, -1], ArrowRight: [1, 0], ArrowUp: [0, 1], PageDown: [-10, 0], PageUp: [10, 0] };
const ENDS = { ArrowLeft: [-1, -1], ArrowRight: [1, 1], ArrowDown: [0, -1], ArrowUp: [0, 1] }; // of a bar
const NOTE = 14; // pixels from one note to the next

const within = (value, low, high) => Math.min(high, Math.max(low, value));

/** `moved(key, value)` is called while a handle moves, and with null when it rests; of a bar with {end, by}, which of its ends go by how
    much from where they were, or {keys}, by how many steps each end goes; `picked(key)` when something is. */
export function createChart(root, moved = () => {}, picked = () => {}) {
  let shown = null;
  let drawnOf = []; // what the ground is drawn of
  const drawing = svg("svg", { class: "plane chart" });
  const back = svg("g", { role: "img" });
  const picksLayer = svg("g");
  const pointsLayer = svg("g");
  const tip = svg("text", { class: "tip", "aria-hidden": "true" });
  const handleElements = new Map();
  let box = null;
  let toX = null;
  let toY = null;
  const placeOf = ([one, other]) => [toX(one), toY(other)];
  drawing.append(back, picksLayer, pointsLayer, tip);
  const size = sized(root, draw);
  draggable(drawing, grasp, pull, ({ key }) => moved(key, null));

  function show(picture) {
    shown = picture;
    draw();
  }

  function draw() {
    const [width, room] = size();
    if (!shown) return drawing.remove();
    const height = shown.height ?? room;
    if (width < 100 || height < (shown.height ?? 80)) return;
    if (drawing.parentNode !== root) root.append(drawing);
    const { points = [], cursor = null, handles = [], told = "", of = {} } = shown;
    const drawn = [of, width, height];
    if (drawn.some((one, i) => one !== drawnOf[i])) ground(width, height);
    drawnOf = drawn;
    back.setAttribute("aria-label", told);
    const line = cursor === null ? [] : [svg("line", { class: "cursor run", x1: toX(cursor), x2: toX(cursor), y1: box.top, y2: box.bottom })];
    pointsLayer.replaceChildren(...line, ...points.map((one) => drawMark(one, placeOf)));
    drawHandles(handles);
  }

  function ground(width, height) {
    const { x, y, equal, bare = false, picks = [], notes = [], margins = equal === undefined ? MARGINS : NONE } = shown;
    box = { left: margins.left, right: width - margins.right, top: margins.top, bottom: height - margins.bottom };
    [toX, toY] = equal === undefined ? [scaled(x, [box.left, box.right]), scaled(y, [box.bottom, box.top])] : fitted(x.range, y.range, box, equal);
    setAttributes(drawing, { width, height });
    const { ground, room } = drawLayers(shown, { box, toX, toY, name: root.id, beside: picks });
    const xs = x.unit ? ticksIn(x.unit, x.range, 8) : marked(x, 7, toX);
    back.replaceChildren(
      ...(equal === undefined && !bare ? [frame(box, toX, toY, { xs, ys: y.ticks ?? marked(y, 5, toY), xname: x.name, yname: y.name, unit: x.unit })] : []),
      ...ground,
      ...notes.map((text, i) => svg("text", { x: 4, y: NOTE * (i + 1), text })),
      ...(x.ruler ? scaleBar(box, toX) : []),
    );
    renew(picksLayer, ...drawPicks(picks, room));
  }

  // --- what can be picked ---

  function drawPicks(picks, room) {
    const { left, right, top, bottom } = box;
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
    const end = x > (box.left + box.right) / 2;
    setAttributes(tip, { x: x + (end ? -8 : 8), y: Math.max(box.top + 12, y - 10), "text-anchor": end ? "end" : "start" });
  }

  // --- handles and bars ---

  /** Handles stay while they are dragged or have the focus: they are moved, not made again. */
  function drawHandles(handles) {
    const kept = new Set(handles.map(({ key }) => key));
    for (const [key, { element }] of handleElements) {
      if (kept.has(key)) continue;
      element.remove();
      handleElements.delete(key);
    }
    for (const handle of handles) {
      const known = handleElements.get(handle.key) ?? createHandle(handle);
      known.handle = handle;
      const { label, text, title = `${label}: ${text}` } = handle;
      setAttributes(known.element, { "aria-label": label, "aria-valuetext": text });
      known.element.querySelector("title").textContent = title;
      if ("to" in handle) placeBar(known.element, handle);
      else placeHandle(known.element, handle);
    }
  }

  function placeHandle(element, { at, along, low, high, name = "law-0", fixed, from, anywhere }) {
    const [x, y] = placeOf(at);
    const inside = [within(x, box.left, box.right), within(y, box.top, box.bottom)];
    const across = along !== "y";
    setAttributes(element, {
      transform: `translate(${inside[0].toFixed(1)} ${inside[1].toFixed(1)})`, class: `handle along-${along} ${name}${fixed ? " fixed" : ""}`,
      "aria-orientation": across ? "horizontal" : "vertical", "aria-valuemin": low, "aria-valuemax": high, "aria-valuenow": from?.() ?? at[across ? 0 : 1],
    });
    const guided = along !== "both" && !anywhere;
    setAttributes(element.querySelector(".guide"), { x1: 0, x2: across || !guided ? 0 : box.right - inside[0], y1: 0, y2: across && guided ? box.bottom - inside[1] : 0 });
  }

  function placeBar(element, { from, to, low, high, short, name }) {
    const { range } = shown.x;
    setAttributes(element, { class: `timing-bar ${name}`, "aria-valuemin": range[0], "aria-valuemax": range[1], "aria-valuenow": Number(from.toFixed(2)) });
    const [left, right] = [toX(from), toX(to)];
    const [top, bottom] = [toY(high), toY(low)].toSorted((one, other) => one - other);
    const rows = { y: top, height: bottom - top };
    const [ground, ...edges] = element.querySelectorAll("rect");
    setAttributes(ground, { ...rows, x: left, width: Math.max(1, right - left) });
    edges.forEach((edge, i) => {
      setAttributes(edge, { ...rows, x: i ? right - EDGE : left, width: EDGE });
      edge.toggleAttribute("hidden", right - left < SHORT);
    });
    const letters = Math.floor((right - left - 6) / 6);
    setAttributes(element.querySelector("text"), { x: left + 4, y: top + 11, text: letters > 3 ? shortened(short, letters) : "" });
  }

  function createHandle({ key, to }) {
    const parts = to === undefined
      ? [svg("line", { class: "guide" }), svg("circle", { class: "halo", r: HALO }), svg("circle", { class: "dot", r: 6 })]
      : [svg("rect", { class: "ground", rx: 3 }), ...["start", "stop"].map((end) => svg("rect", { class: "edge", "data-end": end })), svg("text")];
    const element = svg("g", { tabindex: "0", role: "slider", "data-key": key }, svg("title"), ...parts);
    element.addEventListener("keydown", (event) => onKey(event, key));
    drawing.append(element);
    const known = { element };
    handleElements.set(key, known);
    return known;
  }

  /** A click on a handle moves nothing; one beside the handle of the whole picture moves it there. */
  function grasp(event) {
    const own = event.target.closest("[data-key]")?.dataset.key;
    const key = own ?? [...handleElements].find(([, { handle }]) => handle.anywhere)?.[0] ?? null;
    if (key === null || handleElements.get(key).handle.fixed) return null;
    handleElements.get(key).element.focus({ preventScroll: true });
    const taken = { key, end: event.target.dataset.end ?? "both", x: event.clientX };
    if (own === undefined) pull(taken, event);
    return taken;
  }

  function pull({ key, end, x }, event) {
    const handle = handleElements.get(key)?.handle;
    if (!handle) return;
    if ("to" in handle) return void moved(key, { end, by: toX.back(event.clientX) - toX.back(x) });
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
    const sign = ("to" in handle ? ENDS : SIGNS)[event.key];
    const times = event.shiftKey ? 10 : 1;
    if (handle.fixed) return;
    if ("to" in handle || handle.along === "both") {
      if (!sign) return;
      if ("to" in handle) moved(key, { keys: sign.map((one) => one * times) });
      else moveTo(handle, handle.at.map((one, i) => one + sign[i] * handle.step[i] * times));
    } else if (event.key === "Home") moveTo(handle, handle.low);
    else if (event.key === "End") moveTo(handle, handle.high);
    else if (sign) moveTo(handle, (handle.from?.() ?? handle.at[handle.along === "x" ? 0 : 1]) + (sign[0] + sign[1]) * handle.step * (handle.keys ?? 10) * times);
    else return;
    event.preventDefault();
  }

  return { show };
}

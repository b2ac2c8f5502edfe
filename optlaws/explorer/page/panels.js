// Curves in panels one below the other over one variable, with red zones beyond what is allowed.
//
// An answer has {across, range, ticks, panels, segments}: the name of the variable, its range (a turn unless given), its
// ticks, and a panel for each quantity: {name, unit, at, values, series, limits, peaks, beyond}. `values` is one curve over
// `at`; `series` are several, each {at, values, name, law}, `law` being the number of its colour.

import { frame, scale, ticks } from "./axes.js";
import { html, path, svg } from "./svg.js";

const BOX = { left: 64, right: 14, top: 20, bottom: 6 };
const FOOT = 34;
const LETTER = 17;
/** The least and the greatest value of a limit; null is none, and a value alone is that of both sides. */
const edges = ({ value, least = -value }) => [least ?? -Infinity, value ?? Infinity];
const TURN = [0, 45, 90, 135, 180, 225, 270, 315, 360];
const NEAR = 1.6; // limits farther out than this many peaks are out of sight

export class Panels {
  #root;
  #shown = null;

  constructor(root) {
    this.#root = root;
    new ResizeObserver(() => this.#draw()).observe(root);
  }

  show(answer) {
    this.#shown = answer;
    this.#draw();
  }

  #draw() {
    const width = this.#root.clientWidth - 16;
    if (!this.#shown || width < 100) return;
    if (this.#shown.refused) {
      const { word } = this.#shown.refused;
      this.#root.replaceChildren(html("div", { class: "nothing" }, html("strong", { text: word }), html("span", { text: "there is nothing to draw" })));
      return;
    }
    const { panels } = this.#shown;
    const height = Math.max(96, Math.floor((this.#root.clientHeight - 16 - FOOT) / panels.length));
    this.#root.replaceChildren(...panels.map((panel, i) => this.#panel(panel, i, width, height, i === panels.length - 1)));
  }

  #panel(panel, number, width, height, last) {
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    const series = panel.series ?? [{ at: panel.at, values: panel.values, law: 0 }];
    const known = series.flatMap(({ values }) => values.filter((value) => value !== null));
    const most = Math.max(0, ...known.map(Math.abs));
    const limits = (panel.limits ?? []).flatMap((limit) => edges(limit).map(Math.abs)).filter((value) => value <= NEAR * most);
    const reach = limits.length ? Math.max(...limits) : 0;
    const [low, high] = [Math.min(0, ...known, -reach), Math.max(0, ...known, reach)];
    const room = ((high - low || 1) * LETTER) / (box.bottom - box.top - 2 * LETTER);
    const { range = [0, 360], ticks: xs = this.#shown.range ? ticks(...range, 8) : TURN } = this.#shown;
    const x = scale(range, [box.left, box.right]);
    const y = scale([low < 0 ? low - room : low, high + room], [box.bottom, box.top]);
    const drawing = svg("svg", { class: "curve", width, height: height + (last ? FOOT : 0), role: "img", "aria-label": told(panel, this.#shown.across) });
    drawing.append(frame(box, x, y, { xs, ys: ticks(low, high, 4), xlabels: last, xname: last ? this.#shown.across : "" }));
    drawing.append(svg("text", { class: "title", x: box.left, y: 13, text: titled(panel) }));
    const drawn = series.map(({ at, values, law = 0, name }) => ({ law, name, d: path(at.map((one, i) => (values[i] === null ? null : [x(one), y(values[i])]))) }));
    const zones = this.#zones(panel, x, y, box);
    const name = `beyond-${this.#root.id}-${number}`;
    const clip = svg("clipPath", { id: name }, ...zones.map((zone) => zone.cloneNode()));
    drawing.append(clip, ...zones, ...this.#joints(x, box, number === 0));
    for (const { law, d, name: title } of drawn.toReversed()) drawing.append(svg("path", { class: `line law-${law}${law === 0 ? " active" : ""}`, d }, title ? svg("title", { text: title }) : null));
    if (zones.length && (panel.beyond ?? this.#shown.segments?.some(({ peaks }) => peaks?.[number - 1]?.beyond))) drawing.append(svg("path", { class: "beyond", d: drawn[0].d, "clip-path": `url(#${name})` }));
    for (const peak of panel.peaks ?? []) drawing.append(peakOf(peak, x, y, box));
    return drawing;
  }

  /** Where the motion must not go: above and below the limits of each segment. */
  #zones(panel, x, y, box) {
    const zone = ({ from, to }, top, bottom) => svg("rect", { class: "zone", x: x(from), width: x(to) - x(from), y: top, height: Math.max(0, bottom - top) });
    return (panel.limits ?? []).flatMap((limit) => {
      const [least, value] = edges(limit);
      const [above, below] = [Math.max(box.top, y(value)), Math.min(box.bottom, y(least))];
      const found = above > box.top ? [zone(limit, box.top, above)] : [];
      return below < box.bottom ? [...found, zone(limit, below, box.bottom)] : found;
    });
  }

  #joints(x, box, named) {
    return (this.#shown.segments ?? []).flatMap(({ name, at }) => {
      const marks = x(at[0]) > box.left ? [svg("line", { class: "cursor", x1: x(at[0]), x2: x(at[0]), y1: box.top, y2: box.bottom })] : [];
      if (named && x(at[1]) - x(at[0]) > 7 * name.length) marks.push(svg("text", { class: "segment", x: (x(at[0]) + x(at[1])) / 2, y: 13, "text-anchor": "middle", text: name }));
      return marks;
    });
  }
}

function peakOf(peak, x, y, box) {
  const at = [x(peak.at), y(peak.value)];
  const anchor = at[0] > box.right - 60 ? "end" : at[0] < box.left + 60 ? "start" : "middle";
  return svg(
    "g",
    { class: "peak law-0" },
    svg("circle", { cx: at[0].toFixed(1), cy: at[1].toFixed(1), r: 3 }),
    svg("text", { x: at[0].toFixed(1), y: (at[1] + (peak.value > 0 ? -7 : 16)).toFixed(1), "text-anchor": anchor, text: peak.text }),
  );
}

const titled = ({ name, unit }) => (unit ? `${name}, ${unit}` : name);

/** A picture in words: what it shows, and its peaks with their places. */
function told(panel, across) {
  const peaks = (panel.peaks ?? []).map((peak) => `${peak.text} at ${peak.at}`);
  return `${titled(panel)} over ${across}${peaks.length ? `: ${peaks.join(", ")}` : ""}`;
}

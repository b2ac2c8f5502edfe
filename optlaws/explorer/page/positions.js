// The plane of two positions: the path, what is forbidden to it, where it is nearest, and where it is now.

import { frame, scale, ticks } from "./axes.js";
import { html, path, renew, sized, svg } from "./svg.js";
import { valueAt } from "./timing.js";
import { headed, number, shownUnit, written } from "./units.js";

const BOX = { left: 66, right: 16, top: 12, bottom: 40 };

export class Positions {
  #root;
  #size;
  #svg = svg("svg", { class: "curve plane positions", role: "group" });
  #shown = null;
  #plane = null;
  #nearest = [];
  #moved;
  #place = null;
  #angle = null;
  #drag = null;
  #mark = svg("circle", { class: "point law-1", r: 5 });

  /** `moved(rule, corner, [x, y])` is told where a corner of a region goes, in the units of the picture; null is that it rests. */
  constructor(root, moved) {
    this.#root = root;
    this.#moved = moved;
    this.#svg.addEventListener("pointermove", (event) => this.#drag && this.#pull(event));
    for (const kind of ["pointerup", "pointercancel"]) this.#svg.addEventListener(kind, () => this.#release());
    this.#size = sized(root, () => this.#draw());
  }

  /** The plane of that number of an answer, and the least clearances by their interlocks, where they are known. */
  show(answer, number, nearest = []) {
    this.#shown = answer;
    this.#plane = answer.planes?.[number] ?? answer.planes?.[0] ?? null;
    this.#nearest = nearest;
    this.#draw();
  }

  turn(angle) {
    this.#angle = angle;
    this.#mark.setAttribute("visibility", angle === null ? "hidden" : "visible");
    if (!this.#place || angle === null) return;
    const [cx, cy] = this.#place(angle);
    this.#mark.setAttribute("cx", cx.toFixed(1));
    this.#mark.setAttribute("cy", cy.toFixed(1));
  }

  #draw() {
    const [width, height] = this.#size();
    if (!this.#shown || width < 100 || height < 100) return;
    this.#place = null;
    if (!this.#plane) {
      const text = this.#shown.refused ? "there is nothing to draw" : "an interlock of two positions has its plane here";
      this.#root.replaceChildren(html("p", { class: "quiet", text }));
      return;
    }
    const { axes, units, ranges, regions } = this.#plane;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    const [x, y] = [scale(ranges[0], [box.left, box.right]), scale(ranges[1], [box.bottom, box.top])];
    // in the units of the reader
    const shown = units.map(shownUnit);
    const read = ranges.map((range, i) => range.map((value) => value * shown[i].factor));
    const [across, up] = axes.map((name) => this.#shown.rows.find((row) => row.name === name).values);
    this.#place = (angle) => [x(valueAt(this.#shown.at, across, angle)), y(valueAt(this.#shown.at, up, angle))];
    this.#svg.setAttribute("width", width);
    this.#svg.setAttribute("height", height);
    this.#svg.setAttribute("aria-label", this.#words());
    renew(
      this.#svg,
      frame(box, scale(read[0], [box.left, box.right]), scale(read[1], [box.bottom, box.top]), { xs: ticks(...read[0], 6), ys: ticks(...read[1], 5), xname: headed(axes[0], units[0]), yname: headed(axes[1], units[1]) }),
      ...regions.map((region) => this.#region(region, x, y)),
      svg("path", { class: "line law-0 active", d: path(across.map((value, i) => [x(value), y(up[i])])) }),
      ...regions.filter(({ free }) => free).flatMap((region) => region.corners.map((corner, i) => this.#corner(region, i, corner, x, y))),
      ...regions.map(({ rule }) => this.#near(rule, regions, box, x, y)),
      this.#mark,
    );
    if (this.#svg.parentNode !== this.#root) this.#root.replaceChildren(this.#svg);
    this.turn(this.#angle);
  }

  #words() {
    const { axes, regions } = this.#plane;
    const told = regions.map(({ rule, name }) => (this.#nearest[rule] ? `${name}: ${this.#nearest[rule].status}, ${written(this.#nearest[rule].value)} at ${number(this.#nearest[rule].at)} degrees` : name));
    return `The path in the plane of ${axes.join(" and ")}. ${told.join("; ")}`;
  }

  #region({ name, corners, wall }, x, y) {
    const title = svg("title", { text: name });
    const d = path((corners ?? wall).map(([across, up]) => [x(across), y(up)]));
    return corners ? svg("path", { class: "zone", d: `${d}Z` }, title) : svg("path", { class: "wall", d }, title);
  }

  /** Where the path is nearest: a mark with the clearance, and a line to the region. */
  #near(rule, regions, box, x, y) {
    const least = this.#nearest[rule];
    if (!least) return null;
    const at = this.#place(least.at);
    const { corners, free } = regions.find((one) => one.rule === rule);
    const text = `${least.name}: ${written(least.value)}`;
    const end = at[0] > (box.left + box.right) / 2;
    const line = free && least.status !== "broken" ? svg("path", { class: "shaft-of-arrow", d: path([at, nearest(corners.map(([across, up]) => [x(across), y(up)]), at)]) }) : null;
    return svg("g", { class: `interlock ${least.status}` }, line, svg("circle", { cx: at[0], cy: at[1], r: 4.5 }), svg("text", { class: "tip", x: at[0] + (end ? -9 : 9), y: at[1] - 8 < box.top + 12 ? at[1] + 18 : at[1] - 8, "text-anchor": end ? "end" : "start", text }));
  }

  #corner({ rule, name, turned }, i, [across, up], x, y) {
    const own = { rule, corner: i, turned, x, y, at: [across, up] };
    return svg("circle", {
      class: "corner", cx: x(across), cy: y(up), r: 6, tabindex: 0, role: "slider", "data-key": `corner ${rule} ${i}`,
      "aria-label": `${name}: corner ${i + 1}`, "aria-valuenow": across, "aria-valuetext": `${across}, ${up}`,
      onpointerdown: (event) => this.#grasp(event, own), onkeydown: (event) => this.#key(event, own),
    }, svg("title", { text: `${name}: corner ${i + 1} at ${across}, ${up}. Drag it, or move it by the arrow keys` }));
  }

  #grasp(event, own) {
    if (event.button !== 0) return;
    event.preventDefault();
    this.#svg.setPointerCapture(event.pointerId);
    event.currentTarget.focus({ preventScroll: true });
    this.#drag = own;
    this.#moved(own.rule, own.corner, null);
  }

  #pull(event) {
    const { left, top } = this.#svg.getBoundingClientRect();
    this.#to(this.#drag, [this.#drag.x.back(event.clientX - left), this.#drag.y.back(event.clientY - top)]);
  }

  #to({ rule, corner, turned }, place) {
    const steps = this.#plane.ranges.map(([low, high]) => 10 ** Math.floor(Math.log10((high - low) / 100)));
    const round = place.map((value, i) => Number((Math.round(value / steps[i]) * steps[i]).toPrecision(9)));
    this.#moved(rule, corner, turned ? round.toReversed() : round);
  }

  #release() {
    if (this.#drag) this.#moved(this.#drag.rule, this.#drag.corner, null);
    this.#drag = null;
  }

  #key(event, own) {
    const step = this.#plane.ranges.map(([low, high]) => 10 ** Math.floor(Math.log10((high - low) / 100)) * (event.shiftKey ? 10 : 1));
    const by = { ArrowLeft: [-step[0], 0], ArrowRight: [step[0], 0], ArrowDown: [0, -step[1]], ArrowUp: [0, step[1]] }[event.key];
    if (!by) return;
    event.preventDefault();
    this.#to(own, own.at.map((value, i) => value + by[i]));
  }
}

/** The place on the edge of a polygon that is nearest to a point, for the line that is drawn there. */
function nearest(corners, [px, py]) {
  const places = corners.map(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    const square = (bx - ax) ** 2 + (by - ay) ** 2 || 1;
    const share = Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / square));
    return [ax + share * (bx - ax), ay + share * (by - ay)];
  });
  return places.toSorted((one, other) => Math.hypot(one[0] - px, one[1] - py) - Math.hypot(other[0] - px, other[1] - py))[0];
}

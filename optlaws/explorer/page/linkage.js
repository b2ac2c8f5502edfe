// A mechanism to scale, at a time of its cycle: links with their joints and paths, a cam, or a drum with what it drives.

import { ticks } from "./axes.js";
import { Mechanism } from "./mechanism.js";
import { html, path, sized, svg } from "./svg.js";
import { number, written } from "./units.js";

const ROOM = 26;
const SCALE = 90; // pixels that the bar of the scale is at most long

export class Linkage {
  #root;
  #size;
  #plain = html("div", { class: "fill" });
  #turning = html("div", { class: "fill cam-drawing" });
  #cam = new Mechanism(this.#turning);
  #shown = null;
  #share = 0;
  #place = null;
  #moving = svg("g");

  constructor(root) {
    this.#root = root;
    root.append(this.#plain, this.#turning);
    this.#size = sized(root, () => this.#draw());
  }

  /** What is drawn, or null. */
  show(drawing) {
    this.#shown = drawing;
    this.#plain.hidden = drawing?.kind === "cam";
    this.#turning.hidden = drawing?.kind !== "cam";
    if (drawing?.kind === "cam") this.#cam.show(drawing);
    this.#draw();
  }

  /** Show a share of the cycle, from 0 to 1. */
  at(share) {
    this.#share = share;
    if (!this.#shown) return;
    if (this.#shown.kind === "cam") this.#cam.turn(((this.#of("input") % 360) + 360) % 360);
    else this.#parts();
  }

  /** A value of now: steps are even in time. */
  #of(name) {
    const values = this.#shown[name];
    const place = this.#share * (values.length - 1);
    const [low, high] = [Math.floor(place), Math.min(values.length - 1, Math.floor(place) + 1)];
    return values[low] + (place - low) * (values[high] - values[low]);
  }

  #draw() {
    const [width, height] = this.#size();
    if (!this.#shown) return this.#plain.replaceChildren();
    if (this.#shown.kind === "cam" || width < 100 || height < 80) return this.at(this.#share);
    const { kind, paths = [] } = this.#shown;
    const [[left, right], [low, high]] = this.#ends();
    const factor = Math.min((width - 2 * ROOM) / (right - left || 1), (height - 2 * ROOM) / (high - low || 1));
    const [x0, y0] = [width / 2 - (factor * (left + right)) / 2, height / 2 + (factor * (low + high)) / 2];
    this.#place = ([x, y]) => [x0 + factor * x, y0 - factor * y];
    this.#place.factor = factor;
    const traced = paths.map((line) => svg("path", { class: "joint-path", d: path(line.map(this.#place)) }));
    const bar = kind === "table" || kind === "screw" ? [] : this.#bar(factor, width, height);
    const drawing = svg("svg", { width, height, class: "linkage", role: "img", "aria-label": this.#told() }, ...traced, this.#moving, ...bar);
    this.#plain.replaceChildren(drawing);
    return this.#parts();
  }

  #told() {
    const { name, ends, axis, kind } = this.#shown;
    const scale = kind === "table" || kind === "screw" ? "as a sketch" : "to scale";
    const unit = axis === "angle" ? "deg" : "mm";
    return `The ${name}, drawn ${scale}; its input goes from ${number(ends[0], unit)} to ${written({ value: ends[1], unit, digits: 6 })}`;
  }

  /** The least and greatest x and y of all that moves, in mm; the size of a table is of no meaning. */
  #ends() {
    const { kind, chains = [], paths = [], size = 1, slide } = this.#shown;
    if (kind === "table") return [[-1.1, 1.1], [-1.1, 1.1]];
    if (kind === "links") {
      const all = [...paths.flat(), ...chains.flat(2)];
      const of = (i) => [Math.min(...all.map((one) => one[i])), Math.max(...all.map((one) => one[i]))];
      return [of(0), of(1)];
    }
    const radius = kind === "screw" ? Math.max(...slide.map(Math.abs), size) / 12 : size;
    return [[Math.min(...slide, 0) - 2 * radius, Math.max(...slide, 0) + 2 * radius], [-1.8 * radius, 2 * radius]];
  }

  #bar(factor, width, height) {
    const length = ticks(0, SCALE / factor, 2).at(-1);
    const [x, y] = [width - 14, height - 12];
    return [svg("path", { class: "scale-bar", d: `M${x - factor * length} ${y - 4}v4H${x}v-4` }), svg("text", { x: x - factor * length - 6, y: y + 1, "text-anchor": "end", text: written({ value: length, unit: "mm", digits: 4 }) })];
  }

  #parts() {
    if (!this.#place) return;
    const { kind } = this.#shown;
    this.#moving.replaceChildren(...(kind === "links" ? this.#links() : kind === "table" ? this.#table() : this.#slide(kind)));
  }

  #links() {
    const { chains, fixed } = this.#shown;
    const now = (joint) => {
      const place = this.#share * (joint.length - 1);
      const [low, high] = [Math.floor(place), Math.min(joint.length - 1, Math.floor(place) + 1)];
      return this.#place(joint[low].map((one, i) => one + (place - low) * (joint[high][i] - one)));
    };
    const [below, links, above] = [[], [], []];
    chains.forEach((chain, i) => {
      const places = chain.map(now);
      const [x, y] = places[0];
      if (fixed[i]) below.push(svg("path", { class: "ground", d: `M${x} ${y}l-9 13h18ZM${x - 13} ${y + 13}h26` }), svg("circle", { class: "shaft", cx: x, cy: y, r: 4 }));
      else if (chain.length === 1) above.push(svg("rect", { class: "slider", x: x - 9, y: y - 7, width: 18, height: 14, rx: 2 }), svg("circle", { class: "shaft", cx: x, cy: y, r: 3 }));
      else links.push(svg("path", { class: "link", d: path(places) }), ...places.map(([cx, cy]) => svg("circle", { class: "shaft", cx, cy, r: 3.2 })));
    });
    return [...links, ...below, ...above];
  }

  #table() {
    const [x, y] = this.#place([0, 0]);
    const radius = this.#place.factor;
    const angle = this.#shown.axis === "angle" ? (this.#of("input") * Math.PI) / 180 : 0;
    const spoke = (turn, inner) => [inner, 0.98].flatMap((share) => [x + share * radius * Math.cos(angle + turn), y - share * radius * Math.sin(angle + turn)]);
    const line = (name, [x1, y1, x2, y2]) => svg("line", { class: name, x1, y1, x2, y2 });
    const notches = [1, 2, 3, 4, 5, 6, 7].map((i) => line("key", spoke((i * Math.PI) / 4, 0.82)));
    return [svg("circle", { class: "drum", cx: x, cy: y, r: radius }), ...notches, line("arm", spoke(0, 0.5)), svg("circle", { class: "shaft", cx: x, cy: y, r: 0.12 * radius })];
  }

  /** A pinion with its rack, a pulley with its belt, a screw with its nut. */
  #slide(kind) {
    const { size, slide } = this.#shown;
    const radius = kind === "screw" ? Math.max(...slide.map(Math.abs), size) / 12 : size;
    const [low, high] = [Math.min(...slide, 0) - radius, Math.max(...slide, 0) + radius];
    const way = this.#of("slide");
    const turned = -(this.#of("input") * Math.PI) / 180;
    const line = (name, one, other) => {
      const [[x1, y1], [x2, y2]] = [this.#place(one), this.#place(other)];
      return svg("line", { class: name, x1, y1, x2, y2 });
    };
    const wheel = ([cx, cy]) => {
      const [x, y] = this.#place([cx, cy]);
      const edge = [cx + radius * Math.cos(turned), cy + radius * Math.sin(turned)];
      return [svg("circle", { class: "drum", cx: x, cy: y, r: this.#place.factor * radius }), line("key", [cx, cy], edge), svg("circle", { class: "shaft", cx: x, cy: y, r: 4 })];
    };
    const block = (x, y) => {
      const [left, top] = this.#place([x, y]);
      const side = Math.max(14, this.#place.factor * radius * 0.8);
      return svg("rect", { class: "slider", x: left - side / 2, y: top - side / 2, width: side, height: side, rx: 2 });
    };
    if (kind === "rack") return [...wheel([0, 0]), line("link", [low + way, radius], [high + way, radius]), block(way, 1.4 * radius)];
    if (kind === "belt") return [line("belt", [low, radius], [high, radius]), line("belt", [low, -radius], [high, -radius]), ...wheel([low, 0]), ...wheel([high, 0]), block(way, 1.4 * radius)];
    const pitch = (high - low) / 40;
    const phase = (((way % pitch) + pitch) % pitch) - pitch;
    const threads = [...Array(42).keys()].map((i) => low + phase + i * pitch).filter((x) => x > low && x + 0.6 * pitch < high).map((x) => line("key", [x, -0.5 * radius], [x + 0.6 * pitch, 0.5 * radius]));
    return [line("link", [low, 0.5 * radius], [high, 0.5 * radius]), line("link", [low, -0.5 * radius], [high, -0.5 * radius]), ...threads, block(way, 0)];
  }
}

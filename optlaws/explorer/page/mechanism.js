// The cam and its follower as they turn: profile, pitch curve, cutter path, roller or face, arm or slide; with their
// dimensions, and the force at the contact where it is known.

import { label } from "./axes.js";
import { path, sized, svg } from "./svg.js";
import { valueAt } from "./timing.js";
import { written } from "./units.js";

const ROOM = 1.12;
const LETTER = 6.4; // pixels of a letter
const CIRCLES = { "prime circle": -50, "base circle": -130 }; // where each is named, degrees
const LONGEST = 0.4; // of the cam's size, the arrow of the greatest force
const LINE = 14;
const sizeOf = (value) => written({ value, unit: "mm", digits: 6 });

export class Mechanism {
  #root;
  #size;
  #shown = null;
  #angle = 0;
  #cam = null;
  #follower = null;
  #drawing = null;
  #written = svg("g", { class: "dimensions", "aria-hidden": "true" });
  #force = null;
  #place = null;
  measured = true;

  constructor(root) {
    this.#root = root;
    this.#size = sized(root, () => this.#draw());
  }

  show(answer) {
    this.#shown = answer.refused ? null : { ...answer, frames: framesOf(answer) };
    this.#force = null;
    this.#draw();
  }

  /** The force at the contact over the turn: the curve of its values. */
  bear(force) {
    this.#force = force;
    this.turn(this.#angle);
  }

  /** With or without dimensions. */
  measure(measured) {
    this.measured = measured;
    this.#draw();
  }

  /** Turn the cam to an angle in degrees. */
  turn(angle) {
    this.#angle = angle;
    if (!this.#shown || !this.#cam) return;
    this.#cam.setAttribute("transform", `rotate(${this.#shown.turning * angle})`);
    this.#follower.replaceChildren(...this.#parts());
    this.#written.replaceChildren(...this.#dimensions(), ...this.#arrow());
    const sizes = this.#shown.dimensions.map(({ name, value }) => `${name} ${sizeOf(value)}`);
    const force = this.#forceHere;
    this.#drawing.setAttribute("aria-label", `The cam and its follower at ${written({ value: Math.round(angle), unit: "deg", digits: 6 })}: ${[...sizes, ...(force === null ? [] : [`contact force ${label(force)} N`])].join(", ")}`);
  }

  get #step() {
    return Math.round(this.#angle) % (this.#shown.frames.centre.length - 1);
  }

  get #forceHere() {
    return this.#force && valueAt(this.#force.at, this.#force.values, this.#step);
  }

  /** Circles with their radii, and the other sizes in a corner. */
  #dimensions() {
    if (!this.measured) return [];
    const { dimensions } = this.#shown;
    const [x, y] = this.#place([0, 0]);
    const [width] = this.#size();
    const circles = dimensions.filter(({ name }) => name in CIRCLES).flatMap(({ name, value }) => {
      const way = (CIRCLES[name] * Math.PI) / 180;
      const at = this.#place([value * Math.cos(way), value * Math.sin(way)]);
      const end = at[0] > x ? "start" : "end";
      const said = `${name} R ${sizeOf(value)}`;
      const room = LETTER * said.length; // its text stays in the picture
      const far = [at[0] + (end === "start" ? 22 : -22), at[1] + 26];
      return [
        svg("circle", { class: "dimension", cx: x, cy: y, r: Math.hypot(at[0] - x, at[1] - y) }),
        svg("path", { class: "dimension leader", d: path([[x, y], at, far]) }),
        svg("text", { x: end === "start" ? Math.min(far[0] + 4, width - room) : Math.max(far[0] - 4, room), y: far[1] + 4, "text-anchor": end, text: said }),
      ];
    });
    const others = dimensions.filter(({ name }) => !(name in CIRCLES)).map(({ name, value }, i) => svg("text", { x: 4, y: 14 + LINE * i, text: `${name} ${sizeOf(value)}` }));
    return [...circles, ...others];
  }

  /** The force of the cam on the follower, along the normal at the contact. */
  #arrow() {
    const force = this.#forceHere;
    if (force === null) return [];
    const { frames, follower, curves } = this.#shown;
    const most = Math.max(...this.#force.values.map((value) => Math.abs(value ?? 0)));
    const size = Math.max(...curves.profile.map(([x, y]) => Math.hypot(x, y)));
    const [contact, [ex, ey], centre] = [frames.contact[this.#step], frames.edge[this.#step], frames.centre[this.#step]];
    const outward = follower.roller === null ? contact : [centre[0] - contact[0], centre[1] - contact[1]];
    const sign = Math.sign(-ey * outward[0] + ex * outward[1]) || 1;
    const length = (LONGEST * size * force) / (most || 1);
    const [from, to] = [contact, [contact[0] - sign * ey * length, contact[1] + sign * ex * length]].map((one) => this.#place(one));
    const way = Math.atan2(to[1] - from[1], to[0] - from[0]);
    const barb = (turn) => [to[0] - 9 * Math.cos(way + turn), to[1] - 9 * Math.sin(way + turn)];
    return [svg("path", { class: "force", d: path([from, to, null, barb(0.4), to, barb(-0.4)]) }), svg("text", { class: "force-value", x: to[0] + 8, y: to[1], text: `${label(Number(force.toPrecision(4)))} N` })];
  }

  #draw() {
    const [width, height] = this.#size();
    if (!this.#shown || width < 100 || height < 100) {
      this.#root.replaceChildren();
      this.#cam = null;
      return;
    }
    const { curves, frames, follower } = this.#shown;
    const reach = ROOM * Math.max(...Object.values(curves).flat().map(([x, y]) => Math.hypot(x, y)), follower.pivot ?? 0);
    const top = Math.max(...frames.centre.map(([, y]) => y)) + 0.45 * reach;
    const [low, high] = [-reach, follower.pivot === null ? Math.max(reach, top) : reach];
    const scale = Math.min(width / (2 * reach), height / (high - low));
    this.#cam = svg("g", {}, ...Object.entries(curves).map(([name, points]) => svg("path", { class: `cam-${name}`, d: `${path(points, 4)}Z` })), svg("circle", { class: "shaft", r: 0.06 * reach }), svg("line", { class: "key", x1: 0, y1: 0, x2: 0.06 * reach, y2: 0 }));
    this.#follower = svg("g", { class: "follower" });
    const [middle, ground] = [width / 2, (height + scale * (high + low)) / 2];
    this.#place = ([x, y]) => [middle + scale * x, ground - scale * y];
    // y upward, as in drawings of machines
    const world = svg("g", { transform: `translate(${middle} ${ground}) scale(${scale} ${-scale})` }, this.#cam, this.#follower);
    this.#drawing = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" }, world, this.#written);
    this.#root.replaceChildren(this.#drawing);
    this.turn(this.#angle);
  }

  #parts() {
    const { frames, follower, curves } = this.#shown;
    const at = this.#step;
    const [centre, contact, edge] = [frames.centre[at], frames.contact[at], frames.edge[at]];
    const size = Math.max(...curves.profile.map(([x, y]) => Math.hypot(x, y)));
    const line = (name, [x1, y1], [x2, y2]) => svg("line", { class: name, x1, y1, x2, y2 });
    const along = (length) => [contact[0] + length * edge[0], contact[1] + length * edge[1]];
    const parts = [];
    const foot = follower.roller === null ? contact : centre;
    if (follower.pivot !== null) {
      const pivot = [follower.pivot, 0];
      parts.push(follower.roller === null ? svg("line", { class: "face", x1: along(-size)[0], y1: along(-size)[1], x2: along(size)[0], y2: along(size)[1] }) : line("arm", pivot, centre), svg("circle", { class: "shaft", cx: pivot[0], cy: 0, r: 0.05 * size }));
    } else if (follower.roller === null) {
      parts.push(line("face", along(-0.6 * size), along(0.6 * size)), line("arm", [0, contact[1]], [0, contact[1] + 0.7 * size]));
    } else parts.push(line("arm", foot, [foot[0], foot[1] + 0.7 * size]));
    if (follower.roller !== null) parts.push(svg("circle", { class: "roller", cx: centre[0], cy: centre[1], r: follower.roller }), svg("circle", { class: "shaft", cx: centre[0], cy: centre[1], r: 0.2 * follower.roller }));
    parts.push(svg("circle", { class: "contact", cx: contact[0], cy: contact[1], r: 0.018 * size }));
    return parts;
  }
}

/** The follower at each angle of the cam: its roller's centre, its point of contact, the direction of its face. */
function framesOf({ curves, tangents, turning }) {
  const turned = (points) => points.map(([x, y], i) => {
    const angle = (turning * 2 * Math.PI * i) / (points.length - 1);
    return [Math.cos(angle) * x - Math.sin(angle) * y, Math.sin(angle) * x + Math.cos(angle) * y];
  });
  return { centre: turned(curves.pitch), contact: turned(curves.profile), edge: turned(tangents) };
}

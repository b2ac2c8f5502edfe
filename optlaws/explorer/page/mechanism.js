// The cam and its follower as they turn: profile, pitch curve, cutter path, roller or face, arm or slide.

import { path, svg } from "./svg.js";

const ROOM = 1.12;

export class Mechanism {
  #root;
  #shown = null;
  #angle = 0;
  #cam = null;
  #follower = null;

  constructor(root) {
    this.#root = root;
    new ResizeObserver(() => this.#draw()).observe(root);
  }

  show(answer) {
    this.#shown = answer.refused ? null : answer;
    this.#draw();
  }

  /** Turn the cam to an angle in degrees. */
  turn(angle) {
    this.#angle = angle;
    if (!this.#shown || !this.#cam) return;
    this.#cam.setAttribute("transform", `rotate(${this.#shown.turning * angle})`);
    this.#follower.replaceChildren(...this.#parts());
  }

  #draw() {
    const [width, height] = [this.#root.clientWidth, this.#root.clientHeight];
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
    // y upward, as in drawings of machines
    const world = svg("g", { transform: `translate(${width / 2} ${(height + scale * (high + low)) / 2}) scale(${scale} ${-scale})` }, this.#cam, this.#follower);
    this.#root.replaceChildren(svg("svg", { width, height, role: "img", "aria-label": "The cam and its follower" }, world));
    this.turn(this.#angle);
  }

  #parts() {
    const { frames, follower, curves } = this.#shown;
    const at = Math.round(this.#angle) % (frames.centre.length - 1);
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

// What laws leave in an elastic follower: residual acceleration over its frequency.

import { frame, scale, ticks } from "./axes.js";
import { path, svg } from "./svg.js";

const BOX = { left: 58, right: 16, top: 12, bottom: 44 };

export class Residual {
  #root;
  #shown = null;
  #active = 0;

  constructor(root) {
    this.#root = root;
    new ResizeObserver(() => this.#draw()).observe(root);
  }

  show(answer, active) {
    this.#shown = answer;
    this.#active = active;
    this.#draw();
  }

  #draw() {
    const [width, height] = [this.#root.clientWidth, this.#root.clientHeight];
    if (!this.#shown || width < 120 || height < 120) return;
    const { frequencies, laws, at } = this.#shown;
    const box = { left: BOX.left, right: width - BOX.right, top: BOX.top, bottom: height - BOX.bottom };
    const most = 1.05 * Math.max(1, ...laws.flatMap((law) => law?.values ?? []));
    const x = scale([0, frequencies.at(-1)], [box.left, box.right]);
    const y = scale([0, most], [box.bottom, box.top]);
    const drawing = svg("svg", { class: "plane", width, height, role: "img", "aria-label": this.#told() });
    drawing.append(frame(box, x, y, { xs: ticks(0, frequencies.at(-1), 8), ys: ticks(0, most, 6), xname: "frequency ν of the follower, radians of its vibration in the motion", yname: "residual acceleration (envelope), in units of a″" }));
    laws.forEach((law, i) => {
      if (!law) return;
      const places = law.values.map((value, n) => (value === null ? null : [x(frequencies[n]), y(value)]));
      drawing.append(svg("path", { class: `line law-${i}${i === this.#active ? " active" : ""}`, d: path(places) }));
    });
    drawing.append(svg("line", { class: "cursor", x1: x(at), x2: x(at), y1: box.top, y2: box.bottom }));
    laws.forEach((law, i) => law && drawing.append(svg("circle", { class: `point law-${i}`, cx: x(at), cy: y(law.value), r: 4 })));
    this.#root.replaceChildren(drawing);
  }

  #told() {
    const { laws, at } = this.#shown;
    return `Residual acceleration over the frequency; at ν = ${at}: ${laws.map((law) => law?.text ?? "no law").join(", ")}`;
  }
}

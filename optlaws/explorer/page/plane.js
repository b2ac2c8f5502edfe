// The plane of two constants: front, limit, standard laws, Savin's families, and the laws of the study; one is dragged.

import { Chart } from "./chart.js";

const STEPS = { B: 0.001, C: 0.01, D: 0.01, J: 0.1 };
const WRITTEN = 165; // pixels that the name of the limit takes
const EDGE = 0.04; // of a range: a name further out would be cut

export const NAMES = { B: "peak velocity", C: "peak acceleration", D: "peak power", J: "peak jerk", rms_c: "rms acceleration" };

const valueOf = (view, name) => view?.constants?.find((one) => one.name === name);

export class Plane {
  #chart;
  #asked;
  #front = null;
  #ground = null;
  #laws = [];
  #active = 0;

  /** `asked(x)` is what the active law is asked now: an answer may be on its way. */
  constructor(root, asked, moved, picked) {
    this.#asked = asked;
    this.#chart = new Chart(root, (_, value) => moved(value, this.#front.x, this.#front.y), picked);
  }

  showFront({ series = [], ...front }) {
    const curve = (name) => series.filter((one) => one.name === name).flatMap(({ at, values }) => at.map((x, i) => [x, values[i]]).filter(([, y]) => y !== null));
    this.#front = front;
    this.#ground = groundOf(front, curve("front"), curve("best possible"));
    this.#draw();
  }

  /** `laws` are {asked, view}; `asked` is the value of x that the active one is asked to have, or null. */
  showLaws(laws, active) {
    this.#laws = laws;
    this.#active = active;
    this.#draw();
  }

  #draw() {
    if (!this.#front) return;
    const places = this.#laws.map(({ view }) => [this.#front.x, this.#front.y].map((name) => valueOf(view, name)?.value ?? null));
    const points = places.map((at, i) => ({ at, name: `point law-${i}`, r: 5 })).filter(({ at }, i) => i !== this.#active && !at.includes(null));
    this.#chart.show({ ...this.#ground, of: this.#ground, points, handles: this.#handles(places[this.#active]) });
  }

  #handles(place) {
    const law = this.#laws[this.#active];
    const none = Boolean(law?.view?.refused);
    const { x, y, ranges: [[low, high], [bottom]] } = this.#front;
    const at = none && typeof law.asked === "number" ? [law.asked, bottom] : place;
    if (!at || at.includes(null)) return [];
    const text = none ? "no such law" : [x, y].map((name) => `${name} = ${valueOf(law.view, name).text}`).join(", ");
    // a bound is rounded up: the law that has the value keeps it
    return [{
      key: "law", at, along: "x", low, high, step: STEPS[x], up: x !== "B", from: () => this.#asked(x), anywhere: true, fixed: !law.movable,
      label: `The law in the plane: ${x}`, text, name: `law-${this.#active}${none ? " none" : ""}`,
    }];
  }
}

/** What of the plane does not change with the laws of the study. */
function groundOf({ x, y, ranges, proven, families, known }, front, best) {
  const inside = (edge) => (at) => at.every((value, i) => value >= ranges[i][0] && value <= ranges[i][1] - edge * (ranges[i][1] - ranges[i][0]));
  const named = families.map(({ name, line }) => ({ at: line.findLast(inside(EDGE)), text: name, name: "family-name", up: -4 })).filter(({ at }) => at);
  const shown = best.filter(inside(0));
  // no smooth law lies below and before the best possible: there is room
  const place = shown[Math.floor(shown.length * 0.22)];
  return {
    x: { name: `${NAMES[x]} ${x}`, range: ranges[0] },
    y: { name: `${NAMES[y]} ${y}`, range: ranges[1] },
    lines: [{ points: best, name: "limit" }, ...families.map(({ line }) => ({ points: line, name: "family" })), { points: front, name: proven ? "front" : "front local" }],
    // what is not proven is no curve but the laws that were found
    marks: proven ? [] : front.map((at) => ({ at, name: "front-point", r: 2.2 })),
    labels: [...named, ...(place ? [{ at: place, text: "best possible with any law of this order", name: "limit-name", anchor: "end", up: -14, room: WRITTEN }] : [])],
    picks: known.map(({ name, at, text, named: written }) => ({ key: name, at, text, named: written })),
    told: `${NAMES[y]} over ${NAMES[x]}: the front, standard laws, and the laws of the study`,
  };
}

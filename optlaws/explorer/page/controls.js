// What is asked of the active law: objective, peak velocity, order, degree, bounds.

import { CONSTANTS, bound, minimise, setBound, setVelocity, velocity, weights } from "./asked.js";
import { group, slider } from "./fields.js";
import { html } from "./svg.js";

const SHOWN = { C: "C", D: "D", J: "J", rms_c: "rms c" };
const WORDS = { C: "peak acceleration", D: "peak power", J: "peak jerk", rms_c: "rms acceleration" };
const LIMITS = { C: [3.5, 15, 0.01], D: [2, 15, 0.01], J: [20, 300, 0.1], rms_c: [3.4, 8, 0.01] };

export class Controls {
  #root;
  #study;
  #fields = {};
  #formula;
  #switches = {};
  #problem;
  #known;
  #value;

  /** `value(name)` is the constant of the law that is shown. */
  constructor(root, study, value) {
    this.#root = root;
    this.#study = study;
    this.#value = value;
    this.#problem = html("div", {}, this.#objective(), this.#shape(), this.#bounds());
    this.#known = this.#standard();
    root.replaceChildren(this.#problem, this.#known);
  }

  show(law) {
    this.#problem.hidden = !law.problem;
    this.#known.hidden = Boolean(law.problem);
    if (!law.problem) return;
    const weighed = weights(law);
    for (const name of CONSTANTS) {
      this.#fields[`weight ${name}`].set(weighed?.[name] ?? 0);
      this.#fields[`bound ${name}`].set(bound(law, name));
    }
    if (document.activeElement !== this.#formula) this.#formula.value = weighed ? "" : law.problem.minimise;
    this.#fields.B.set(velocity(law));
    this.#fields.order.set(law.problem.order ?? 2);
    this.#fields.degree.set(law.problem.degree ?? 9);
    this.#switches.monotone.checked = Boolean(law.problem.monotone);
    this.#switches.symmetric.checked = law.problem.symmetric ?? true;
  }

  #change(what, alter) {
    this.#study.change(what, (state) => alter(state.laws[state.active]));
  }

  #field(key, options, alter) {
    const field = slider({ ...options, changed: (value) => this.#change(key, (law) => alter(law, value)), rested: () => this.#study.rest() });
    this.#fields[key] = field;
    return field.element;
  }

  #objective() {
    const rows = CONSTANTS.map((name) => {
      const row = this.#field(`weight ${name}`, { name: SHOWN[name], title: `Weight of ${WORDS[name]} in the objective`, low: 0, high: 1, step: 0.05, most: 100 }, (law, value) => minimise(law, { ...weights(law), [name]: Math.max(0, value) }));
      const alone = html("button", { type: "button", class: "link", title: `Minimise the ${WORDS[name]} alone`, text: SHOWN[name], onclick: () => this.#change(`alone ${name}`, (law) => minimise(law, { [name]: 1 })) });
      row.firstElementChild.replaceChildren(alone);
      return row;
    });
    this.#formula = html("input", { type: "text", placeholder: "or a formula: max(C/4, D/2.25)", "aria-label": "Objective as a formula", spellcheck: "false", maxlength: 300 });
    this.#formula.addEventListener("change", () => this.#change("formula", (law) => {
      const text = this.#formula.value.trim();
      if (!text) return minimise(law, { C: 1 });
      law.problem.minimise = text;
    }));
    return group("Minimise", html("p", { class: "hint", text: "weights of C/4, D/2.25, J/32, rms c/3.46: each by its least value of all laws" }), ...rows, this.#formula);
  }

  #shape() {
    const B = this.#field("B", { name: "B", title: "Peak velocity B", low: 1.05, high: 2.6, step: 0.001, off: true }, (law, value) => setVelocity(law, value === undefined ? this.#rounded("B") : value));
    const order = this.#field("order", { name: "order l", title: "Order: end conditions at each end", low: 2, high: 8, step: 1, most: 12 }, (law, value) => (law.problem.order = Math.round(value)));
    const degree = this.#field("degree", { name: "degree", title: "Degree of Z", low: 1, high: 25, step: 1, most: 41 }, (law, value) => (law.problem.degree = Math.round(value)));
    return group("Law", B, order, degree, this.#switch("monotone", "no return (b ≥ 0)", false), this.#switch("symmetric", "symmetric", true));
  }

  #switch(name, text, usual) {
    const box = html("input", { type: "checkbox" });
    box.addEventListener("change", () => this.#change(name, (law) => {
      if (box.checked === usual) delete law.problem[name];
      else law.problem[name] = box.checked;
    }));
    this.#switches[name] = box;
    return html("label", { class: "switch" }, box, text);
  }

  #bounds() {
    const rows = CONSTANTS.map((name) => {
      const [low, high, step] = LIMITS[name];
      return this.#field(`bound ${name}`, { name: `${SHOWN[name]} ≤`, title: `Greatest ${WORDS[name]}`, low, high, step, off: true }, (law, value) => setBound(law, name, value === undefined ? this.#rounded(name) : value));
    });
    return group("At most", ...rows);
  }

  /** A bound that the law of now keeps. */
  #rounded(name) {
    const value = this.#value(name) ?? 2;
    return Number((Math.ceil(value * 1000) / 1000).toPrecision(7));
  }

  #standard() {
    const start = (alter) => this.#change("optimal", (law) => {
      const B = this.#value("B");
      for (const name of ["name", "law", "title"]) delete law[name];
      law.problem = { order: 4, degree: 9, B: Number((B ?? 1.7).toPrecision(8)) };
      alter(law);
    });
    return group(
      "A given law",
      html("p", { class: "hint", text: "Nothing is asked of it. Ask for an optimal law in its place:" }),
      html("button", { type: "button", text: "least C at its peak velocity", onclick: () => start(() => {}) }),
      html("button", { type: "button", text: "… with no more jerk", onclick: () => start((law) => this.#value("J") && setBound(law, "J", this.#rounded("J"))) }),
    );
  }
}

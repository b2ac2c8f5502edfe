// What is asked of the active law: objective, peak velocity, order, degree, bounds; and the machine that it is for.

import { bound, minimise, setBound, setVelocity, velocity, weights } from "./asked.js";
import { createForm, slider } from "./form.js";
import { group } from "./layout.js";
import { button, html } from "./svg.js";

/** Each constant: how it is written, its words, and the range of its bound with the step. */
const CONSTANTS = { C: ["C", "peak acceleration", 3.5, 15, 0.01], D: ["D", "peak power", 2, 15, 0.01], J: ["J", "peak jerk", 20, 300, 0.1], rms_c: ["rms c", "rms acceleration", 3.4, 8, 0.01] };
const SIZES = { stroke: "none, or 35 mm", time: "none, or 0.1 s", mass: "none, or 2 kg" };

/** `value(name)` is the constant of the law that is shown. */
export function createControls(root, study, value) {
  const shows = [];
  const problem = html("div", {}, objective(), shape(), bounds());
  const known = standard();
  const sizesForm = createForm((what, alter) => study.change(`machine ${what}`, (state) => {
    alter((state.controller ??= {}));
    if (!Object.keys(state.controller).length) delete state.controller;
  }), () => study.rest());
  const sizes = Object.entries(SIZES).map(([name, placeholder]) => sizesForm.field({ path: [name], label: name, placeholder, isText: true }, `${name} of the machine`));
  root.append(problem, known, group("In machine units", ...sizes));

  function show({ laws, active, controller = {} }) {
    const law = laws[active];
    problem.hidden = !law.problem;
    known.hidden = Boolean(law.problem);
    sizesForm.show(controller);
    if (law.problem) for (const show of shows) show(law);
  }

  function change(what, alter) {
    study.change(what, (state) => alter(state.laws[state.active]));
  }

  function field(key, options, of, alter) {
    const field = slider({ ...options, changed: (value) => change(key, (law) => alter(law, value)), rested: () => study.rest() });
    shows.push((law) => field.set(of(law)));
    return field.element;
  }

  function objective() {
    const rows = Object.entries(CONSTANTS).map(([name, [text, words]]) => {
      const row = field(`weight ${name}`, { name: text, title: `Weight of ${words} in the objective`, low: 0, high: 1, step: 0.05, most: 100 }, (law) => weights(law)?.[name] ?? 0, (law, value) => minimise(law, { ...weights(law), [name]: value }));
      row.firstElementChild.replaceChildren(button(text, () => change(`alone ${name}`, (law) => minimise(law, { [name]: 1 })), { class: "link", title: `Minimise the ${words} alone` }));
      return row;
    });
    const formula = html("input", { type: "text", placeholder: "or a formula: max(C/4, D/2.25)", "aria-label": "Objective as a formula", spellcheck: "false", maxlength: 300 });
    formula.addEventListener("change", () => change("formula", (law) => {
      if (formula.value.trim()) law.problem.minimise = formula.value.trim();
      else minimise(law, { C: 1 });
    }));
    shows.push((law) => document.activeElement !== formula && (formula.value = weights(law) ? "" : law.problem.minimise));
    return group("Minimise", html("p", { class: "hint", text: "weights of C/4, D/2.25, J/32, rms c/3.46: each by its least value of all laws" }), ...rows, formula);
  }

  function shape() {
    const whole = (name, text, title, low, high, most, usual) => field(name, { name: text, title, low, high, step: 1, most }, ({ problem }) => problem[name] ?? usual, ({ problem }, value) => (problem[name] = Math.round(value)));
    return group(
      "Law",
      field("B", { name: "B", title: "Peak velocity B", low: 1.05, high: 2.6, step: 0.001, off: true }, velocity, (law, value = rounded("B")) => setVelocity(law, value)),
      whole("order", "order l", "Order: end conditions at each end", 2, 8, 12, 2), whole("degree", "degree", "Degree of Z", 1, 25, 41, 9),
      toggle("monotone", "no return (b ≥ 0)", false), toggle("symmetric", "symmetric", true),
    );
  }

  function toggle(name, text, usual) {
    const box = html("input", { type: "checkbox", onchange: () => change(name, ({ problem }) => {
      if (box.checked === usual) delete problem[name];
      else problem[name] = box.checked;
    }) });
    shows.push(({ problem }) => (box.checked = problem[name] ?? usual));
    return html("label", { class: "switch" }, box, text);
  }

  function bounds() {
    return group("At most", ...Object.entries(CONSTANTS).map(([name, [text, words, low, high, step]]) => field(`bound ${name}`, { name: `${text} ≤`, title: `Greatest ${words}`, low, high, step, off: true }, (law) => bound(law, name), (law, value = rounded(name)) => setBound(law, name, value))));
  }

  /** A bound that the law of now keeps. */
  function rounded(name) {
    return Number((Math.ceil((value(name) ?? 2) * 1000) / 1000).toPrecision(7));
  }

  function standard() {
    const start = (alter) => change("optimal", (law) => {
      for (const name of ["name", "law", "title"]) delete law[name];
      law.problem = { order: 4, degree: 9, B: Number((value("B") ?? 1.7).toPrecision(8)) };
      alter(law);
    });
    return group(
      "A given law",
      html("p", { class: "hint", text: "Nothing is asked of it. Ask for an optimal law in its place:" }),
      button("least C at its peak velocity", () => start(() => {})),
      button("… with no more jerk", () => start((law) => value("J") && setBound(law, "J", rounded("J")))),
    );
  }

  return { show };
}

// What is asked of the active law: objective, peak velocity, order, degree, bounds; and the machine that it is for.

import { bound, minimise, setBound, setVelocity, velocity, weights } from "./asked.js";
import { createForm, slider } from "./form.js";
import { group } from "./layout.js";
import { button, html } from "./svg.js";

const SIZES = { stroke: "none, or 35 mm", time: "none, or 0.1 s", mass: "none, or 2 kg" };
const words = ({ about }) => about.replace(/[,.:].*/, "").replace(/^P/, "p");

/** `value(name)` is the constant of the law that is shown; `declared` are the entries of a law. */
export function createControls(root, study, value, declared) {
  const shows = [];
  const problemForm = createForm((what, alter) => change(what, ({ problem }) => alter(problem)), () => study.rest());
  const problem = html("div", {}, objective(), group("Law", ...declared.space.flatMap(space)), bounds());
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
    if (!law.problem) return;
    problemForm.show(law.problem);
    for (const show of shows) show(law);
  }

  function change(what, alter) {
    study.change(what, (state) => alter(state.laws[state.active]));
  }

  /** A slider of a value of the law, which `of` reads and `alter` changes. */
  function slide(key, options, of, alter) {
    const field = slider({ ...options, changed: (value) => change(key, (law) => alter(law, value)), rested: () => study.rest() });
    shows.push((law) => field.set(of(law)));
    return field.element;
  }

  function objective() {
    const rows = declared.constants.map(({ name, label, ...entry }) => {
      const row = slide(`weight ${name}`, { name: label, title: `Weight of ${words(entry)} in the objective`, low: 0, high: 1, step: 0.05, most: 100 }, (law) => weights(law)?.[name] ?? 0, (law, value) => minimise(law, { ...weights(law), [name]: value }));
      row.firstElementChild.replaceChildren(button(name.replace("_", " "), () => change(`alone ${name}`, (law) => minimise(law, { [name]: 1 })), { class: "link", title: `Minimise the ${words(entry)} alone` }));
      return row;
    });
    const formula = html("input", { type: "text", placeholder: "or a formula: max(C/4, D/2.25)", "aria-label": "Objective as a formula", title: declared.minimise.about, spellcheck: "false", maxlength: 300 });
    formula.addEventListener("change", () => change("formula", (law) => {
      if (formula.value.trim()) law.problem.minimise = formula.value.trim();
      else minimise(law, { C: 1 });
    }));
    shows.push((law) => document.activeElement !== formula && (formula.value = weights(law) ? "" : law.problem.minimise));
    return group("Minimise", html("p", { class: "hint", text: "weights of C/4, D/2.25, J/32, rms c/3.46: each by its least value of all laws" }), ...rows, formula);
  }

  /** An entry of the problem as it is declared; the peak velocity is a number or free. */
  function space(entry) {
    const { name, label, slider: range, default: usual, example } = entry;
    if (!range) return problemForm.fields([entry]);
    if (name === "B") return slide("B", { name, title: `${words(entry)} B`, ...range, off: true }, velocity, (law, value = rounded("B")) => setVelocity(law, value));
    return slide(name, { name: label, title: label, ...range }, ({ problem }) => problem[name] ?? usual ?? example, ({ problem }, value) => (problem[name] = Math.round(value)));
  }

  function bounds() {
    const field = ({ name, slider: range, ...entry }) => slide(`bound ${name}`, { name: `${name.replace("_", " ")} ≤`, title: `Greatest ${words(entry)}`, ...range, off: true }, (law) => bound(law, name), (law, value = rounded(name)) => setBound(law, name, value));
    return group("At most", ...declared.constants.map(field));
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

// The axes of a machine as a form: their names, one more, one less. What interlocks and an overlap say of an axis follows.

import { group } from "./fields.js";
import { otherOf } from "./interlocks.js";
import { html, renew } from "./svg.js";

const FRESH = [
  { kind: "dwell", duration: "90 deg" },
  { kind: "rise", by: "10 mm", duration: "90 deg", law: "cycloidal" },
  { kind: "dwell" },
  { kind: "return", by: "10 mm", duration: "90 deg", law: "cycloidal" },
];

export class AxisNames {
  #root;
  #study;
  #held;
  #kinds;
  #shape = "";

  /** `held(state)` is what holds the axes and the interlocks, whose entries are declared by their `kinds`. */
  constructor(root, study, held, kinds) {
    this.#kinds = kinds;
    this.#root = root;
    this.#study = study;
    this.#held = held;
  }

  show(state) {
    const names = this.#held(state).axis.map(({ name }) => name);
    const shape = JSON.stringify([names, state.axis]);
    if (shape === this.#shape) return;
    this.#shape = shape;
    const add = html("button", { type: "button", text: "+ axis", onclick: () => this.#add(names) });
    renew(this.#root, group("Axes", ...names.map((name, i) => this.#row(name, i, names, i === Math.min(state.axis, names.length - 1))), add));
  }

  #change(what, alter) {
    this.#study.change(what, (state) => alter(this.#held(state), state));
    this.#study.rest();
  }

  #row(name, i, names, chosen) {
    const field = html("input", { type: "text", value: name, spellcheck: "false", maxlength: 60, "aria-label": `name of axis ${i + 1}`, "data-key": `axis ${i}` });
    field.addEventListener("change", () => {
      const now = field.value.trim();
      if (now && !names.includes(now)) this.#change(`rename ${i}`, (held) => renamed(held, i, now, this.#kinds));
      else field.value = name;
    });
    const choose = html("input", { type: "radio", name: "axis-of-programme", checked: chosen, "aria-label": `segments of axis ${i + 1}`, title: "its segments stand below", onchange: () => this.#change("axis", (_held, state) => (state.axis = i)) });
    const remove = html("button", { type: "button", class: "close", disabled: names.length < 2, "aria-label": `Remove axis ${i + 1}`, title: "Remove this axis, and its interlocks", text: "×", onclick: () => this.#change(`remove axis ${i}`, (held, state) => {
      without(held, i, this.#kinds);
      state.axis = Math.min(state.axis > i ? state.axis - 1 : state.axis, held.axis.length - 1);
    }) });
    return html("div", { class: "axis-name" }, choose, field, remove);
  }

  #add(names) {
    const name = Array.from({ length: names.length + 1 }, (_, i) => `axis ${names.length + 1 + i}`).find((one) => !names.includes(one));
    this.#change("add axis", (held, state) => {
      held.axis.push({ name, segment: structuredClone(FRESH) });
      state.axis = held.axis.length - 1;
    });
  }
}

/** Call an axis by another name, wherever it is named. */
function renamed({ axis, interlocks = [], overlap }, i, now, kinds) {
  const was = axis[i].name;
  axis[i].name = now;
  for (const rule of interlocks) for (const key of ["axis", otherOf(kinds, rule.kind)]) if (rule[key] === was) rule[key] = now;
  if (overlap?.of) overlap.of = overlap.of.map((name) => (name === was ? now : name));
}

/** Take an axis away, with the interlocks and the goal that are of it. */
function without(held, i, kinds) {
  const [{ name }] = held.axis.splice(i, 1);
  if (held.interlocks) held.interlocks = held.interlocks.filter((rule) => rule.axis !== name && rule[otherOf(kinds, rule.kind)] !== name);
  if (!held.interlocks?.length) delete held.interlocks;
  if (!held.overlap?.of) return;
  held.overlap.of = held.overlap.of.filter((one) => one !== name);
  if (!held.overlap.of.length) delete held.overlap;
}

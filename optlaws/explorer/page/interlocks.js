// Interlocks as a form: which two axes, and what must not happen between them.

import { Form } from "./form.js";
import { group } from "./fields.js";
import { html, renew } from "./svg.js";

/** The entry that names the other axis, by the kind. */
export const otherOf = (kinds, kind) => kinds[kind]?.find(({ name, axis }) => axis && name !== "axis")?.name;

export class Interlocks {
  #root;
  #study;
  #held;
  #kinds;
  #form;
  #shape = "";

  /** `held(state)` is what holds the interlocks and the axes; `kinds` are their declared entries by their kinds. */
  constructor(root, study, held, kinds) {
    this.#root = root;
    this.#study = study;
    this.#held = held;
    this.#kinds = kinds;
    this.#form = new Form((what, alter) => study.change(what, (state) => alter(held(state))), () => study.rest(), ({ interlocks }, [, i], before) => this.#take(interlocks[i], before));
  }

  show(state) {
    const held = this.#held(state);
    const names = held.axis.map(({ name }) => name);
    const shape = JSON.stringify([names, held.interlocks?.length]);
    if (shape !== this.#shape) this.#build(held.interlocks ?? [], names);
    this.#shape = shape;
    this.#form.show(held);
  }

  /** An interlock of another kind is of the same axes. */
  #take(rule, before) {
    for (const { name, example } of this.#kinds[rule.kind]) if (example !== undefined) rule[name] ??= structuredClone(example);
    Object.assign(rule, { axis: before.axis, [otherOf(this.#kinds, rule.kind)]: before[otherOf(this.#kinds, before.kind)], ...(before.name && { name: before.name }) });
  }

  #change(what, alter) {
    this.#study.change(what, (state) => {
      const held = this.#held(state);
      held.interlocks ??= [];
      alter(held.interlocks);
      if (!held.interlocks.length) delete held.interlocks;
    });
  }

  #build(interlocks, names) {
    this.#form.clear();
    // an axis is one of those that there are
    const kinds = Object.fromEntries(Object.entries(this.#kinds).map(([kind, entries]) => [kind, entries.map((entry) => (entry.axis ? { ...entry, choices: names } : entry))]));
    const cards = interlocks.map((_, i) => {
      const remove = html("button", { type: "button", class: "close", "aria-label": `Take interlock ${i + 1} away`, text: "×", onclick: () => this.#change(`remove interlock ${i}`, (all) => all.splice(i, 1)) });
      const head = html("div", { class: "segment-head" }, html("span", { class: "field-name", text: String(i + 1) }), remove);
      return html("div", { class: "segment-card" }, head, ...this.#form.fields([{ kinds, name: i }], ["interlocks"]));
    });
    const begun = () => Object.fromEntries(this.#kinds.after.filter(({ needed, example }) => needed || example !== undefined).map(({ name, example }) => [name, example]));
    const add = html("button", {
      type: "button", text: "+ interlock", disabled: names.length < 2,
      onclick: () => this.#change("add interlock", (all) => all.push({ kind: "after", ...begun(), axis: names[0], of: names[1] })),
    });
    renew(this.#root, group("Interlocks", ...cards, add));
  }
}

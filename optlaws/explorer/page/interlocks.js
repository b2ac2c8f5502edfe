// Interlocks as a form: which two axes, and what must not happen between them.

import { group } from "./fields.js";
import { plain } from "./units.js";
import { html, renew } from "./svg.js";

/** The entry that names the other axis, by the kind. */
export const otherOf = (kinds, kind) => kinds[kind]?.find(({ name, axis }) => axis && name !== "axis")?.name;

export class Interlocks {
  #root;
  #study;
  #held;
  #kinds;
  #shape = "";
  #shows = [];

  /** `held(state)` is what holds the interlocks and the axes; `kinds` are their declared entries by their kinds. */
  constructor(root, study, held, kinds) {
    this.#root = root;
    this.#study = study;
    this.#held = held;
    this.#kinds = kinds;
  }

  show(state) {
    const { interlocks = [], axis } = this.#held(state);
    const shape = JSON.stringify([axis.map(({ name }) => name), interlocks.map(({ kind }) => kind)]);
    if (shape !== this.#shape) this.#build(interlocks, axis.map(({ name }) => name));
    this.#shape = shape;
    for (const show of this.#shows) show(interlocks);
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
    this.#shows = [];
    const cards = interlocks.map((one, i) => this.#card(one, i, names));
    const add = html("button", {
      type: "button", text: "+ interlock", disabled: names.length < 2,
      onclick: () => this.#change("add interlock", (all) => all.push(this.#begun("after", { axis: names[0], of: names[1] }))),
    });
    renew(this.#root, group("Interlocks", ...cards, add));
  }

  /** An interlock of a kind with what it needs, and of two entries of which it has one that with an example; its axes named. */
  #begun(kind, named) {
    const entries = this.#kinds[kind].filter(({ needed, example }) => needed || example !== undefined);
    return { kind, ...Object.fromEntries(entries.map(({ name, example }) => [name, structuredClone(example)])), ...named };
  }

  #card({ kind }, i, names) {
    const take = html("button", { type: "button", class: "close", "aria-label": `Take interlock ${i + 1} away`, text: "×", onclick: () => this.#change(`remove interlock ${i}`, (all) => all.splice(i, 1)) });
    const choose = this.#select(i, "kind", String(i + 1), Object.fromEntries(Object.keys(this.#kinds).map((one) => [one, one])), (rule) => rule.kind, (rule, value) => {
      const { axis, name } = rule;
      const other = rule[otherOf(this.#kinds, rule.kind)];
      for (const key of Object.keys(rule)) delete rule[key];
      Object.assign(rule, this.#begun(value, { axis, [otherOf(this.#kinds, value)]: other, ...(name && { name }) }));
    });
    choose.append(take);
    const axes = Object.fromEntries(names.map((name) => [name, name]));
    const rows = (this.#kinds[kind] ?? []).map((entry) => {
      const { name, label, axis, choices } = entry;
      if (axis) return this.#select(i, name, label, axes, (rule) => rule[name], (rule, value) => (rule[name] = value), true);
      if (choices) return this.#select(i, name, label, { "": "any", ...Object.fromEntries(choices.map((one) => [one, one])) }, (rule) => rule[name] ?? "", (rule, value) => put(rule, name, value));
      return this.#text(i, entry);
    });
    return html("div", { class: "segment-card" }, choose, ...rows);
  }

  /** A field of text: pairs of positions stand in several lines, and are read when it is left. */
  #text(i, { name, label, about, placeholder, example, list, parts, default: usual }) {
    const more = { placeholder: list ? lines(example) : placeholder, spellcheck: "false", maxlength: 2000, "aria-label": `interlock ${i + 1} ${name}` };
    const field = list ? html("textarea", { rows: 2, ...more }) : html("input", { type: "text", ...more });
    const valueOf = (text) => {
      if (list && text.includes(";")) return split(text, ";").map((pair) => split(pair, ","));
      if (parts && text.includes(",")) return split(text, ",");
      return typeof usual === "number" && text && Number.isFinite(Number(text)) ? Number(text) : text;
    };
    field.addEventListener(list ? "change" : "input", () => this.#change(`interlock ${i + 1} ${name}`, (all) => put(all[i], name, valueOf(plain(field.value.trim())))));
    if (!list) field.addEventListener("change", () => this.#study.rest());
    this.#shows.push((all) => {
      const text = lines(all[i]?.[name]);
      if (document.activeElement !== field || (!list && plain(field.value.trim()) !== text)) field.value = text;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: label, title: about }), field);
  }

  #select(i, name, title, options, get, put, named = false) {
    const field = html("select", { "aria-label": `interlock ${i + 1} ${name}` }, ...Object.entries(options).map(([value, text]) => html("option", { value, text, translate: named ? "no" : null })));
    field.addEventListener("change", () => this.#change(`interlock ${i + 1} ${name}`, (all) => put(all[i], field.value)));
    this.#shows.push((all) => all[i] && (field.value = get(all[i])));
    return html("div", { class: "entry" }, html("span", { class: "field-name", text: title }), field);
  }
}

const split = (text, sign) => text.split(sign).map((one) => one.trim()).filter(Boolean);
const lines = (value) => (Array.isArray(value) ? value.map((one) => (Array.isArray(one) ? one.join(", ") : one)).join(Array.isArray(value[0]) ? "; " : ", ") : String(value ?? ""));

function put(rule, name, value) {
  if (value) rule[name] = value;
  else delete rule[name];
}

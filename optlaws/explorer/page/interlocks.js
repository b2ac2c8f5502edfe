// Interlocks as a form: which two axes, and what must not happen between them.

import { group } from "./fields.js";
import { plain } from "./units.js";
import { html, renew } from "./svg.js";

const KINDS = { after: "after", clearance: "clearance", forbidden: "forbidden region", synchronous: "synchronous" };
/** The entry that names the other axis, by the kind. */
export const OTHER = { after: "of", clearance: "over", forbidden: "across", synchronous: "to" };
const TITLES = { of: "until", over: "over", across: "across", to: "with" };
const FRESH = {
  after: { position: "1 mm", above: "10 mm" },
  clearance: { least: [["0 mm", "10 mm"], ["50 mm", "20 mm"]] },
  forbidden: { corners: [["10 mm", "0 mm"], ["40 mm", "0 mm"], ["40 mm", "20 mm"]] },
  synchronous: { during: ["60 deg", "120 deg"], within: "1 mm/s" },
};

export class Interlocks {
  #root;
  #study;
  #held;
  #shape = "";
  #shows = [];

  /** `held(state)` is what holds the interlocks and the axes. */
  constructor(root, study, held) {
    this.#root = root;
    this.#study = study;
    this.#held = held;
  }

  show(state) {
    const { interlocks = [], axis } = this.#held(state);
    const shape = JSON.stringify([axis.map(({ name }) => name), interlocks.map((one) => [one.kind, side(one), paired(one)])]);
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
      onclick: () => this.#change("add interlock", (all) => all.push({ kind: "after", axis: names[0], of: names[1], ...FRESH.after })),
    });
    renew(this.#root, group("Interlocks", ...cards, add));
  }

  #card(one, i, names) {
    const { kind } = one;
    const take = html("button", { type: "button", class: "close", "aria-label": `Take interlock ${i + 1} away`, text: "×", onclick: () => this.#change(`remove interlock ${i}`, (all) => all.splice(i, 1)) });
    const choose = this.#select(i, "kind", String(i + 1), KINDS, (rule) => rule.kind, (rule, value) => {
      const { axis, name } = rule;
      const other = rule[OTHER[rule.kind]];
      for (const key of Object.keys(rule)) delete rule[key];
      Object.assign(rule, { kind: value, ...(name && { name }), axis, [OTHER[value]]: other }, structuredClone(FRESH[value]));
    });
    choose.append(take);
    const listed = Object.fromEntries(names.map((name) => [name, name]));
    const axis = this.#select(i, "axis", "axis", listed, (rule) => rule.axis, (rule, value) => (rule.axis = value), true);
    const other = this.#select(i, OTHER[kind], TITLES[OTHER[kind]] ?? "", listed, (rule) => rule[OTHER[kind]], (rule, value) => (rule[OTHER[kind]] = value), true);
    const name = this.#text(i, "name", "in words unless named", (rule) => rule.name, (rule, value) => put(rule, "name", value));
    return html("div", { class: "segment-card" }, choose, axis, ...this.#rows(kind, i, one, other), name);
  }

  #rows(kind, i, one, other) {
    if (kind === "after") {
      const way = this.#select(i, "way", "way", { "": "any", up: "up", down: "down" }, (rule) => rule.way ?? "", (rule, value) => put(rule, "way", value));
      return [this.#text(i, "position", "1 mm", (rule) => rule.position, (rule, value) => (rule.position = value), "passes"), way, other, this.#sided(i, ["above", "below"]), this.#text(i, side(one), "10 mm", (rule) => rule[side(rule)], (rule, value) => (rule[side(rule)] = value), "")];
    }
    if (kind === "clearance") {
      const units = paired(one) ? [] : [this.#text(i, "units", "deg, mm", (rule) => rule.units?.join(", "), (rule, value) => put(rule, "units", value && value.split(",").map((part) => part.trim())))];
      return [other, this.#sided(i, ["least", "most"]), this.#pairs(i, side(one), "0 deg, 20 mm; 45 deg, 60 mm", true), ...units];
    }
    if (kind === "forbidden") return [other, this.#pairs(i, "corners", "10 mm, 0 mm; 40 mm, 0 mm; 40 mm, 20 mm")];
    return [
      other,
      this.#text(i, "during", "60 deg, 120 deg", (rule) => rule.during?.join(", "), (rule, value) => (rule.during = value.split(",").map((part) => part.trim()))),
      this.#text(i, "within", "1 mm/s", (rule) => rule.within, (rule, value) => (rule.within = value)),
      this.#text(i, "ratio", "1", (rule) => rule.ratio, (rule, value) => put(rule, "ratio", Number.isFinite(Number(value)) && value ? Number(value) : value)),
    ];
  }

  /** Which side of a position or a bound: the entry has another name, its value stays. */
  #sided(i, names) {
    return this.#select(i, "side", "is", Object.fromEntries(names.map((name) => [name, name === "least" ? "at least" : name === "most" ? "at most" : name])), side, (rule, value) => {
      const was = rule[side(rule)];
      for (const name of names) delete rule[name];
      rule[value] = was;
    });
  }

  /** Pairs of positions in a line of text, or a formula where that may be. */
  #pairs(i, name, placeholder, formula = false) {
    const pairs = (text) => text.split(";").map((pair) => pair.split(",").map((part) => part.trim())).filter((pair) => pair.some(Boolean));
    const field = html("textarea", { rows: 2, placeholder, spellcheck: "false", maxlength: 2000, "aria-label": `interlock ${i + 1} ${name}` });
    field.addEventListener("change", () => this.#change(`interlock ${i + 1} ${name}`, (all) => {
      const text = plain(field.value.trim());
      all[i][name] = formula && !text.includes(";") ? text : pairs(text);
      if (Array.isArray(all[i][name])) delete all[i].units;
    }));
    this.#shows.push((all) => {
      const value = all[i]?.[name];
      const text = Array.isArray(value) ? value.map((pair) => (Array.isArray(pair) ? pair.join(", ") : String(pair))).join("; ") : String(value ?? "");
      if (document.activeElement !== field) field.value = text;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: name === "corners" ? "corners" : "" }), field);
  }

  #text(i, name, placeholder, get, put, title = name) {
    const field = html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 100, "aria-label": `interlock ${i + 1} ${name}` });
    field.addEventListener("input", () => this.#change(`interlock ${i + 1} ${name}`, (all) => put(all[i], plain(field.value.trim()))));
    field.addEventListener("change", () => this.#study.rest());
    this.#shows.push((all) => {
      const value = String((all[i] && get(all[i])) ?? "");
      if (document.activeElement !== field || plain(field.value.trim()) !== value) field.value = value;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: title }), field);
  }

  #select(i, name, title, options, get, put, named = false) {
    const field = html("select", { "aria-label": `interlock ${i + 1} ${name}` }, ...Object.entries(options).map(([value, text]) => html("option", { value, text, translate: named ? "no" : null })));
    field.addEventListener("change", () => this.#change(`interlock ${i + 1} ${name}`, (all) => put(all[i], field.value)));
    this.#shows.push((all) => all[i] && (field.value = get(all[i])));
    return html("div", { class: "entry" }, html("span", { class: "field-name", text: title }), field);
  }
}

const side = (rule) => ({ after: "below" in rule ? "below" : "above", clearance: "most" in rule ? "most" : "least" })[rule.kind] ?? "";
const paired = (rule) => rule.kind !== "clearance" || Array.isArray(rule[side(rule)]);

function put(rule, name, value) {
  if (value) rule[name] = value;
  else delete rule[name];
}

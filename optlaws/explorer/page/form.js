// Forms made from what values declare: a field for each entry of a table, by its path; a blank one takes the entry away.

import { put, read, textOf, valueOf } from "./entries.js";
import { plain } from "./units.js";
import { html } from "./svg.js";

const NOTHING = ["none", "free"]; // a field that says so is blank
const WORDS = ["name", "law", "columns", "cam"]; // whose commas are no list
const spoken = (path) => path.join(" ").replaceAll("_", " ");
const at = (table, path) => path.reduce((part, name) => part?.[name], table);

/** Declared entries with their paths: in place of a table its own entries, nothing in place of a list of tables. */
function flattened(entries, path = []) {
  return entries.flatMap((entry) => {
    const own = [...path, entry.name];
    if (entry.entries) return flattened(entry.entries, own);
    if (entry.kinds) return [{ ...entry, path: own }];
    if (entry.names) return entry.names.map((name) => ({ path: [...own, name], label: name, about: entry.about, placeholder: entry.example?.[name] ?? "" }));
    if (entry.list?.entries || entry.list?.kinds) return [];
    const text = typeof entry.example === "object" ? `${entry.needed ? "" : "none, or "}${textOf(entry.example)}` : entry.placeholder;
    return [{ ...entry, path: own, placeholder: text }];
  });
}

export class Form {
  #change;
  #rested;
  #taken;
  #shows = [];

  /** `change(what, alter)` changes the table, `rested()` ends a step; `taken(table, path, before)` may alter what another
      kind leaves behind, `before` being the table of the former kind. */
  constructor(change, rested, taken = () => {}) {
    this.#change = change;
    this.#rested = rested;
    this.#taken = taken;
  }

  /** Forget the fields: others are made. */
  clear() {
    this.#shows = [];
  }

  /** Fields of declared entries of the table at a path; names that a reader of the screen hears begin after `base`. */
  fields(entries, path = [], base = path) {
    return flattened(entries, path).flatMap((entry) => (entry.kinds ? this.#kinds(entry) : this.field(entry, spoken(entry.path.slice(base.length)))));
  }

  /** The field of an entry at its path; `name` is what a reader of the screen hears. */
  field({ path, label, about, placeholder, choices, needed, default: usual }, name = spoken(path)) {
    const own = path.at(-1);
    const options = [...(needed ? [] : [""]), ...(choices ?? []).map(String)].filter((value) => value !== String(usual));
    const field = choices
      ? html("select", { "aria-label": name }, ...options.map((value) => html("option", { value, text: value || String(usual ?? (placeholder || "—")), translate: "no" })))
      : html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 2000, "aria-label": name, ...(own === "law" && { list: "names" }) });
    const given = () => (NOTHING.includes(field.value.trim()) ? "" : plain(field.value.trim()));
    field.addEventListener("input", () => this.#change(name, (table) => put(table, path, given(), !WORDS.includes(own))));
    field.addEventListener("change", () => this.#rested());
    this.#shows.push((table) => {
      const value = read(table, path);
      const shown = choices && value === String(usual) ? "" : value;
      // what is being written is left as it is as long as it says what the table has
      if (document.activeElement !== field || (given() !== shown && textOf(valueOf(given())) !== shown)) field.value = shown;
      field.title = value || placeholder;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: label, title: about ?? name }), field);
  }

  /** Show what a table holds. */
  show(table) {
    for (const show of this.#shows) show(table);
  }

  /** The choice of one of several kinds of a table, and below it the fields of that kind. */
  #kinds({ kinds, path }) {
    const base = typeof path.at(-1) === "number" ? path.slice(0, -2) : path; // the table of a list is heard with its number
    const name = base === path ? `kind of ${spoken(path)}` : `${spoken(path.slice(base.length))} kind`;
    const choose = html("select", { "aria-label": name }, ...Object.keys(kinds).map((kind) => html("option", { value: kind, text: kind })));
    const below = html("div", { class: "kind" });
    const own = new Form(this.#change, this.#rested, this.#taken);
    choose.addEventListener("change", () => this.#change(name, (table) => {
      const before = { ...at(table, path) };
      put(table, [...path, "kind"], choose.value);
      const now = at(table, path);
      for (const entry of Object.keys(now)) if (entry !== "kind") delete now[entry];
      for (const { name: entry, needed, example } of kinds[choose.value]) if (needed) now[entry] = structuredClone(example);
      this.#taken(table, path, before);
    }));
    this.#shows.push((table) => {
      const kind = at(table, path)?.kind;
      if (kind !== choose.dataset.kind) {
        own.clear();
        below.replaceChildren(...own.fields(kinds[kind] ?? [], path, base));
      }
      choose.value = choose.dataset.kind = kind;
      own.show(table);
    });
    return [choose, below];
  }
}

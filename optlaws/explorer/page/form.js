// Forms made from what values declare: a field for each entry of a table, by its path; a blank one takes the entry away.
// Lengths, bodies, loads are written as in a problem file; a list is written "a, b" or "a to b", a table of places "a: b, c: d".

import { html, renew } from "./svg.js";
import { plain } from "./units.js";
import { object } from "./views.js";

const NOTHING = ["none", "free"]; // a field that says so is blank
const WORDS = ["name", "law", "columns", "cam"]; // whose commas are no list
const spoken = (path) => path.join(" ").replaceAll("_", " ");
const at = (table, path) => path.reduce((part, name) => part?.[name], table);
const places = (value) => object(value) && Object.keys(value).length > 0 && Object.keys(value).every((key) => /^[-+\d.]/.test(key));
const pairs = (value) => Array.isArray(value) && value.length > 0 && value.every((one) => Array.isArray(one) && one.length === 2);

/** A value as text; null is what no field can hold. */
function textOf(value) {
  if (places(value)) return textOf(Object.entries(value));
  if (pairs(value)) return value.map(([place, one]) => `${place}: ${one}`).join(", ");
  if (Array.isArray(value)) return value.some((one) => typeof one === "object") ? null : value.join(", ");
  return object(value) || value === null || value === undefined ? null : String(value);
}

const parsed = (text) => (text !== "" && Number.isFinite(Number(text)) ? Number(text) : { true: true, false: false }[text] ?? text);

/** The value of a text; formulas stay as they are. */
function valueOf(text) {
  if (/[({]/.test(text)) return text;
  const parts = text.split(/,| to /).map((part) => part.trim()).filter(Boolean);
  if (parts.length && parts.every((part) => part.includes(":"))) return parts.map((part) => part.split(":").map((one) => parsed(one.trim())));
  return parts.length > 1 ? parts.map(parsed) : parsed(text.trim());
}

/** Put a text at a path; a blank one takes the entry away, and what is then empty with it. */
function put(table, [name, ...rest], text, isText = false) {
  if (rest.length === 0) {
    if (text === "") delete table[name];
    else table[name] = isText ? text : valueOf(text);
    return;
  }
  if (typeof (table[name] ?? 0) !== "object") table[name] = {};
  put(table[name], rest, text, isText);
  if (Object.keys(table[name]).length === 0 && name !== "bodies") delete table[name];
}

/** A field with its name before it. */
export const entry = (text, field, title = null) => html("label", { class: "entry" }, html("span", { class: "field-name", text, title }), field);

/** A choice of one of several values, each with its text unless that is the value. */
export function choice(label, options, value, chosen) {
  const texts = Array.isArray(options) ? options.map((one) => [one, one]) : Object.entries(options);
  const field = html("select", { "aria-label": label }, ...texts.map(([one, text]) => html("option", { value: one, text })));
  field.addEventListener("change", () => chosen(field.value));
  field.value = value;
  return field;
}

/** A row with a name, a slider and a number; `off` makes a switch of it, `most` is the greatest number. Returns
    {element, set}. */
export function slider({ name, title, low, high, step, most = null, off = false, changed, rested }) {
  const range = html("input", { type: "range", min: low, max: high, step, "aria-label": title });
  const number = html("input", { type: "text", class: "numeric", inputmode: "decimal", autocomplete: "off", maxlength: 24, "aria-label": `${title}, number` });
  const given = (field) => (field === number ? plain(number.value.trim()) : field.value);
  let shown = null;
  const toggle = off ? html("input", { type: "checkbox", "aria-label": `${title}: bounded` }) : null;
  const tell = (field) => given(field) !== "" && Number(given(field)) >= 0 && Number.isFinite(Number(given(field))) && changed(Math.min(most ?? Infinity, Number(given(field))));
  for (const field of [range, number]) {
    field.addEventListener("input", () => tell(field));
    field.addEventListener("change", rested);
  }
  number.addEventListener("keydown", (event) => {
    const sign = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!sign) return;
    event.preventDefault();
    number.value = Number((Math.max(0, Number(given(number))) + sign * step).toPrecision(10));
    tell(number);
  });
  toggle?.addEventListener("change", () => changed(toggle.checked ? undefined : null));
  number.addEventListener("change", () => set(shown));
  const element = html("div", { class: "field" }, html(toggle ? "label" : "span", { class: "field-name" }, toggle, name), range, number);
  const set = (value) => {
    shown = value;
    const none = value === null;
    element.classList.toggle("off", none);
    if (toggle) toggle.checked = !none;
    range.disabled = number.disabled = none;
    if (none) return void (number.value = "");
    range.value = value;
    if (document.activeElement !== number || Number(given(number)) !== value) number.value = value;
  };
  return { element, set };
}

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

/** `change(what, alter)` changes the table, `rested()` ends a step; `taken(table, path, before)` may alter what another
    kind leaves behind, `before` being the table of the former kind. */
export function createForm(change, rested, taken = () => {}) {
  let shownShape = "";
  let shows = [];
  const left = {}; // what tables of other kinds had when they were left

  /** Show a table in the fields of an element; they are made anew where what decides which there are has changed. */
  function draw(root, shape, table, make) {
    const text = JSON.stringify(shape);
    if (text !== shownShape) {
      shows = [];
      renew(root, ...make());
    }
    shownShape = text;
    show(table);
  }

  /** Show what a table holds. */
  function show(table) {
    for (const show of shows) show(table);
  }

  /** `show(table)` is called whenever a table is shown. */
  function also(show) {
    shows.push(show);
  }

  /** Fields of declared entries of the table at a path; names that a reader of the screen hears begin after `base`. */
  function fields(entries, path = [], base = path) {
    return flattened(entries, path).flatMap((one) => (one.kinds ? kinds(one) : field(one, spoken(one.path.slice(base.length)))));
  }

  /** The field of an entry at its path; `name` is what a reader of the screen hears. */
  function field({ path, label, about, placeholder, choices, needed, default: usual, isText = WORDS.includes(path.at(-1)) }, name = spoken(path)) {
    const options = [...(needed ? [] : [""]), ...(choices ?? []).map(String)].filter((value) => value !== String(usual));
    const field = choices
      ? html("select", { "aria-label": name }, ...options.map((value) => html("option", { value, text: value || String(usual ?? (placeholder || "—")), translate: "no" })))
      : html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 2000, "aria-label": name, ...(path.at(-1) === "law" && { list: "names" }) });
    const given = () => (NOTHING.includes(field.value.trim()) ? "" : plain(field.value.trim()));
    field.addEventListener("input", () => change(name, (table) => put(table, path, given(), isText)));
    field.addEventListener("change", () => rested());
    also((table) => {
      const value = textOf(at(table, path)) ?? "";
      const shown = choices && value === String(usual) ? "" : value;
      // what a file has beyond the choices is one while it is shown
      if (choices && shown && ![...field.options].some((one) => one.value === shown)) field.append(html("option", { value: shown, text: shown, translate: "no" }));
      // what is being written is left as it is as long as it says what the table has
      if (document.activeElement !== field || (given() !== shown && textOf(valueOf(given())) !== shown)) field.value = shown;
      field.title = value || placeholder;
    });
    return entry(label, field, about ?? name);
  }

  /** The choice of one of several kinds of a table, and below it the fields of that kind. */
  function kinds({ kinds, path }) {
    const base = typeof path.at(-1) === "number" ? path.slice(0, -2) : path; // the table of a list is heard with its number
    const name = base === path ? `kind of ${spoken(path)}` : `${spoken(path.slice(base.length))} kind`;
    const below = html("div", { class: "kind" });
    const own = createForm(change, rested, taken);
    const choose = choice(name, Object.keys(kinds), "", (kind) => change(name, (table) => {
      const before = { ...at(table, path) };
      put(table, [...path, "kind"], kind);
      const now = at(table, path);
      for (const one of Object.keys(now)) if (one !== "kind") delete now[one];
      left[[...path, before.kind]] = before;
      for (const { name: one, needed, example } of kinds[kind]) if (needed) now[one] = structuredClone(example);
      Object.assign(now, structuredClone(left[[...path, kind]]));
      taken(table, path, before);
    }));
    also((table) => {
      const kind = (choose.value = at(table, path)?.kind);
      own.draw(below, kind, table, () => own.fields(kinds[kind] ?? [], path, base));
    });
    return [choose, below];
  }

  return { draw, show, also, fields, field };
}

/** A card of a list of tables: its number, what is done with it, and its fields. */
export function card(i, acts, fields) {
  return html("div", { class: "segment-card" }, html("div", { class: "segment-head" }, html("span", { class: "field-name", text: String(i + 1) }), html("span", { class: "acts" }, ...acts)), ...fields);
}

// Tables of a problem file as fields: lengths, bodies, loads; a list is written "a, b" or "a to b",
// a table of places "a: b, c: d".

import { object } from "./views.js";

const table = (value) => object(value) && Object.keys(value).length > 0 && Object.keys(value).every((key) => /^[-+\d.]/.test(key));
const pairs = (value) => Array.isArray(value) && value.length > 0 && value.every((one) => Array.isArray(one) && one.length === 2);

/** A value as text; null is what no field can hold. */
export function textOf(value) {
  if (table(value)) return textOf(Object.entries(value));
  if (pairs(value)) return value.map(([place, one]) => `${place}: ${one}`).join(", ");
  if (Array.isArray(value)) return value.some((one) => typeof one === "object") ? null : value.join(", ");
  return object(value) || value === null || value === undefined ? null : String(value);
}

const plain = (text) => (text !== "" && Number.isFinite(Number(text)) ? Number(text) : { true: true, false: false }[text] ?? text);

/** The value of a text; formulas stay as they are. */
export function valueOf(text) {
  if (/[({]/.test(text)) return text;
  const parts = text.split(/,| to /).map((part) => part.trim()).filter(Boolean);
  if (parts.length && parts.every((part) => part.includes(":"))) return parts.map((part) => part.split(":").map((one) => plain(one.trim())));
  return parts.length > 1 ? parts.map(plain) : plain(text.trim());
}

/** The paths of all that fields can hold, with their texts: [["bodies", "crank"], "2 kg"]. */
export function flat(value, path = []) {
  if (object(value) && !table(value)) return Object.entries(value).flatMap(([name, part]) => flat(part, [...path, name]));
  const text = textOf(value);
  return text === null ? [] : [[path, text]];
}

/** The text at a path; blank where there is nothing. */
export function read(value, path) {
  return textOf(path.reduce((part, name) => part?.[name], value)) ?? "";
}

/** Put a text at a path; a blank one takes the entry away, and what is then empty with it. */
export function put(value, [name, ...rest], text, parsed = true) {
  if (rest.length === 0) {
    if (text === "") delete value[name];
    else value[name] = parsed ? valueOf(text) : text;
    return;
  }
  if (typeof (value[name] ?? 0) !== "object") value[name] = {};
  put(value[name], rest, text, parsed);
  if (Object.keys(value[name]).length === 0 && name !== "bodies") delete value[name];
}

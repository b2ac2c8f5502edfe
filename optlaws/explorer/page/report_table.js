// Tables of reports, in the units that are chosen.

import { html } from "./svg.js";
import { headed, number } from "./units.js";

/** A table whose headings are "name, unit" or elements, and whose cells are numbers in the unit of their column, quantities,
    texts, elements, or null; `look(i, j)` are further attributes of a cell. */
export function table(name, headings, rows, look = () => ({})) {
  const units = headings.map((heading) => (typeof heading === "string" ? heading.split(", ")[1] ?? "" : ""));
  const shown = (heading, i) => (units[i] ? headed(heading.split(", ")[0], units[i]) : heading);
  // columns of numbers and quantities stand on the right
  const isNumber = (value) => value === null || typeof value === "number" || (typeof value === "object" && !Array.isArray(value) && !(value instanceof Element));
  const right = headings.map((_, j) => (j > 0 && rows.every((row) => isNumber(row[j])) ? "number" : null));
  const head = headings.map((heading, j) => html("th", { scope: "col", class: right[j] }, shown(heading, j)));
  const cell = (value, i, j) => {
    const attributes = { ...look(i, j) };
    if (value instanceof Element) return html("td", attributes, value);
    const text = value === null ? "—" : typeof value === "number" ? number(value, units[j]) : value;
    return html("td", { title: text, ...attributes, class: [right[j], attributes.class].filter(Boolean).join(" ") || null, text });
  };
  const body = rows.map(([title, ...cells], i) => html("tr", {}, html("th", { scope: "row", title, text: title }), ...cells.map((value, j) => cell(value, i, j + 1))));
  return html("table", { "aria-label": name }, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...body));
}

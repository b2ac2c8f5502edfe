// Tables of reports, in the units that are chosen.

import { html } from "./svg.js";
import { headed, number } from "./units.js";

/** A table whose headings are "name, unit" or elements, and whose cells are numbers in the unit of their column, quantities,
    texts, elements, or null; `look(i, j)` are further attributes of a cell. */
export function table(name, headings, rows, look = () => ({})) {
  const units = headings.map((heading) => (typeof heading === "string" ? heading.split(", ")[1] ?? "" : ""));
  const shown = (heading, i) => (units[i] ? headed(heading.split(", ")[0], units[i]) : heading);
  const head = headings.map((heading, i) => html("th", { scope: "col", class: i ? "number" : null }, shown(heading, i)));
  const cell = (value, i, j) => {
    const attributes = { ...look(i, j) };
    if (value instanceof Element) return html("td", attributes, value);
    const text = value === null ? "—" : typeof value === "number" ? number(value, units[j]) : value;
    return html("td", { title: attributes.class ? null : text, ...attributes, class: `number ${attributes.class ?? ""}`.trim(), text });
  };
  const body = rows.map(([title, ...cells], i) => html("tr", {}, html("th", { scope: "row", title, text: title }), ...cells.map((value, j) => cell(value, i, j + 1))));
  return html("table", { "aria-label": name }, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...body));
}

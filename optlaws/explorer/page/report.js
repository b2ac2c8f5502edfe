// Reports in words and tables: how far a law can be trusted, or why there is none and how far one must go back. A click on
// "check this proof" is an event of its own, which the page answers.

import { button, html, renew } from "./svg.js";
import { headed, listed, number, plain, written } from "./units.js";

export function showTrust(root, view, ways = [], go = () => {}) {
  marked(root, view?.refused ? written(view.refused.reason) : "");
  root.classList.toggle("none", Boolean(view?.refused));
  if (!view) renew(root);
  else if (view.refused) renew(root, ...refusal(view.refused, ways, go));
  else if (view.trust) renew(root, ...trust(view.trust));
  else renew(root, html("p", {}, html("strong", { class: "word given", text: "given" }), " A law as it stands: nothing was optimised."));
}

/** Mark the fields of a view that a refusal names with the value that they have. */
export function marked(root, reason) {
  const quoted = [...reason.matchAll(/'([^']*)'/g)].map(([, value]) => value);
  for (const field of root.closest(".view").querySelectorAll("input[type=text]")) {
    const named = field.getAttribute("aria-label")?.match(/\w{3,}/g)?.some((word) => reason.includes(word));
    if (named && quoted.includes(plain(field.value.trim()))) field.setAttribute("aria-invalid", "true");
    else field.removeAttribute("aria-invalid");
  }
}

function trust({ status, word, advice, gap, facts, proof }) {
  return [
    html("p", {}, html("strong", { class: `word ${status}`, text: word }), ` ${written(advice)} `, html("span", { class: "quiet", text: gap })),
    html("p", { class: "facts", text: listed(facts) }),
    proof ? checking() : null,
  ].filter(Boolean);
}

/** The button by which the second checker is given what is shown. */
export function checking() {
  return html("p", {}, button("check this proof", ({ target }) => target.dispatchEvent(new Event("prove", { bubbles: true })), { class: "link", "data-key": "prove" }));
}

function refusal({ word, reason, tried }, ways, go) {
  const found = [html("p", { class: "reason", title: tried }, html("strong", { class: "word refused", text: word }), ` ${written(reason)}`)];
  if (ways === null) found.push(html("p", { class: "quiet", text: "looking for the nearest problem that has a law …" }));
  else if (ways.length) {
    const buttons = ways.map((way) => button(way.text, () => go(way), { "data-entry": way.entry, "data-value": way.value }));
    found.push(html("p", { class: "ways" }, "Go back: ", ...buttons));
  }
  return found;
}

/** A table whose headings are "name, unit" or elements, and whose cells are numbers in the unit of their column, quantities,
    texts, elements, or null; the first one of a row is its heading. `look(i, j)` are further attributes of a cell, `line(i)` of a
    row; columns of numbers and quantities stand on the right, and all of them where `right` says so. */
export function table(name, headings, rows, { look = () => ({}), line = () => ({}), right: all = false, ...attributes } = {}) {
  const units = headings.map((heading) => (typeof heading === "string" ? heading.split(", ")[1] ?? "" : ""));
  const shown = (heading, i) => (units[i] ? headed(heading.split(", ")[0], units[i]) : heading);
  const isNumber = (value) => value === null || typeof value === "number" || (typeof value === "object" && !Array.isArray(value) && !(value instanceof Node));
  const right = headings.map((_, j) => (j > 0 && (all || rows.every((row) => isNumber(row[j]))) ? "number" : null));
  const head = headings.map((heading, j) => (heading === "" ? html("td") : html("th", { scope: "col", class: right[j] }, shown(heading, j))));
  const cell = (value, i, j) => {
    const own = look(i, j);
    if (value instanceof Node) return html("td", own, value);
    const text = value === null ? "—" : typeof value === "number" ? number(value, units[j]) : value;
    return html("td", { title: text, ...own, class: [right[j], own.class].filter(Boolean).join(" ") || null, text });
  };
  const body = rows.map(([title, ...cells], i) => html("tr", line(i), title instanceof Node ? html("th", { scope: "row" }, title) : html("th", { scope: "row", title, text: title }), ...cells.map((value, j) => cell(value, i, j + 1))));
  return html("table", { "aria-label": name, ...attributes }, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...body));
}

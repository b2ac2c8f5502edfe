// Constants of the laws side by side, with the digits that the server gave.

import { html } from "./svg.js";

const NAMES = ["B", "C", "D", "J", "rms_c"];

/** `machine` are rows of the active law in the units of a machine: {name, cells} with a quantity for each constant. */
export function showTable(root, views, active, machine = []) {
  const least = Object.fromEntries(NAMES.map((name) => [name, leastOf(views, name)]));
  const head = html("tr", {}, html("th", { scope: "col", text: "law" }), ...NAMES.map((name) => html("th", { scope: "col", class: "number", text: name === "rms_c" ? "rms c" : name })));
  const rows = views.flatMap((view, i) => [row(view, i, i === active, views.length > 1 ? least : {}), ...(i === active ? machine.map(machineRow) : [])]);
  root.replaceChildren(html("table", { "aria-label": "Constants of the laws, dimensionless" }, html("thead", {}, head), html("tbody", {}, ...rows)));
}

function machineRow({ name, cells }) {
  return html("tr", { class: "in-units" }, html("th", { scope: "row", text: name }), ...NAMES.map((constant) => html("td", { class: "number", text: cells[constant] ?? "" })));
}

function leastOf(views, name) {
  const values = views.map((view) => valueOf(view, name)).filter((value) => value !== null);
  return values.length ? Math.min(...values) : null;
}

function valueOf(view, name) {
  return view?.constants?.find((one) => one.name === name)?.value ?? null;
}

function row(view, i, active, least) {
  const cells = NAMES.map((name) => {
    const one = view?.constants?.find((constant) => constant.name === name);
    const best = one && one.value !== null && least[name] === one.value;
    return html("td", { class: `number${best ? " best" : ""}`, "data-constant": name, title: one?.k || null, text: one?.text ?? "—" });
  });
  const title = view?.title ?? (view?.refused ? view.refused.word : "…");
  return html("tr", { class: active ? "active" : "" }, html("th", { scope: "row" }, html("span", { class: `swatch law-${i}`, text: "ABCD"[i] }), html("span", { class: "row-name", text: title, title })), ...cells);
}

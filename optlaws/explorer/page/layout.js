// What views are laid out of: columns of panels, groups of fields, tabs.

import { button, html } from "./svg.js";

export const part = (id, attributes = {}, ...children) => html("div", { id, ...attributes }, ...children);
export const panel = (id, attributes = {}, ...children) => part(id, { class: "panel", ...attributes }, ...children);
export const picture = (id) => part(id, { class: "picture" });
/** A panel whose words a reader of the screen hears when they change. */
export const status = (id) => panel(id, { role: "status", "aria-live": "polite" });
/** A panel that takes the height which the others of its column leave. */
export const growing = (...children) => html("div", { class: "panel growing" }, ...children);
export const head = (...children) => html("div", { class: "panel-head" }, ...children);
export const column = (id, label, ...children) => html("section", { id, "aria-label": label }, ...children);

/** Append columns to the element of a view; its elements by their ids, without the name of the view before these. */
export function laidOut(root, ...columns) {
  root.append(...columns);
  const own = root.id.replace("view", "");
  return Object.fromEntries([...root.querySelectorAll("[id]")].map((one) => [one.id.replace(own, ""), one]));
}

export function group(title, ...children) {
  return html("fieldset", {}, html("legend", { text: title }), ...children);
}

/** What a view shows explained, closed at first: pairs of a name, or of its look, and a text. */
export function explained(words) {
  return html("details", { class: "explained" }, html("summary", { text: "What is shown" }), html("dl", {}, ...words.flatMap(([name, text]) => [html("dt", {}, name), html("dd", { text })])));
}

/** Buttons of which one is chosen; arrow keys go from one to the next. Returns a function that shows the chosen one. */
export function tabs(root, names, chosen) {
  const buttons = Object.entries(names).map(([key, text]) => button(text, () => chosen(key), { role: "tab", "data-key": key }));
  root.replaceChildren(...buttons);
  root.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const at = buttons.indexOf(document.activeElement);
    if (!step || at < 0) return;
    const next = buttons[(at + step + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  return (key) => {
    for (const button of buttons) {
      const own = button.dataset.key === key;
      button.setAttribute("aria-selected", String(own));
      button.tabIndex = own ? 0 : -1;
    }
  };
}

/** The letter of a law in its colour, and beside it its name. */
export const swatch = (i, title = null) => html("span", { class: `swatch law-${i}`, title, text: "ABCD"[i] });

/** Parts that stand beside each other without an element of their own. */
export function fragment(...parts) {
  const all = document.createDocumentFragment();
  all.append(...parts);
  return all;
}

// What views are laid out of: columns of panels, pictures in them, and what is said of an answer.

import { html } from "./svg.js";

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

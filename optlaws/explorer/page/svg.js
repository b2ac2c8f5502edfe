// Elements of the page and of its pictures.

import { written } from "./units.js";

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "text") element.textContent = written(value);
    else element.setAttribute(name, value === true ? "" : written(value));
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export const setAttributes = (element, attributes) => fill(element, attributes, []);

export function html(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

export const button = (text, onclick, attributes = {}, ...children) => html("button", { type: "button", text, onclick, ...attributes }, ...children);

export function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

/** The width and the height of an element, as a function; `draw` is called when they change. What is read amid writing
    would lay out the page once more, so that they are read after it is laid out. */
export function sized(element, draw) {
  let known = [0, 0];
  const read = () => [element.clientWidth, element.clientHeight];
  new ResizeObserver(() => {
    known = read();
    draw();
  }).observe(element);
  return () => (known[0] ? known : read());
}

/** New children for an element; what had the focus has it again, or where it is gone the first that can have it, or the
    element itself. */
export function renew(root, ...children) {
  const named = (one) => one.dataset.key ?? one.getAttribute("aria-label") ?? one.textContent;
  const before = root.contains(document.activeElement) ? document.activeElement : null;
  const name = before && named(before);
  root.replaceChildren(...children);
  if (before === null || root.contains(document.activeElement)) return;
  const all = [...root.querySelectorAll("button, input, select, [tabindex]")].filter((one) => !one.disabled);
  const next = all.find((one) => named(one) === name) ?? all[0] ?? root;
  if (next === root) root.tabIndex = -1;
  next.focus({ preventScroll: true });
}

/** Let parts of an element be dragged: `grasp(event)` is what is taken, or null; `pull(taken, event)` follows the pointer. */
export function draggable(root, grasp, pull, release) {
  let taken = null;
  root.addEventListener("pointerdown", (event) => {
    taken = event.button === 0 ? grasp(event) : null;
    if (taken === null) return;
    root.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  root.addEventListener("pointermove", (event) => taken !== null && pull(taken, event));
  for (const end of ["pointerup", "pointercancel"]) root.addEventListener(end, () => {
    if (taken !== null) release(taken);
    taken = null;
  });
}

/** A path through [x, y] pairs in pixels, or in units of which a picture takes so many decimals; null breaks it. */
export function path(places, decimals = 1) {
  let text = "";
  let pen = "M";
  for (const place of places) {
    if (place === null) {
      pen = "M";
      continue;
    }
    text += `${pen}${place[0].toFixed(decimals)} ${place[1].toFixed(decimals)}`;
    pen = "L";
  }
  return text;
}

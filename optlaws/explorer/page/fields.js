// Fields of forms: a slider with its number, that may be switched off.

import { plain } from "./units.js";
import { html } from "./svg.js";

/** A row with a name, a slider and a number; `off` makes a switch of it, `most` is the greatest number. Returns
    {element, set}. */
export function slider({ name, title, low, high, step, most = null, off = false, changed, rested }) {
  const range = html("input", { type: "range", min: low, max: high, step, "aria-label": title });
  const number = html("input", { type: "text", class: "numeric", inputmode: "decimal", autocomplete: "off", maxlength: 24, "aria-label": `${title}, number` });
  const valueOf = (field) => (field === number ? plain(number.value.trim()) : field.value);
  const toggle = off ? html("input", { type: "checkbox", "aria-label": `${title}: bounded` }) : null;
  const tell = (field) => () => valueOf(field) !== "" && Number(valueOf(field)) >= 0 && Number.isFinite(Number(valueOf(field))) && changed(Math.min(most ?? Infinity, Number(valueOf(field))));
  range.addEventListener("input", tell(range));
  range.addEventListener("change", rested);
  number.addEventListener("input", tell(number));
  number.addEventListener("change", rested);
  number.addEventListener("keydown", (event) => {
    const sign = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!sign) return;
    event.preventDefault();
    number.value = localised(Number((Math.max(0, Number(valueOf(number))) + sign * step).toPrecision(10)));
    tell(number)();
  });
  toggle?.addEventListener("change", () => changed(toggle.checked ? undefined : null));
  const element = html("div", { class: "field" }, toggle ? html("label", { class: "field-name" }, toggle, name) : html("span", { class: "field-name", text: name }), range, number);
  const set = (value) => {
    const none = value === null;
    element.classList.toggle("off", none);
    if (toggle) toggle.checked = !none;
    range.disabled = number.disabled = none;
    if (none) return void (number.value = "");
    range.value = value;
    if (document.activeElement !== number || Number(valueOf(number)) !== value) number.value = value;
  };
  return { element, set };
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
  const buttons = Object.entries(names).map(([key, text]) => html("button", { type: "button", role: "tab", "data-key": key, text, onclick: () => chosen(key) }));
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

// The laws side by side: which one is active, another added, one taken away.

import { swatch } from "./layout.js";
import { button, html, renew } from "./svg.js";

const MOST = 4;

/** Laws by their titles as chips, of which one is active; `choose(i)` makes one so, `remove(i)` takes one of several away. */
export function chips(titles, active, choose, remove) {
  return titles.map((title, i) => html("span", { class: `chip${i === active ? " active" : ""}` },
    button(undefined, () => choose(i), { class: "choose", "data-key": `law ${i}`, "aria-pressed": String(i === active), title }, swatch(i), html("span", { class: "chip-name", text: title })),
    titles.length > 1 ? button("×", () => remove(i), { class: "close", "data-key": `close ${i}`, "aria-label": `Take ${title} away` }) : null));
}

/** A field that adds a standard law by its name. */
export function standard(label, add) {
  const field = html("input", { list: "names", placeholder: "+ standard law", "aria-label": label, maxlength: 100 });
  field.addEventListener("change", () => field.value.trim() && add(field.value.trim()));
  return field;
}

export function createTray(root, study) {
  let shownText = "";

  function show(laws, views, active) {
    const shown = JSON.stringify([laws.length, views.map((view, i) => titled(laws[i], view)), active]);
    if (shown === shownText) return;
    shownText = shown;
    const titles = laws.map((law, i) => titled(law, views[i]));
    renew(root, ...chips(titles, active, (i) => study.change("active", (state) => (state.active = i)), remove), ...(laws.length < MOST ? adding() : []));
  }

  /** Compare with a standard law by its name; what there is to say where there is no room for one more. */
  function add(name) {
    const { laws } = study.state;
    const there = laws.findIndex((law) => law.name === name);
    if (there < 0 && laws.length >= MOST) return `${MOST} laws are compared: take one away before ${name} is added`;
    study.change(`add ${name}`, (state) => (state.active = there < 0 ? state.laws.push({ name }) - 1 : there));
    return "";
  }

  function remove(i) {
    study.change(`remove ${i}`, (state) => {
      state.laws.splice(i, 1);
      state.active = Math.min(state.active > i ? state.active - 1 : state.active, state.laws.length - 1);
    });
  }

  function adding() {
    const copy = button("+ copy", () => study.change("copy", (state) => {
      state.active = state.laws.push(structuredClone(state.laws[state.active])) - 1;
    }), { class: "quiet-button", title: "Keep this law and change a copy of it" });
    return [copy, standard("Add a standard law by its name", add)];
  }

  return { show, add };
}

function titled(law, view) {
  return view?.title ?? law.title ?? law.name ?? "a problem";
}

// The laws side by side: which one is active, another added, one taken away.

import { swatch } from "./layout.js";
import { html, renew } from "./svg.js";

const MOST = 4;

/** Laws by their titles as chips, of which one is active; `choose(i)` makes one so, `remove(i)` takes one of several away. */
export function chips(titles, active, choose, remove) {
  return titles.map((title, i) => html("span", { class: `chip${i === active ? " active" : ""}` },
    html("button", { type: "button", class: "choose", "data-key": `law ${i}`, "aria-pressed": String(i === active), title, onclick: () => choose(i) }, swatch(i), html("span", { class: "chip-name", text: title })),
    titles.length > 1 ? html("button", { type: "button", class: "close", "data-key": `close ${i}`, "aria-label": `Take ${title} away`, text: "×", onclick: () => remove(i) }) : null));
}

/** A field that adds a standard law by its name. */
export function standard(label, add) {
  const field = html("input", { list: "names", placeholder: "+ standard law", "aria-label": label, maxlength: 100 });
  field.addEventListener("change", () => field.value.trim() && add(field.value.trim()));
  return field;
}

export class Tray {
  #root;
  #study;
  #shown = "";

  constructor(root, study) {
    this.#root = root;
    this.#study = study;
  }

  show(laws, views, active) {
    const shown = JSON.stringify([laws.length, views.map((view, i) => titled(laws[i], view)), active]);
    if (shown === this.#shown) return;
    this.#shown = shown;
    const titles = laws.map((law, i) => titled(law, views[i]));
    renew(this.#root, ...chips(titles, active, (i) => this.#study.change("active", (state) => (state.active = i)), (i) => this.#remove(i)), ...(laws.length < MOST ? this.#adding() : []));
  }

  /** Compare with a standard law by its name. */
  add(name) {
    this.#study.change(`add ${name}`, (state) => {
      const there = state.laws.findIndex((law) => law.name === name);
      if (there >= 0) state.active = there;
      else if (state.laws.length < MOST) state.active = state.laws.push({ name }) - 1;
    });
  }

  #remove(i) {
    this.#study.change(`remove ${i}`, (state) => {
      state.laws.splice(i, 1);
      state.active = Math.min(state.active > i ? state.active - 1 : state.active, state.laws.length - 1);
    });
  }

  #adding() {
    const copy = html("button", {
      type: "button", class: "quiet-button", text: "+ copy", title: "Keep this law and change a copy of it",
      onclick: () => this.#study.change("copy", (state) => {
        state.active = state.laws.push(structuredClone(state.laws[state.active])) - 1;
      }),
    });
    return [copy, standard("Add a standard law by its name", (name) => this.add(name))];
  }
}

function titled(law, view) {
  return view?.title ?? law.title ?? law.name ?? "a problem";
}

// The laws side by side: which one is active, another added, one taken away.

import { html, renew } from "./svg.js";

const MOST = 4;

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
    const chips = laws.map((law, i) => this.#chip(law, views[i], i, i === active, laws.length > 1));
    renew(this.#root, ...chips, ...(laws.length < MOST ? this.#adding() : []));
  }

  /** Compare with a standard law by its name. */
  add(name) {
    this.#study.change(`add ${name}`, (state) => {
      const there = state.laws.findIndex((law) => law.name === name);
      if (there >= 0) state.active = there;
      else if (state.laws.length < MOST) state.active = state.laws.push({ name }) - 1;
    });
  }

  #chip(law, view, i, active, several) {
    const title = titled(law, view);
    const choose = html("button", { type: "button", class: "choose", "data-key": `law ${i}`, "aria-pressed": String(active), title, onclick: () => this.#study.change("active", (state) => (state.active = i)) }, html("span", { class: `swatch law-${i}`, text: "ABCD"[i] }), html("span", { class: "chip-name", text: title }));
    const close = several ? html("button", { type: "button", class: "close", "data-key": `close ${i}`, "aria-label": `Take ${title} away`, text: "×", onclick: () => this.#remove(i) }) : null;
    return html("span", { class: `chip${active ? " active" : ""}` }, choose, close);
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
    const field = html("input", { list: "names", placeholder: "+ standard law", "aria-label": "Add a standard law by its name", maxlength: 100 });
    field.addEventListener("change", () => field.value.trim() && this.add(field.value.trim()));
    return [copy, field];
  }
}

function titled(law, view) {
  return view?.title ?? law.title ?? law.name ?? "a problem";
}

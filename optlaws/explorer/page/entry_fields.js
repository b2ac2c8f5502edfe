// Fields of the entries of a table, by their paths: what is written goes into the study, a blank one takes an entry away.

import { put, read } from "./entries.js";
import { plain } from "./units.js";
import { html } from "./svg.js";

export class EntryFields {
  #change;
  #rested;
  #shows = [];

  /** `change(what, alter)` changes the table, `rested()` ends a step. */
  constructor(change, rested) {
    this.#change = change;
    this.#rested = rested;
  }

  /** Forget the fields: others are made. */
  clear() {
    this.#shows = [];
  }

  /** A field of the entry at a path; `about` is what a reader of the screen hears, `more` says what it is, or may be. */
  field(path, placeholder, name, about, more = {}) {
    const field = more.choices
      ? html("select", { "aria-label": about }, ...["", ...more.choices].map((value) => html("option", { value, text: value || placeholder })))
      : html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 400, "aria-label": about });
    field.addEventListener("input", () => this.#change(about, (table) => put(table, path, plain(field.value.trim()))));
    field.addEventListener("change", () => this.#rested());
    this.#shows.push((table) => {
      const value = read(table, path);
      if (document.activeElement !== field || field.value.trim() !== value) field.value = value;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: name, title: more.about ?? about }), field);
  }

  /** Show what a table holds. */
  show(table) {
    for (const show of this.#shows) show(table);
  }
}

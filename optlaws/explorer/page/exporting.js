// Motions for controllers: a format is chosen, and what the controller will run stands beside the law before it is saved.

import { plain } from "./units.js";
import { Latest } from "./latest.js";
import { download } from "./saving.js";
import { html } from "./svg.js";

export const MACHINE = { format: "csv", stroke: "35 mm", time: "0.1 s", master: "120 deg" };
const TEXTS = { stroke: "stroke", time: "time", master: "master" };
const NUMBERS = { points: "points", counts: "encoder counts a stroke" };

export class Exporting {
  #study;
  #formats;
  #dialog;
  #result = html("div", { class: "report", "aria-live": "polite" });
  #format;
  #fields = {};
  #save = html("button", { type: "button", text: "Save the file", disabled: true });
  #answer = null;
  #asked;
  #motion;

  /** `motion(state)` is what the view that is shown has to export: entries of the question, or null. */
  constructor(study, formats, motion) {
    this.#study = study;
    this.#motion = motion;
    this.#formats = formats;
    this.#asked = new Latest("api/export", (answer) => this.#show(answer), (error) => this.#refuse(error));
    this.#format = html("select", { "aria-label": "format" }, ...formats.map(({ name, target }) => html("option", { value: name, text: `${name}: ${target}` })));
    this.#format.addEventListener("change", () => this.#change("format", this.#format.value));
    const fields = [...Object.entries(TEXTS), ...Object.entries(NUMBERS)].map(([name, text]) => this.#field(name, text));
    const close = html("button", { type: "button", text: "Close", onclick: () => this.#dialog.close() });
    this.#save.addEventListener("click", () => this.#answer && download(this.#answer.name, this.#answer.type, this.#answer.text));
    this.#dialog = html("dialog", { "aria-label": "Export for a controller" }, html("h2", { text: "Export for a controller" }), this.#format, html("div", { class: "machine" }, ...fields), this.#result, html("div", { class: "buttons" }, this.#save, close));
    document.body.append(this.#dialog);
  }

  open() {
    if (!this.#motion(this.#study.state)) return;
    this.show(this.#study.state);
    this.#dialog.showModal();
    this.#ask(this.#study.state);
  }

  show(state) {
    const machine = { ...MACHINE, ...state.controller };
    const { takes } = this.#formats.find(({ name }) => name === machine.format) ?? { takes: [] };
    this.#format.value = machine.format;
    for (const [name, field] of Object.entries(this.#fields)) {
      const value = String(machine[name] ?? "");
      if (document.activeElement !== field || plain(field.value.trim()) !== value) field.value = value;
      field.parentElement.hidden = name in TEXTS ? this.#motion(state)?.view !== "laws" : !takes.includes(name);
    }
    if (this.#dialog.open && this.#motion(state)) this.#ask(state);
  }

  #field(name, text) {
    const number = name in NUMBERS;
    const field = html("input", { type: number ? "number" : "text", placeholder: number ? (name === "points" ? "the best number" : "exact") : "", min: 2, step: 1, maxlength: 60, "aria-label": text });
    field.addEventListener("input", () => this.#change(name, number ? (field.value === "" ? null : Math.round(Number(field.value))) : plain(field.value.trim())));
    field.addEventListener("change", () => this.#study.rest());
    this.#fields[name] = field;
    return html("label", { class: "entry" }, html("span", { class: "field-name", text }), field);
  }

  #change(name, value) {
    this.#study.change(`export ${name}`, (state) => {
      state.controller = { ...MACHINE, ...state.controller, [name]: value };
      if (value === null) delete state.controller[name];
    });
  }

  #ask(state) {
    const { takes } = this.#formats.find(({ name }) => name === (state.controller?.format ?? MACHINE.format)) ?? { takes: [] };
    const machine = Object.fromEntries(Object.entries({ ...MACHINE, ...state.controller }).filter(([name]) => name in MACHINE || takes.includes(name)));
    this.#answer = null;
    this.#save.disabled = true;
    const { format: kind, ...others } = machine;
    this.#asked.ask({ kind, ...others, ...this.#motion(state) });
  }

  #show(answer) {
    this.#answer = answer;
    this.#save.disabled = false;
    this.#save.textContent = `Save ${answer.name}`;
    const head = html("tr", {}, ...["", "as executed", "as designed", "ratio"].map((text, i) => html("th", { scope: "col", class: i ? "number" : null, text })));
    const rows = answer.rows.map(([name, ...cells]) => html("tr", {}, html("th", { scope: "row", text: name }), ...cells.map((text) => html("td", { class: "number", text }))));
    this.#result.replaceChildren(
      html("p", { text: answer.words }), ...answer.notes.map((text) => html("p", { class: "quiet", text })),
      html("table", { "aria-label": "What the controller will run" }, html("thead", {}, head), html("tbody", {}, ...rows)),
    );
  }

  /** Nothing of an earlier export is left where there is none. */
  #refuse(error) {
    this.#answer = null;
    this.#save.disabled = true;
    this.#result.replaceChildren(html("p", { class: "reason" }, html("strong", { class: "word refused", text: "no export" }), ` ${error.message}`));
  }
}

// Motions for controllers: a format is chosen, and what the controller will run stands beside the law before it is saved.

import { download } from "./files.js";
import { Form, choice } from "./form.js";
import { Latest } from "./latest.js";
import { table } from "./report.js";
import { button, html } from "./svg.js";

const MACHINE = { format: "csv", stroke: "35 mm", time: "0.1 s", master: "120 deg" };
/** Entries of the machine of a law, and those that formats take. */
const FIELDS = [
  ...["stroke", "time", "master"].map((name) => ({ path: [name], label: name, placeholder: "", isText: true })),
  { path: ["points"], label: "points", placeholder: "the best number" },
  { path: ["counts"], label: "encoder counts a stroke", placeholder: "exact" },
];

/** The machine of a state; what was emptied stays so. */
const machineOf = ({ controller }) => (controller?.format ? controller : { ...MACHINE, ...controller });

export class Exporting {
  #study;
  #formats;
  #dialog;
  #result = html("div", { class: "report", "aria-live": "polite" });
  #form;
  #rows;
  #save = button("Save the file", () => this.#answer && download(this.#answer), { disabled: true });
  #answer = null;
  #asked = new Latest("api/export", (answer) => this.#show(answer), (error) => this.#refuse(error));
  #motion;

  /** `motion(state)` is what the view that is shown has to export: entries of the question, or null. */
  constructor(study, formats, motion) {
    this.#study = study;
    this.#motion = motion;
    this.#formats = Object.fromEntries(formats.map((one) => [one.name, one]));
    const change = (what, alter) => study.change(`export ${what}`, (state) => alter((state.controller = machineOf(state))));
    this.#form = new Form(change, () => study.rest());
    const targets = Object.fromEntries(formats.map(({ name, target }) => [name, `${name}: ${target}`]));
    const format = choice("format", targets, MACHINE.format, (value) => change("format", (machine) => (machine.format = value)));
    this.#form.also((machine) => (format.value = machine.format));
    this.#rows = FIELDS.map((entry) => [entry.path[0], this.#form.field(entry, entry.label)]);
    this.#dialog = html("dialog", { "aria-label": "Export for a controller" }, html("h2", { text: "Export for a controller" }), format, html("div", { class: "machine" }, ...this.#rows.map(([, row]) => row)), this.#result, html("div", { class: "buttons" }, this.#save, button("Close", () => this.#dialog.close())));
    document.body.append(this.#dialog);
  }

  open() {
    if (!this.#motion(this.#study.state)) return;
    this.#dialog.showModal();
    this.show(this.#study.state);
  }

  show(state) {
    const machine = machineOf(state);
    const motion = this.#motion(state);
    const { takes = [] } = this.#formats[machine.format] ?? {};
    this.#form.show(machine);
    for (const [name, row] of this.#rows) row.hidden = name in MACHINE ? motion?.view !== "laws" : !takes.includes(name);
    if (!this.#dialog.open || !motion) return;
    this.#answer = null;
    this.#save.disabled = true;
    const { format: kind, stroke = "", time = "", master = "", ...others } = machine;
    this.#asked.ask({ kind, stroke, time, master, ...Object.fromEntries(Object.entries(others).filter(([name]) => takes.includes(name))), ...motion });
  }

  #show(answer) {
    this.#answer = answer;
    this.#save.disabled = false;
    this.#save.textContent = `Save ${answer.name}`;
    this.#result.replaceChildren(
      html("p", { text: answer.words }), ...answer.notes.map((text) => html("p", { class: "quiet", text })),
      table("What the controller will run", ["", "as executed", "as designed", "ratio"], answer.rows, { right: true }),
    );
  }

  /** Nothing of an earlier export is left where there is none. */
  #refuse(error) {
    this.#answer = null;
    this.#save.disabled = true;
    this.#result.replaceChildren(html("p", { class: "reason" }, html("strong", { class: "word refused", text: "no export" }), ` ${error.message}`));
  }
}

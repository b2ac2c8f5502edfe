// Motions for controllers: a format is chosen, and what the controller will run stands beside the law before it is saved.

import { download } from "./files.js";
import { choice, createForm } from "./form.js";
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

/** `motion(state)` is what the view that is shown has to export: entries of the question, or null. */
export function createExporting(study, formats, motion) {
  const result = html("div", { class: "report", "aria-live": "polite" });
  const save = button("Save the file", () => file && download(file), { disabled: true });
  let file = null;
  const asked = new Latest("api/export", showAnswer, refuse);
  const motionOf = motion;
  const formatsByName = Object.fromEntries(formats.map((one) => [one.name, one]));
  const change = (what, alter) => study.change(`export ${what}`, (state) => alter((state.controller = machineOf(state))));
  const form = createForm(change, () => study.rest());
  const targets = Object.fromEntries(formats.map(({ name, target }) => [name, `${name}: ${target}`]));
  const format = choice("format", targets, MACHINE.format, (value) => change("format", (machine) => (machine.format = value)));
  form.also((machine) => (format.value = machine.format));
  const rows = FIELDS.map((entry) => [entry.path[0], form.field(entry, entry.label)]);
  const dialog = html("dialog", { "aria-label": "Export for a controller" }, html("h2", { text: "Export for a controller" }), format, html("div", { class: "machine" }, ...rows.map(([, row]) => row)), result, html("div", { class: "buttons" }, save, button("Close", () => dialog.close())));
  document.body.append(dialog);

  function open() {
    if (!motionOf(study.state)) return;
    dialog.showModal();
    show(study.state);
  }

  function show(state) {
    const machine = machineOf(state);
    const motion = motionOf(state);
    const { takes = [] } = formatsByName[machine.format] ?? {};
    form.show(machine);
    for (const [name, row] of rows) row.hidden = name in MACHINE ? motion?.view !== "laws" : !takes.includes(name);
    if (!dialog.open || !motion) return;
    file = null;
    save.disabled = true;
    const { format: kind, stroke = "", time = "", master = "", ...others } = machine;
    asked.ask({ kind, stroke, time, master, ...Object.fromEntries(Object.entries(others).filter(([name]) => takes.includes(name))), ...motion });
  }

  function showAnswer(answer) {
    file = answer;
    save.disabled = false;
    save.textContent = `Save ${answer.name}`;
    result.replaceChildren(
      html("p", { text: answer.words }), ...answer.notes.map((text) => html("p", { class: "quiet", text })),
      table("What the controller will run", ["", "as executed", "as designed", "ratio"], answer.rows, { right: true }),
    );
  }

  /** Nothing of an earlier export is left where there is none. */
  function refuse(error) {
    file = null;
    save.disabled = true;
    result.replaceChildren(html("p", { class: "reason" }, html("strong", { class: "word refused", text: "no export" }), ` ${error.message}`));
  }

  return { open, show };
}

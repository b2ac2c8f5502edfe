// The forms of the one machine that the tabs Motion, Mechanism and torque, Timing, Least time and Advice show: its axes, its
// cycle with limits and segments, its interlocks, its mechanism and drive. They stand in the tab that is shown.

import { AxisNames } from "./axis_names.js";
import { Interlocks } from "./interlocks.js";
import { MachineForm } from "./machine_form.js";
import { Programme } from "./programme.js";
import { html } from "./svg.js";

const ONLY = { mechanism: "machine", interlocks: "axes" }; // forms of one tab
const PARTS = { names: "axes-names", mechanism: "machine-form", interlocks: "axes-interlocks", programme: "programme" };
const machineOf = ({ machine }) => machine;

export class MachineForms {
  #element = html("aside", { id: "machine-forms", "aria-label": "The machine" });
  #own = html("div");
  #parts = Object.fromEntries(Object.entries(PARTS).map(([name, id]) => [name, html("div", { id })]));
  #forms;

  constructor(study, known) {
    const { names, mechanism, interlocks, programme } = this.#parts;
    this.#element.append(names, this.#own, mechanism, interlocks, programme);
    this.#forms = [
      new AxisNames(names, study, machineOf, known.programme.interlocks),
      new MachineForm(mechanism, study, known),
      new Interlocks(interlocks, study, machineOf, known.programme.interlocks),
      new Programme(programme, study, machineOf, known.programme),
    ];
  }

  /** Show the machine of a state in a tab, with what it asks besides. */
  show(state, tab, root, own = null) {
    if (this.#element.parentNode !== root) root.prepend(this.#element);
    if (this.#own.firstChild !== own) this.#own.replaceChildren(...(own ? [own] : []));
    const moves = tab === "fastest" && state.fastest !== undefined; // which are no machine
    for (const [name, part] of Object.entries(this.#parts)) part.hidden = moves || (name in ONLY && ONLY[name] !== tab);
    for (const form of this.#forms) form.show(state);
  }
}

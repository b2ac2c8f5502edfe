// The mechanism of an axis and its drive as fields: its kind, its lengths, bodies and loads, its gear and its motor.

import { Form } from "./form.js";
import { group, slider } from "./fields.js";
import { html, renew } from "./svg.js";

const RATIOS = [0.1, 200];

/** The axes of the same machine: those that have the mechanism and the drive of one. */
export function beside(study, index) {
  const axis = study.axis[index] ?? study.axis[0];
  const own = JSON.stringify([axis.mechanism, axis.drive]);
  return study.axis.filter((one) => JSON.stringify([one.mechanism, one.drive]) === own);
}

/** Change the mechanism and the drive of all axes of the machine that an axis has. */
export function changeAll(study, what, alter) {
  study.change(what, ({ machine, axis }) => {
    for (const one of beside(machine, axis)) alter(one, machine);
  });
}

/** A slider of a ratio steps by equal shares. */
const logarithm = (value) => Math.round(1000 * Math.log10(value)) / 1000;

export class MachineForm {
  #root;
  #study;
  #kinds;
  #driving;
  #shape = "";
  #shows = [];
  #fields;

  /** `kinds` are mechanisms with their examples, `drive` its entries. */
  constructor(root, study, { mechanisms, drive }) {
    this.#root = root;
    this.#study = study;
    this.#kinds = mechanisms;
    this.#driving = drive;
    this.#fields = new Form((what, alter) => changeAll(study, what, alter), () => study.rest());
  }

  show(state) {
    const axis = state.machine.axis[state.axis] ?? state.machine.axis[0];
    const kind = axis.mechanism?.kind ?? "";
    const shape = JSON.stringify([kind, Boolean(axis.drive?.motor)]);
    if (shape !== this.#shape) this.#build(kind, axis);
    this.#shape = shape;
    for (const show of this.#shows) show(axis);
    this.#fields.show(axis);
  }

  #build(kind, axis) {
    this.#shows = [];
    this.#fields.clear();
    const entries = (this.#kinds[kind]?.fields ?? []).filter(({ name }) => name !== "segment");
    const choose = html("select", { "aria-label": "kind of mechanism" }, ...(kind in this.#kinds ? [] : [html("option", { value: "", text: "none" })]), ...Object.keys(this.#kinds).map((value) => html("option", { value, text: value })));
    choose.value = kind;
    choose.addEventListener("change", () => changeAll(this.#study, "mechanism", (one, study) => this.#take(one, study, choose.value)));
    renew(this.#root, group("Mechanism", choose, ...this.#fields.fields(entries, ["mechanism"], [])), ...this.#drive(Boolean(axis.drive?.motor)));
  }

  /** Another kind begins with its example and a motion within its range; what moves by which law stays. */
  #take(axis, study, kind) {
    const example = structuredClone(this.#kinds[kind]);
    const law = axis.segment.find((one) => one.law)?.law;
    axis.mechanism = { kind, ...example.mechanism };
    for (const name of ["start", "advance", "limits", "load"]) delete axis[name];
    Object.assign(axis, example.axis);
    if (law) for (const segment of axis.segment) if (["rise", "return", "move"].includes(segment.kind)) segment.law = law;
    if (example.period || !study.period) {
      delete study.speed;
      study.period = example.period ?? "0.7 s";
    }
  }

  #drive(motor) {
    const toggle = html("select", { "aria-label": "what drives" }, html("option", { value: "", text: "a torque at the input" }), html("option", { value: "motor", text: "a motor with a gear" }));
    toggle.value = motor ? "motor" : "";
    toggle.addEventListener("change", () => changeAll(this.#study, "drive", (one) => {
      const usual = (name) => structuredClone(this.#driving.find((entry) => entry.name === name).example);
      if (toggle.value) one.drive = { motor: usual("motor"), ratio: usual("ratio") };
      else delete one.drive;
    }));
    if (!motor) return [group("Driven by", toggle)];
    const [low, high] = RATIOS.map(logarithm);
    const ratio = slider({
      name: "ratio", title: "Ratio of the gear, by its logarithm", low, high, step: 0.001, most: null,
      changed: (value) => changeAll(this.#study, "ratio", (one) => (one.drive.ratio = Number((10 ** value).toPrecision(4)))), rested: () => this.#study.rest(),
    });
    const number = ratio.element.lastElementChild;
    const exact = html("input", { type: "number", min: 0, step: "any", "aria-label": "Ratio of the gear" });
    exact.addEventListener("input", () => Number(exact.value) > 0 && changeAll(this.#study, "ratio", (one) => (one.drive.ratio = Number(exact.value))));
    exact.addEventListener("change", () => this.#study.rest());
    number.replaceWith(exact);
    this.#shows.push(({ drive }) => {
      const value = Number(drive?.ratio ?? 1);
      if (value > 0) ratio.set(logarithm(value));
      if (document.activeElement !== exact || Number(exact.value) !== value) exact.value = value;
    });
    const gear = this.#fields.fields(this.#driving.filter(({ name }) => name !== "ratio" && name !== "motor"), ["drive"], []);
    const motors = this.#fields.fields(this.#driving.find(({ name }) => name === "motor").entries, ["drive", "motor"], []);
    return [group("Driven by", toggle, ratio.element, ...gear), group("Motor", ...motors)];
  }
}

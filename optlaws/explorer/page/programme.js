// The programme of a cycle as a form: speed, what is least, limits, and the segments with their laws.

import { Form } from "./form.js";
import { group } from "./fields.js";
import { html, renew } from "./svg.js";

const KEPT = ["by", "duration", "name"]; // by a segment of another kind
const SPEEDS = { speed: "200 rpm", period: "0.3 s" };
const FRESH = { kind: "dwell", duration: "30 deg" };

export class Programme {
  #root;
  #study;
  #held;
  #entries;
  #form;
  #shape = "";

  /** `held(state)` is what holds speed and period; its axes, or its motion, hold the segments. `entries` are those that
      a cycle and its segments declare. */
  constructor(root, study, held, entries) {
    this.#root = root;
    this.#study = study;
    this.#held = held;
    this.#entries = entries;
    this.#form = new Form((what, alter) => this.#change(what, alter), () => study.rest(), (tables, path, before) => this.#keep(path.reduce((part, name) => part[name], tables), before));
  }

  show(state) {
    const cycle = this.#held(state);
    const axis = axisOf(cycle, state.axis);
    if (!axis) return;
    const shape = JSON.stringify([state.axis, axis.name, axis.segment?.length, "period" in cycle, "mechanism" in axis]);
    if (shape !== this.#shape) this.#build(cycle, axis);
    this.#shape = shape;
    this.#form.show({ cycle, axis });
  }

  /** Change the tables of the cycle and of its axis that is shown. */
  #change(what, alter) {
    this.#study.change(what, (state) => {
      const cycle = this.#held(state);
      alter({ cycle, axis: axisOf(cycle, state.axis) });
    });
  }

  #keep(segment, before) {
    const declared = this.#entries.segments[segment.kind].map(({ name }) => name);
    for (const name of KEPT.filter((one) => declared.includes(one))) {
      const value = before[name] ?? segment[name] ?? (name === "by" ? "10 mm" : undefined);
      if (value !== undefined) segment[name] = value;
    }
  }

  #build(cycle, axis) {
    this.#form.clear();
    const timing = "period" in cycle ? "period" : "speed";
    const given = html("select", { "aria-label": "timing" }, ...Object.keys(SPEEDS).map((name) => html("option", { value: name, text: name, selected: name === timing })));
    given.addEventListener("change", () => this.#change("timing", ({ cycle: study }) => {
      const value = study[timing];
      delete study[timing];
      study[given.value] = turned(value, given.value);
    }));
    const head = [
      html("label", { class: "entry" }, html("span", { class: "field-name", text: "given by" }), given),
      this.#form.field({ path: ["cycle", timing], label: timing, placeholder: SPEEDS[timing] }, "timing value"),
      this.#form.field({ path: ["axis", "minimise"], label: "least", choices: this.#entries.objectives, default: "acceleration" }, "minimise"),
    ];
    const limits = this.#entries.limits[axis.mechanism ? "machine" : "motion"].map((entry) => this.#form.field({ ...entry, path: ["axis", "limits", entry.name] }, `limit ${entry.name}`));
    const segments = (axis.segment ?? []).map((_, i, { length }) => this.#segment(i, length));
    const add = html("button", { type: "button", text: "+ segment", onclick: () => this.#change("add segment", ({ axis: { segment } }) => segment.push({ ...FRESH })) });
    renew(this.#root, group("Cycle", ...head), group("At most", ...limits), group("Segments", ...segments, add));
  }

  #segment(i, count) {
    const act = (text, about, alter) => html("button", { type: "button", class: "close", "aria-label": `${about} segment ${i + 1}`, title: `${about} this segment`, text, onclick: () => this.#change(`${about} ${i}`, ({ axis }) => alter(axis.segment)) });
    const swap = (all, one, other) => ([all[one], all[other]] = [all[other], all[one]]);
    const acts = html("span", { class: "acts" },
      act("↑", "Move up", (all) => i > 0 && swap(all, i - 1, i)),
      act("↓", "Move down", (all) => i < count - 1 && swap(all, i, i + 1)),
      act("+", "Insert a segment after", (all) => all.splice(i + 1, 0, { ...FRESH })),
      act("×", "Take away", (all) => count > 1 && all.splice(i, 1)),
    );
    const fields = this.#form.fields([{ kinds: this.#entries.segments, name: i }], ["axis", "segment"]);
    return html("div", { class: "segment-card" }, html("div", { class: "segment-head" }, html("span", { class: "field-name", text: String(i + 1) }), acts), ...fields);
  }
}

/** Let segment i end at an angle where `shown` says that it is; a duration in time stays one. */
export function join(segments, shown, { i, at, turn }) {
  if (segments.length !== shown.length) return;
  const [before, after] = [segments[i], segments[i + 1]];
  const angle = (value) => Number(value.toPrecision(9));
  const written = (old, degrees) => {
    const unit = /[\d.]\s*(m?s)$/.exec(old)?.[1];
    const time = (degrees / 360) * turn * (unit === "s" ? 1e-3 : 1);
    return unit ? `${Number(time.toPrecision(6))} ${unit}` : `${angle(degrees)} deg`;
  };
  if (before.duration || !after.duration) before.duration = written(before.duration, at - shown[i].at[0]);
  if (after.duration) after.duration = written(after.duration, shown[i + 1].at[1] - at);
}

/** A speed as a period, or a period as a speed, where its unit is one of the usual; else an example. */
function turned(value, kind) {
  const [, number, unit] = /^([\d.eE+-]+)\s*(rpm|1\/min|s|ms)$/.exec(value ?? "") ?? [];
  const [times, written] = kind === "period" ? [{ rpm: 60, "1/min": 60 }[unit], "s"] : [{ s: 60, ms: 60_000 }[unit], "rpm"];
  const turns = times / Number(number);
  return Number.isFinite(turns) ? `${Number(turns.toPrecision(12))} ${written}` : kind === "speed" ? "200 rpm" : "0.3 s";
}

const axisOf = (cycle, index) => cycle.motion ?? cycle.axis?.[index] ?? cycle.axis?.[0];

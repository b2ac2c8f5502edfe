// The programme of a cycle as a form: speed, what is least, limits, and the segments with their laws.

import { group } from "./fields.js";
import { plain } from "./units.js";
import { html, renew } from "./svg.js";

const KEPT = ["by", "duration", "name"];
const NOTHING = ["none", "free"];

export class Programme {
  #root;
  #study;
  #held;
  #entries;
  #shape = "";
  #shows = [];

  /** `held(state)` is what holds speed and period; its axes, or its motion, hold the segments. `entries` are those that
      a cycle and its segments declare. */
  constructor(root, study, held, entries) {
    this.#entries = entries;
    this.#root = root;
    this.#study = study;
    this.#held = held;
  }

  show(state) {
    const cycle = this.#held(state);
    const index = state.axis;
    const axis = axisOf(cycle, index);
    if (!axis) return;
    const shape = JSON.stringify([index, cycle.axis?.map((one) => one.name), (axis.segment ?? []).map((one) => one.kind), "period" in cycle, "mechanism" in axis]);
    if (shape !== this.#shape) this.#build(cycle, axis);
    this.#shape = shape;
    for (const show of this.#shows) show(cycle, axis);
  }

  #change(what, alter) {
    this.#study.change(what, (state) => {
      const cycle = this.#held(state);
      alter(axisOf(cycle, state.axis), cycle, state);
    });
  }

  #build(cycle, axis) {
    this.#shows = [];
    const timing = "period" in cycle ? "period" : "speed";
    const head = [
      this.#select("timing", "given by", { speed: "speed", period: "period" }, () => timing, (_axis, study, kind) => {
        const value = study.speed ?? study.period;
        delete study.speed;
        delete study.period;
        study[kind] = turned(value, kind);
      }),
      this.#text("timing value", { name: timing, placeholder: timing === "speed" ? "200 rpm" : "0.3 s" }, (_axis, study) => study[timing], (_axis, study, value) => (study[timing] = value)),
      this.#select("minimise", "least", named(this.#entries.objectives), (one) => one.minimise ?? "acceleration", (one, _study, value) => (one.minimise = value)),
    ];
    const limits = this.#entries.limits[axis.mechanism ? "machine" : "motion"].map(({ name, label, placeholder, about }) => this.#text(`limit ${name}`, { name: label, placeholder, about }, (one) => listed(one.limits?.[name]), (one, _study, value) => {
      one.limits = { ...one.limits, [name]: value === "true" || sided(value) };
      if (!value) delete one.limits[name];
    }));
    const segments = (axis.segment ?? []).map((segment, i) => this.#segment(segment, i, axis.segment.length));
    const add = html("button", { type: "button", text: "+ segment", onclick: () => this.#change("add segment", (one) => one.segment.push({ kind: "dwell", duration: "30 deg" })) });
    renew(this.#root, group("Cycle", ...head), group("At most", ...limits), group("Segments", ...segments, add));
  }

  #segment(segment, i, count) {
    const of = (axis) => axis.segment?.[i] ?? {};
    const row = ({ name, label, placeholder, about, list }) => this.#text(`segment ${i} ${name.replaceAll("_", " ")}`, { name: label, placeholder, about, list, law: name === "law" }, (axis) => listed(of(axis)[name]), (axis, _study, value) => {
      if (value) axis.segment[i][name] = list ? parts(value, ";").map((pair) => parts(pair, ",")) : name === "duration" ? sided(value) : value;
      else delete axis.segment[i][name];
    });
    const kinds = this.#entries.segments;
    const kind = this.#select(`segment ${i} kind`, "kind", named(Object.keys(kinds)), (axis) => of(axis).kind, (axis, _study, value) => {
      const before = axis.segment[i];
      const segment = (axis.segment[i] = { kind: value });
      for (const { name, needed, placeholder } of kinds[value]) {
        const usual = needed ? placeholder : name === "by" ? "10 mm" : undefined;
        const entry = KEPT.includes(name) ? before[name] ?? usual : usual;
        if (entry !== undefined) segment[name] = entry;
      }
    });
    const act = (text, about, alter) => html("button", { type: "button", class: "close", "aria-label": `${about} segment ${i + 1}`, title: `${about} this segment`, text, onclick: () => this.#change(`${about} ${i}`, (axis) => alter(axis.segment)) });
    const swap = (all, one, other) => ([all[one], all[other]] = [all[other], all[one]]);
    const entries = kinds[segment.kind] ?? [];
    const head = row(entries.find(({ name }) => name === "name") ?? { name: "name", placeholder: "" });
    head.firstElementChild.textContent = String(i + 1);
    const acts = html("span", { class: "acts" },
      act("↑", "Move up", (all) => i > 0 && swap(all, i - 1, i)),
      act("↓", "Move down", (all) => i < count - 1 && swap(all, i, i + 1)),
      act("+", "Insert a segment after", (all) => all.splice(i + 1, 0, { kind: "dwell", duration: "30 deg" })),
      act("×", "Take away", (all) => count > 1 && all.splice(i, 1)),
    );
    const rows = entries.filter(({ name }) => name !== "name").map(row);
    return html("div", { class: "segment-card" }, html("div", { class: "segment-head" }, head, acts), kind, ...rows);
  }

  /** A field of text; that of a list is read when it is left, as half of one says nothing. */
  #text(what, { name, placeholder, about, law = false, list = false }, get, put) {
    const field = html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 400, "aria-label": what, ...(law && { list: "names" }) });
    field.addEventListener(list ? "change" : "input", () => this.#change(what, (axis, study) => put(axis, study, NOTHING.includes(field.value.trim()) ? "" : plain(field.value.trim()))));
    field.addEventListener("change", () => this.#study.rest());
    this.#shows.push((cycle, axis) => {
      const value = get(axis, cycle) ?? "";
      if (document.activeElement !== field || (!list && plain(field.value.trim()) !== value)) field.value = value;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: name, title: about ?? what }), field);
  }

  #select(what, name, options, get, put) {
    const field = html("select", { "aria-label": what }, ...Object.entries(options).map(([value, text]) => html("option", { value, text })));
    field.addEventListener("change", () => this.#change(what, (axis, study, state) => put(axis, study, field.value, state)));
    this.#shows.push((cycle, axis) => (field.value = get(axis, cycle)));
    return html("div", { class: "entry" }, html("span", { class: "field-name", text: name }), field);
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

const named = (names) => Object.fromEntries(names.map((one) => [one, one]));

/** Two quantities as "40 deg to 60 deg", pairs as "40 deg, 20 mm; 60 deg, 30 mm". */
const listed = (value) => (Array.isArray(value?.[0]) ? value.map((pair) => pair.join(", ")).join("; ") : Array.isArray(value) ? value.join(" to ") : typeof value === "boolean" ? String(value) : value);
const parts = (text, sign) => text.split(sign).map((one) => one.trim()).filter(Boolean);
const sided = (text) => (text.includes(" to ") ? parts(text, " to ") : text);

const axisOf = (cycle, index) => cycle.motion ?? cycle.axis?.[index] ?? cycle.axis?.[0];

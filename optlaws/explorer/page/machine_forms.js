// The forms of the one machine that five tabs show, in the tab that is shown: its axes, its mechanism and drive, its
// interlocks, and the programme of its cycle with limits and segments, which a cam has too.

import { card, choice, createForm, entry, slider } from "./form.js";
import { group } from "./layout.js";
import { button, html, renew } from "./svg.js";

const ONLY = { mechanism: "machine", interlocks: "axes" }; // forms of one tab
const FRESH_AXIS = [
  { kind: "dwell", duration: "90 deg" },
  { kind: "rise", by: "10 mm", duration: "90 deg", law: "cycloidal" },
  { kind: "dwell" },
  { kind: "return", by: "10 mm", duration: "90 deg", law: "cycloidal" },
];
const FRESH = { kind: "dwell", duration: "30 deg" };
const KEPT = ["by", "duration", "name"]; // by a segment of another kind
const MOVES = ["rise", "return", "move"];
const SPEEDS = { speed: "200 rpm", period: "0.3 s" };
const RATIOS = [0.1, 200];

export function createMachineForms(study, known) {
  const element = html("aside", { id: "machine-forms", "aria-label": "The machine" });
  const ownPart = html("div");
  const { interlocks } = known.programme;
  const [names, mechanism, locks, programme] = ["axes-names", "machine-form", "axes-interlocks", "programme"].map((id) => html("div", { id }));
  const parts = { names, mechanism, interlocks: locks, programme };
  element.append(names, ownPart, mechanism, locks, programme);
  const forms = [
    createAxisNames(names, study, interlocks), createMachineForm(mechanism, study, known), createInterlocks(locks, study, interlocks),
    createProgramme(programme, study, ({ machine }) => machine, known.programme),
  ];

  /** Show the machine of a state in a tab, with what it asks besides. */
  function show(state, tab, root, own = null) {
    if (element.parentNode !== root) root.prepend(element);
    if (ownPart.firstChild !== own) ownPart.replaceChildren(...(own ? [own] : []));
    const moves = tab === "fastest" && state.fastest !== undefined; // which are no machine
    for (const [name, part] of Object.entries(parts)) part.hidden = moves || (name in ONLY && ONLY[name] !== tab);
    for (const form of forms) form.show(state);
  }

  return { show };
}

/** The entry of an interlock that names the other axis, by the kind. */
const otherOf = (kinds, kind) => kinds[kind]?.find(({ name, axis }) => axis && name !== "axis")?.name;

/** The names of axes, one more, one less; what interlocks and an overlap say of an axis follows. */
function createAxisNames(root, study, kinds) {
  let shownShape = "";

  function show({ machine, axis }) {
    const names = machine.axis.map(({ name }) => name);
    const shape = JSON.stringify([names, axis]);
    if (shape === shownShape) return;
    shownShape = shape;
    renew(root, group("Axes", ...names.map((name, i) => row(name, i, names, i === axis)), button("+ axis", () => add(names))));
  }

  function change(what, alter) {
    study.change(what, alter);
    study.rest();
  }

  function row(name, i, names, chosen) {
    const field = html("input", { type: "text", value: name, spellcheck: "false", maxlength: 60, "aria-label": `name of axis ${i + 1}`, "data-key": `axis ${i}` });
    field.addEventListener("change", () => {
      const now = field.value.trim();
      if (now && !names.includes(now)) change(`rename ${i}`, ({ machine }) => renameAxis(machine, i, now));
      else field.value = name;
    });
    const choose = html("input", { type: "radio", name: "axis-of-programme", checked: chosen, "aria-label": `segments of axis ${i + 1}`, title: "its segments stand below", onchange: () => change("axis", (state) => (state.axis = i)) });
    const remove = button("×", () => change(`remove axis ${i}`, (state) => removeAxis(state, i, kinds)), { class: "close", disabled: names.length < 2, "aria-label": `Remove axis ${i + 1}`, title: "Remove this axis, and its interlocks" });
    return html("div", { class: "axis-name" }, choose, field, remove);
  }

  function add(names) {
    const name = Array.from({ length: names.length + 1 }, (_, i) => `axis ${names.length + 1 + i}`).find((one) => !names.includes(one));
    change("add axis", (state) => (state.axis = state.machine.axis.push({ name, segment: structuredClone(FRESH_AXIS) }) - 1));
  }

  /** Call an axis by another name, wherever it is named. */
  function renameAxis({ axis, interlocks = [], overlap }, i, now) {
    const was = axis[i].name;
    axis[i].name = now;
    for (const rule of interlocks) for (const key of ["axis", otherOf(kinds, rule.kind)]) if (rule[key] === was) rule[key] = now;
    if (overlap?.of) overlap.of = overlap.of.map((name) => (name === was ? now : name));
  }

  return { show };
}

/** Take an axis away, with the interlocks and the goal that are of it; `kinds` are the declared entries of interlocks. */
export function removeAxis(state, i, kinds) {
  const { machine } = state;
  const [{ name }] = machine.axis.splice(i, 1);
  if (machine.interlocks) machine.interlocks = machine.interlocks.filter((rule) => rule.axis !== name && rule[otherOf(kinds, rule.kind)] !== name);
  if (!machine.interlocks?.length) delete machine.interlocks;
  state.axis = Math.min(state.axis > i ? state.axis - 1 : state.axis, machine.axis.length - 1);
  if (!machine.overlap?.of) return;
  machine.overlap.of = machine.overlap.of.filter((one) => one !== name);
  if (!machine.overlap.of.length) delete machine.overlap;
}

/** The axes of the same machine: those that have the mechanism and the drive of one. */
export function beside(study, index) {
  const axis = study.axis[index];
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

/** The mechanism of an axis and its drive: its kind, its lengths, bodies and loads, its gear and its motor. `mechanisms` are
    kinds with their examples, `drive` its entries. */
function createMachineForm(root, study, { mechanisms, drive }) {
  const mechanismKinds = mechanisms;
  const driving = Object.fromEntries(drive.map((one) => [one.name, one]));
  const fields = createForm((what, alter) => changeAll(study, what, alter), () => study.rest());

  function show(state) {
    const axis = state.machine.axis[state.axis];
    const kind = axis.mechanism?.kind ?? "";
    const motor = Boolean(axis.drive?.motor);
    fields.draw(root, [kind, motor], axis, () => [mechanismGroup(kind), ...driveGroups(motor)]);
  }

  function mechanismGroup(kind) {
    const kinds = Object.fromEntries([...(kind in mechanismKinds ? [] : [["", "none"]]), ...Object.keys(mechanismKinds).map((one) => [one, one])]);
    const choose = choice("kind of mechanism", kinds, kind, (now) => changeAll(study, "mechanism", (one, study) => take(one, study, now)));
    return group("Mechanism", choose, ...fields.fields((mechanismKinds[kind]?.fields ?? []).filter(({ name }) => name !== "segment"), ["mechanism"], []));
  }

  /** Another kind begins with its example and a motion within its range; what moves by which law stays. */
  function take(axis, study, kind) {
    const example = structuredClone(mechanismKinds[kind]);
    const law = axis.segment.find((one) => one.law)?.law;
    axis.mechanism = { kind, ...example.mechanism };
    for (const name of ["start", "advance", "limits", "load"]) delete axis[name];
    Object.assign(axis, example.axis);
    if (law) for (const segment of axis.segment) if (MOVES.includes(segment.kind)) segment.law = law;
    if (example.period || !study.period) {
      delete study.speed;
      study.period = example.period ?? "0.7 s";
    }
  }

  function driveGroups(motor) {
    const { motor: { entries: motors, example }, ratio, ...gear } = driving;
    const toggle = choice("what drives", { "": "a torque at the input", motor: "a motor with a gear" }, motor ? "motor" : "", (value) => changeAll(study, "drive", (one) => {
      if (value) one.drive = structuredClone({ motor: example, ratio: ratio.example });
      else delete one.drive;
    }));
    if (!motor) return [group("Driven by", toggle)];
    const turn = (value) => value > 0 && changeAll(study, "ratio", (one) => (one.drive.ratio = value));
    const [low, high] = RATIOS.map(logarithm);
    const slide = slider({ name: "ratio", title: "Ratio of the gear, by its logarithm", low, high, step: 0.001, changed: (value) => turn(Number((10 ** value).toPrecision(4))), rested: () => study.rest() });
    const exact = html("input", { type: "number", min: 0, step: "any", "aria-label": "Ratio of the gear", oninput: () => turn(Number(exact.value)), onchange: () => study.rest() });
    slide.element.lastElementChild.replaceWith(exact);
    fields.also(({ drive }) => {
      const value = Number(drive?.ratio ?? 1);
      if (value > 0) slide.set(logarithm(value));
      if (document.activeElement !== exact || Number(exact.value) !== value) exact.value = value;
    });
    return [group("Driven by", toggle, slide.element, ...fields.fields(Object.values(gear), ["drive"], [])), group("Motor", ...fields.fields(motors, ["drive", "motor"], []))];
  }

  return { show };
}

/** Interlocks: which two axes, and what must not happen between them. `kinds` are the declared entries of interlocks by their
    kinds. */
function createInterlocks(root, study, kinds) {
  const interlockKinds = kinds;
  const form = createForm((what, alter) => study.change(what, ({ machine }) => alter(machine)), () => study.rest(), ({ interlocks }, [, i], before) => take(interlocks[i], before));

  function show({ machine }) {
    const names = machine.axis.map(({ name }) => name);
    form.draw(root, [names, machine.interlocks?.length], machine, () => [cards(machine.interlocks ?? [], names)]);
  }

  /** An interlock of another kind is of the same axes. */
  function take(rule, before) {
    for (const { name, example } of interlockKinds[rule.kind]) if (example !== undefined) rule[name] ??= structuredClone(example);
    Object.assign(rule, { axis: before.axis, [otherOf(interlockKinds, rule.kind)]: before[otherOf(interlockKinds, before.kind)], ...(before.name && { name: before.name }) });
  }

  function change(what, alter) {
    study.change(what, ({ machine }) => {
      machine.interlocks ??= [];
      alter(machine.interlocks);
      if (!machine.interlocks.length) delete machine.interlocks;
    });
  }

  function cards(interlocks, names) {
    // an axis is one of those that there are
    const kinds = Object.fromEntries(Object.entries(interlockKinds).map(([kind, entries]) => [kind, entries.map((one) => (one.axis ? { ...one, choices: names } : one))]));
    const cards = interlocks.map((_, i) => card(i, [
      button("×", () => change(`remove interlock ${i}`, (all) => all.splice(i, 1)), { class: "close", "aria-label": `Take interlock ${i + 1} away` }),
    ], form.fields([{ kinds, name: i }], ["interlocks"])));
    const begun = () => Object.fromEntries(interlockKinds.after.filter(({ needed, example }) => needed || example !== undefined).map(({ name, example }) => [name, example]));
    const add = button("+ interlock", () => change("add interlock", (all) => all.push({ kind: "after", ...begun(), axis: names[0], of: names[1] })), { disabled: names.length < 2 });
    return group("Interlocks", ...cards, add);
  }

  return { show };
}

/** The programme of a cycle: speed, what is least, limits, and the segments with their laws. `held(state)` is what holds
    speed and period; its axes, or its motion, hold the segments. `entries` are those that a cycle and its segments declare. */
export function createProgramme(root, study, held, entries) {
  const form = createForm(change, () => study.rest(), (tables, path, before) => keep(path.reduce((part, name) => part[name], tables), before));

  function show(state) {
    const tables = tablesOf(state);
    const { cycle, axis } = tables;
    form.draw(root, [state.axis, axis.name, axis.segment.length, "period" in cycle, "mechanism" in axis, turns(axis)], tables, () => fields(cycle, axis));
  }

  const turns = ({ segment }) => segment.some(({ by }) => /deg|rad/.test(by));

  function tablesOf(state) {
    const cycle = held(state);
    return { cycle, axis: cycle.motion ?? cycle.axis[state.axis] };
  }

  /** Change the tables of the cycle and of its axis that is shown. */
  function change(what, alter) {
    study.change(what, (state) => alter(tablesOf(state)));
  }

  function keep(segment, before) {
    const declared = entries.segments[segment.kind].map(({ name }) => name);
    for (const name of KEPT.filter((one) => declared.includes(one))) {
      const value = before[name] ?? segment[name] ?? (name === "by" ? "10 mm" : undefined);
      if (value !== undefined) segment[name] = value;
    }
  }

  function fields(cycle, axis) {
    const timing = "period" in cycle ? "period" : "speed";
    const given = choice("timing", Object.keys(SPEEDS), timing, (now) => change("timing", ({ cycle: study }) => {
      const value = study[timing];
      delete study[timing];
      study[now] = turned(value, now);
    }));
    const head = [
      entry("given by", given),
      form.field({ path: ["cycle", timing], label: timing, placeholder: SPEEDS[timing] }, "timing value"),
      form.field({ path: ["axis", "minimise"], label: "least", choices: entries.objectives, default: "acceleration" }, "minimise"),
    ];
    const limits = entries.limits[axis.mechanism ? "machine" : "motion"].map((one) => form.field({ ...one, path: ["axis", "limits", one.name] }, `limit ${one.name}`));
    const segments = axis.segment.map((_, i, { length }) => segment(i, length));
    const add = button("+ segment", () => change("add segment", ({ axis: { segment } }) => segment.push({ ...FRESH })));
    // a mechanism has its drive in a form of its own, a cam among its forces
    const drive = axis.mechanism || cycle.motion ? [] : [group("What is moved", ...form.fields(entries.drive[turns(axis) ? "angle" : "length"], ["axis", "drive"], ["axis"]))];
    return [group("Cycle", ...head), group("At most", ...limits), group("Segments", ...segments, add), ...drive];
  }

  function segment(i, count) {
    const act = (text, about, alter) => button(text, () => change(`${about} ${i}`, ({ axis }) => alter(axis.segment)), { class: "close", "aria-label": `${about} segment ${i + 1}`, title: `${about} this segment` });
    const swap = (all, one, other) => ([all[one], all[other]] = [all[other], all[one]]);
    return card(i, [
      act("↑", "Move up", (all) => i > 0 && swap(all, i - 1, i)),
      act("↓", "Move down", (all) => i < count - 1 && swap(all, i, i + 1)),
      act("+", "Insert a segment after", (all) => all.splice(i + 1, 0, { ...FRESH })),
      act("×", "Take away", (all) => count > 1 && all.splice(i, 1)),
    ], form.fields([{ kinds: entries.segments, name: i }], ["axis", "segment"]));
  }

  return { show };
}

/** Let segment i end at an angle where `shown` says that it is; a duration in time stays one. */
export function join(segments, shown, { i, at, turn }) {
  if (segments.length !== shown.length) return;
  const [before, after] = [segments[i], segments[i + 1]];
  const written = (old, degrees) => {
    const unit = /[\d.]\s*(m?s)$/.exec(old)?.[1];
    const time = (degrees / 360) * turn * (unit === "s" ? 1e-3 : 1);
    return unit ? `${Number(time.toPrecision(6))} ${unit}` : `${Number(degrees.toPrecision(9))} deg`;
  };
  if (before.duration || !after.duration) before.duration = written(before.duration, at - shown[i].at[0]);
  if (after.duration) after.duration = written(after.duration, shown[i + 1].at[1] - at);
}

/** A speed as a period, or a period as a speed, where its unit is one of the usual; else an example. */
function turned(value, kind) {
  const [, number, unit] = /^([\d.eE+-]+)\s*(rpm|1\/min|s|ms)$/.exec(value ?? "") ?? [];
  const [times, written] = kind === "period" ? [{ rpm: 60, "1/min": 60 }[unit], "s"] : [{ s: 60, ms: 60_000 }[unit], "rpm"];
  const turns = times / Number(number);
  return Number.isFinite(turns) ? `${Number(turns.toPrecision(5))} ${written}` : SPEEDS[kind];
}

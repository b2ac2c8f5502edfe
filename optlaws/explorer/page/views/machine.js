// The mechanism of the machine and its torque: the mechanism that moves with torque over speed, over the ratio and over the
// input, and torque, power and speed over the cycle for each law.

import { createChart } from "../chart.js";
import { Latest } from "../latest.js";
import { spanOf } from "../layers.js";
import { column, growing, head, laidOut, panel, part, picture, status, swatch, tabs } from "../layout.js";
import { beside, changeAll, removeAxis } from "../machine_forms.js";
import { createMechanism } from "../mechanism.js";
import { createPanels, createRun, createStrip } from "../panels.js";
import { showTrust, table } from "../report.js";
import { button, html, renew } from "../svg.js";
import { chips, standard } from "../tray.js";
import { headed, number, written } from "../units.js";
import { same } from "../views.js";

const PICTURES = { speed: "torque over speed", ratio: "over the ratio", input: "J and T" };
const LEAST = "What no law that never turns back can beat in each move";
const MOST = 4;
const MOST_AXES = 8;
const SLOW = 4; // s that a cycle takes as it is played
const SPAN = 3; // ratios from a third of the present one to three times it
const NEAR = 1.2;
const MOVES = ["rise", "return", "move"];

export function createView(root, study, { programme }) {
  const files = ["python", "problem", "table"];
  let stateShown = null;
  let current = null;
  let least = [];
  let over = null;
  let asked = null;
  let due = false;
  let span = null;
  let optimum = null; // the last answer with optimal laws, and the question that it answers
  const orders = new WeakMap(); // of questions: the one asked later, or for the optimum, is shown over another
  let order = 0;
  let shown = 0;
  let still = () => {};
  const at = laidOut(root,
    column("machine-middle", "The mechanism and its torque", part("machine-tray", { class: "tray", role: "group", "aria-label": "Laws side by side" }), status("machine-trust"),
      growing(picture("machine-drawing"), part("machine-turning")),
      growing(head(part("machine-pictures", { role: "tablist", "aria-label": "Pictures of the machine" }), html("p", { id: "machine-words", class: "quiet" })), picture("machine-chart"), part("machine-input"))),
    column("machine-right", "Torque, power and speed over the cycle", panel("machine-curves"),
      panel("machine-table", { class: "panel scrolled", tabindex: "0", role: "group", "aria-label": "What the laws ask of the drive" })),
  );
  const linkage = createMechanism(at.drawing);
  const chart = createChart(at.chart, moved);
  const input = createPanels(at.input);
  const curves = createPanels(at.curves, { strip: createStrip({ chosen: () => {} }) });
  const chooses = tabs(at.pictures, PICTURES, (key) => study.change("machine picture", (state) => (state.machinePicture = key)));
  playing();
  const machines = new Latest("api/machine", solved);
  const earlier = new Latest("api/machine", evaluated, solve);
  const limits = new Latest("api/machine-limits", (answer, question) => isOfNow(question) && bounded(answer), () => bounded({ moves: [] }));
  const ratios = new Latest("api/machine-ratios", (answer, question) => same(question, asked) && swept(answer), (error) => swept({ ratios: [], words: error.message }));

  /** The request to the server, of which files are made too. */
  function request({ machine, axis }) {
    return { study: machine, axis };
  }

  function show(state) {
    stateShown = state;
    tray(state);
    const picture = pictureOf(state);
    chooses(picture);
    at.chart.hidden = picture === "input";
    at.input.hidden = picture !== "input";
    if (picture === "ratio") sweep(state);
    order += 1;
    const laws = lawsBefore(state);
    if (laws) ask(earlier, { study: state.machine, axis: state.axis, laws }, 2 * order);
    else solve();
    draw();
  }

  function ask(latest, question, order) {
    orders.set(question, order);
    latest.ask(question);
  }

  /** Ask for the optimal laws of what is set now, and for what takes as long. */
  function solve() {
    const { machine, axis } = stateShown;
    ask(machines, { study: machine, axis }, 2 * order + 1);
    if (due) ratios.ask(asked);
    due = false;
  }

  /** The optimal laws of the values before, if the machine alone has changed since, so that others are to be found. */
  function lawsBefore(state) {
    if (!optimum) return null;
    const { answer: { limiting, optima }, question } = optimum;
    const now = { study: state.machine, axis: state.axis };
    return same(likeness(now), likeness(question)) && !same(driving(now, limiting), driving(question, limiting)) ? optima : null;
  }

  function solved(answer, question) {
    if (!answer.refused) optimum = answer.optima ? { answer, question } : null;
    answered(answer, question);
  }

  /** What the laws before do in the machine as it is now; their optimum is looked for as soon as nothing newer is asked. */
  function evaluated(answer, question) {
    if (!answer.refused) answered(answer, question);
    if (!earlier.behind && isOfNow(question)) solve();
  }

  function pictureOf({ machinePicture }) {
    return Object.hasOwn(PICTURES, machinePicture) ? machinePicture : "speed";
  }

  function isOfNow(question) {
    return same(question.study, stateShown.machine) && question.axis === stateShown.axis;
  }

  function answered(answer, question) {
    const order = orders.get(question);
    if (order < shown) return;
    shown = order;
    current = answer;
    least = [];
    // while a drag goes on the newest answer alone is looked at closer
    if (!question.laws && !answer.refused && !machines.behind) limits.ask(question);
    showTrust(at.trust, answer);
    linkage.show(answer.refused ? null : answer.drawing);
    still();
    tray(stateShown);
    draw();
  }

  function bounded({ moves }) {
    least = moves;
    draw();
  }

  /** Curves, table and picture of what is known. */
  function draw() {
    if (!current) return;
    const { refused, panels, over_input: overInput } = current;
    curves.show(refused ? current : { ...current, panels: panels.map((panel, i) => (i === 0 ? { ...panel, series: [...panel.series, ...leastLines()] } : panel)) });
    at.table.replaceChildren(...(refused ? [] : [driveTable(current, names()), ...(least.length ? [table(LEAST, ["in the move", "peak", "lower bound", "RMS", "lower bound"], least.map(({ name, peak, rms }) => [name, ...peak, ...rms]))] : [])]));
    input.show(refused ? current : overInput);
    const picture = pictureOf(stateShown);
    at.words.textContent = { speed: "dashed: continuous torque", ratio: over?.words ?? "computing …", input: "" }[picture];
    if (picture === "speed") chart.show(refused ? null : overSpeed());
    if (picture === "ratio") chart.show(refused ? null : overRatio());
  }

  function names() {
    return beside(stateShown.machine, stateShown.axis).map(({ name }) => name);
  }

  /** The least peak of each move, on both sides, as lines over its time. */
  function leastLines() {
    const known = least.filter(({ peak: [, least] }) => least !== null);
    return [1, -1].filter(() => known.length).map((side) => ({
      law: "limit", name: "no law that never turns back has a lower peak in this move",
      at: known.flatMap(({ at }) => [...at, at[1]]), values: known.flatMap(({ peak: [, least] }) => [side * least, side * least, null]),
    }));
  }

  // --- laws side by side ---

  function tray(state) {
    const { machine, axis } = state;
    const laws = beside(machine, axis).slice(0, MOST);
    const places = laws.map((law) => machine.axis.indexOf(law));
    const titles = laws.map(({ name }, i) => (current?.laws?.[i]?.refused ? `${name} (${current.laws[i].refused.word})` : name));
    const shown = chips(titles, places.indexOf(axis), (i) => study.change("axis", (next) => (next.axis = places[i])), (i) => study.change(`remove axis ${i}`, (next) => removeAxis(next, places[i], programme.interlocks)));
    const others = machine.axis.map((one, i) => [one, i]).filter(([one]) => !beside(machine, axis).includes(one)).map(([one, i]) => button(one.name, () => study.change("axis", (next) => (next.axis = i)), { class: "quiet-button", title: "Another machine of this study" }));
    const full = laws.length >= MOST || machine.axis.length >= MOST_AXES;
    renew(at.tray, ...shown, ...(full ? [] : adding()), ...others);
  }

  function adding() {
    const optimal = button("+ optimal", () => add("least RMS torque", (axis) => {
      axis.minimise = axis.minimise === "rms torque" && !axis.segment.some(({ law }) => law) ? "torque" : "rms torque";
      for (const segment of axis.segment) delete segment.law;
      if (axis.minimise === "torque") axis.name = "least peak torque";
    }), { class: "quiet-button", title: "The law of the least torque beside" });
    return [optimal, standard("Add a standard law to the machine", (law) => add(law, (axis) => {
      for (const segment of axis.segment) if (MOVES.includes(segment.kind)) segment.law = law;
    }))];
  }

  function add(name, alter) {
    study.change(`add ${name}`, (state) => {
      const axis = structuredClone(state.machine.axis[state.axis]);
      axis.name = name;
      alter(axis);
      const taken = state.machine.axis.map((one) => one.name);
      for (let i = 2; taken.includes(axis.name); i += 1) axis.name = `${name} ${i}`;
      delete axis.export;
      state.axis = state.machine.axis.push(axis) - 1;
    });
  }

  // --- pictures that are dragged ---

  /** Torque over speed at the motor, whose limits are dragged. */
  function overSpeed() {
    const { over_speed: known, active } = current;
    if (!known) return null;
    const { courses, greatest, motor } = known;
    const speeds = courses.flatMap((course) => course.speeds);
    const torques = courses.flatMap((course) => course.torques);
    const most = 1.18 * Math.max(1e-9, ...torques.map(Math.abs), motor.rated_torque ?? 0, ...(motor.curves.peak ?? []).map(([, torque]) => torque));
    const fastest = 1.12 * Math.max(1e-9, ...speeds.map(Math.abs), motor.greatest_speed ?? 0);
    const back = Math.min(...speeds) < -1e-6 * fastest;
    const sides = (points, name) => [1, -1].flatMap((side) => (back ? [1, -1] : [1]).map((way) => ({ name, points: points.map(([speed, torque]) => [way * speed, side * torque]) })));
    const lines = [
      ...Object.entries(motor.curves).flatMap(([name, points]) => sides(points, `motor-${name}`)),
      ...courses.map(({ law, speeds: at, torques: values }) => ({ name: `line law-${law}${law === active ? " active" : ""}`, title: names()[law], points: at.map((speed, i) => [speed, values[i]]) })),
    ];
    if (motor.greatest_speed !== null) lines.push({ name: "motor-peak", points: [[motor.greatest_speed, -most], [motor.greatest_speed, most]] });
    return {
      x: { name: headed("speed of the motor", "rpm"), range: [back ? -fastest : 0, fastest] },
      y: { name: "torque, N m", range: [-most, most] },
      lines, handles: motorHandles(motor, most, fastest),
      told: `Torque over speed at the motor; the greatest torque is ${number(greatest.torque)} N m, the greatest speed ${written({ value: greatest.speed, unit: "rpm", digits: 6 })}`,
    };
  }

  function motorHandles(motor, most, fastest) {
    const handle = (key, at, along, label, unit) => {
      const size = 10 ** Math.floor(Math.log10(along === "x" ? fastest : most) - 2);
      const value = at[along === "x" ? 0 : 1];
      return { key, at, along, label, low: size, high: 10 * (along === "x" ? fastest : most), step: size, text: written({ value, unit, digits: 4 }), name: "of-motor" };
    };
    const end = motor.greatest_speed ?? fastest;
    const found = [];
    if (motor.peak_torque !== null && !motor.corners.length) found.push(handle("peak_torque", [0.5 * end, motor.peak_torque], "y", "Peak torque of the motor", "N m"));
    if (motor.rated_torque !== null) found.push(handle("rated_torque", [0.25 * end, motor.rated_torque], "y", "Rated torque of the motor", "N m"));
    if (motor.greatest_speed !== null && !motor.corners.length) found.push(handle("greatest_speed", [motor.greatest_speed, 0], "x", "Greatest speed of the motor", "rpm"));
    motor.corners.forEach((corner, i) => found.push(handle(`curve ${i}`, corner, "y", `Peak torque of the motor at ${written({ value: corner[0], unit: "rpm", digits: 4 })}`, "N m")));
    return found;
  }

  /** What is to be asked of the ratios around the present one; a drag within them asks nothing new. */
  function sweep(state) {
    const axis = state.machine.axis[state.axis];
    const ratio = Number(axis.drive?.ratio ?? 1);
    const [low, high] = span ?? [0, 0];
    if (ratio < NEAR * low || ratio > high / NEAR) span = [ratio / SPAN, SPAN * ratio].map((value) => Number(value.toPrecision(2)));
    const study = structuredClone(state.machine);
    for (const one of beside(study, state.axis)) if (one.drive) delete one.drive.ratio;
    const question = { study, axis: state.axis, low: span[0], high: span[1] };
    if (same(question, asked)) return;
    asked = question;
    over = null;
    due = true;
  }

  function swept(answer) {
    over = answer;
    draw();
  }

  function overRatio() {
    const { active, rows } = current;
    const axis = stateShown.machine.axis[stateShown.axis];
    const ratio = Number(axis.drive?.ratio ?? 1);
    if (!axis.drive?.motor || !(ratio > 0)) return null;
    const now = (name) => rows.find((row) => row.name === name)?.values[active] ?? null;
    const { ratios = [], laws = [], bound = [], fits = [] } = over ?? {};
    const of = over?.of === "peak" ? "peak" : "rms";
    const value = now(of === "peak" ? "peak torque" : "RMS torque") ?? 0;
    const along = (values) => ratios.map((one, i) => [one, values[i]]);
    const lines = laws.flatMap((law, i) => [
      { name: `line law-${i}${i === active ? " active" : ""}`, title: `${names()[i]}: RMS torque`, points: along(law.rms) },
      { name: `line thin law-${i}`, title: `${names()[i]}: peak torque`, points: along(law.peak) },
    ]);
    if (bound.some((one) => one !== null)) lines.push({ name: "limit", title: "lower bound", points: along(bound) });
    const [low, high] = span;
    const shown = [value, ...laws.flatMap((law) => [...law.rms, ...law.peak])];
    const mine = laws[active];
    const labels = mine && ratios.length ? [["rms", "RMS"], ["peak", "peak"]].map(([name, text]) => ({ at: [ratios.at(-1), mine[name].at(-1) ?? 0], text, anchor: "end", up: 7 })) : [];
    const marks = mine ? ratios.map((one, i) => ({ at: [one, mine[of][i]], name: fits[i] === false ? "front-point too-weak" : "front-point", title: fits[i] === false ? "the motor is too weak" : "" })).filter(({ at }) => at[1] !== null) : [];
    return {
      x: { name: "ratio of the gear", range: [low, high], log: true },
      y: { name: "torque at the motor, N m", range: spanOf(shown) },
      lines, labels, marks,
      handles: [{ key: "ratio", at: [ratio, value], along: "x", low: 0.1, high: 1000, step: Number((low / 200).toPrecision(1)), label: "Ratio of the gear", text: `ratio ${number(ratio, "", 4)}, ${of === "peak" ? "peak" : "RMS"} torque ${number(value, "", 4)} N m`, name: `law-${active}` }],
      told: `Torque at the motor over the ratio of the gear; at ${number(ratio, "", 4)} it is ${number(value, "", 4)} N m. ${over?.words ?? ""}`,
    };
  }

  function moved(key, value) {
    if (value === null) return study.rest();
    if (key === "ratio") return changeAll(study, "ratio", (axis) => (axis.drive.ratio = value));
    const [name, corner] = key.split(" ");
    return changeAll(study, key, ({ drive }) => {
      if (corner !== undefined) drive.motor.curve[Number(corner)][1] = `${value} N m`;
      else drive.motor[name] = `${value} ${name === "greatest_speed" ? "rpm" : "N m"}`;
    });
  }

  // --- the cycle as it runs ---

  function playing() {
    const { cursor } = curves;
    const reading = html("span", { class: "reading quiet" });
    const show = (time) => {
      const drawing = current?.drawing;
      if (!drawing) return;
      const share = Math.min(1, Math.max(0, time / drawing.duration));
      linkage.at(share);
      const input = drawing.input[Math.round(share * (drawing.input.length - 1))];
      reading.textContent = `${Math.round(time)} ms · ${written({ value: input, unit: drawing.axis === "angle" ? "deg" : "mm", digits: 4 })}`;
    };
    still = () => show(cursor.at ?? 0);
    cursor.watch((time) => time !== null && show(time));
    createRun(at.turning, "Time in the cycle, thousandths", cursor, { text: "Play", end: () => current?.drawing?.duration ?? 1, steps: 1000, seconds: SLOW, spoken: () => reading.textContent });
    at.turning.append(reading);
  }

  return { files, moves: true, drawings: "#machine-curves svg", request, show };
}

/** What laws are found for, without the numbers of the machine and of its motion. */
function likeness({ study, axis }) {
  const laws = beside(study, axis).map(({ name, minimise, order, degree, load, limits, segment, mechanism, drive }) => [
    name, minimise, order, degree, load, limits, segment.map(({ kind, law }) => [kind, law]), mechanism?.kind, Boolean(drive?.motor),
  ]);
  return [laws, axis];
}

/** The numbers of the machine and of its motion, without those of the motor that change no optimum. */
function driving({ study, axis }, limiting) {
  const { speed, period } = study;
  const axes = structuredClone(beside(study, axis));
  for (const { drive } of axes) for (const name of limiting) delete drive?.motor?.[name];
  return [speed, period, axes];
}

function driveTable({ rows, active }, names) {
  const cells = rows.map(({ name, unit, values }) => [headed(name, unit), ...values.map((value) => (value === null ? null : number(value, unit)))]);
  const look = (i, j) => {
    const over = rows[i].over[j - 1];
    return { class: [over && "over", j - 1 === active && "active"].filter(Boolean).join(" "), title: over ? "the motor is too weak" : null };
  };
  return table("What each law asks of the drive", ["at the drive", ...names.slice(0, MOST).map((name, i) => swatch(i, name))], cells, { right: true, look, line: (i) => ({ title: rows[i].note || null }) });
}

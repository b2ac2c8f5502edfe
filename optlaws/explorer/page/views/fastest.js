// The view of least times: moves or a cycle with their limits on the left; the time that is given, from the proven least
// on, and the front of what is least in it, in the middle; on the right the motion, drawn by the limit that is nearest.

import { createChart } from "../chart.js";
import { choice, createForm } from "../form.js";
import { Latest } from "../latest.js";
import { spanOf } from "../layers.js";
import { column, group, growing, head, laidOut, panel, part, picture, status } from "../layout.js";
import { createPanels, createStrip } from "../panels.js";
import { showTrust, table } from "../report.js";
import { button, html, svg } from "../svg.js";
import { valueAt } from "../timing.js";
import { headed, number, shownUnit, written } from "../units.js";
import { same } from "../views.js";

const OWN = ["stroke", "start_velocity", "end_velocity", "start"];
const LONGEST = 2; // times the least, where a front has no end of its own
const FINEST = 1e-4; // s
export function createView(root, study, { move, space, examples, mechanisms, drive }) {
  const files = ["problem", "proof"];
  let stateShown = null;
  let current = null;
  let frontShown = null;
  let asked = null;
  const declared = Object.fromEntries(move.map((entry) => [entry.name, entry]));
  const of = choice("least time of", { "": "the cycle", moves: "moves of their own" }, "", (value) => study.change("least time of", (state) => {
    delete state.time;
    if (value) state.fastest = structuredClone(examples.moves);
    else delete state.fastest;
  }));
  const form = html("div", {}, group("Least time of", of), html("div"));
  const at = { of, form: form.lastElementChild, ...laidOut(root,
    column("fastest-middle", "The least time and what longer times save", status("fastest-trust"), panel("fastest-timing", { class: "panel timing-of-motion" }),
      growing(head(part("fastest-objective"), html("p", { id: "fastest-words", class: "quiet" })), picture("fastest-chart")),
      panel("fastest-legend", { role: "group", "aria-label": "Which limit is nearest" })),
    column("fastest-right", "The motion with its limits", panel("fastest-curves"), panel("fastest-table", { class: "panel scrolled", tabindex: "0", role: "group", "aria-label": "What is taken of each limit" })),
  ) };
  const fieldsForm = createForm(change, () => study.rest());
  const panels = createPanels(at.curves, { strip: createStrip({ chosen: () => {} }) });
  const chart = createChart(at.chart, (_, value) => (value === null ? study.rest() : give(value / 1000)));
  const answers = new Latest("api/fastest", answered);
  const fronts = new Latest("api/fastest-front", (front, question) => same(question, asked) && swept(front), (error) => swept({ points: [], words: error.message }));
  timing();

  /** The request to the server, of which files are made too. */
  function request(state) {
    const { fastest, machine, time, axis } = state;
    return { study: fastest ?? machine, axis: fastest ? numberOf(state) : axis, ...(time > 0 && { time }) };
  }

  function show(state) {
    stateShown = state;
    const { fastest: moves } = state;
    at.form.hidden = !moves;
    at.of.value = moves ? "moves" : "";
    if (moves) showForm(moves, entries(state));
    const { time: _, ...question } = request(state);
    answers.ask(request(state));
    if (!same(question, asked)) {
      asked = question;
      frontShown = null;
      fronts.ask(question);
    }
    draw();
  }

  function numberOf({ fastest, move }) {
    return Number.isInteger(move) && move >= 0 && move < fastest.move.length ? move : 0;
  }

  function entries(state) {
    return state.fastest.move[numberOf(state)];
  }

  /** Change the move that is shown and the laws of all. */
  function change(what, alter) {
    study.change(what, (state) => {
      const table = { ...entries(state), problem: state.fastest.problem ?? {} };
      alter(table);
      const { problem, ...move } = table;
      if (Object.keys(problem ?? {}).length) state.fastest.problem = problem;
      else delete state.fastest.problem;
      move.limits ??= {};
      state.fastest.move[numberOf(state)] = move;
    });
  }

  function showForm(moves, move) {
    const { mechanism, drive, follower } = move;
    const shape = [moves.move.map(({ name }) => name), mechanism?.kind, Boolean(drive), Boolean(drive?.motor), Boolean(follower), numberOf(stateShown)];
    fieldsForm.draw(at.form, shape, { ...move, problem: moves.problem ?? {} }, () => build(moves, move));
  }

  function build(moves, move) {
    const several = choice("move", { ...moves.move.map(({ name }) => name) }, numberOf(stateShown), (i) => study.change("move", (state) => {
      state.move = Number(i);
      delete state.time;
    }));
    const { limits, follower, front } = declared;
    const limited = limits.entries.filter(({ name }) => (!name.includes("torque") || move.drive) && (!name.startsWith("residual") || move.follower));
    const fields = (entry, entries = entry.entries) => fieldsForm.fields(entries, [entry.name], []);
    const driven = drive.filter(({ name }) => name !== "motor" || move.drive?.motor);
    return [
      group("Move", several, ...fieldsForm.fields(OWN.map((name) => declared[name]))),
      group("At most", ...fields(limits, limited)),
      group("Laws", ...fieldsForm.fields(space, ["problem"], [])),
      ...(move.mechanism ? [group("Mechanism", ...fieldsForm.fields(mechanisms[move.mechanism.kind]?.fields ?? [], ["mechanism"], []))] : []),
      ...(move.drive ? [group("Drive", ...fieldsForm.fields(driven, ["drive"], []))] : []),
      group("What vibrates", ...fields(follower)),
      group("Front", ...fields(front, front.entries.filter(({ name }) => name === "longest"))),
    ];
  }

  // --- the time that is given ---

  /** Give the motion a time; the least is given by none. */
  function give(time) {
    const least = current?.least?.time ?? 0;
    study.change("time", (state) => {
      if (time > least * (1 + 1e-6)) state.time = Number(time.toPrecision(7));
      else delete state.time;
    });
  }

  /** One slider of the time, whose stop is the proven least, and beside it the time and the speed as numbers. */
  function timing() {
    const slide = html("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": "Time of the motion" });
    const entered = (title, of) => {
      const field = html("input", { type: "number", min: 0, step: "any", "aria-label": title });
      field.addEventListener("change", () => Number(field.value) > 0 && give(of(Number(field.value))));
      return field;
    };
    const time = entered("Time of the motion, ms", (value) => value / 1000);
    const speed = entered("Motions a minute", (value) => 60 / value);
    const stop = button("least", () => give(0), { title: "The proven least time" });
    slide.addEventListener("input", () => {
      const [least, longest] = reach();
      give(least * (longest / least) ** (Number(slide.value) / 1000));
    });
    slide.addEventListener("change", () => study.rest());
    at.timing.replaceChildren(stop, slide, html("label", {}, time, " ms"), html("label", {}, speed, " / min"));
    at.showTime = () => {
      const [least, longest] = reach();
      const now = current?.time ?? least;
      slide.value = Math.round((1000 * Math.log(now / least)) / Math.log(longest / least)) || 0;
      slide.setAttribute("aria-valuetext", `${number(1000 * now, "", 5)} ms, ${number(60 / now, "", 5)} a minute; the least is ${current?.least?.text ?? ""} ms`);
      if (document.activeElement !== time) time.value = Number((1000 * now).toPrecision(6));
      if (document.activeElement !== speed) speed.value = Number((60 / now).toPrecision(6));
    };
  }

  /** The least time and the longest that is shown, s. */
  function reach() {
    const least = current?.least?.time ?? 1;
    const last = frontShown?.points?.at(-1)?.[0] ?? 0;
    const now = current?.time ?? least;
    return [least, Math.max(last > least ? last : LONGEST * least, now)];
  }

  function answered(answer) {
    current = answer;
    showTrust(at.trust, answer);
    draw();
  }

  function swept(front) {
    frontShown = front;
    draw();
  }

  function draw() {
    const answer = current;
    if (!answer) return;
    panels.show(answer.refused ? answer : { ...answer, panels: coloured(answer) });
    at.table.replaceChildren(...(answer.refused ? [] : [taken(answer)]));
    at.legend.replaceChildren(...(answer.refused ? [] : legend(answer)));
    at.timing.hidden = Boolean(answer.refused);
    at.words.textContent = answer.refused ? "" : [answer.note, frontShown?.words ?? "computing …"].filter(Boolean).join(" · ");
    at.objective.replaceChildren(...objective());
    chart.show(answer.refused || !frontShown?.points?.length ? null : pictured());
    if (!answer.refused) at.showTime();
  }

  function objective() {
    const { objectives = [], minimise } = current;
    if (!objectives.length) return [];
    const options = Object.fromEntries([...(minimise ? [] : [["", "nothing"]]), ...objectives.map((value) => [value, `least ${value}`])]);
    return [choice("what is least in longer times", options, minimise ?? "", (value) => change("objective", (move) => {
      const others = (move.front?.minimise ?? []).filter((name) => name !== value);
      move.front = { ...move.front, minimise: [value, ...others].slice(0, 6) };
    }))];
  }

  /** The front over the time, with the times that no law and no law of this space beats. */
  function pictured() {
    const { least, time, rows, minimise } = current;
    const { points, name, unit, proven } = frontShown;
    const { unit: shown, factor } = shownUnit(unit);
    const known = points.filter(([, value]) => value !== null).map(([at, one, bound]) => [at, factor * one, bound === null ? null : factor * bound]);
    const values = known.map(([, value]) => value);
    const [from, to] = reach();
    const first = least.best_possible === null ? from : Math.min(from, least.best_possible);
    const x = { name: "time, ms", range: [1000 * (first - 0.06 * (to - first)), 1000 * (to + 0.02 * (to - first))] };
    const y = { name: headed(name, unit), range: spanOf([...values, 0]) };
    const top = y.range[1];
    const value = known.length ? valueAt(known.map(([at]) => at), values, time) : 0; // on the line of the front; what is read is the law's own
    const lines = [
      { name: "limit", title: `no law of the space has a lower ${name}`, points: known.filter(([, , bound]) => bound !== null).map(([at, , bound]) => [1000 * at, bound]) },
      { name: proven ? "front" : "front local", title: `least ${name}`, points: known.map(([at, one]) => [1000 * at, one]) },
      { name: "stop", title: "the proven least time", points: [[1000 * from, y.range[0]], [1000 * from, top]] },
      ...(least.best_possible === null ? [] : [{ name: "limit", title: "no law of any degree is faster", points: [[1000 * least.best_possible, y.range[0]], [1000 * least.best_possible, top]] }]),
    ];
    const labels = [{ at: [1000 * from, top], text: "proven least time", up: -4 }, ...(least.best_possible === null || from - least.best_possible < 0.09 * (to - first) ? [] : [{ at: [1000 * least.best_possible, top], text: "no law", up: -4 }])].map((one) => ({ ...one, at: [one.at[0] + 0.008 * (x.range[1] - x.range[0]), one.at[1]] }));
    const row = rows.find((one) => one.name.toLowerCase() === minimise);
    const here = row ? written(row.value) : `${number(value, "", 5)} ${shown}`;
    return {
      x, y, lines, labels,
      marks: known.map(([at, one]) => ({ at: [1000 * at, one], name: "front-point", title: `${number(1000 * at, "", 5)} ms: ${number(one, "", 5)} ${shown}` })),
      handles: [{ key: "time", at: [1000 * time, value], along: "x", low: 1000 * from, high: 1000 * LONGEST * to, step: 1000 * FINEST, label: "Time of the motion", text: `${number(1000 * time, "", 5)} ms, ${name} ${here}`, name: "law-0" }],
      told: `${name} over the time: from ${number(values[0] ?? 0, "", 5)} ${shown} in ${least.text} ms to ${number(values.at(-1) ?? 0, "", 5)} ${shown} in ${number(1000 * to, "", 5)} ms; now ${number(1000 * time, "", 5)} ms`,
    };
  }

  return { files, moves: true, drawings: "#fastest-curves svg", request, show, form };
}

/** The curves with a series for each limit, where most is taken of that one. */
function coloured({ panels, segments }) {
  return panels.map((panel) => {
    const [curve] = panel.series;
    const parts = segments.map(({ at: [from, to], law }) => {
      const [start, stop] = [curve.at.findIndex((at) => at >= from), curve.at.findLastIndex((at) => at <= to) + 2]; // on to the first place of the next one
      return { law: `bind-${law}`, at: curve.at.slice(start, stop), values: curve.values.slice(start, stop) };
    });
    return { ...panel, series: [curve, ...parts] };
  });
}

/** How the curves are drawn where most is taken of each limit. */
function legend({ shares }) {
  const items = shares.map(({ name, text, full }, i) => html("span", { class: "limit-key" }, svg("svg", { width: 30, height: 10, "aria-hidden": "true" }, svg("path", { class: `line law-bind-${i}`, d: "M0 5H30" })), ` ${name}: ${text} %${full ? ", binds" : ""}`));
  return [html("p", { class: "quiet", text: "The curves are drawn by the limit of which most is taken; above them stands where it is which." }), ...items];
}

function taken({ rows }) {
  const cells = rows.map(({ name, value, text, full }) => [name, value, text && `${text} %${full ? " binds" : ""}`]);
  return table("What is taken of each limit", ["", "value", "of the limit"], cells, { look: (i, j) => ({ class: j === 2 && rows[i].full ? "best" : null }) });
}

// The view of least times: moves or a cycle with their limits on the left; the time that is given, from the proven least
// on, and the front of what is least in it, in the middle; on the right the motion, drawn by the limit that is nearest.

import { Chart, spanOf } from "../chart.js";
import { Form, choice, flat } from "../form.js";
import { Latest } from "../latest.js";
import { column, group, growing, head, laidOut, panel, part, picture, status } from "../layout.js";
import { Panels } from "../panels.js";
import { showTrust, table } from "../report.js";
import { Strip } from "../strip.js";
import { html, svg } from "../svg.js";
import { headed, number, shownUnit, written } from "../units.js";
import { same } from "../views.js";

const OWN = ["stroke", "start_velocity", "end_velocity", "start"];
const LONGEST = 2; // times the least, where a front has no end of its own
const FINEST = 1e-4; // s
export class View {
  files = ["problem", "proof"];
  moves = true;
  drawings = "#fastest-curves svg";
  #study;
  #state = null;
  #at;
  #fields;
  #declared;
  #space;
  #shape = "";
  #paths = [];
  #panels;
  #chart;
  #answers;
  #fronts;
  #answer = null;
  #front = null;
  #asked = null;

  constructor(root, study, { move, space, examples }) {
    this.#space = space;
    this.#declared = Object.fromEntries(move.map((entry) => [entry.name, entry]));
    this.#study = study;
    const of = choice("least time of", { "": "the cycle", moves: "moves of their own" }, "", (value) => study.change("least time of", (state) => {
      delete state.time;
      if (value) state.fastest = structuredClone(examples.moves);
      else delete state.fastest;
    }));
    this.form = html("div", {}, group("Least time of", of), html("div"));
    this.#at = { of, form: this.form.lastElementChild, ...laidOut(root,
      column("fastest-middle", "The least time and what longer times save", status("fastest-trust"), panel("fastest-timing", { class: "panel timing-of-motion" }),
        growing(head(part("fastest-objective"), html("p", { id: "fastest-words", class: "quiet" })), picture("fastest-chart")),
        panel("fastest-legend", { role: "group", "aria-label": "Which limit is nearest" })),
      column("fastest-right", "The motion with its limits", panel("fastest-curves"), panel("fastest-table", { class: "panel scrolled", tabindex: "0", role: "group", "aria-label": "What is taken of each limit" })),
    ) };
    this.#fields = new Form((what, alter) => this.#change(what, alter), () => study.rest());
    this.#panels = new Panels(this.#at.curves, { strip: new Strip({ chosen: () => {} }) });
    this.#chart = new Chart(this.#at.chart, (_, value) => (value === null ? study.rest() : this.#give(value / 1000)));
    this.#answers = new Latest("api/fastest", (answer) => this.#answered(answer));
    this.#fronts = new Latest("api/fastest-front", (front, question) => same(question, this.#asked) && this.#swept(front), (error) => this.#swept({ points: [], words: error.message }));
    this.#timing();
  }

  /** The request to the server, of which files are made too. */
  request(state) {
    const { fastest, machine, time, axis } = state;
    return { study: fastest ?? machine, axis: fastest ? this.#number(state) : axis, ...(time > 0 && { time }) };
  }

  show(state) {
    this.#state = state;
    const { fastest: moves } = state;
    this.#at.form.hidden = !moves;
    this.#at.of.value = moves ? "moves" : "";
    if (moves) this.#form(moves, this.#entries(state));
    const { time: _, ...question } = this.request(state);
    this.#answers.ask(this.request(state));
    if (!same(question, this.#asked)) {
      this.#asked = question;
      this.#front = null;
      this.#fronts.ask(question);
    }
    this.#draw();
  }

  #number({ fastest, move }) {
    return Number.isInteger(move) && move >= 0 && move < fastest.move.length ? move : 0;
  }

  #entries(state) {
    return state.fastest.move[this.#number(state)];
  }

  /** Change the move that is shown and the laws of all. */
  #change(what, alter) {
    this.#study.change(what, (state) => {
      const table = { ...this.#entries(state), problem: state.fastest.problem ?? {} };
      alter(table);
      const { problem, ...move } = table;
      if (Object.keys(problem ?? {}).length) state.fastest.problem = problem;
      else delete state.fastest.problem;
      move.limits ??= {};
      state.fastest.move[this.#number(state)] = move;
    });
  }

  #form(study, move) {
    const machine = flat({ mechanism: move.mechanism ?? {}, drive: move.drive ?? {} }).map((path) => JSON.stringify(path));
    // a field that is emptied stays until the move is another one
    const shape = JSON.stringify([study.move.map(({ name }) => name), Boolean(move.drive), this.#number(this.#state)]);
    if (shape !== this.#shape || machine.some((path) => !this.#paths.includes(path))) [this.#shape, this.#paths] = [shape, machine];
    this.#fields.draw(this.#at.form, [shape, this.#paths], { ...move, problem: study.problem ?? {} }, () => this.#build(study, move, this.#paths.map((path) => JSON.parse(path))));
  }

  #build(study, move, machine) {
    const several = choice("move", { ...study.move.map(({ name }) => name) }, this.#number(this.#state), (i) => this.#study.change("move", (state) => {
      state.move = Number(i);
      delete state.time;
    }));
    const { limits, follower, front } = this.#declared;
    const limited = limits.entries.filter(({ name }) => (!name.includes("torque") || move.drive) && (!name.startsWith("residual") || move.follower));
    const fields = (entry, entries = entry.entries) => this.#fields.fields(entries, [entry.name], []);
    const of = (part) => machine.filter(([first]) => first === part).map((path) => this.#fields.field({ path, placeholder: "", label: path.slice(1).join(" ").replaceAll("_", " ") }));
    return [
      group("Move", several, ...this.#fields.fields(OWN.map((name) => this.#declared[name]))),
      group("At most", ...fields(limits, limited)),
      group("Laws", ...this.#fields.fields(this.#space, ["problem"], [])),
      ...(machine.length ? [group("Mechanism", ...of("mechanism")), group("Drive", ...of("drive"))] : []),
      group("What vibrates", ...fields(follower)),
      group("Front", ...fields(front, front.entries.filter(({ name }) => name === "longest"))),
    ];
  }

  // --- the time that is given ---

  /** Give the motion a time; the least is given by none. */
  #give(time) {
    const least = this.#answer?.least?.time ?? 0;
    this.#study.change("time", (state) => {
      if (time > least * (1 + 1e-6)) state.time = Number(time.toPrecision(7));
      else delete state.time;
    });
  }

  /** One slider of the time, whose stop is the proven least, and beside it the time and the speed as numbers. */
  #timing() {
    const slide = html("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": "Time of the motion" });
    const entered = (title, of) => {
      const field = html("input", { type: "number", min: 0, step: "any", "aria-label": title });
      field.addEventListener("change", () => Number(field.value) > 0 && this.#give(of(Number(field.value))));
      return field;
    };
    const time = entered("Time of the motion, ms", (value) => value / 1000);
    const speed = entered("Motions a minute", (value) => 60 / value);
    const stop = html("button", { type: "button", text: "least", title: "The proven least time", onclick: () => this.#give(0) });
    slide.addEventListener("input", () => {
      const [least, longest] = this.#reach();
      this.#give(least * (longest / least) ** (Number(slide.value) / 1000));
    });
    slide.addEventListener("change", () => this.#study.rest());
    this.#at.timing.replaceChildren(stop, slide, html("label", {}, time, " ms"), html("label", {}, speed, " / min"));
    this.#at.showTime = () => {
      const [least, longest] = this.#reach();
      const now = this.#answer?.time ?? least;
      slide.value = Math.round((1000 * Math.log(now / least)) / Math.log(longest / least)) || 0;
      slide.setAttribute("aria-valuetext", `${number(1000 * now, "", 5)} ms, ${number(60 / now, "", 5)} a minute; the least is ${this.#answer?.least?.text ?? ""} ms`);
      if (document.activeElement !== time) time.value = Number((1000 * now).toPrecision(7));
      if (document.activeElement !== speed) speed.value = Number((60 / now).toPrecision(7));
    };
  }

  /** The least time and the longest that is shown, s. */
  #reach() {
    const least = this.#answer?.least?.time ?? 1;
    const last = this.#front?.points?.at(-1)?.[0] ?? 0;
    const now = this.#answer?.time ?? least;
    return [least, Math.max(last > least ? last : LONGEST * least, now)];
  }

  #answered(answer) {
    this.#answer = answer;
    showTrust(this.#at.trust, answer);
    this.#draw();
  }

  #swept(front) {
    this.#front = front;
    this.#draw();
  }

  #draw() {
    const answer = this.#answer;
    if (!answer) return;
    this.#panels.show(answer.refused ? answer : { ...answer, panels: coloured(answer) });
    this.#at.table.replaceChildren(...(answer.refused ? [] : [taken(answer)]));
    this.#at.legend.replaceChildren(...(answer.refused ? [] : legend(answer)));
    this.#at.timing.hidden = Boolean(answer.refused);
    this.#at.words.textContent = answer.refused ? "" : [answer.note, this.#front?.words ?? "computing …"].filter(Boolean).join(" · ");
    this.#at.objective.replaceChildren(...this.#objective());
    this.#chart.show(answer.refused || !this.#front?.points?.length ? null : this.#picture());
    if (!answer.refused) this.#at.showTime();
  }

  #objective() {
    const { objectives = [], minimise } = this.#answer;
    if (!objectives.length) return [];
    const options = Object.fromEntries([...(minimise ? [] : [["", "nothing"]]), ...objectives.map((value) => [value, `least ${value}`])]);
    return [choice("what is least in longer times", options, minimise ?? "", (value) => this.#change("objective", (move) => {
      const others = (move.front?.minimise ?? []).filter((name) => name !== value);
      move.front = { ...move.front, minimise: [value, ...others].slice(0, 6) };
    }))];
  }

  /** The front over the time, with the times that no law and no law of this space beats. */
  #picture() {
    const { least, time, rows, minimise } = this.#answer;
    const { points, name, unit, proven } = this.#front;
    const { unit: shown, factor } = shownUnit(unit);
    const known = points.filter(([, value]) => value !== null).map(([at, one, bound]) => [at, factor * one, bound === null ? null : factor * bound]);
    const values = known.map(([, value]) => value);
    const [from, to] = this.#reach();
    const first = least.best_possible === null ? from : Math.min(from, least.best_possible);
    const x = { name: "time, ms", range: [1000 * (first - 0.06 * (to - first)), 1000 * (to + 0.02 * (to - first))] };
    const y = { name: headed(name, unit), range: spanOf([...values, 0]) };
    const top = y.range[1];
    const value = this.#valueAt(known, time);
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

  /** Where the handle stands: on the line of the front; what is read is the law's own. */
  #valueAt(points, time) {
    const i = points.findIndex(([at]) => at >= time);
    if (i < 0) return points.at(-1)?.[1] ?? 0;
    if (i === 0) return points[0][1];
    const [[from, low], [to, high]] = [points[i - 1], points[i]];
    return low + ((time - from) / (to - from)) * (high - low);
  }
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

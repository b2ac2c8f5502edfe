// The view of advice: which law the motion of a cycle or of a machine should have. Standard and optimal laws side by side
// with all their measures, the recommended one in two sentences, the front, and curves of it beside the usual law.

import { Chart, spanOf } from "../chart.js";
import { Form, choice, entry } from "../form.js";
import { Latest, unanswered } from "../latest.js";
import { column, fragment, group, growing, laidOut, panel, part, picture, status, swatch } from "../layout.js";
import { Panels } from "../panels.js";
import { marked, table } from "../report.js";
import { button, html, renew } from "../svg.js";
import { headed, number, shownUnit, written } from "../units.js";

const OBJECTIVES = ["", "acceleration", "jerk", "rms acceleration", "torque", "rms torque", "force", "rms force", "residual acceleration"];
const ASKED = { minimise: "", follower: { on: false, low: "27 Hz", high: "33 Hz", damping: 0.05 } };
const FOLLOWER = [["low", "from"], ["high", "to"], ["damping", "damping"]];
const MOVES = ["rise", "return", "move"];
const OPTIMAL = "optimal";
const LETTER = 0.022; // of the width of a picture
const LINE = 0.07; // of its height
const WIDE = 10; // values further apart are drawn by their logarithms
const PATIENCE = 120; // s that the laws have where the reader came here; an address that is opened has less
const POINTS = 6; // of the front
const MOST_BESIDE = 6;
const STEPS = ["standard laws", "optimal laws", "the front"];


export class View {
  files = ["table"];
  drawings = "#advice-side svg";
  #study;
  #state = null;
  #answer = null;
  #fields = new Form((what, alter) => this.#change(what, alter), () => this.#study.rest());
  #chart;
  #curves;
  #standard;
  #advice;
  #question = "";
  #step = 0; // of STEPS, that is under way
  #at;

  constructor(root, study) {
    this.#study = study;
    this.form = this.#build();
    this.#at = laidOut(root,
      column("advice-middle", "Laws side by side", status("advice-words"), panel("advice-table")),
      column("advice-side", "The laws in a picture, and the recommended one beside the usual one", growing(picture("advice-chart")),
        growing(html("p", { id: "advice-names", class: "quiet" }), part("advice-curves"))),
    );
    this.#chart = new Chart(this.#at.chart, () => {});
    this.#curves = new Panels(this.#at.curves);
    const failed = (error, question) => this.#failed(error, question);
    this.#standard = new Latest("api/advice-standard", (answer, question) => this.#answered(answer, question, 1), failed);
    this.#advice = new Latest("api/advice", (answer, question) => this.#answered(answer, question, question.points ? 3 : 2), failed);
  }

  show(state) {
    this.#state = state;
    this.#fields.show(this.#asked(state));
    const question = this.request(state);
    if (JSON.stringify(question) === this.#question) return;
    this.#question = JSON.stringify(question);
    this.#step = 0;
    this.#advice.stop();
    this.#standard.ask(question);
  }

  request(state) {
    const { minimise, follower } = this.#asked(state);
    const vibrates = follower?.on && { follower: { frequency: [follower.low, follower.high], damping: follower.damping || 0 } };
    return { study: state.machine, axis: state.axis, ...(minimise && { minimise }), ...vibrates };
  }

  #asked({ advice }) {
    return { ...ASKED, ...advice };
  }

  #change(what, alter) {
    this.#study.change(`advice ${what}`, (state) => {
      state.advice = structuredClone(this.#asked(state));
      alter(state.advice);
    });
  }

  // --- what is asked ---

  #build() {
    const least = choice("least", Object.fromEntries(OBJECTIVES.map((value) => [value, value || "as it says"])), "", (value) => this.#change("least", (asked) => (asked.minimise = value)));
    const on = html("input", { type: "checkbox", onchange: () => this.#change("follower", (asked) => (asked.follower.on = on.checked)) });
    const follower = FOLLOWER.map(([key, label]) => this.#fields.field({ path: ["follower", key], label, placeholder: String(ASKED.follower[key]) }, `follower, ${label}`));
    this.#fields.also((asked) => {
      least.value = asked.minimise;
      on.checked = asked.follower.on;
      for (const field of follower) field.lastElementChild.disabled = !asked.follower.on;
    });
    return html("div", {},
      group("Advice", entry("least", least), html("p", { class: "hint", text: "with the limits, the drive and the load of the motion" })),
      group("What it leaves vibrating", html("label", { class: "switch" }, on, "an elastic follower"), ...follower, html("p", { class: "hint", text: "its natural frequency, the least and the greatest, and its damping ratio" })),
    );
  }

  // --- what is answered ---

  /** What is quick is shown first; then the laws that are searched for, then the front between them. */
  #answered(answer, question, step) {
    if (!this.#isLast(question)) return;
    this.#step = answer.refused ? STEPS.length : step;
    if (answer.refused && step === STEPS.length) this.#answer.remarks.push(["front: ", answer.refused.reason].flat());
    else this.#answer = answer;
    this.#draw();
    if (this.#step < STEPS.length) this.#advice.ask({ ...JSON.parse(this.#question), points: step === 1 ? 0 : POINTS }, navigator.userActivation?.hasBeenActive ? PATIENCE : null);
  }

  /** What was stopped, or took too long, can be gone on with; what is known stays. */
  #failed(error, question) {
    if (!this.#isLast(question)) return;
    if (this.#step === 0) this.#answer = unanswered(error);
    this.#draw(error);
  }

  #isLast({ points, ...question }) {
    return JSON.stringify(question) === this.#question;
  }

  #draw(error = null) {
    const answer = this.#answer;
    marked(this.#at.words, answer.refused ? written(answer.refused.reason) : "");
    this.#at.words.classList.toggle("none", Boolean(answer.refused));
    renew(this.#at.words, ...(answer.refused ? refusal(answer.refused) : [...(answer.chosen ? this.#words(answer) : []), ...this.#progress(error)]));
    renew(this.#at.table, ...(answer.refused ? [] : [this.#table(answer), ...(answer.remarks ?? []).map((text) => html("p", { class: "quiet", translate: "no", text }))]));
    this.#chart.show(answer.refused ? null : pictured(answer));
    this.#curves.show(answer.refused ? answer : answer.curves);
    renew(this.#at.names, ...(answer.refused ? [] : answer.curves.panels[0]?.series ?? []).map(({ law, name }) => html("span", { class: "name-of-curve" }, swatch(law), ` ${name}`)));
  }

  /** Which step is under way, with a button that ends it; or goes on with it. */
  #progress(error) {
    if (this.#step >= STEPS.length) return [];
    const text = `${STEPS[this.#step]}: ${error ? error.message : "computing …"}`;
    const again = () => {
      this.#draw();
      this.#advice.ask({ ...JSON.parse(this.#question), points: this.#step === 1 ? 0 : POINTS }, PATIENCE);
    };
    const button = error ? html("button", { type: "button", text: "Go on", onclick: again }) : html("button", { type: "button", text: "Stop", onclick: () => this.#advice.stop() });
    return [html("p", { class: "progress" }, html("progress", { max: STEPS.length, value: this.#step, "aria-label": "steps of the advice" }), html("span", { class: "quiet", text }), button)];
  }

  #words({ sentences, rule, rows, chosen }) {
    const row = rows.find(({ name }) => name === chosen);
    const take = row.take ? [html("button", { type: "button", class: "main-button", text: "Take this law", onclick: () => this.#take(row) })] : [];
    return [
      html("p", { class: "advice" }, html("strong", { class: "word optimal", text: "advice" }), " ", written(sentences[0])),
      html("p", { text: sentences[1] }),
      html("p", { class: "quiet", translate: "no", text: `Rule: ${rule}.` }),
      ...take,
    ];
  }

  #table({ measures, rows, chosen }) {
    // beside so many quantities what a law keeps and proves stands under its name, or the table would be too wide
    const beneath = measures.length > MOST_BESIDE;
    const ends = ({ limits, proof }) => [["limits", limits, limits && limits !== "satisfied" ? "over" : null], ["proof", proof, null]];
    const named = (row) => fragment(
      html("span", { class: "row-name", text: row.name }),
      row.take ? button("take", () => this.#take(row), { class: "link", "data-key": `take ${row.name}`, "aria-label": `Take ${row.name}` }) : "",
      ...(beneath ? ends(row).filter(([, text]) => text).map(([key, text, over]) => html("span", { "data-ends": key, class: over ?? "quiet", text })) : []),
    );
    const cells = rows.map((row) => [named(row), ...row.values.map((value, i) => number(value, measures[i].unit, 5)), ...(beneath ? [] : ends(row)).map(([, text]) => text)]);
    const look = (i, j) => {
      const [key, , over] = ends(rows[i])[j - 1 - measures.length] ?? [];
      return key ? { "data-column": key, class: over } : {};
    };
    return table("Laws with what they take", ["law", ...measures.map(({ name, unit }) => headed(name, unit)), ...(beneath ? [] : ["limits", "proof"])], cells, {
      right: true, look, class: beneath ? "dense" : null, line: (i) => ({ class: rows[i].name === chosen ? "active" : null, "aria-current": rows[i].name === chosen ? "true" : null }),
    });
  }

  /** Give the motion a law, and show it there. */
  #take({ name, take }) {
    this.#study.change(`take ${name}`, (state) => {
      const axis = state.machine.axis[Math.min(state.axis, state.machine.axis.length - 1)];
      axis.segment.forEach((segment, i) => {
        const law = take.laws[i];
        if (law === null || law === undefined || !MOVES.includes(segment.kind)) return;
        if (law === OPTIMAL) delete segment.law;
        else segment.law = law;
      });
      if (take.minimise) axis.minimise = take.minimise;
      if (take.limits) axis.limits = take.limits;
      if (take.degree) axis.degree = take.degree;
      state.view = axis.mechanism ? "machine" : "cycle";
    });
  }
}

function refusal({ word: title, reason, tried }) {
  return [html("p", { class: "reason", title: tried }, html("strong", { class: "word refused", text: title }), ` ${written(reason)}`)];
}

/** The laws, the front and what is proven, in the plane of two measures. */
function pictured({ picture: { x, y, front: [curves] }, measures, rows, chosen }) {
  const [across, up] = [x, y].map(({ unit }) => shownUnit(unit).factor);
  const [i, j] = [x, y].map(({ name }) => measures.findIndex((one) => one.name === name));
  const known = rows.filter(({ values }) => values[i] !== null && values[j] !== null).map(({ name, kind, values, more }) => ({ name, kind, more, x: across * values[i], y: up * values[j] }));
  const [front, reached, below] = (curves ?? []).map(({ at, values, name }) => ({ title: name, points: at.map((one, k) => [across * one, up * values[k]]) }));
  const xs = [...known.map((point) => point.x), ...(front?.points ?? []).map(([value]) => value)];
  const positive = xs.filter((value) => value > 0);
  const log = positive.length === xs.length && Math.max(...positive) > WIDE * Math.min(...positive);
  const range = log ? [Math.min(...positive) / 1.3, 1.6 * Math.max(...positive)] : spanOf(xs, { free: true, room: 0.12 });
  const lines = reached?.points.length ? [{ ...reached, name: "front", title: "the front" }, { ...below, name: "limit" }] : [];
  const best = known.find(({ name }) => name === chosen);
  return {
    x: { name: headed(x.name, x.unit), range, log },
    y: { name: headed(y.name, y.unit), range: spanOf([...known.map((point) => point.y), ...(front?.points ?? []).map(([, value]) => value)], { free: true, room: 0.1 }) },
    lines,
    marks: [
      ...(front?.points ?? []).map((at) => ({ at, name: "front-point", title: "a law of the front" })),
      ...known.map((point) => ({ at: [point.x, point.y], name: `advised ${point.kind}${point.more.length ? " beyond" : ""}${point.name === chosen ? " chosen" : ""}`, title: `${point.name}: ${number(point.y, "", 4)}${point.more.length ? `; more ${point.more.join(", ")} than the usual law` : ""}` })),
    ],
    labels: placed(known.map((point) => ({ ...point, of: point.name === chosen })), range, log),
    told: `${y.name} over ${x.name}: ${known.map((point) => `${point.name} ${number(point.y, "", 4)} at ${number(point.x, "", 4)}`).join(", ")}${best ? `; recommended is ${best.name}` : ""}`,
  };
}

/** Names beside the points, without those that would lie on another one: first of the recommended law, then of standard laws. */
function placed(points, range, log) {
  const heights = points.map(({ y }) => y);
  const [low, tall] = [Math.min(...heights), Math.max(...heights) - Math.min(...heights) || 1];
  const along = (value) => (log ? Math.log(value / range[0]) / Math.log(range[1] / range[0]) : (value - range[0]) / (range[1] - range[0]));
  const kept = [];
  for (const point of [...points].sort((one, other) => other.of - one.of || (one.kind === "optimal") - (other.kind === "optimal"))) {
    if (point.name.includes(",") && !point.of) continue;
    const text = point.of ? "recommended" : point.name;
    const long = LETTER * text.length;
    const end = along(point.x) > Math.min(0.66, 1 - long);
    const from = along(point.x) - (end ? long : 0);
    const box = { from, to: from + long, at: (point.y - low) / tall };
    if (kept.some(({ box: other }) => box.from < other.to && box.to > other.from && Math.abs(box.at - other.at) < LINE)) continue;
    kept.push({ box, at: [point.x, point.y], text, name: point.of ? "chosen" : "", anchor: end ? "end" : "start", up: point.of ? 9 : 6 });
  }
  return kept;
}

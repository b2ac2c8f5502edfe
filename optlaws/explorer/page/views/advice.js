// The view of advice: which law the motion of a cycle or of a machine should have. Standard and optimal laws side by side
// with all their measures, the recommended one in two sentences, the front, and curves of it beside the usual law.

import { createChart } from "../chart.js";
import { choice, createForm, entry } from "../form.js";
import { Latest, unanswered } from "../latest.js";
import { spanOf } from "../layers.js";
import { column, fragment, group, growing, laidOut, panel, part, picture, status, swatch } from "../layout.js";
import { createPanels } from "../panels.js";
import { marked, showTrust, table } from "../report.js";
import { button, html, renew } from "../svg.js";
import { headed, number, shownUnit, written } from "../units.js";

const OBJECTIVES = ["", "acceleration", "jerk", "rms acceleration", "torque", "rms torque", "force", "rms force", "residual acceleration"];
const ASKED = { minimise: "", follower: { on: false, low: "27 Hz", high: "33 Hz", damping: 0.05 } };
const FOLLOWER = [["low", "from"], ["high", "to"], ["damping", "damping"]];
const MOVES = ["rise", "return", "move"];
const OPTIMAL = "optimal";
const WIDE = 10; // values further apart are drawn by their logarithms
const PATIENCE = 120; // s that the laws have where the reader came here; an address that is opened has less
const POINTS = 6; // of the front
const MOST_BESIDE = 6;
const STEPS = ["standard laws", "optimal laws", "the front"];

export function createView(root, study) {
  const files = ["table"];
  let stateShown = null;
  let advice = null;
  const fields = createForm(change, () => study.rest());
  let asked = "";
  let stepDone = 0; // of STEPS, that is under way
  const form = build();
  const at = laidOut(root,
    column("advice-middle", "Laws side by side", status("advice-words"), panel("advice-table")),
    column("advice-side", "The laws in a picture, and the recommended one beside the usual one", growing(picture("advice-chart")),
      growing(html("p", { id: "advice-names", class: "quiet" }), part("advice-curves"))),
  );
  const chart = createChart(at.chart, () => {});
  const curves = createPanels(at.curves);
  const standardRequest = new Latest("api/advice-standard", (answer, question) => answered(answer, question, 1), failed);
  const adviceRequest = new Latest("api/advice", (answer, question) => answered(answer, question, question.points ? 3 : 2), failed);

  function show(state) {
    stateShown = state;
    fields.show(askedOf(state));
    const question = request(state);
    if (JSON.stringify(question) === asked) return;
    asked = JSON.stringify(question);
    stepDone = 0;
    adviceRequest.stop();
    standardRequest.ask(question);
  }

  function request(state) {
    const { minimise, follower } = askedOf(state);
    const vibrates = follower?.on && { follower: { frequency: [follower.low, follower.high], damping: follower.damping || 0 } };
    return { study: state.machine, axis: state.axis, ...(minimise && { minimise }), ...vibrates };
  }

  function askedOf({ advice }) {
    return { ...ASKED, ...advice };
  }

  function change(what, alter) {
    study.change(`advice ${what}`, (state) => {
      state.advice = structuredClone(askedOf(state));
      alter(state.advice);
    });
  }

  // --- what is asked ---

  function build() {
    const least = choice("least", Object.fromEntries(OBJECTIVES.map((value) => [value, value.replace("rms", "RMS") || "as it says"])), "", (value) => change("least", (asked) => (asked.minimise = value)));
    const on = html("input", { type: "checkbox", onchange: () => change("follower", (asked) => (asked.follower.on = on.checked)) });
    const follower = FOLLOWER.map(([key, label]) => fields.field({ path: ["follower", key], label, placeholder: String(ASKED.follower[key]) }, `follower, ${label}`));
    fields.also((asked) => {
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
  function answered(answer, question, step) {
    if (!isLast(question)) return;
    stepDone = answer.refused ? STEPS.length : step;
    if (answer.refused && step === STEPS.length) advice.remarks.push(["front: ", answer.refused.reason].flat());
    else advice = answer;
    draw();
    if (stepDone < STEPS.length) adviceRequest.ask({ ...JSON.parse(asked), points: step === 1 ? 0 : POINTS }, navigator.userActivation?.hasBeenActive ? PATIENCE : null);
  }

  /** What was stopped, or took too long, can be gone on with; what is known stays. */
  function failed(error, question) {
    if (!isLast(question)) return;
    if (stepDone === 0) advice = unanswered(error);
    draw(error);
  }

  function isLast({ points, ...question }) {
    return JSON.stringify(question) === asked;
  }

  function draw(error = null) {
    const answer = advice;
    if (answer.refused) showTrust(at.words, answer);
    else {
      marked(at.words, "");
      at.words.classList.remove("none");
      renew(at.words, ...(answer.chosen ? words(answer) : []), ...progress(error));
    }
    renew(at.table, ...(answer.refused ? [] : [lawsTable(answer), ...(answer.remarks ?? []).map((text) => html("p", { class: "quiet", translate: "no", text }))]));
    chart.show(answer.refused ? null : pictured(answer));
    curves.show(answer.refused ? answer : answer.curves);
    renew(at.names, ...(answer.refused ? [] : answer.curves.panels[0]?.series ?? []).map(({ law, name }) => html("span", { class: "name-of-curve" }, swatch(law), ` ${name}`)));
  }

  /** Which step is under way, with a button that ends it; or goes on with it. */
  function progress(error) {
    if (stepDone >= STEPS.length) return [];
    const text = `${STEPS[stepDone]}: ${error ? error.message : "computing …"}`;
    const again = () => {
      draw();
      adviceRequest.ask({ ...JSON.parse(asked), points: stepDone === 1 ? 0 : POINTS }, PATIENCE);
    };
    const press = error ? button("Go on", again) : button("Stop", () => adviceRequest.stop());
    return [html("p", { class: "progress" }, html("progress", { max: STEPS.length, value: stepDone, "aria-label": "steps of the advice" }), html("span", { class: "quiet", text }), press)];
  }

  function words({ sentences, rule, rows, chosen }) {
    const row = rows.find(({ name }) => name === chosen);
    const take = row.take ? [button("Take this law", () => takeLaw(row), { class: "main-button" })] : [];
    return [
      html("p", { class: "advice" }, html("strong", { class: "word optimal", text: "advice" }), " ", written(sentences[0])),
      html("p", { text: sentences[1] }),
      html("p", { class: "quiet", translate: "no", text: `Rule: ${rule}.` }),
      ...take,
    ];
  }

  function lawsTable({ measures, rows, chosen }) {
    // beside so many quantities what a law keeps and proves stands under its name, or the table would be too wide
    const beneath = measures.length > MOST_BESIDE;
    const ends = ({ limits, proof }) => [["limits", limits, limits && limits !== "satisfied" ? "over" : null], ["proof", proof, null]];
    const named = (row) => fragment(
      html("span", { class: "row-name", text: row.name }),
      row.take ? button("take", () => takeLaw(row), { class: "link", "data-key": `take ${row.name}`, "aria-label": `Take ${row.name}` }) : "",
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
  function takeLaw({ name, take }) {
    study.change(`take ${name}`, (state) => {
      const axis = state.machine.axis[state.axis];
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

  return { files, drawings: "#advice-side svg", show, request, form };
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
    // first of the recommended law, then of standard laws
    labels: known.filter(({ name }) => name === chosen || !name.includes(",")).sort((one, other) => (other.name === chosen) - (one.name === chosen) || (one.kind === "optimal") - (other.kind === "optimal"))
      .map(({ name, ...point }) => ({ at: [point.x, point.y], text: name === chosen ? "recommended" : name, name: name === chosen ? "chosen" : "", free: true })),
    told: `${y.name} over ${x.name}: ${known.map((point) => `${point.name} ${number(point.y, "", 4)} at ${number(point.x, "", 4)}`).join(", ")}${best ? `; recommended is ${best.name}` : ""}`,
  };
}

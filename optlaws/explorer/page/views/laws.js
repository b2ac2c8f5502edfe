// The view of laws: what is asked on the left, the plane of the constants in the middle, the curves on the right.

import { askedOf, move } from "../asked.js";
import { createBand } from "../band.js";
import { createControls } from "../controls.js";
import { slider } from "../form.js";
import { Latest, unanswered } from "../latest.js";
import { column, explained, fragment, group, growing, head, laidOut, panel, part, picture, status, swatch, tabs } from "../layout.js";
import { createPanels } from "../panels.js";
import { createPlane } from "../planes.js";
import { showTrust, table } from "../report.js";
import { html, svg } from "../svg.js";
import { createTray } from "../tray.js";
import { same } from "../views.js";

const PICTURES = { "B-C": "C over B", "B-D": "D over B", "B-J": "J over B", "C-D": "D over C", "J-C": "C over J", residual: "residual" };

const look = (width, height, mark, attributes) => svg("svg", { width, height, "aria-hidden": "true" }, svg(mark, attributes));
const WORDS = () => [
  [look(26, 8, "path", { class: "front", d: "M0 4H26" }), "the front: for each value below, the optimal law of this order and degree; points alone are not proven least"],
  [look(26, 8, "path", { class: "limit", d: "M0 4H26" }), "the best possible: no law of this order is below it, whatever its degree"],
  [look(26, 10, "circle", { class: "mark-of-legend", cx: 13, cy: 5, r: 3.2 }), "standard laws; grey lines are Savin's families I to IV"],
  ["a, b, c, j", "displacement from 0 to 1 over the time k from 0 to 1, and its velocity, acceleration and jerk; d = b·c is the power of a mass"],
  ["B, C, D, J", "their peaks: a stroke h in a time T has the peak velocity B·h/T, the peak acceleration C·h/T², the peak jerk J·h/T³"],
  ["order l", "conditions at each end: order 2 begins and ends at rest, order 3 also without acceleration, order 4 also without jerk"],
  ["degree", "of the free polynomial Z: more of it comes nearer to the best possible and costs jerk"],
];

const NAMES = ["B", "C", "D", "J", "rms_c"];

export function createView(root, study, { law }, drawn) {
  const files = ["python", "problem", "law", "table"];
  let stateShown = null;
  let lawViews = [];
  let asked = [];
  let waysBack = null;
  let front = null;
  let words = "";
  let left = "";
  let machine = [];
  const at = laidOut(root,
    html("aside", { id: "ask", "aria-label": "What is asked of the law" }),
    column("middle", "Laws in the plane of their constants", part("tray", { class: "tray", role: "group", "aria-label": "Laws side by side" }),
      growing(head(part("pictures", { role: "tablist", "aria-label": "Pictures" }), html("p", { id: "words", class: "quiet" })), picture("plane"), part("follower", { hidden: true }), explained(WORDS())),
      status("trust"), panel("table", { tabindex: "0", role: "group", "aria-label": "Constants of the laws" })),
    html("section", { id: "curves", class: "panel", "aria-label": "The law and its derivatives over k" }),
  );
  const curves = createPanels(at.curves);
  const controls = createControls(at.ask, study, value, law);
  const tray = createTray(at.tray, study);
  const [plane, residual] = [html("div", { class: "fill" }), html("div", { class: "fill", id: "residual" })];
  at.plane.append(plane, residual);
  const lawPlane = createPlane(plane, (x) => askedOf(study.state.laws[study.state.active], x), moveLaw, (name) => {
    words = tray.add(name) || words;
    render();
  });
  const band = createBand(study);
  const residualPanels = createPanels(residual, { strip: band.strip });
  residualPanels.cursor.watch((at, placed) => placed && at !== null && at !== study.state.frequency && study.change("frequency", (state) => (state.frequency = Number(at.toPrecision(4)))));
  const chooses = tabs(at.pictures, PICTURES, (key) => study.change("picture", (state) => (state.picture = key)));
  const follower = followerFields();
  const machines = new Latest("api/law-machine", ({ rows }) => inUnits(rows), (error) => inUnits(lawViews[stateShown.active]?.refused ? [] : [{ name: error.message, cells: {} }]));
  const laws = new Latest("api/laws", answered, (error, question) => answered({ laws: question.laws.map(() => unanswered(error)) }, question));
  const fronts = new Latest("api/front", showFront, withoutFront);
  const nearest = new Latest("api/nearest", near, (_, question) => near({ ways: [] }, question));
  const residuals = new Latest("api/residual", showResidual, withoutResidual);

  /** A table that is dropped onto the residual is a measured spectrum. */
  function dropped(file) {
    return stateShown.picture === "residual" && /\.(csv|txt|tsv|dat|tab)$/i.test(file.name) && band.read(file);
  }

  /** The active law is the one that a controller is to run. */
  function request({ laws, active }) {
    return { laws, active };
  }

  function show(state) {
    stateShown = state;
    const isResidual = state.picture === "residual";
    const [plane, residual] = at.plane.children;
    plane.hidden = isResidual;
    residual.hidden = at.follower.hidden = !isResidual;
    chooses(state.picture);
    controls.show(state);
    const { stroke, time, mass } = state.controller ?? {};
    if (stroke && time) machines.ask({ laws: state.laws, active: state.active, stroke, time, ...(mass && { mass }) });
    else machine = [];
    follower(state);
    askLaws(state);
    if (isResidual) residuals.ask({ laws: state.laws, frequency: state.frequency, damping: state.damping, ...band.question(state) });
    else askFront(state);
  }

  function askLaws(state) {
    if (same(state.laws, asked) && !laws.behind) render();
    laws.ask({ laws: state.laws });
  }

  function askFront(state) {
    const over = (Object.hasOwn(PICTURES, state.picture) ? state.picture : "B-C").split("-");
    // a law that is given has no front: that of the first problem stands beside it
    const active = state.laws[state.active];
    const law = structuredClone(active.problem ? active : state.laws.find(({ problem }) => problem) ?? active);
    delete law.title;
    // what runs along the front does not change it
    if (law.problem) delete law.problem[over[0]];
    const question = { laws: [law], over };
    if (same(question, front)) return;
    front = question;
    words = "computing the front …";
    at.plane.classList.add("behind");
    fronts.ask(question);
  }

  function showFront(front) {
    words = front.words;
    at.plane.classList.remove("behind");
    lawPlane.showFront(front);
    render();
  }

  function withoutFront(error) {
    front = null;
    words = `no front: ${error.message}`;
    render();
  }

  function showResidual(answer) {
    const named = ({ series, ...panel }, i) => ({ ...panel, span: i ? null : [0, 1], series: series.map((one) => ({ ...one, name: lawViews[one.law]?.title })) });
    const picture = { ...answer, panels: answer.panels.map(named), across: "frequency ν of the follower, radians of its vibration in the motion", symbol: "ν", active: stateShown.active };
    residualPanels.show(band.picture(picture, answer, stateShown));
    if (residualPanels.cursor.at !== answer.at) residualPanels.cursor.place(answer.at);
    left = `residual acceleration at ν = ${answer.at}: ${answer.laws.map((law, i) => `${"ABCD"[i]} ${law?.text ?? "—"}`).join(", ")}${band.words(answer)}`;
    render();
  }

  function withoutResidual(error) {
    left = error.message;
    render();
  }

  function answered({ laws }, question) {
    lawViews = laws;
    asked = question.laws;
    waysBack = null;
    const active = stateShown.active;
    if (laws[active]?.refused?.word === "no such law" && question.laws[active]?.problem) nearest.ask({ laws: question.laws, active });
    else waysBack = [];
    render();
    drawn();
  }

  function inUnits(rows) {
    machine = rows;
    showConstants();
  }

  function near({ ways }, question) {
    if (!same(question.laws, asked) || question.active !== stateShown.active) return;
    waysBack = ways;
    render();
  }

  function render() {
    const { laws, active, picture } = stateShown;
    const x = picture.split("-")[0];
    const views = laws.map((_, i) => lawViews[i]);
    tray.show(laws, views, active);
    curves.show(curvesOf(views, active));
    lawPlane.showLaws(laws.map((law, i) => ({ view: views[i], asked: askedOf(law, x), movable: Boolean(law.problem) })), active);
    showTrust(at.trust, views[active], waysBack, back);
    showConstants();
    at.words.textContent = picture === "residual" ? left : words;
  }

  function showConstants() {
    const { laws, active } = stateShown;
    at.table.replaceChildren(constants(laws.map((_, i) => lawViews[i]), active, machine));
  }

  function value(name) {
    return lawViews[stateShown.active]?.constants?.find((one) => one.name === name)?.value ?? null;
  }

  function moveLaw(value, x, y) {
    if (value === null) return study.rest();
    return study.change(`drag ${x}`, (state) => move(state.laws[state.active], x, y, value));
  }

  function back({ entry, value }) {
    study.change(`back ${entry}`, (state) => {
      const { problem } = state.laws[state.active];
      if (entry === "B" || entry === "degree") problem[entry] = value;
      else if (entry === "rms_c") problem.bounds = { ...problem.bounds, rms_c: [0, value] };
      else problem[entry] = [0, value];
    });
  }

  function followerFields() {
    const field = (name, title, key, high, step) => slider({
      name, title, low: key === "frequency" ? 2 : 0, high, step, most: key === "frequency" ? 1000 : 0.5,
      changed: (value) => band.change(key, (state) => (state[key] = value)),
      rested: () => study.rest(),
    });
    const frequency = field("frequency ν", "Frequency nu of the follower", "frequency", 80, 0.5);
    const damping = field("damping ζ", "Damping ratio of the follower", "damping", 0.3, 0.005);
    at.follower.append(frequency.element, damping.element, ...band.elements);
    return (state) => {
      band.show(state);
      frequency.set(state.frequency);
      damping.set(state.damping);
    };
  }

  return { files, moves: true, drawings: "#curves svg", dropped, request, show };
}

/** Constants of the laws with the digits that the server gave, and below the active one its rows in the units of a machine. */
function constants(views, active, machine) {
  const of = (view, name) => view?.constants?.find((one) => one.name === name);
  const least = Object.fromEntries(NAMES.map((name) => [name, Math.min(...views.map((view) => of(view, name)?.value ?? Infinity))]));
  const lines = views.flatMap((view, i) => [{ view, i }, ...(i === active ? machine.map((row) => ({ row })) : [])]);
  const title = (view) => view?.title ?? view?.refused?.word ?? "…";
  const row = ({ view, i, row: known }) => (known
    ? [known.name, ...NAMES.map((name) => known.cells[name] ?? "")]
    : [fragment(swatch(i), html("span", { class: "row-name", text: title(view), title: title(view) })), ...NAMES.map((name) => of(view, name)?.text ?? "—")]);
  const look = (k, j) => {
    const one = of(lines[k].view, NAMES[j - 1]);
    return lines[k].row ? {} : { "data-constant": NAMES[j - 1], title: one?.k || null, class: views.length > 1 && one && one.value === least[one.name] ? "best" : null };
  };
  return table("Constants of the laws, dimensionless", ["law", ...NAMES.map((name) => name.replace("_", " "))], lines.map(row), { right: true, look, line: (k) => ({ class: lines[k].row ? "in-units" : lines[k].i === active ? "active" : null }) });
}

/** The curves of laws, one panel for each of a, b, c, d and j; or why there is nothing to draw. */
function curvesOf(views, active) {
  const drawn = views.map((view, law) => ({ view, law })).filter(({ view }) => view?.panels);
  const own = views[active];
  if (!drawn.length && own?.refused) return { refused: own.refused };
  const unbounded = own?.constants?.some(({ name, value }) => name === "J" && value === null);
  const panels = (own?.panels ?? drawn[0]?.view.panels ?? []).map((panel, i) => ({
    ...panel,
    ...(own?.panels ? {} : { peaks: [], limits: [] }),
    series: drawn.flatMap(({ view, law }) => view.panels[i].series.map((one) => ({ ...one, law, name: view.title }))),
    span: panel.symbol === "a" ? [0, 1] : null,
    note: panel.symbol === "j" && unbounded ? "without bound: c jumps" : "",
  }));
  return { across: "dimensionless time k", symbol: "k", range: [0, 1], ticks: [0, 0.25, 0.5, 0.75, 1], active, panels };
}

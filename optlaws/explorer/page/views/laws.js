// The view of laws: what is asked on the left, the plane of the constants in the middle, the curves on the right.

import { askedOf, move } from "../asked.js";
import { Band } from "../band.js";
import { Controls } from "../controls.js";
import { slider } from "../form.js";
import { Latest, unanswered } from "../latest.js";
import { curvesOf } from "../law_curves.js";
import { column, explained, fragment, group, growing, head, laidOut, panel, part, picture, status, swatch, tabs } from "../layout.js";
import { Panels } from "../panels.js";
import { Plane } from "../plane.js";
import { showTrust, table } from "../report.js";
import { html, svg } from "../svg.js";
import { Tray } from "../tray.js";
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

export class View {
  files = ["python", "problem", "law", "table"];
  moves = true;
  drawings = "#curves svg";
  #study;
  #state = null;
  #views = [];
  #asked = [];
  #ways = null;
  #front = null;
  #words = "";
  #left = "";
  #controls;
  #tray;
  #plane;
  #residual;
  #band;
  #at;
  #curves;
  #chooses;
  #machines;
  #machine = [];
  #follower;
  #laws;
  #fronts;
  #nearest;
  #residuals;
  #drawn;

  constructor(root, study, _start, drawn) {
    this.#study = study;
    this.#drawn = drawn;
    this.#at = laidOut(root,
      html("aside", { id: "ask", "aria-label": "What is asked of the law" }),
      column("middle", "Laws in the plane of their constants", part("tray", { class: "tray", role: "group", "aria-label": "Laws side by side" }),
        growing(head(part("pictures", { role: "tablist", "aria-label": "Pictures" }), html("p", { id: "words", class: "quiet" })), picture("plane"), part("follower", { hidden: true }), explained(WORDS())),
        status("trust"), panel("table")),
      html("section", { id: "curves", class: "panel", "aria-label": "The law and its derivatives over k" }),
    );
    this.#curves = new Panels(this.#at.curves);
    this.#controls = new Controls(this.#at.ask, study, (name) => this.#value(name));
    this.#tray = new Tray(this.#at.tray, study);
    const [plane, residual] = [html("div", { class: "fill" }), html("div", { class: "fill", id: "residual" })];
    this.#at.plane.append(plane, residual);
    this.#plane = new Plane(plane, (x) => askedOf(study.state.laws[study.state.active], x), (value, x, y) => this.#move(value, x, y), (name) => this.#tray.add(name));
    this.#band = new Band(study);
    this.#residual = new Panels(residual, { strip: this.#band.strip });
    this.#residual.cursor.watch((at, placed) => placed && at !== null && at !== study.state.frequency && study.change("frequency", (state) => (state.frequency = Number(at.toPrecision(4)))));
    this.#chooses = tabs(this.#at.pictures, PICTURES, (key) => study.change("picture", (state) => (state.picture = key)));
    this.#follower = this.#followerFields();
    this.#machines = new Latest("api/law-machine", ({ rows }) => this.#inUnits(rows), (error) => this.#inUnits(this.#views[this.#state.active]?.refused ? [] : [{ name: error.message, cells: {} }]));
    this.#laws = new Latest("api/laws", (answer, question) => this.#answered(answer, question), (error, question) => this.#answered({ laws: question.laws.map(() => unanswered(error)) }, question));
    this.#fronts = new Latest("api/front", (front) => this.#showFront(front), (error) => this.#withoutFront(error));
    this.#nearest = new Latest("api/nearest", (answer, question) => this.#near(answer, question), (_, question) => this.#near({ ways: [] }, question));
    this.#residuals = new Latest("api/residual", (answer) => this.#showResidual(answer), (error) => this.#withoutResidual(error));
  }

  /** A table that is dropped onto the residual is a measured spectrum. */
  dropped(file) {
    return this.#state.picture === "residual" && /\.(csv|txt|tsv|dat|tab)$/i.test(file.name) && this.#band.read(file);
  }

  /** The active law is the one that a controller is to run. */
  request({ laws, active }) {
    return { laws, active };
  }

  show(state) {
    this.#state = state;
    const isResidual = state.picture === "residual";
    const [plane, residual] = this.#at.plane.children;
    plane.hidden = isResidual;
    residual.hidden = this.#at.follower.hidden = !isResidual;
    this.#chooses(state.picture);
    this.#controls.show(state);
    const { stroke, time, mass } = state.controller ?? {};
    if (stroke && time) this.#machines.ask({ laws: state.laws, active: state.active, stroke, time, ...(mass && { mass }) });
    else this.#machine = [];
    this.#follower(state);
    this.#askLaws(state);
    if (isResidual) this.#residuals.ask({ laws: state.laws, frequency: state.frequency, damping: state.damping, ...this.#band.question(state) });
    else this.#askFront(state);
  }

  #askLaws(state) {
    if (same(state.laws, this.#asked) && !this.#laws.behind) this.#render();
    this.#laws.ask({ laws: state.laws });
  }

  #askFront(state) {
    const over = (Object.hasOwn(PICTURES, state.picture) ? state.picture : "B-C").split("-");
    // a law that is given has no front: that of the first problem stands beside it
    const active = state.laws[state.active];
    const law = structuredClone(active.problem ? active : state.laws.find(({ problem }) => problem) ?? active);
    delete law.title;
    // what runs along the front does not change it
    if (law.problem) delete law.problem[over[0]];
    const question = { laws: [law], over };
    if (same(question, this.#front)) return;
    this.#front = question;
    this.#words = "computing the front …";
    this.#at.plane.classList.add("behind");
    this.#fronts.ask(question);
  }

  #showFront(front) {
    this.#words = front.words;
    this.#at.plane.classList.remove("behind");
    this.#plane.showFront(front);
    this.#render();
  }

  #withoutFront(error) {
    this.#front = null;
    this.#words = `no front: ${error.message}`;
    this.#render();
  }

  #showResidual(answer) {
    const named = ({ series, ...panel }, i) => ({ ...panel, span: i ? null : [0, 1], series: series.map((one) => ({ ...one, name: this.#views[one.law]?.title })) });
    const picture = { ...answer, panels: answer.panels.map(named), across: "frequency ν of the follower, radians of its vibration in the motion", symbol: "ν", active: this.#state.active };
    this.#residual.show(this.#band.picture(picture, answer, this.#state));
    if (this.#residual.cursor.at !== answer.at) this.#residual.cursor.place(answer.at);
    this.#left = `residual acceleration at ν = ${answer.at}: ${answer.laws.map((law, i) => `${"ABCD"[i]} ${law?.text ?? "—"}`).join(", ")}${this.#band.words(answer)}`;
    this.#render();
  }

  #withoutResidual(error) {
    this.#left = error.message;
    this.#render();
  }

  #answered({ laws }, question) {
    this.#views = laws;
    this.#asked = question.laws;
    this.#ways = null;
    const active = this.#state.active;
    if (laws[active]?.refused?.word === "no such law" && question.laws[active]?.problem) this.#nearest.ask({ laws: question.laws, active });
    else this.#ways = [];
    this.#render();
    this.#drawn();
  }

  #inUnits(rows) {
    this.#machine = rows;
    this.#constants();
  }

  #near({ ways }, question) {
    if (!same(question.laws, this.#asked) || question.active !== this.#state.active) return;
    this.#ways = ways;
    this.#render();
  }

  #render() {
    const { laws, active, picture } = this.#state;
    const x = picture.split("-")[0];
    const views = laws.map((_, i) => this.#views[i]);
    this.#tray.show(laws, views, active);
    this.#curves.show(curvesOf(views, active));
    this.#plane.showLaws(laws.map((law, i) => ({ view: views[i], asked: askedOf(law, x), movable: Boolean(law.problem) })), active);
    showTrust(this.#at.trust, views[active], this.#ways, (way) => this.#back(way));
    this.#constants();
    this.#at.words.textContent = picture === "residual" ? this.#left : this.#words;
  }

  #constants() {
    const { laws, active } = this.#state;
    this.#at.table.replaceChildren(constants(laws.map((_, i) => this.#views[i]), active, this.#machine));
  }

  #value(name) {
    return this.#views[this.#state.active]?.constants?.find((one) => one.name === name)?.value ?? null;
  }

  #move(value, x, y) {
    if (value === null) return this.#study.rest();
    return this.#study.change(`drag ${x}`, (state) => move(state.laws[state.active], x, y, value));
  }

  #back({ entry, value }) {
    this.#study.change(`back ${entry}`, (state) => {
      const { problem } = state.laws[state.active];
      if (entry === "B" || entry === "degree") problem[entry] = value;
      else if (entry === "rms_c") problem.bounds = { ...problem.bounds, rms_c: [0, value] };
      else problem[entry] = [0, value];
    });
  }

  #followerFields() {
    const field = (name, title, key, high, step) => slider({
      name, title, low: key === "frequency" ? 2 : 0, high, step, most: key === "frequency" ? 1000 : 0.5,
      changed: (value) => this.#band.change(key, (state) => (state[key] = value)),
      rested: () => this.#study.rest(),
    });
    const frequency = field("frequency ν", "Frequency nu of the follower", "frequency", 80, 0.5);
    const damping = field("damping ζ", "Damping ratio of the follower", "damping", 0.3, 0.005);
    this.#at.follower.append(frequency.element, damping.element, ...this.#band.elements);
    return (state) => {
      this.#band.show(state);
      frequency.set(state.frequency);
      damping.set(state.damping);
    };
  }
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

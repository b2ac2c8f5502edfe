// The timing of the machine: its axes in a diagram with interlocks, the plane of two positions, clearances, a run.

import { Cursor } from "../cursor.js";
import { choice } from "../form.js";
import { Latest } from "../latest.js";
import { column, group, growing, head, laidOut, panel, part, picture, status } from "../layout.js";
import { Panels } from "../panels.js";
import { Positions } from "../positions.js";
import { showTrust, table } from "../report.js";
import { Run } from "../run.js";
import { html, renew } from "../svg.js";
import { Timing, valueAt } from "../timing.js";
import { listed, written } from "../units.js";
import { same } from "../views.js";

const GOALS = { "": "as they are given", acceleration: "least acceleration", period: "least period" };
const WORDS = { clear: "good", broken: "bad" };
const PEAKS = ["axis", "stroke", "velocity", "acceleration", "jerk", "laws"];

export class View {
  files = ["python", "problem", "table"];
  moves = true;
  drawings = "#axes-timing svg, #axes-plane svg, #axes-rooms svg";
  #study;
  #timing;
  #positions;
  #rooms;
  #cursor = new Cursor();
  #parts;
  #gained = html("div", { role: "status", "aria-live": "polite" });
  #answers;
  #clearances;
  #together;
  #answer = null;
  #asked = null;
  #known = null;
  #shape = "";

  constructor(root, study) {
    this.#study = study;
    const parts = (this.#parts = laidOut(root,
      column("axes-middle", "Timing diagram and positions", status("axes-trust"),
        html("div", { class: "panel" }, part("axes-timing"), part("axes-run"), html("p", { class: "facts", id: "axes-reading" })),
        growing(head(html("span", { class: "quiet", text: "positions" }), html("select", { id: "axes-choice", "aria-label": "plane of two positions" })), picture("axes-plane"))),
      column("axes-right", "Clearances", panel("axes-rooms"), panel("axes-table", { class: "panel scrolled" })),
    ));
    const { timing, run, plane, choice, rooms } = parts;
    this.form = html("div");
    this.#timing = new Timing(timing, (row, segments) => this.#moved(row, segments));
    this.#positions = new Positions(plane, (rule, corner, place) => this.#cornered(rule, corner, place));
    this.#rooms = new Panels(rooms, { cursor: this.#cursor });
    new Run(run, "Angle of the master, degrees", this.#cursor);
    this.#cursor.watch((at) => this.#turn(at));
    choice.addEventListener("change", () => study.change("plane", (state) => (state.plane = Number(choice.value))));
    this.#answers = new Latest("api/axes", (...answer) => this.#answered(...answer));
    this.#clearances = new Latest("api/axes-clearances", (known, question) => same(question, this.#asked) && this.#know(known));
    this.#together = new Latest("api/axes-together", (answer, question) => this.#put(answer, question), (error) => this.#say([error.message]));
  }

  /** The axis of the programme is the one that a controller is to run. */
  request({ machine, axis }) {
    return { study: machine, axis };
  }

  show(state) {
    this.#goal(state.machine);
    this.#answers.ask({ study: state.machine });
    if (this.#answer) this.#draw();
  }

  #answered(answer, question) {
    this.#answer = answer;
    this.#asked = question;
    if (answer.refused) this.#know({ refused: answer.refused });
    else {
      this.#clearances.ask(question);
      this.#draw();
      this.#facts();
    }
  }

  /** What is proven of the answer that is drawn. */
  #know(known) {
    this.#known = { rows: [], ...known, of: JSON.stringify(this.#asked) };
    showTrust(this.#parts.trust, known);
    this.#draw();
    this.#facts();
  }

  #draw() {
    const known = this.#known?.of === JSON.stringify(this.#asked) ? this.#known.rows : [];
    const { study } = this.#asked;
    this.#timing.show(this.#answer, study, known.map(({ status }) => status), same(study, this.#study.state.machine));
    this.#positions.show(this.#answer, this.#study.state.plane ?? 0, known);
    const { refused, panels, across, unit, note, planes = [] } = this.#answer;
    this.#rooms.show(refused ? this.#answer : { across, unit, note, panels: known.length ? this.#known.panels : panels, segments: [] });
    const { choice } = this.#parts;
    const names = planes.map(({ axes }) => axes.join(" and "));
    if (JSON.stringify(names) !== JSON.stringify([...choice.options].map(({ text }) => text))) choice.replaceChildren(...names.map((text, value) => html("option", { value, text, translate: "no" })));
    choice.hidden = names.length < 2;
    choice.value = String(Math.min(this.#study.state.plane ?? 0, names.length - 1));
    this.#turn(this.#cursor.at);
  }

  /** Where all axes are at an angle of the master. */
  #turn(at) {
    this.#timing.turn(at);
    this.#positions.turn(at);
    const angle = at ?? 0;
    const rows = this.#answer?.refused ? [] : this.#answer?.rows ?? [];
    const places = rows.map(({ name, values, unit }) => `${name} ${written({ value: valueAt(this.#answer.at, values, angle), unit, digits: 4 })}`);
    this.#parts.reading.textContent = [`at ${written({ value: Number(angle.toFixed(1)), unit: "deg", digits: 6 })}`, ...places].join(" · ");
  }

  #facts() {
    const rows = this.#answer.refused ? [] : this.#answer.rows;
    const shown = rows.length ? [table("Axes with their peaks", PEAKS, rows.map(({ name, cells }) => [name, ...cells]))] : [];
    const proven = this.#known?.of === JSON.stringify(this.#asked) ? this.#known.tables ?? [] : [];
    const words = (cells) => [cells[0], html("span", { class: `word ${WORDS[cells[1]] ?? "warn"}`, text: cells[1] }), ...cells.slice(2)];
    this.#parts.table.replaceChildren(...proven.map((one) => table("Least clearances of the interlocks", one.headings, one.rows.map(words))), ...shown);
  }

  /** A bar of an axis was moved, or taken or let go. */
  #moved(row, segments) {
    this.#study.change(`bar ${row}`, (state) => {
      state.axis = row;
      if (segments) state.machine.axis[row].segment = segments;
    });
    if (!segments) this.#study.rest();
  }

  #cornered(rule, corner, place) {
    if (!place) return this.#study.rest();
    const { axes, units } = this.#answer.planes.find(({ regions }) => regions.some((one) => one.rule === rule));
    return this.#study.change(`corner ${rule} ${corner}`, (state) => {
      const { axis, across, corners } = state.machine.interlocks[rule];
      corners[corner] = place.map((value, i) => `${value} ${units[axes.indexOf([axis, across][i])]}`);
    });
  }

  /** For what the moves are put together, and of which axes an acceleration is to be least. */
  #goal({ overlap, axis }) {
    const names = axis.map(({ name }) => name);
    const shape = JSON.stringify([names, overlap]);
    if (shape === this.#shape) return;
    this.#shape = shape;
    const goal = choice("put the moves together for", GOALS, overlap?.goal ?? "", (value) => this.#study.change("overlap", (state) => {
      if (value) state.machine.overlap = { goal: value, ...(value === "acceleration" && { of: [names[state.axis] ?? names[0]] }) };
      else delete state.machine.overlap;
    }));
    const chosen = overlap?.of ?? [];
    const boxes = overlap?.goal !== "acceleration" ? [] : names.map((name) => {
      const box = html("input", { type: "checkbox", checked: chosen.includes(name), onchange: () => this.#study.change(`overlap of ${name}`, (state) => {
        state.machine.overlap.of = names.filter((one) => (one === name ? box.checked : chosen.includes(one)));
      }) });
      return html("label", { class: "switch" }, box, `of ${name}`);
    });
    const press = overlap ? [html("button", { type: "button", text: "Put the moves together", onclick: () => this.#together.ask({ study: this.#study.state.machine }) })] : [];
    renew(this.form, group("Overlap", goal, ...boxes, ...press, this.#gained));
  }

  #put({ refused, facts, study: made }, { study }) {
    if (refused) return this.#say([`${refused.word}: ${written(refused.reason)}`], true);
    if (made && same(study, this.#study.state.machine)) {
      this.#study.change("together", (state) => (state.machine = made));
      this.#study.rest();
    }
    return this.#say(facts);
  }

  #say(facts, none = false) {
    this.#gained.replaceChildren(html("p", { class: none ? "reason" : "facts", text: listed(facts) }));
  }
}

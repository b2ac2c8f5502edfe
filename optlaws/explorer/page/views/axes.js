// The timing of the machine: its axes in a diagram with interlocks, the plane of two positions, clearances, a run.

import { choice } from "../form.js";
import { Latest } from "../latest.js";
import { column, group, growing, head, laidOut, panel, part, picture, status } from "../layout.js";
import { createCursor, createPanels, createRun } from "../panels.js";
import { createPositions } from "../planes.js";
import { showTrust, table } from "../report.js";
import { button, html, renew } from "../svg.js";
import { createTiming, valueAt } from "../timing.js";
import { listed, written } from "../units.js";
import { same } from "../views.js";

const GOALS = { "": "as they are given", acceleration: "least acceleration", period: "least period" };
const WORDS = { clear: "good", broken: "bad" };
const PEAKS = ["axis", "stroke", "velocity", "acceleration", "jerk", "laws"];

export function createView(root, study) {
  const files = ["python", "problem", "table"];
  const cursor = createCursor();
  const gained = html("div", { role: "status", "aria-live": "polite" });
  let current = null;
  let asked = null;
  let clearancesKnown = null;
  let shownShape = "";
  const elements = laidOut(root,
    column("axes-middle", "Timing diagram and positions", status("axes-trust"),
      html("div", { class: "panel" }, part("axes-timing"), part("axes-run"), html("p", { class: "facts", id: "axes-reading" })),
      growing(head(html("span", { class: "quiet", text: "positions" }), html("select", { id: "axes-choice", "aria-label": "plane of two positions" })), picture("axes-plane"))),
    column("axes-right", "Clearances", panel("axes-rooms"), panel("axes-table", { class: "panel scrolled", tabindex: "0", role: "group", "aria-label": "Clearances and peaks" })),
  );
  const { timing, run, plane, choice: planes, rooms } = elements;
  const form = html("div");
  const diagram = createTiming(timing, moved);
  const positions = createPositions(plane, cornered);
  const clearancePanels = createPanels(rooms, { cursor });
  createRun(run, "Angle of the master, degrees", cursor);
  cursor.watch(turn);
  planes.addEventListener("change", () => study.change("plane", (state) => (state.plane = Number(planes.value))));
  const answers = new Latest("api/axes", answered);
  const clearances = new Latest("api/axes-clearances", (known, question) => same(question, asked) && know(known));
  const together = new Latest("api/axes-together", put, (error) => say([error.message]));

  /** The axis of the programme is the one that a controller is to run. */
  function request({ machine, axis }) {
    return { study: machine, axis };
  }

  function show(state) {
    goal(state.machine);
    answers.ask({ study: state.machine });
    if (current) draw();
  }

  function answered(answer, question) {
    current = answer;
    asked = question;
    if (answer.refused) know({ refused: answer.refused });
    else {
      clearances.ask(question);
      draw();
      facts();
    }
  }

  /** What is proven of the answer that is drawn. */
  function know(known) {
    clearancesKnown = { rows: [], ...known, of: JSON.stringify(asked) };
    showTrust(elements.trust, known);
    draw();
    facts();
  }

  function draw() {
    const known = clearancesKnown?.of === JSON.stringify(asked) ? clearancesKnown.rows : [];
    const { study: machine } = asked;
    diagram.show(current, machine, known.map(({ status }) => status), same(machine, study.state.machine));
    positions.show(current, study.state.plane ?? 0, known);
    const { refused, panels, across, unit, note, planes = [] } = current;
    clearancePanels.show(refused ? current : { across, unit, note, panels: known.length ? clearancesKnown.panels : panels, segments: [] });
    const { choice: chosen } = elements;
    const names = planes.map(({ axes }) => axes.join(" and "));
    if (JSON.stringify(names) !== JSON.stringify([...chosen.options].map(({ text }) => text))) chosen.replaceChildren(...names.map((text, value) => html("option", { value, text, translate: "no" })));
    chosen.hidden = names.length < 2;
    chosen.value = String(Math.min(study.state.plane ?? 0, names.length - 1));
    turn(cursor.at);
  }

  /** Where all axes are at an angle of the master. */
  function turn(at) {
    diagram.turn(at);
    positions.turn(at);
    const angle = at ?? 0;
    const rows = current?.refused ? [] : current?.rows ?? [];
    const places = rows.map(({ name, values, unit }) => `${name} ${written({ value: valueAt(current.at, values, angle), unit, digits: 4 })}`);
    elements.reading.textContent = [`at ${written({ value: Number(angle.toFixed(1)), unit: "deg", digits: 6 })}`, ...places].join(" · ");
  }

  function facts() {
    const rows = current.refused ? [] : current.rows;
    const shown = rows.length ? [table("Axes with their peaks", PEAKS, rows.map(({ name, cells }) => [name, ...cells]))] : [];
    const proven = clearancesKnown?.of === JSON.stringify(asked) ? clearancesKnown.tables ?? [] : [];
    const words = (cells) => [cells[0], html("span", { class: `word ${WORDS[cells[1]] ?? "warn"}`, text: cells[1] }), ...cells.slice(2)];
    elements.table.replaceChildren(...proven.map((one) => table("Least clearances of the interlocks", one.headings, one.rows.map(words))), ...shown);
  }

  /** A bar of an axis was moved, or taken or let go. */
  function moved(row, segments) {
    study.change(`bar ${row}`, (state) => {
      state.axis = row;
      if (segments) state.machine.axis[row].segment = segments;
    });
    if (!segments) study.rest();
  }

  function cornered(rule, corner, place) {
    if (!place) return study.rest();
    const { axes, units } = current.planes.find(({ regions }) => regions.some((one) => one.rule === rule));
    return study.change(`corner ${rule} ${corner}`, (state) => {
      const { axis, across, corners } = state.machine.interlocks[rule];
      corners[corner] = place.map((value, i) => `${value} ${units[axes.indexOf([axis, across][i])]}`);
    });
  }

  /** For what the moves are put together, and of which axes an acceleration is to be least. */
  function goal({ overlap, axis }) {
    const names = axis.map(({ name }) => name);
    const shape = JSON.stringify([names, overlap]);
    if (shape === shownShape) return;
    shownShape = shape;
    const goal = choice("put the moves together for", GOALS, overlap?.goal ?? "", (value) => study.change("overlap", (state) => {
      if (value) state.machine.overlap = { goal: value, ...(value === "acceleration" && { of: [names[state.axis] ?? names[0]] }) };
      else delete state.machine.overlap;
    }));
    const chosen = overlap?.of ?? [];
    const boxes = overlap?.goal !== "acceleration" ? [] : names.map((name) => {
      const box = html("input", { type: "checkbox", checked: chosen.includes(name), onchange: () => study.change(`overlap of ${name}`, (state) => {
        state.machine.overlap.of = names.filter((one) => (one === name ? box.checked : chosen.includes(one)));
      }) });
      return html("label", { class: "switch" }, box, `of ${name}`);
    });
    const press = overlap ? [button("Put the moves together", () => together.ask({ study: study.state.machine }))] : [];
    renew(form, group("Overlap", goal, ...boxes, ...press, gained));
  }

  function put({ refused, facts, study: made }, { study: machine }) {
    if (refused) return say([`${refused.word}: ${written(refused.reason)}`], true);
    if (made && same(machine, study.state.machine)) {
      study.change("together", (state) => (state.machine = made));
      study.rest();
    }
    return say(facts);
  }

  function say(facts, none = false) {
    gained.replaceChildren(html("p", { class: none ? "reason" : "facts", text: listed(facts) }));
  }

  return { files, moves: true, drawings: "#axes-timing svg, #axes-plane svg, #axes-rooms svg", request, show, form };
}

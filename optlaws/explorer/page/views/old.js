// The view of an old cam: its table dropped or chosen, the moves that it holds, and better laws within a tolerance.

import { fileOf, stateOf, textOf } from "../files.js";
import { createForm, slider } from "../form.js";
import { Latest } from "../latest.js";
import { column, group, laidOut, panel, status } from "../layout.js";
import { createPanels, createStrip } from "../panels.js";
import { checking, showTrust, table } from "../report.js";
import { button, html, renew } from "../svg.js";
import { written } from "../units.js";
import { same } from "../views.js";

const ELSEWHERE = ["text", "file", "within", "speed"];

export function createView(root, study, { table: entries }) {
  const files = ["problem", "cycle", "table"];
  const band = html("div");
  const name = html("strong");
  let withinField = null;
  let current = null;
  let readStudy = null;
  let betterLaws = [];
  let wanted = false; // each takes a second of the processor and more: they wait for a click
  const tableForm = createForm((what, alter) => study.change(what, (state) => alter(state.old)), () => study.rest());
  const at = laidOut(root,
    html("aside", { id: "old-ask", "aria-label": "The table and what is asked of it" }),
    column("old-middle", "What the table holds", status("old-trust"), panel("old-moves"), panel("old-gains")),
    html("section", { id: "old-curves", class: "panel", "aria-label": "Points and laws over the master" }),
  );
  const curves = createPanels(at.curves, { strip: createStrip({ chosen: (i) => curves.look(current.segments[i].at) }) });
  const tables = new Latest("api/old", answered);
  const better = new Latest("api/old-move", find);
  build(entries);

  /** Every file but those of problems and laws is a table here. */
  async function dropped(file) {
    if (/\.(json|toml)$/i.test(file.name)) return false;
    await take(file);
    return true;
  }

  /** The cycle with its better laws, as far as they are found. */
  function request({ old }) {
    const known = readStudy && same(near(readStudy), near(old));
    return { study: old, laws: known ? laws() : [] };
  }

  /** The better laws that are found, and nothing for a move that keeps its own. */
  function laws() {
    return betterLaws.some((one) => one?.law) ? [Array.from(betterLaws, (one) => one?.law ?? {})] : [];
  }

  function show(state) {
    name.textContent = state.old.file ?? "table";
    tableForm.show(state.old);
    withinField?.set(state.old.within ?? current?.within ?? null);
    if (!same(near(state.old), readStudy && near(readStudy))) tables.ask({ study: state.old });
    else ask();
  }

  /** A table that is read anew has no better laws yet. */
  function answered(answer, { study: asked, laws = [] }) {
    current = answer;
    if (!laws.length) {
      readStudy = asked;
      betterLaws = [];
      showTrust(at.trust, answer);
      if (!answer.refused) measure(answer);
    }
    draw();
    if (!laws.length) ask();
  }

  /** Ask for the better laws one by one, from the first that is not known for this tolerance. */
  function ask() {
    if (!current || current.refused || !wanted) return;
    const next = current.moves.findIndex((_, i) => !betterLaws[i]);
    if (next >= 0) better.ask({ study: bounded(), axis: next });
  }

  /** The table with the tolerance that is taken where none is given. */
  function bounded() {
    return { ...readStudy, within: current.within };
  }

  function find(answer, { study: asked, axis }) {
    if (!same(asked, bounded()) || !same(near(study.state.old), near(readStudy))) return;
    betterLaws[axis] = answer;
    draw();
    if (answer.law) tables.ask({ study: asked, laws: laws() });
    if (!answer.refused || answer.refused.word !== "no answer") ask();
  }

  function draw() {
    const answer = current;
    curves.show(answer.refused ? answer : { ...answer, active: 0 });
    if (answer.refused) return [at.moves, at.gains].forEach((one) => one.replaceChildren());
    const { moves, heights: unit, drawn, tables: [stretches, gains] } = answer;
    at.moves.replaceChildren(table("Moves of the table", stretches.headings, stretches.rows), html("p", { class: "facts", text: ["A old law · B new law · C points", drawn].filter(Boolean).join(" · ") }), button("Take these moves as the machine", ({ target }) => hand().catch((error) => target.after(html("p", { class: "reason", text: error.message })))));
    const words = `Laws of least acceleration within ${written({ value: answer.within, unit, digits: 6 })} of the old ones at every place; jerk at most a fifth above.`;
    const press = button("Find better laws", () => {
      wanted = true;
      draw();
      ask();
    });
    const missing = moves.map((name, i) => [name, betterLaws[i]]).filter(([, one]) => !one?.law).map(([name, one]) => `${name}: ${one ? written(one.kept ?? one.refused.reason) : "…"}`);
    const found = laws().length ? [...(gains ? [table("Better laws within the tolerance", gains.headings, gains.rows)] : []), checking()] : [];
    renew(at.gains, html("p", { class: "quiet", text: words }), ...(wanted ? [...found, html("p", { class: "facts", text: missing.join(" · ") })] : [press]));
  }

  /** The moves are the machine from now on, with their laws by name. */
  async function hand() {
    const { text } = await fileOf("problem", { request }, study.state);
    const { machine } = await stateOf(new File([text], "table.toml"));
    study.change("take moves", (state) => Object.assign(state, { machine, axis: 0, view: "cycle" }));
  }

  /** The tolerance is dragged up to a fiftieth of the stroke, or typed. */
  function measure({ stroke, heights: unit, within }) {
    const high = Number((stroke / 50).toPrecision(1));
    const step = 10 ** Math.floor(Math.log10(high / 100));
    withinField = slider({
      name: `± ${unit}`, title: "Tolerance of the better laws", low: 0, high, step, off: false,
      changed: (value) => value > 0 && study.change("within", (state) => (state.old.within = value)), rested: () => study.rest(),
    });
    withinField.set(study.state.old.within ?? within);
    renew(band, group("Tolerance band", withinField.element));
  }

  function build(entries) {
    const chooser = html("input", { type: "file", "aria-label": "Table of an old cam", onchange: () => chooser.files.length && take(chooser.files[0]) });
    const fields = (shown) => entries.filter(({ name }) => shown(name)).map((entry) => tableForm.field({ ...entry, path: [entry.name] }, entry.label));
    at.ask.replaceChildren(
      group("Table", html("p", {}, name), chooser, html("p", { class: "hint", text: "or drop a file anywhere: columns of numbers, or what a controller has (CODESYS, TwinCAT, Siemens, an .L5X of Rockwell, …)" }), ...fields((name) => !ELSEWHERE.includes(name))),
      band,
      group("Machine", ...fields((name) => name === "speed")),
    );
  }

  async function take(file) {
    const text = await textOf(file);
    study.change(`table ${file.name}`, (state) => (state.old = { file: file.name.slice(-200), text }));
    study.rest();
  }

  return { files, moves: true, drawings: "#old-curves svg", dropped, request, show };
}

/** What better laws depend on. */
const near = ({ speed, ...rest }) => rest;

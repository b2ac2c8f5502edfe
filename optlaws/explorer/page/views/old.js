// The view of an old cam: its table dropped or chosen, the moves that it holds, and better laws within a tolerance.

import { fileOf, stateOf, textOf } from "../files.js";
import { Form, slider } from "../form.js";
import { Latest } from "../latest.js";
import { column, group, laidOut, panel, status } from "../layout.js";
import { Panels } from "../panels.js";
import { checking, showTrust, table } from "../report.js";
import { Strip } from "../strip.js";
import { html, renew } from "../svg.js";
import { written } from "../units.js";
import { same } from "../views.js";

const ELSEWHERE = ["text", "file", "within", "speed"];

export class View {
  files = ["problem", "cycle", "table"];
  moves = true;
  drawings = "#old-curves svg";
  #study;
  #at;
  #band = html("div");
  #name = html("strong");
  #fields;
  #within = null;
  #curves;
  #tables;
  #better;
  #answer = null;
  #asked = null;
  #found = [];
  #wanted = false; // each takes a second of the processor and more: they wait for a click

  constructor(root, study, { table: entries }) {
    this.#study = study;
    this.#fields = new Form((what, alter) => study.change(what, (state) => alter(state.old)), () => study.rest());
    this.#at = laidOut(root,
      html("aside", { id: "old-ask", "aria-label": "The table and what is asked of it" }),
      column("old-middle", "What the table holds", status("old-trust"), panel("old-moves"), panel("old-gains")),
      html("section", { id: "old-curves", class: "panel", "aria-label": "Points and laws over the master" }),
    );
    this.#curves = new Panels(this.#at.curves, { strip: new Strip({ chosen: (i) => this.#curves.look(this.#answer.segments[i].at) }) });
    this.#tables = new Latest("api/old", (...answer) => this.#answered(...answer));
    this.#better = new Latest("api/old-move", (answer, question) => this.#find(answer, question));
    this.#build(entries);
  }

  /** Every file but those of problems and laws is a table here. */
  async dropped(file) {
    if (/\.(json|toml)$/i.test(file.name)) return false;
    await this.#take(file);
    return true;
  }

  /** The cycle with its better laws, as far as they are found. */
  request({ old }) {
    const known = this.#asked && same(near(this.#asked), near(old));
    return { study: old, laws: known ? this.#laws : [] };
  }

  /** The better laws that are found, and nothing for a move that keeps its own. */
  get #laws() {
    return this.#found.some((one) => one?.law) ? [Array.from(this.#found, (one) => one?.law ?? {})] : [];
  }

  show(state) {
    this.#name.textContent = state.old.file ?? "table";
    this.#fields.show(state.old);
    this.#within?.set(state.old.within ?? this.#answer?.within ?? null);
    if (!same(near(state.old), this.#asked && near(this.#asked))) this.#tables.ask({ study: state.old });
    else this.#ask();
  }

  /** A table that is read anew has no better laws yet. */
  #answered(answer, { study, laws = [] }) {
    this.#answer = answer;
    if (!laws.length) {
      this.#asked = study;
      this.#found = [];
      showTrust(this.#at.trust, answer);
      if (!answer.refused) this.#measure(answer);
    }
    this.#draw();
    if (!laws.length) this.#ask();
  }

  /** Ask for the better laws one by one, from the first that is not known for this tolerance. */
  #ask() {
    if (!this.#answer || this.#answer.refused || !this.#wanted) return;
    const next = this.#answer.moves.findIndex((_, i) => !this.#found[i]);
    if (next >= 0) this.#better.ask({ study: this.#bounded, axis: next });
  }

  /** The table with the tolerance that is taken where none is given. */
  get #bounded() {
    return { ...this.#asked, within: this.#answer.within };
  }

  #find(answer, { study, axis }) {
    if (!same(study, this.#bounded) || !same(near(this.#study.state.old), near(this.#asked))) return;
    this.#found[axis] = answer;
    this.#draw();
    if (answer.law) this.#tables.ask({ study, laws: this.#laws });
    if (!answer.refused || answer.refused.word !== "no answer") this.#ask();
  }

  #draw() {
    const answer = this.#answer;
    this.#curves.show(answer.refused ? answer : { ...answer, active: 0 });
    if (answer.refused) {
      this.#at.moves.replaceChildren();
      this.#at.gains.replaceChildren();
      return;
    }
    const { moves, heights: unit, drawn, tables: [stretches, gains] } = answer;
    this.#at.moves.replaceChildren(table("Moves of the table", stretches.headings, stretches.rows), html("p", { class: "facts", text: ["A old law · B new law · C points", drawn].filter(Boolean).join(" · ") }), html("button", { type: "button", text: "Take these moves as the machine", onclick: ({ target }) => this.#hand().catch((error) => target.after(html("p", { class: "reason", text: error.message }))) }));
    const words = `Laws of least acceleration within ${written({ value: answer.within, unit, digits: 6 })} of the old ones at every place; jerk at most a fifth above.`;
    const button = html("button", { type: "button", text: "Find better laws", onclick: () => {
      this.#wanted = true;
      this.#draw();
      this.#ask();
    } });
    const missing = moves.map((name, i) => [name, this.#found[i]]).filter(([, one]) => !one?.law).map(([name, one]) => `${name}: ${one ? written(one.kept ?? one.refused.reason) : "…"}`);
    const found = this.#laws.length ? [...(gains ? [table("Better laws within the tolerance", gains.headings, gains.rows)] : []), checking()] : [];
    renew(this.#at.gains, html("p", { class: "quiet", text: words }), ...(this.#wanted ? [...found, html("p", { class: "facts", text: missing.join(" · ") })] : [button]));
  }

  /** The moves are the machine from now on, with their laws by name. */
  async #hand() {
    const { text } = await fileOf("problem", this, this.#study.state);
    const { machine } = await stateOf(new File([text], "table.toml"));
    this.#study.change("take moves", (state) => Object.assign(state, { machine, axis: 0, view: "cycle" }));
  }

  /** The tolerance is dragged up to a fiftieth of the stroke, or typed. */
  #measure({ stroke, heights: unit, within }) {
    const high = Number((stroke / 50).toPrecision(1));
    const step = 10 ** Math.floor(Math.log10(high / 100));
    this.#within = slider({
      name: `± ${unit}`, title: "Tolerance of the better laws", low: 0, high, step, off: false,
      changed: (value) => value > 0 && this.#study.change("within", (state) => (state.old.within = value)), rested: () => this.#study.rest(),
    });
    this.#within.set(this.#study.state.old.within ?? within);
    renew(this.#band, group("Tolerance band", this.#within.element));
  }

  #build(entries) {
    const chooser = html("input", { type: "file", "aria-label": "Table of an old cam", onchange: () => chooser.files.length && this.#take(chooser.files[0]) });
    const fields = (shown) => entries.filter(({ name }) => shown(name)).map((entry) => this.#fields.field({ ...entry, path: [entry.name] }, entry.label));
    this.#at.ask.replaceChildren(
      group("Table", html("p", {}, this.#name), chooser, html("p", { class: "hint", text: "or drop a file anywhere: columns of numbers, or what a controller has (CODESYS, TwinCAT, Siemens, an .L5X of Rockwell, …)" }), ...fields((name) => !ELSEWHERE.includes(name))),
      this.#band,
      group("Machine", ...fields((name) => name === "speed")),
    );
  }

  async #take(file) {
    const text = await textOf(file);
    this.#study.change(`table ${file.name}`, (state) => (state.old = { file: file.name.slice(-200), text }));
    this.#study.rest();
  }
}

/** What better laws depend on. */
const near = ({ speed, ...rest }) => rest;

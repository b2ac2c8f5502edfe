// The view of a problem file with many problems: a row for each; a click on one shows its law.

import { curvesOf } from "../law_curves.js";
import { Latest } from "../latest.js";
import { Panels } from "../panels.js";
import { html, renew } from "../svg.js";
import { showTrust, unanswered } from "../trust.js";

const told = (value) => JSON.stringify(value);
const CONSTANTS = ["B", "C", "D", "J", "rms_c"];

export class View {
  files = [{ kind: "problem", text: "Problem file (TOML)", about: "For optlaws run" }];
  drawings = "#study-curves svg";
  #study;
  #state = null;
  #about = html("aside", { id: "study-about", "aria-label": "The problem file" });
  #rows = html("div", { class: "panel", id: "study-rows" });
  #trust = html("div", { class: "panel", id: "study-trust", role: "status", "aria-live": "polite" });
  #curves;
  #answer = null;
  #asked = null;
  #views = new Map();
  #files;
  #law;
  #others;

  constructor(root, study) {
    this.#study = study;
    const curves = html("section", { id: "study-curves", class: "panel", "aria-label": "The law of the row and its derivatives" });
    root.append(this.#about, html("section", { id: "study-middle", "aria-label": "The problems of the file" }, this.#trust, this.#rows), curves);
    this.#curves = new Panels(curves);
    this.#files = new Latest("api/study", (answer) => this.#answered(answer), (error) => this.#answered(unanswered(error)));
    this.#law = new Latest("api/laws", ({ laws: [view] }, question) => this.#know(question.laws[0], view), (error, question) => this.#know(question.laws[0], unanswered(error)));
    this.#others = new Latest("api/laws", ({ laws: [view] }, question) => this.#know(question.laws[0], view), (error, question) => this.#know(question.laws[0], unanswered(error)));
  }

  /** The part of a study that files are made of. */
  saved({ study }) {
    return { study: { study } };
  }

  /** The proof of the row's law. */
  proof() {
    return { view: "laws", laws: [this.#own.law], active: 0 };
  }

  show(state) {
    this.#state = state;
    if (told(state.study) !== this.#asked) {
      this.#asked = told(state.study);
      this.#answer = null;
      this.#views.clear();
      this.#files.ask({ study: state.study });
    } else this.#render();
  }

  get #own() {
    return this.#answer?.rows?.[this.#state.row] ?? this.#answer?.rows?.[0] ?? null;
  }

  #answered(answer) {
    this.#answer = answer;
    this.#render();
  }

  #know(law, view) {
    this.#views.set(told(law), view);
    this.#render();
  }

  #render() {
    const answer = this.#answer;
    if (!answer) return;
    const own = this.#own;
    if (own && !this.#views.has(told(own.law))) this.#law.ask({ laws: [own.law] });
    const view = own && this.#views.get(told(own.law));
    this.#about.replaceChildren(...this.#words(answer));
    showTrust(this.#trust, answer.refused ? answer : view ?? null, [], () => {});
    if (answer.note) this.#trust.append(html("p", { text: answer.note }));
    this.#curves.show(answer.refused ?? !own ? { refused: answer.refused ?? { word: answer.job } } : curvesOf([view], 0));
    renew(this.#rows, ...(own ? [this.#table(answer)] : []));
    // the other rows follow one by one, as long as the view is seen
    const next = own && view && !this.#rows.closest(".view").hidden && answer.rows.find(({ law }) => !this.#views.has(told(law)));
    if (next && !this.#others.behind) this.#others.ask({ laws: [next.law] });
  }

  #words({ title, text, rows, job }) {
    const open = html("button", { type: "button", text: "Change this law", onclick: () => this.#study.change("row as law", (state) => {
      state.laws = [structuredClone(this.#own.law)];
      state.active = 0;
      state.view = "laws";
    }) });
    return [html("h2", { text: title ?? "" }), html("p", { class: "hint", text: job ?? "" }), html("p", { text: text ?? "" }), ...(rows?.length ? [open] : [])];
  }

  #table({ names, rows }) {
    const own = this.#own;
    const head = html("tr", {}, html("th", { scope: "col", text: "row" }), ...names.map((text) => html("th", { scope: "col", text })), ...[...CONSTANTS, "status"].map((text) => html("th", { scope: "col", class: "number", text: text.replace("_", " ") })));
    const lines = rows.map((row, i) => {
      const view = this.#views.get(told(row.law));
      const constant = (name) => view?.constants?.find((one) => one.name === name)?.text ?? (view ? "—" : "");
      const choose = html("button", { type: "button", class: "link", "data-key": `row ${i}`, text: String(i + 1), "aria-label": `Show the law of row ${i + 1}`, onclick: () => this.#choose(i) });
      return html("tr", { class: row === own ? "active" : "", "aria-current": row === own ? "true" : null, onclick: () => this.#choose(i) },
        html("th", { scope: "row" }, choose), ...row.cells.map((text) => html("td", { text, title: text })), ...CONSTANTS.map((name) => html("td", { class: "number", text: constant(name) })),
        html("td", { class: "number", text: view?.trust?.word ?? view?.refused?.word ?? "…" }));
    });
    return html("table", { "aria-label": "The problems of the file with the constants of their laws" }, html("thead", {}, head), html("tbody", {}, ...lines));
  }

  #choose(i) {
    this.#study.change("row", (state) => (state.row = i));
  }
}

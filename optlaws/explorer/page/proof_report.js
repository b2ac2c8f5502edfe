// The check of a proof file beside the page: what it says of each claim, and how long it took.

import { html } from "./svg.js";

const WORDS = { proven: "good", "not proven": "bad", "not checked": "warn" };
export class ProofReport {
  #verdict;
  #claims;
  #working;
  #ready;
  #worker;
  #checking = false;

  /** Elements for the verdict and for the table of claims; `working(busy)` is told when a check begins and ends, `ready()`
   *  when all that it needs of the server is there. */
  constructor(verdict, claims, { working = () => {}, ready = () => {} }) {
    this.#verdict = verdict;
    this.#claims = claims;
    this.#working = working;
    this.#ready = ready;
    this.#begin();
  }

  #begin() {
    this.#worker = new Worker("proof_worker.mjs", { type: "module" });
    this.#worker.onmessage = ({ data }) => data.ready && this.#ready();
  }

  check(name, text) {
    if (this.#checking) this.#end();
    this.#checking = true;
    this.#working(true);
    this.#verdict.hidden = false;
    this.#claims.hidden = true;
    const stop = html("button", { type: "button", text: "Stop", onclick: () => {
      this.#end();
      this.#show({ error: "stopped" }, name);
    } });
    this.#verdict.replaceChildren(html("p", {}, `Checking ${name} … `, stop));
    this.#worker.onmessage = ({ data }) => (data.ready ? this.#ready() : this.#show(data, name));
    this.#worker.onerror = () => this.#show({ error: "this browser cannot run the check" }, name);
    this.#worker.postMessage(text);
  }

  #end() {
    this.#worker.terminate();
    this.#begin();
  }

  #show({ results, seconds, error }, name) {
    this.#checking = false;
    if (error || !results.length) {
      const reason = error ?? "nothing in it is a certificate or a solution";
      this.#verdict.replaceChildren(html("p", { class: "reason" }, html("strong", { class: "word refused", text: "not checked" }), ` ${name}: ${reason}`));
    } else this.#list(results, seconds, name);
    this.#working(false);
  }

  #list(results, seconds, name) {
    const counts = Object.keys(WORDS).map((word) => [word, results.filter((result) => result.verdict === word).length]);
    const worst = counts[1][1] ? "not proven" : counts[2][1] ? "not checked" : "proven";
    const text = counts.filter(([, count]) => count).map(([word, count]) => `${count} ${word}`).join(", ");
    const word = worst === "not checked" ? "partly checked" : worst;
    this.#verdict.replaceChildren(
      html("p", {}, html("strong", { class: `word ${WORDS[worst]}`, text: word }), ` ${name}: ${text}`),
      html("p", { class: "quiet", text: `checked on this page in ${seconds.toFixed(2)} s` }),
    );
    const rows = results.map((result) => html("tr", {}, html("td", {}, html("span", { class: WORDS[result.verdict], text: result.verdict })), html("td", { text: result.path }), html("td", { text: result.detail })));
    this.#claims.hidden = false;
    const head = html("tr", {}, ...["verdict", "where", "what"].map((title) => html("th", { scope: "col", text: title })));
    this.#claims.replaceChildren(html("table", { class: "claims" }, html("thead", {}, head), html("tbody", {}, ...rows)));
  }
}

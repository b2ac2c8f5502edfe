// The view of a proof: that of a result, or of a file, checked on this page by a program that shares no code with the library.

import { during } from "../latest.js";
import { ProofReport } from "../proof_report.js";
import { html } from "../svg.js";

const ABOUT = "The multipliers of the file are added up in fractions of whole numbers, by a program that shares no code with the library and asks no server. It never rounds in favour of a claim, and says what it does not know.";
const part = (id, attributes) => html("section", { id, class: "panel", ...attributes, hidden: true });

// they begin when this module is loaded, so that files are checked when the server is away
const verdict = part("proof-verdict", { role: "status", "aria-live": "polite" });
const claims = part("proof-claims", { "aria-label": "What the file states" });
let done = () => {};
const offline = html("p", { class: "facts" });
const report = new ProofReport(verdict, claims, {
  working: (busy) => {
    done();
    if (busy) during(new Promise((resolve) => (done = resolve)));
  },
  ready: () => (offline.textContent = "The checker is loaded: files are checked without the server."),
});
let waiting = null;

/** Check a file as soon as the view is shown. */
export function prove(name, text) {
  waiting = { name, text };
}

export class View {
  files = [];

  constructor(root) {
    const chooser = html("input", { type: "file", accept: ".json,application/json", "aria-label": "File with a proof" });
    chooser.addEventListener("change", async () => chooser.files.length && this.dropped(chooser.files[0]));
    root.append(
      html("section", { class: "panel", "aria-label": "The file to check" },
        html("p", {}, html("strong", { text: "A solution, a table of laws or a certificate (JSON): choose it, or drop it anywhere." })),
        html("p", {}, chooser), html("p", { class: "quiet", text: ABOUT }), offline),
      verdict, claims,
    );
  }

  /** Files of proofs are checked here; others are opened. */
  async dropped(file) {
    if (!file.name.toLowerCase().endsWith(".json")) return false;
    report.check(file.name, await file.text());
    return true;
  }

  show() {
    if (waiting) report.check(waiting.name, waiting.text);
    waiting = null;
  }
}

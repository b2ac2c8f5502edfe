// The view of a proof: that of a result, or of a file, checked on this page by a program that shares no code with the library.

import { during } from "../latest.js";
import { table } from "../report.js";
import { button, html } from "../svg.js";

const ABOUT = "The multipliers of the file are added up in fractions of whole numbers, by a program that shares no code with the library and asks no server. It never rounds in favour of a claim, and says what it does not know.";
const WORDS = { proven: "good", "not proven": "bad", "not checked": "warn" };
const part = (id, attributes) => html("section", { id, class: "panel", ...attributes, hidden: true });

const verdict = part("proof-verdict", { role: "status", "aria-live": "polite" });
const claims = part("proof-claims", { "aria-label": "What the file states" });
const offline = html("p", { class: "facts" });
let worker = null;
let done = null; // ends the check under way
let waiting = null;

function begin() {
  worker = new Worker("proof_worker.mjs", { type: "module" });
  worker.onmessage = ({ data }) => data.ready && (offline.textContent = "The checker is loaded: files are checked without the server.");
}

begin(); // when this module is loaded, so that files are checked when the server is away

/** Check a file as soon as the view is shown. */
export function prove(name, text) {
  waiting = { name, text };
}

function check({ name, text }) {
  if (done) stop();
  during(new Promise((resolve) => (done = resolve)));
  verdict.hidden = false;
  claims.hidden = true;
  verdict.replaceChildren(html("p", {}, `Checking ${name} … `, button("Stop", () => {
    stop();
    show({ error: "stopped" }, name);
  })));
  worker.onmessage = ({ data }) => !data.ready && show(data, name);
  worker.onerror = () => show({ error: "this browser cannot run the check" }, name);
  worker.postMessage(text);
}

function stop() {
  worker.terminate();
  begin();
  done();
  done = null;
}

function show({ results = [], seconds, error = results.length ? null : "nothing in it is a certificate or a solution" }, name) {
  const counts = Object.keys(WORDS).map((word) => [word, results.filter((result) => result.verdict === word).length]).filter(([, count]) => count);
  const worst = ["not proven", "not checked", "proven"].find((word) => counts.some(([one]) => one === word));
  const said = (look, word, text) => html("p", { class: error ? "reason" : null }, html("strong", { class: `word ${look}`, text: word }), ` ${name}: ${text}`);
  if (error) verdict.replaceChildren(said("refused", "not checked", error));
  else {
    const text = counts.map(([word, count]) => `${count} ${word}`).join(", ");
    verdict.replaceChildren(said(WORDS[worst], worst === "not checked" ? "partly checked" : worst, text), html("p", { class: "quiet", text: `checked on this page in ${seconds.toFixed(2)} s` }));
    const rows = results.map((result) => [html("span", { class: WORDS[result.verdict], text: result.verdict }), result.path, result.detail]);
    claims.replaceChildren(table("What the file states", ["verdict", "where", "what"], rows, { class: "claims" }));
  }
  claims.hidden = Boolean(error);
  done?.();
  done = null;
}

export function createView(root) {
  const files = [];
  const chooser = html("input", { type: "file", accept: ".json,application/json", "aria-label": "File with a proof", onchange: () => chooser.files.length && dropped(chooser.files[0]) });
  root.append(
    html("section", { class: "panel", "aria-label": "The file to check" },
      html("p", {}, html("strong", { text: "A solution, a table of laws or a certificate (JSON): choose it, or drop it anywhere." })),
      html("p", {}, chooser), html("p", { class: "quiet", text: ABOUT }), offline),
    verdict, claims,
  );

  /** Files of proofs are checked here; others are opened. */
  async function dropped(file) {
    if (!file.name.toLowerCase().endsWith(".json")) return false;
    check({ name: file.name, text: await file.text() });
    return true;
  }

  function show() {
    if (waiting) check(waiting);
    waiting = null;
  }

  return { files, dropped, show };
}

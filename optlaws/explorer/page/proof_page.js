// A file of proofs checked on this page: chosen or dropped, without a server.

import { html } from "./svg.js";

const [drop, chooser, verdict, claims] = ["drop", "proof-file", "verdict", "claims"].map((id) => document.getElementById(id));
const WORDS = { proven: "good", "not proven": "bad", "not checked": "warn" };
let worker = null;

chooser.addEventListener("change", () => chooser.files.length && check(chooser.files[0]));
for (const kind of ["dragover", "drop"]) document.addEventListener(kind, (event) => event.preventDefault());
document.addEventListener("dragover", () => drop.classList.add("over"));
document.addEventListener("dragleave", () => drop.classList.remove("over"));
document.addEventListener("drop", (event) => {
  drop.classList.remove("over");
  const [file] = event.dataTransfer.files;
  if (file) check(file);
});

async function check(file) {
  worker?.terminate();
  document.body.dataset.work = "busy";
  verdict.hidden = false;
  claims.hidden = true;
  const stop = html("button", { type: "button", text: "Stop", onclick: () => { worker.terminate(); shown({ error: "stopped" }, file.name); } });
  verdict.replaceChildren(html("p", {}, `Checking ${file.name} … `, stop));
  worker = new Worker("proof_worker.mjs", { type: "module" });
  worker.onmessage = ({ data }) => shown(data, file.name);
  worker.onerror = () => shown({ error: "this browser cannot run the check" }, file.name);
  worker.postMessage(await file.text());
}

function shown({ results, seconds, error }, name) {
  document.body.dataset.work = "ready";
  if (error || !results.length) {
    const reason = error ?? "nothing in it is a certificate or a solution";
    verdict.replaceChildren(html("p", { class: "reason" }, html("strong", { class: "word refused", text: "not checked" }), ` ${name}: ${reason}`));
    return;
  }
  const counts = Object.keys(WORDS).map((word) => [word, results.filter((result) => result.verdict === word).length]);
  const worst = counts[1][1] ? "not proven" : counts[2][1] ? "not checked" : "proven";
  const text = counts.filter(([, count]) => count).map(([word, count]) => `${count} ${word}`).join(", ");
  const word = worst === "proven" ? "proven" : worst === "not proven" ? "not proven" : "partly checked";
  verdict.replaceChildren(
    html("p", {}, html("strong", { class: `word ${WORDS[worst]}`, text: word }), ` ${name}: ${text}`),
    html("p", { class: "quiet", text: `checked on this page in ${seconds.toFixed(2)} s` }),
  );
  const rows = results.map((result) => html("tr", {}, html("td", {}, html("span", { class: WORDS[result.verdict], text: result.verdict })), html("td", { text: result.path }), html("td", { text: result.detail })));
  claims.hidden = false;
  claims.replaceChildren(html("table", { class: "claims" }, html("thead", {}, html("tr", {}, ...["", "where", "what"].map((head) => html("th", { scope: "col", text: head })))), html("tbody", {}, ...rows)));
}

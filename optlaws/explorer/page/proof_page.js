// A file of proofs checked on a page of its own: chosen or dropped, without a server.

import { ProofReport } from "./proof_report.js";

const [drop, chooser, verdict, claims] = ["drop", "proof-file", "verdict", "claims"].map((id) => document.getElementById(id));
const report = new ProofReport(verdict, claims, { working: (busy) => (document.body.dataset.work = busy ? "busy" : "ready") });
const check = async (file) => report.check(file.name, await file.text());

chooser.addEventListener("change", () => chooser.files.length && check(chooser.files[0]));
for (const kind of ["dragover", "drop"]) document.addEventListener(kind, (event) => event.preventDefault());
document.addEventListener("dragover", () => drop.classList.add("over"));
document.addEventListener("dragleave", () => drop.classList.remove("over"));
document.addEventListener("drop", (event) => {
  drop.classList.remove("over");
  const [file] = event.dataTransfer.files;
  if (file) check(file);
});

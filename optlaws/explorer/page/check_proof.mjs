/* node check_proof.mjs [--json] FILE...: what proof files state, checked in exact numbers.

   It ends with 1 where something is not proven, with 2 where a file cannot be read, with 3 where something is not checked. */

import { readFileSync } from "node:fs";
import { fileChecked } from "./proof_check.mjs";

const LONGEST = 200; // of a reason
const plain = process.argv.slice(2).filter((argument) => argument !== "--json");
const asJson = plain.length + 2 < process.argv.length;
const ended = new Set(plain.length ? [] : [2]);
for (const file of plain) {
  let results = [];
  try {
    results = fileChecked(JSON.parse(readFileSync(file, "utf8")));
  } catch (error) {
    console.error(`${file}: ${error.message}`);
    ended.add(2);
    continue;
  }
  if (!results.length) results.push({ path: "the file", verdict: "not checked", detail: "nothing in it is a certificate, a solution or a law with its constants" });
  if (results.some(({ verdict }) => verdict === "not proven")) ended.add(1);
  if (results.some(({ verdict }) => verdict === "not checked")) ended.add(3);
  if (asJson) {
    console.log(JSON.stringify(results.map((result) => ({ ...result, bound: result.bound?.toNumber() ?? null }))));
    continue;
  }
  const unchecked = new Map(); // reasons that differ in their numbers alone are one
  for (const { path, verdict, detail } of results) {
    const reason = detail.replace(/\d[\d.e+-]*/g, "#");
    if (verdict === "not checked") unchecked.set(reason, [...(unchecked.get(reason) ?? []), { path, detail }]);
    else console.log(`${file}: ${path}: ${verdict}: ${detail}`);
  }
  for (const [{ path, detail }, ...others] of unchecked.values()) {
    const shown = detail.length > LONGEST ? `${detail.slice(0, LONGEST)}...` : detail;
    console.log(`${file}: ${path}${others.length ? ` and ${others.length} more` : ""}: not checked: ${shown}`);
  }
  const counts = ["proven", "not proven", "not checked"].map((word) => `${results.filter(({ verdict }) => verdict === word).length} ${word}`);
  console.log(`${file}: ${counts.join(", ")}`);
}
// what is false comes first, then what cannot be read, then what is checked in part
process.exitCode = [1, 2, 3].find((status) => ended.has(status)) ?? 0;

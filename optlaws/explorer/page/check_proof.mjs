/* node check_proof.mjs FILE...: every certificate of proof files, checked in exact numbers. */

import { readFileSync } from "node:fs";
import { fileChecked } from "./proof_check.mjs";

const files = process.argv.slice(2);
let worst = 0;
for (const file of files) {
  const results = fileChecked(JSON.parse(readFileSync(file, "utf8")));
  for (const { path, verdict, detail } of results) {
    console.log(`${file}: ${path}: ${verdict}: ${detail}`);
    if (verdict === "not proven") worst = 1;
  }
}
process.exitCode = files.length ? worst : 2;

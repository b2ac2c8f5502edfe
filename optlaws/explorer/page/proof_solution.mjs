/* What a file states of a law beside its proofs, held against the law and against what the proofs prove. */

import { HALF, ONE, Unknown, ZERO, exact, greatest, sum, whole } from "./proof_numbers.mjs";
import { MEANS, PEAKS, parsed, scaleOf } from "./proof_rows.mjs";
import { ends, lawOfZ } from "./proof_laws.mjs";
import { limitOf } from "./proof_limits.mjs";
import { conditionsOf, distance, enclosed, missesOf, motionOf, objectiveOf, reachedAt } from "./proof_motion.mjs";

/* Stated constants are doubles: by how much of themselves they may be off, bounds, and the ends of a law. */
const STATED = exact(1e-9);
const ROUNDED = exact(1e-11);
const ROUNDING = exact(1e-12);
/* By how much of its bound a law may break a condition. */
const KEPT = exact(1e-9);
/* What a gap may be off, and be without: the law is optimal then. */
const GAP = exact(1e-8);
/* An objective that is less, of its scale, is 0 but for rounding. */
const NO_OBJECTIVE = exact(1e-6);
/* By how much of its size a law may differ from its Z. */
const ROUNDED_SERIES = exact(2 ** -44);

/* Pairs of numbers, of which the first is proven to be at most the second; what is less is 0 but for rounding. */
const ORDERED = [["lower_bound", "objective"], ["best_possible", "objective"], ["lower_bound", "value"], ["best_possible", "duration"]];
const NOTHING = exact(1e-12);

/* Bounds that are stated to be above what they are bounds of, whatever that is. */
export function boundsAbove(data, path) {
  const isAbove = (low, high) => typeof low === "number" && typeof high === "number" && exact(high).plus(greatest(STATED.times(exact(high).magnitude()), NOTHING)).below(exact(low));
  return ORDERED.filter(([low, high]) => isAbove(data[low], data[high])).map(([low, high]) => (
    { path: `${path}: ${low.replace("_", " ")}`, verdict: "not proven", detail: `${data[low]} is stated, above the ${high}, ${data[high]}` }
  ));
}

/* What a solution states beside its proofs, held against its law and against what the proofs prove. */
export function solutionChecked(data, path, proven) {
  const claims = [];
  const claim = (name, holds, detail) => claims.push({ path: `${path}: ${name}`, verdict: holds ? "proven" : "not proven", detail });
  const tried = (name, check) => {
    try {
      check();
    } catch (error) {
      const known = error instanceof Unknown;
      claims.push({ path: `${path}: ${name}`, verdict: known ? "not checked" : "not proven", detail: known ? `this program does not know ${error.message}` : error.message });
    }
  };
  const { problem } = data;
  let highest = null;
  tried("law", () => {
    const motion = motionOf(data.law);
    claims.push(...constantsChecked(data, path, motion));
    tried("objective", () => {
      const objective = objectiveOf(motion, parsed(problem.minimise));
      [, highest] = objective;
      if (data.objective !== undefined) claim("objective", near(data.objective, objective, scaleOf(parsed(problem.minimise))), `${data.objective} is stated, ${objective[1].toNumber()} is that of the law`);
    });
    for (const key of ["certificate", "power_certificate", "peak_certificate"]) {
      if (data[key]) claim(`problem of the ${key.replace("_", " ")}`, sameData(data[key].problem, problem), "it is to be that of the file");
    }
    if (data.z) tried("Z", () => claim("Z", fitsZ(motion, problem, data.z), "its law is to be that of the file"));
    const misses = missesOf(motion, ends(problem)).filter(({ by, size }) => ROUNDING.times(size).below(by));
    claim("ends", misses.length === 0, misses.length ? `derivative ${misses[0].nu} at ${misses[0].end} is off by ${misses[0].by.toNumber()}` : "the law has the derivatives that are given");
    for (const { name, by } of conditionsOf(motion, problem)) {
      tried(name, () => {
        const most = by();
        claim(name, !KEPT.below(most), most.sign > 0 ? `broken by at most ${most.toNumber()} of its bound` : "kept");
      });
    }
  });
  tried("lower bound", () => {
    const limit = limitOf(problem, parsed(problem.minimise));
    const scale = scaleOf(parsed(problem.minimise));
    const above = (stated, value) => value.plus(STATED.times(greatest(value.magnitude(), scale))).below(exact(stated));
    const agrees = (stated, bound) => bound !== null && !above(stated, bound);
    const aboveIt = (stated) => above(stated, highest);
    const bounds = [...proven.map(({ bound }) => bound), limit].filter((bound) => bound);
    const certificates = ["certificate", "power_certificate", "peak_certificate"].filter((key) => data[key]);
    const limitKnown = (data.best_possible ?? null) === null || agrees(data.best_possible, limit);
    const ofDrive = data.drive_limit?.value ?? null;
    if (ofDrive !== null && highest && aboveIt(ofDrive)) claim("drive limit", false, `${ofDrive} is stated, above the objective of the law, ${highest.toNumber()}`);
    const allKnown = !data.drive_limit && limitKnown && proven.filter(({ bound, verdict }) => bound && verdict !== "not checked").length === certificates.length;
    const best = bounds.length ? bounds.reduce(greatest) : null;
    for (const [name, stated, bound] of [["best possible", data.best_possible ?? null, limit], ["lower bound", data.lower_bound ?? null, best]]) {
      if (stated === null) continue;
      if (agrees(stated, bound)) claim(name, true, `${stated} is stated, ${bound.toNumber()} is proven`);
      else if (highest && aboveIt(stated)) claim(name, false, `${stated} is stated, above the objective of the law, ${highest.toNumber()}`);
      else if (allKnown && best && name === "lower bound") claim(name, false, `${stated} is stated, ${best.toNumber()} is proven`);
      else claims.push({ path: `${path}: ${name}`, verdict: "not checked", detail: `${stated} is stated, by no proof that this program knows` });
    }
    // of an objective that is 0 but for rounding, the scale is the measure of gaps
    const size = highest?.magnitude();
    const measure = size && (NO_OBJECTIVE.times(scale).below(size) ? size : scale);
    const gap = measure?.sign > 0 && best ? highest.minus(best).over(measure) : null;
    const room = (most) => gap && !most.plus(GAP).below(gap);
    const nearly = (least) => least && !GAP.times(HALF).below(least);
    const shown = gap ? `it is at most ${gap.toNumber()}` : "the gap is not known";
    if ((data.gap ?? null) !== null) gapClaims(claim, claims, path, "gap", data.gap, room(exact(data.gap)), shown);
    if (data.status === "optimal") gapClaims(claim, claims, path, "status", data.status, room(ZERO), shown);
    else if (data.status) {
      // this program may prove more than is stated, of which the status is
      const stated = (data.lower_bound ?? null) !== null && gap ? highest.minus(exact(data.lower_bound)).over(measure) : gap;
      claim("status", ["local", "inaccurate"].includes(data.status) && !nearly(stated), `${data.status} is stated, ${shown}`);
    }
  });
  const above = highest ? [] : boundsAbove(data, path);
  return [...claims.filter(({ path: place }) => !above.some((wrong) => wrong.path === place)), ...above];
}

/* A gap that is greater may be that of a proof which this program does not know. */
function gapClaims(claim, claims, path, name, stated, holds, shown) {
  if (holds) claim(name, true, `${stated} is stated, ${shown}`);
  else claims.push({ path: `${path}: ${name}`, verdict: "not checked", detail: `${stated} is stated, ${shown} by what this program knows` });
}

/* Whether plain data are the same, in whatever order their keys are. */
export function sameData(one, other) {
  return sorted(one) === sorted(other);
}

/* Plain data as a text in which keys are in order. */
function sorted(data) {
  return JSON.stringify(data, (_, value) => (value && typeof value === "object" && !Array.isArray(value) ? Object.fromEntries(Object.entries(value).sort()) : value));
}

/* Whether the law has the polynomial Z that is stated, by powers of k, but for rounding. */
function fitsZ(motion, problem, z) {
  const stated = lawOfZ(problem, z.map(exact));
  if (!stated || motion.length > 1) throw new Unknown(`Z of laws of the basis ${problem.basis}`);
  const size = sum(z.map((entry) => exact(entry).magnitude())).over(whole(4).power(problem.order)).plus(ONE);
  return !ROUNDED_SERIES.times(size).below(distance(motion, stated));
}

/* The constants that a law is said to have. */
function constantsChecked(data, path, motion) {
  return Object.entries(data.constants ?? {}).flatMap(([name, entry]) => {
    const { value: stated, k = null } = typeof entry === "object" && entry !== null ? entry : { value: entry };
    const place = `${path}: ${name}`;
    if (!(name in PEAKS || name in MEANS || name === "D")) return [{ path: place, verdict: "not checked", detail: "this program does not know this constant" }];
    // a derivative of pieces may jump
    if (stated === null) return [{ path: place, verdict: motion.length > 1 ? "not checked" : "not proven", detail: "it is stated to have no bound" }];
    const reached = k === null || reachedAt(motion, name, exact(k), exact(stated));
    const detail = reached ? `${stated} is stated` : `${stated} is stated, but not reached at k = ${k}`;
    return [{ path: place, verdict: reached && near(stated, enclosed(motion, name)) ? "proven" : "not proven", detail }];
  });
}

/* The constants of a law that stands alone. */
export function lawChecked(data, path) {
  try {
    return constantsChecked(data, path, motionOf(data.law));
  } catch (error) {
    const known = error instanceof Unknown;
    return [{ path: `${path}: law`, verdict: known ? "not checked" : "not proven", detail: known ? `this program does not know ${error.message}` : error.message }];
  }
}

function near(stated, [low, high], scale = ONE) {
  const room = ROUNDED.times(greatest(scale, high.magnitude()));
  return !exact(stated).below(low.minus(room)) && !high.plus(room).below(exact(stated));
}

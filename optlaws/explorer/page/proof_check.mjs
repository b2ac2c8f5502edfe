/* A proof file checked in exact numbers: what each certificate proves, and what of the file's claims follows.

   It shares no code with the library that writes the proofs: docs/reference/proof-format.md says what is computed. */

import { ONE, Rational, Unknown, ZERO, exact, greatest, least, quotientRounded, solvedWhole, sum, whole, wholeNumbers } from "./proof_numbers.mjs";
import { MEANS, PEAKS, ROOT, Rows, neverNegative, parsed, rangeOf, scaleOf } from "./proof_rows.mjs";
import { boxesHold } from "./proof_boxes.mjs";
import { boundsAbove, lawChecked, sameData, solutionChecked } from "./proof_solution.mjs";
import { endVelocities, stroke } from "./proof_laws.mjs";

/* A stated bound is a double: by how much of itself it may be above the proven one. */
const STATED = exact(1e-9);
/* What this program may charge for the rounding of multipliers, of a bound: a bound that this alone hides is not false. */
const CHARGED = exact(1e-8);
/* The newest format that is read; what names none is of the first. */
const FORMAT = 1;
/* What certificates, their parts and problems may say: anything else could mean that they speak of something else. */
const COMMON = ["format", "problem", "bound", "about"];
const KEYS = {
  contacts: [...COMMON, "program", "tangent", "contacts", "equations"],
  steps: [...COMMON, "claim", "points", "steps"],
  cells: [...COMMON, "constant", "claim", "cells"],
  contact: ["constraint", "sign", "k", "multiplier", "direction"],
  split: ["variable", "at"],
  step: ["variable", "side", "contacts", "equations", "claim"],
  cell: ["k", "reach", "sign", "contacts", "equations"],
  problem: [
    "minimise", "order", "basis", "degree", "continuity", "breaks", "straight", "monotone", "symmetric", "B", "C", "D", "J",
    "bounds", "inflexion", "start", "end", "windows",
  ],
  window: ["quantity", "low", "high", "start", "stop"],
};

function isCertificate(data) {
  return typeof data.problem === "object" && data.problem !== null && ("contacts" in data || "steps" in data || "cells" in data);
}

/* What a certificate proves: {verdict: "proven" | "not proven" | "not checked", detail, bound}. */
export function checked(certificate) {
  try {
    checkKeys(certificate);
    if ("steps" in certificate) return boxesChecked(certificate);
    if ("cells" in certificate) throw new Unknown("places of a peak");
    return leafChecked(certificate);
  } catch (error) {
    if (error instanceof Unknown) return { verdict: "not checked", detail: `this program does not know ${error.message}`, bound: null };
    return { verdict: "not proven", detail: `the file is no certificate: ${error.message}`, bound: null };
  }
}

/* Refuse what nobody knows, and a file of a newer format. */
function checkKeys(certificate) {
  const known = (data, kind) => {
    const unknown = Object.keys(data).find((key) => !KEYS[kind].includes(key));
    if (unknown !== undefined) throw new TypeError(`nothing is known of the entry ${unknown} of a ${kind in certificate ? "certificate" : kind}`);
  };
  const needed = (holds, what) => {
    if (!holds) throw new TypeError(what);
  };
  const signed = (value, name) => needed(value === 1 || value === -1, `${name} must be 1 or -1`);
  const placed = (value, name) => needed(value >= 0 && value <= 1, `${name} must be from 0 to 1`);
  const summed = (data) => data.contacts?.forEach((contact) => {
    known(contact, "contact");
    signed(contact.sign, "the sign of a contact");
    placed(contact.k, "the k of a contact");
  });
  const kind = ["steps", "cells", "contacts"].find((key) => key in certificate);
  known(certificate, kind);
  known(certificate.problem, "problem");
  for (const name of ["order", "degree", "continuity"]) {
    needed(Number.isInteger(certificate.problem[name] ?? 0), `${name} must be a whole number`);
  }
  certificate.points?.forEach((k) => placed(k, "a point"));
  certificate.problem.windows?.forEach((window) => known(window, "window"));
  summed(certificate);
  certificate.steps?.forEach((step) => {
    known(step, "at" in step ? "split" : "step");
    needed(Number.isInteger(step.variable) && step.variable >= -1, "a variable is numbered from 0 on, or -1");
    if (!("at" in step)) signed(step.side, "a side");
    summed(step);
  });
  certificate.cells?.forEach((cell) => {
    known(cell, "cell");
    summed(cell);
  });
}

function checkFormat({ format = 1 }, path) {
  if (!Number.isInteger(format) || format < 1) throw new TypeError(`${path}: the format must be a whole number from 1 on`);
  if (format > FORMAT) throw new TypeError(`${path} was written by a newer optlaws: format ${format}, this reads up to ${FORMAT}`);
}

function boxesChecked(certificate) {
  const { claim, bound = null } = certificate;
  const holds = boxesHold(certificate);
  const stated = bound === null || bound <= claim;
  const detail = !holds ? `the steps do not prove that no law has an objective below ${claim}` : stated ? `no law has an objective below ${claim}` : `${bound} is stated, ${claim} is proven`;
  return { verdict: holds && stated ? "proven" : "not proven", detail, bound: holds ? exact(claim) : null };
}

function leafChecked(certificate) {
  const { bound, contradiction, charge, unbounded } = provenBy(certificate);
  const stated = certificate.bound ?? null;
  const room = STATED.times(greatest(bound?.magnitude() ?? ZERO, scaleOf(parsed(certificate.problem.minimise))));
  const contradicts = contradiction && bound !== null && bound.sign > 0;
  const holds = bound !== null && (contradicts || !contradiction) && (stated === null || !bound.plus(room).below(exact(stated)));
  if (!holds && unbounded) {
    return { verdict: "not checked", detail: "this program does not know how little the rounding of the multipliers takes: nothing bounds the laws", bound };
  }
  if (contradiction) {
    const why = contradicts ? `${stated} is stated, the rows contradict each other by ${bound.toNumber()}` : "the rows do not contradict each other";
    return { verdict: holds ? "proven" : "not proven", detail: holds ? "no law of the problem exists" : why, bound: null };
  }
  if (stated === null) return { verdict: "proven", detail: "no bound is stated", bound };
  if (bound === null) return { verdict: "not proven", detail: `${stated} is stated, and nothing is proven`, bound };
  const hidden = charge && !CHARGED.times(bound.magnitude()).below(charge) && !bound.plus(charge).plus(room).below(exact(stated));
  if (!holds && hidden) {
    const detail = `this program does not know how little the rounding of the multipliers takes: ${bound.toNumber()} is proven of ${stated}`;
    return { verdict: "not checked", detail, bound };
  }
  return { verdict: holds ? "proven" : "not proven", detail: `${stated} is stated, ${bound.toNumber()} is proven`, bound };
}

/* The lower bound that one leaf proves, or by how much its rows contradict each other. */
export function provenBy(certificate) {
  const { program, contacts, equations, tangent } = certificate;
  if (!["objective", "relaxed", "violation"].includes(program)) throw new TypeError(`there is no program ${program}`);
  const rows = new Rows(certificate.problem, program, tangent ?? 0);
  const contradiction = program === "violation";
  const nothing = Array(rows.laws.terms).fill(ZERO);
  const total = { z: nothing, off: nothing, names: new Map(rows.cost), constant: ZERO, offConstant: ZERO };
  const loose = new Map();
  const means = new Set();
  const used = [];
  const take = (multiplier, row) => {
    used.push([multiplier.magnitude(), row]);
    add(total, multiplier, row);
  };
  for (const contact of contacts) {
    const multiplier = exact(contact.multiplier);
    const row = multiplier.sign > 0 ? rows.row(contact) : null;
    if (row?.rms) means.add(row.rms);
    else if (row?.loose) loose.set(row.loose, [...(loose.get(row.loose) ?? []), [multiplier, row]]);
    else if (row) take(multiplier, row);
  }
  rows.equations.forEach((row, i) => { if (equations[i]) take(exact(equations[i]), row); });
  // such that nothing is left of their variable, of a maximum before those of its parts, whose names are within its own
  for (const [name, group] of [...loose].sort(([one], [other]) => other.length - one.length)) {
    const factor = (total.names.get(name) ?? ZERO).over(sum(group.map(([multiplier]) => multiplier)));
    if (factor.sign > 0) group.forEach(([multiplier, row]) => take(multiplier.times(factor), row));
  }
  for (const name of means) {
    const weight = total.names.get(name) ?? ZERO;
    const row = weight.sign > 0 ? rows.beside(name, total.z.map((slope) => slope.over(weight))) : null;
    if (row) take(weight, row);
  }
  const claim = contradiction ? ZERO : greatest(total.constant, ZERO);
  const charge = chargeOf(rows, total, claim, contradiction);
  if (charge === null) {
    const unbounded = total.constant.sign > 0 && isRounding(rows, total, used);
    return { bound: contradiction ? null : floorOf(rows), contradiction, unbounded };
  }
  const value = total.constant.minus(charge);
  if (contradiction) return { bound: value, contradiction };
  return { bound: greatest(least(value, claim), floorOf(rows) ?? value), contradiction, charge };
}

function add(total, multiplier, row) {
  total.z = total.z.map((entry, i) => entry.plus(multiplier.times(row.z[i])));
  for (const [name, entry] of Object.entries(row.names)) total.names.set(name, (total.names.get(name) ?? ZERO).plus(multiplier.times(entry)));
  total.constant = total.constant.plus(multiplier.times(row.constant));
  if (!row.off) return;
  const size = multiplier.magnitude();
  total.off = total.off.map((entry, i) => entry.plus(size.times(row.off[i])));
  total.offConstant = total.offConstant.plus(size.times(row.offConstant));
}

/* Whether what is left of the sum is small beside the rows that are summed. */
function isRounding(rows, total, used) {
  const largest = (row) => [...row.z, ...Object.values(row.names), row.constant].map((entry) => entry.magnitude()).reduce(greatest);
  const most = CHARGED.times(sum([...[...rows.cost.values()].map((cost) => cost.magnitude()), ...used.map(([size, row]) => size.times(largest(row)))]));
  const named = [...total.names].filter(([name, slope]) => slope.sign < 0 || !neverNegative(rows.problem, name)).map(([, slope]) => slope);
  return ![...total.z, ...named].some((slope) => most.below(slope.magnitude()));
}

/* What the objective is at least because none of its constants is negative; null where one may be. */
function floorOf(rows) {
  return [...rows.cost.keys()].every((name) => neverNegative(rows.problem, name)) ? ZERO : null;
}

/* What the slopes that are left can be worth at most in a law whose objective is below the claim; null if nothing bounds it. */
function chargeOf(rows, total, claim, contradiction) {
  const most = greatestValues(rows, claim, contradiction);
  let charge = total.offConstant;
  for (const [name, slope] of total.names) {
    if (slope.sign === 0 || (slope.sign > 0 && neverNegative(rows.problem, name))) continue;
    if (slope.sign > 0 || !most.has(name)) return null;
    charge = charge.minus(slope.times(most.get(name)));
  }
  if ([...total.z, ...total.off].every((slope) => slope.sign === 0)) return charge;
  const families = meansOf(rows, most);
  const worths = families.map((family) => worthIn(family, total.z)).filter((value) => value !== null);
  if (!worths.length) return null;
  charge = charge.plus(worths.reduce(least));
  if (total.off.every((off) => off.sign === 0)) return charge;
  const sizes = families.map(sizesIn).find((value) => value !== null);
  return sizes ? charge.plus(sum(total.off.map((off, i) => off.times(sizes[i])))) : null;
}

/* The greatest values of constants, maxima and B in a law whose objective is below the claim. */
function greatestValues(rows, claim, contradiction) {
  const most = new Map();
  const lower = (name, value) => most.set(name, most.has(name) ? least(most.get(name), value) : value);
  function spread(terms, value) {
    for (const [weight, term] of terms) {
      if (terms.some(([, other]) => other !== term && !neverNegative(rows.problem, other.name))) continue;
      lower(term.name, value.over(weight));
      if (term.parts) for (const part of term.parts) spread(part, value.over(weight));
    }
  }
  if (!contradiction) spread(rows.objective, claim);
  for (const name of [...Object.keys(PEAKS), ...Object.keys(MEANS), "D", ...rows.machines.keys()]) {
    const range = rangeOf(rows.problem, name);
    if (range?.high) lower(name, range.high);
  }
  if (rows.relaxed && most.has("D")) most.set(ROOT, most.get("D").rootAbove());
  return most;
}

/* Functions whose mean magnitude is bounded in such a law: their moments, by how much these are off, and the bound.

   The last moments are those of equations, `fixed` of them, which are 0. */
function meansOf(rows, most) {
  const { problem } = rows;
  const known = [];
  for (const [name, nu] of [["C", 2], ["rms_c", 2], ["J", 3], ["rms_j", 3], ["snap", 4], ["rms_snap", 4]]) {
    if (most.has(name)) known.push([nu, most.get(name)]);
  }
  const velocities = endVelocities(problem);
  if (velocities) {
    const twice = (name) => greatest(most.get(name), ZERO).times(whole(2));
    if (most.has("C_plus")) known.push([2, twice("C_plus").minus(velocities.change)]);
    if (most.has("C_minus")) known.push([2, twice("C_minus").plus(velocities.change)]);
    const rest = velocities.start.sign === 0 && velocities.change.sign === 0;
    if (rest && most.has(ROOT)) known.push([1, most.get(ROOT)]);
  }
  const way = stroke(problem);
  if (most.has("B")) known.push([1, most.get("B").times(whole(2)).plus(way.magnitude())]);
  if (problem.monotone) known.push([1, way.magnitude()]);
  // what a derivative does not see of pieces, their equations settle
  const settled = rows.equations.filter(({ names }) => !Object.keys(names).length).map(({ z, constant }) => [...z, constant]);
  const fixed = rows.laws.conditions.length ? settled : [];
  const families = known.map(([nu, mean]) => ({ moments: [...rows.laws.moments(nu), ...fixed], fixed: fixed.length, off: ZERO, mean }));
  if (families.length) return families;
  for (const [name, { constant }] of rows.machines) {
    if (!most.has(name) || constant.kind === "mode_residual" || constant.start.sign || constant.stop.below(ONE)) continue;
    const { rows: moments, off } = rows.outputMoments(name);
    const mean = constant.kind === "output_rms" ? most.get(name).times(constant.stop.rootAbove()) : most.get(name);
    families.push({ moments, fixed: 0, off, mean });
  }
  return families;
}

/* What slopes are worth at most where means are bounded, those that are off by rounding too; null if nothing is known. */
function worthIn(family, slopes) {
  const found = worth(family, slopes);
  if (found === null || family.off.sign === 0) return found?.value ?? null;
  const sizes = sizesIn(family);
  return sizes && found.value.plus(found.weight.times(family.off).times(sum(sizes)));
}

/* What each coordinate of the law is at most in magnitude. */
function sizesIn(family) {
  if (family.sizes !== undefined) return family.sizes;
  const terms = family.moments[0]?.length - 1;
  const units = Array.from({ length: terms }, (_, i) => worth(family, Array.from({ length: terms }, (__, j) => (i === j ? ONE : ZERO))));
  family.sizes = null;
  if (units.some((unit) => unit === null)) return null;
  // the sum S of all is at most that of the values and `left` times S
  const left = sum(units.map(({ weight }) => weight)).times(family.off);
  if (!left.below(ONE)) return null;
  const all = sum(units.map(({ value }) => value)).over(ONE.minus(left)).rounded(1);
  family.sizes = units.map(({ value, weight }) => value.plus(weight.times(family.off).times(all)).rounded(1));
  return family.sizes;
}

/* What slopes in the coordinates are worth at most where a mean magnitude is bounded, by Legendre moments; and the sum of weights.

   The mean magnitudes of all pieces sum to that of the whole: the weights of the moments of one piece count, those of the piece
   in which they are greatest. */
function worth({ moments, fixed, off, mean }, slopes) {
  const { whole: all, factor } = wholeNumbers(moments.flatMap((row) => row.slice(0, -1)));
  const columns = slopes.length;
  const matrix = moments.map((_, m) => all.slice(m * columns, (m + 1) * columns));
  const dot = (i, j) => matrix.reduce((total, row) => total + row[i] * row[j], 0n);
  const gram = slopes.map((_, i) => slopes.map((__, j) => (j < i ? 0n : dot(i, j))));
  const right = wholeNumbers(slopes);
  const solution = solvedWhole(gram.map((row, i) => row.map((entry, j) => (j < i ? gram[j][i] : entry))), right.whole);
  if (solution === null) return null;
  let total = ZERO;
  let weights = ZERO;
  const pieces = new Map();
  matrix.forEach((row, m) => {
    const weight = row.reduce((value, entry, i) => value + entry * solution.numerators[i], 0n);
    const size = new Rational(weight).magnitude().rounded(1);
    const piece = moments[m].piece ?? `moment ${m}`;
    if (m < moments.length - fixed) pieces.set(piece, (pieces.get(piece) ?? ZERO).plus(size));
    total = total.plus(size.times(moments[m].at(-1).magnitude().plus(off).rounded(1)));
    weights = weights.plus(size);
  });
  const alone = sum([...pieces].filter(([piece]) => typeof piece === "string").map(([, size]) => size));
  const greatestPiece = [...pieces].filter(([piece]) => typeof piece === "number").map(([, size]) => size).reduce(greatest, ZERO);
  total = total.plus(mean.rounded(1).times(alone.plus(greatestPiece)));
  // the moments are whole / factor, the slopes whole / right.factor: weights grow by the quotient of both
  const scaled = (number) => quotientRounded(number, new Rational(solution.divisor).magnitude(), 1, 160).times(factor).over(right.factor).rounded(1);
  return { value: scaled(total), weight: scaled(weights) };
}

/* The same file with the names of today: earlier files call the snap jounce, and the best possible of a solution its limit. */
function withPresentNames(data) {
  const text = JSON.stringify(data);
  const renamed = (name, value) => {
    if (value === null || typeof value !== "object" || !("limit" in value) || !("objective" in value || "duration" in value)) return value;
    const { limit, ...others } = value;
    return { ...others, best_possible: limit };
  };
  return text.includes("jounce") || text.includes('"limit":') ? JSON.parse(text.replaceAll("jounce", "snap"), renamed) : data;
}

/* Everything in a file that this program can check, each with its verdict, and what it does not know of the file. */
export function fileChecked(data) {
  return partsChecked(withPresentNames(data), "");
}

function isEmpty(value) {
  return value === null || (typeof value === "object" && !Object.keys(value).length);
}

function namesIn(value) {
  return value !== null && typeof value === "object" && !Array.isArray(value) ? Object.keys(value) : ["it"];
}

/* What is said to people, of the search and of programs: nothing is claimed by it. */
const SILENT = ["about", "format", "iterations", "seconds", "starts", "versions", "state"];
/* The other entries of a solution, of a law with its constants, and of a row of a table. */
const OF_SOLUTION = [
  "problem", "law", "constants", "z", "objective", "lower_bound", "gap", "best_possible", "status", "certificate",
  "power_certificate", "peak_certificate", "drive_limit",
];
const OF_LAW = ["law", "constants"];
const OF_ROW = ["asked", "status", "B"];

/* What is checked of data; nothing where this program knows nothing of it. */
function partsChecked(data, path) {
  if (Array.isArray(data)) {
    const each = data.map((entry, i) => partsChecked(entry, `${path}[${i}]`));
    if (!each.some((results) => results.length)) return [];
    return each.flatMap((results, i) => (results.length || isEmpty(data[i]) ? results : [unknownRow(`${path}[${i}]`, namesIn(data[i]))]));
  }
  if (data === null || typeof data !== "object") return [];
  const where = path || "the file";
  checkFormat(data, where);
  if (isCertificate(data)) return [{ path: where, ...checked(data) }];
  if (isDriveLimit(data)) return driveLimitChecked(data, where);
  if (isMoveLimit(data)) return moveLimitChecked(data, where);
  if (data.law) checkFormat(data.law, path ? `${path}.law` : "law");
  const inside = (key) => partsChecked(data[key], path ? `${path}.${key}` : key);
  if (data.law && data.certificate && data.problem) return [...wholeSolutionChecked(data, path, inside), ...othersChecked(data, where, OF_SOLUTION, inside, true)];
  if (data.law && data.constants) return [...lawChecked(data, where), ...othersChecked(data, where, OF_LAW, inside, true)];
  const isRow = "asked" in data || "solution" in data || "B" in data;
  const inner = othersChecked(data, where, isRow ? OF_ROW : [], inside);
  return isRow && inner.length ? [...inner, ...rowChecked(data, where, inner)] : inner;
}

/* The entries that a kind of object does not have, checked by themselves, and which of them this program does not know. */
function othersChecked(data, where, known, inside, isKnown = false) {
  const results = known.includes("lower_bound") ? [] : boundsAbove(data, where);
  const unknown = [];
  for (const [key, value] of Object.entries(data)) {
    if (isEmpty(value) || SILENT.includes(key) || known.includes(key)) continue;
    const inner = inside(key);
    if (inner.length) results.push(...inner);
    else unknown.push(key);
  }
  return unknown.length && (results.length || isKnown) ? [...results, unknownRow(where, unknown)] : results;
}

function unknownRow(where, names) {
  return { path: where, verdict: "not checked", detail: `this program does not know what is stated by ${names.join(", ")}` };
}

function wholeSolutionChecked(data, path, inside) {
  const same = JSON.stringify(data.problem);
  const proofs = ["certificate", "power_certificate", "peak_certificate", "drive_limit"].filter((key) => data[key]);
  const inner = proofs.flatMap(inside);
  const of = (key) => (data[key] && JSON.stringify(data[key].problem) === same ? [`${path ? `${path}.` : ""}${key}`] : []);
  const places = ["certificate", "power_certificate"].flatMap(of);
  return [...inner, ...solutionChecked(data, path || "the file", inner.filter((result) => places.includes(result.path)))];
}

/* What a row of a table states of the solution or the proof in it. */
function rowChecked(data, where, inner) {
  const { asked = null, status = null, B = null, solution = null, proof = null } = data;
  const results = [];
  const state = (name, verdict, detail) => results.push({ path: `${where}: ${name}`, verdict, detail });
  const problem = (solution ?? proof)?.problem ?? null;
  if (asked !== null) state("problem", problem && sameData(asked, problem) ? "proven" : "not checked", "it is to be that of what stands in the row");
  if (B !== null) {
    const within = Object.values(data).map((entry) => entry?.problem).find((entry) => entry) ?? problem;
    const known = within && typeof within.B === "number";
    state("B", !known ? "not checked" : Number(B) === within.B ? "proven" : "not proven", `${B} is stated`);
  }
  if (status === null) return results;
  if (solution) state("status", status === solution.status ? "proven" : "not proven", `${status} is stated, ${solution.status} in the solution`);
  else if (!proof || status !== "infeasible") state("status", status === "infeasible" || !proof ? "not checked" : "not proven", `${status} is stated`);
  else if (proof.program === "violation") state("status", inner.find(({ path }) => path === `${where}.proof`)?.verdict ?? "not checked", "no law is stated");
  else state("status", "not checked", "no law is stated, by a bound of another constant");
  return results;
}

const LIMITS = { "peak torque": ["N m", "N"], "rms torque": ["N m", "N"], energy: ["J"], time: ["s"] };

function isDriveLimit(data) {
  return "plane" in data && "potential" in data;
}

function isMoveLimit(data) {
  return "drive_limit" in data && "unit" in data && "dimension" in data;
}

/* The limit of a drive: its certificate is in the phase plane, and what contradicts itself is false. */
function driveLimitChecked({ minimise, value = null, attained = null, unit }, where) {
  const number = (stated) => stated === null || Number.isFinite(stated);
  const detail = !(minimise in LIMITS)
    ? `nothing is known of the ${minimise} as what is least`
    : !number(value) || !number(attained)
      ? `${value} as a bound and ${attained} as attained are no numbers`
      : !(Number.isFinite(unit) && unit > 0)
        ? `the unit is ${unit}`
        : value !== null && attained !== null && attained < value - 1e-9 * Math.abs(value)
          ? `${value} is stated as a bound, and ${attained} is attained`
          : "";
  if (detail) return [{ path: where, verdict: "not proven", detail }];
  return [{ path: where, verdict: "not checked", detail: "this program does not know limits in the phase plane" }];
}

const OF_MOVE_LIMIT = ["format", "dimension", "unit", "move", "drive_limit"];

/* The unit of a move's limit is that of its kind, and its limit is of what its move minimises, or a proof of no motion. */
function moveLimitChecked(data, where) {
  const { unit, dimension, move, drive_limit: limit } = data;
  const least = limit?.minimise;
  const other = Object.keys(data).find((key) => !OF_MOVE_LIMIT.includes(key) && !SILENT.includes(key));
  const mechanism = move?.mechanism ?? move?.drive?.mechanism;
  const detail = other
    ? `nothing is known of the entry ${other}`
    : !(LIMITS[least] ?? []).includes(dimension)
      ? `${dimension} is no unit of the ${least}`
      : !(Number.isFinite(unit) && unit > 0)
        ? `the unit is ${unit}`
        : !mechanism
          ? "its move has neither a mechanism nor a drive"
          : !(move.minimise in LIMITS) || ![move.minimise, "time", "peak torque"].includes(least)
            ? `its move minimises the ${move.minimise}, and its limit is of the ${least}`
            : least === "time" && move.minimise === "time" && move.duration !== null
              ? "the duration of a least time is given"
              : "";
  if (detail) return [{ path: where, verdict: "not proven", detail }];
  return [...driveLimitChecked(limit, `${where}: drive_limit`), unknownRow(where, ["unit, dimension, move"])];
}

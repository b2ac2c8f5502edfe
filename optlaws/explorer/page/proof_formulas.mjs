/* Formulas of a, b, c and j with their first and second slopes, between numbers, as their names are. */

import { ONE, TWO, Unknown, ZERO, exact } from "./proof_numbers.mjs";
import { NOTHING, added, circularOver, interval, inverse, negative, power, product } from "./proof_intervals.mjs";

const TOKEN = /\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(\*\*|[-+*/()^]))/y;

/* A formula as a tree: {kind: "number" | "name" | "sum" | "product" | "inverse" | "power" | "sin" | "cos", ...}. */
export function formulaOf(text) {
  const tokens = [];
  for (TOKEN.lastIndex = 0; TOKEN.lastIndex < text.trimEnd().length;) {
    const read = TOKEN.exec(text);
    if (!read) throw new Unknown(`the formula ${text}`);
    tokens.push(read);
  }
  let at = 0;
  const next = (...signs) => (signs.includes(tokens[at]?.[3]) ? tokens[at++][3] : null);
  function sum() {
    const parts = [productOf()];
    for (let sign = next("+", "-"); sign; sign = next("+", "-")) parts.push(sign === "-" ? opposed(productOf()) : productOf());
    return parts.length > 1 ? { kind: "sum", parts } : parts[0];
  }
  function productOf() {
    const parts = [signed()];
    for (let sign = next("*", "/"); sign; sign = next("*", "/")) parts.push(sign === "/" ? { kind: "inverse", of: signed() } : signed());
    return parts.length > 1 ? { kind: "product", parts } : parts[0];
  }
  function signed() {
    const sign = next("+", "-");
    if (sign) return sign === "-" ? opposed(signed()) : signed();
    const base = atom();
    if (!next("^", "**")) return base;
    const exponent = signed();
    if (exponent.kind !== "number") throw new Unknown(`the formula ${text}`);
    return { kind: "power", of: base, exponent: exponent.value.toNumber() };
  }
  function atom() {
    const [, number, name, sign] = tokens[at++] ?? [];
    if (number !== undefined) return { kind: "number", value: exact(Number(number)) };
    if (sign === "(") return closed(sum());
    if (name === "sin" || name === "cos") {
      if (!next("(")) throw new Unknown(`the formula ${text}`);
      return { kind: name, of: closed(sum()) };
    }
    if (!["a", "b", "c", "j"].includes(name)) throw new Unknown(`${name ?? "the signs"} in the formula ${text}`);
    return { kind: "name", name };
  }
  function closed(inner) {
    if (!next(")")) throw new Unknown(`the formula ${text}`);
    return inner;
  }
  const formula = sum();
  if (at !== tokens.length) throw new Unknown(`the formula ${text}`);
  return formula;
}

export function opposed(formula) {
  return { kind: "product", parts: [{ kind: "number", value: ONE.negative() }, formula] };
}

/* The names in a formula, in their order. */
export function namesIn(formula) {
  const found = new Set();
  const walk = (part) => {
    if (part.kind === "name") found.add(part.name);
    for (const inner of part.parts ?? (part.of ? [part.of] : [])) walk(inner);
  };
  walk(formula);
  return [...found].sort();
}

/* Value, slopes and second slopes: the latter a list of the pairs (i, j) with i <= j. */
const pairsOf = (size) => [...Array(size).keys()].flatMap((i) => [...Array(size - i).keys()].map((j) => [i, i + j]));

function sumOf(first, second) {
  return {
    value: added(first.value, second.value),
    slopes: first.slopes.map((slope, i) => added(slope, second.slopes[i])),
    bends: first.bends.map((bend, i) => added(bend, second.bends[i])),
  };
}

function productOf(first, second) {
  const cross = ([i, j]) => added(product(first.slopes[i], second.slopes[j]), product(first.slopes[j], second.slopes[i]));
  const scaled = (factor, other) => product(factor, other);
  return {
    value: product(first.value, second.value),
    slopes: first.slopes.map((slope, i) => added(scaled(second.value, slope), scaled(first.value, second.slopes[i]))),
    bends: pairsOf(first.slopes.length).map((pair, i) => (
      added(cross(pair), added(scaled(second.value, first.bends[i]), scaled(first.value, second.bends[i])))
    )),
  };
}

/* A function with the value, the slope and the second slope f, f', f'' of what is inside. */
function through({ slopes, bends }, [value, slope, bend]) {
  const square = ([i, j]) => (i === j ? power(slopes[i], 2) : product(slopes[i], slopes[j]));
  return {
    value,
    slopes: slopes.map((inner) => product(slope, inner)),
    bends: pairsOf(slopes.length).map((pair, i) => added(product(bend, square(pair)), product(slope, bends[i]))),
  };
}

function functionOf({ kind, exponent }, x) {
  if (kind === "inverse") {
    const over = inverse(x);
    const square = product(over, over);
    return [over, negative(square), product(interval(TWO), product(square, over))];
  }
  if (kind === "power") {
    const factor = (value) => interval(exact(value));
    const vanishes = (value) => value === 0;
    const term = (weight, order) => (vanishes(weight) ? NOTHING : product(factor(weight), power(x, exponent - order)));
    return [power(x, exponent), term(exponent, 1), term(exponent * (exponent - 1), 2)];
  }
  const { sine, cosine } = circularOver(x);
  return kind === "sin" ? [sine, cosine, negative(sine)] : [cosine, negative(sine), negative(cosine)];
}

/* A formula where names are what `known` says of them: {value, slopes, bends} each. */
function jetOf(formula, known) {
  const { slopes, bends } = Object.values(known)[0];
  if (formula.kind === "name") return known[formula.name];
  if (formula.kind === "number") return { value: interval(formula.value), slopes: slopes.map(() => NOTHING), bends: bends.map(() => NOTHING) };
  if (formula.kind === "sum") return formula.parts.map((part) => jetOf(part, known)).reduce(sumOf);
  if (formula.kind === "product") return formula.parts.map((part) => jetOf(part, known)).reduce(productOf);
  const inside = jetOf(formula.of, known);
  return through(inside, functionOf(formula, inside.value));
}

/* The value and the first two slopes over k of a formula of a law, whose names have theirs. */
export function along(formula, known) {
  const names = Object.entries(known).map(([name, [value, slope, bend]]) => [name, { value, slopes: [slope], bends: [bend] }]);
  const { value, slopes, bends } = jetOf(formula, Object.fromEntries(names));
  return [value, slopes[0], bends[0]];
}

/* Names as variables of their own in ranges. */
function variables(names, ranges) {
  const entries = names.map((name, i) => [name, {
    value: ranges[i],
    slopes: names.map((_, j) => (i === j ? interval(ONE) : NOTHING)),
    bends: pairsOf(names.length).map(() => NOTHING),
  }]);
  return Object.fromEntries(entries);
}

/* A plane that is nowhere above a formula in ranges and touches it at a place of them, or would: slopes and height. */
export function planeBelow(formula, names, ranges, touch) {
  const at = jetOf(formula, variables(names, touch.map((place) => interval(place))));
  let height = added(at.value, negative(at.slopes.map((slope, i) => product(slope, interval(touch[i]))).reduce(added)));
  const { bends } = jetOf(formula, variables(names, ranges));
  const away = ranges.map(([low, high], i) => [low.minus(touch[i]), high.minus(touch[i])]);
  pairsOf(names.length).forEach(([i, j], n) => {
    if (bends[n].every((end) => end.sign === 0)) return;
    const way = i === j ? product(interval(ONE.over(TWO)), [ZERO, power(away[i], 2)[1]]) : product(away[i], away[j]);
    height = added(height, product(bends[n], way));
  });
  return { slopes: at.slopes, height };
}

/* Whether a name is in no more than a term of its own, with a number as its factor. */
function isAffine(formula, name) {
  const has = (part) => namesIn(part).includes(name);
  if (!has(formula) || formula.kind === "name") return true;
  if (formula.kind === "sum") return formula.parts.every((part) => isAffine(part, name));
  const others = (formula.parts ?? []).filter((part) => !has(part));
  return formula.kind === "product" && others.length === formula.parts.length - 1
    && others.every((part) => namesIn(part).length === 0) && isAffine(formula.parts.find(has), name);
}

/* The factors of the names in a formula and what is left of it, in exact numbers; null where it is not affine in them. */
export function affineIn(formula) {
  const names = namesIn(formula);
  const constant = (part) => {
    const { value } = jetOf(part, variables(["a"], [NOTHING]));
    return value[0].same(value[1]) ? value[0] : null;
  };
  const at = (values) => constant(placed(formula, values));
  if (!names.every((name) => isAffine(formula, name))) return null;
  const nothing = Object.fromEntries(names.map((name) => [name, ZERO]));
  const rest = at(nothing);
  const factors = names.map((name) => [name, at({ ...nothing, [name]: ONE })]);
  if (rest === null || factors.some(([, factor]) => factor === null)) return null;
  return { rest, factors: Object.fromEntries(factors.map(([name, factor]) => [name, factor.minus(rest)])) };
}

/* A formula with numbers for its names. */
function placed(formula, values) {
  if (formula.kind === "name") return { kind: "number", value: values[formula.name] };
  if (formula.parts) return { ...formula, parts: formula.parts.map((part) => placed(part, values)) };
  return formula.of ? { ...formula, of: placed(formula.of, values) } : formula;
}

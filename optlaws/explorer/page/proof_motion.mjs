/* The constants of a stored law, enclosed: of the very function that its numbers describe. */

import { ONE, Rational, TWO, Unknown, ZERO, exact, greatest, least, sum, whole } from "./proof_numbers.mjs";
import { derivative, inPlace, multiplied, valueAt } from "./proof_laws.mjs";
import { above, below } from "./proof_balls.mjs";
import { along, formulaOf, namesIn, opposed } from "./proof_formulas.mjs";
import { interval } from "./proof_intervals.mjs";
import { machineConstant, machineName, outputOf } from "./proof_machines.mjs";
import { MEANS, ORDERS, PEAKS, peakOf, rangeOf } from "./proof_rows.mjs";

const BITS = 256;
const BITS_OF_CELL = 192;
/* Of its bound a formula may be above it by so much, and so many cells may show that it is no more. */
const KEPT = exact(1e-9);
const FORMULA_CELLS = 4000;
/* By how much of itself a peak may be above the value where it is said to be. */
const PLACE = exact(1e-7);
/* Peaks are enclosed to this share of themselves. */
const NARROW = new Rational(1n, 1n, -80);
/* By how much rounding may move the mirror image of a break. */
const EVEN = new Rational(1n, 1n, -50);

/* The pieces of a stored law: where each begins and ends, and its acceleration, velocity and position over t in [0, 1]. */
export function motionOf(law) {
  const several = law.kind === "piecewise";
  const breaks = (several ? law.breaks : [0, 1]).map(exact);
  const segments = several ? law.segments : [law];
  let position = exact(law.a0 ?? 0);
  return segments.map((segment, i) => {
    if (segment.kind !== "polynomial") throw new Unknown(`segments of the kind ${segment.kind}`);
    const [start, stop] = [breaks[i], breaks[i + 1]];
    const length = stop.minus(start);
    // Chebyshev polynomials of x = 2 t - 1
    const c = inPlace(ofChebyshev(segment.acceleration.map(exact)), ONE.negative(), TWO);
    const b = integral(c, length, exact(segment.b0 ?? 0));
    const a = integral(b, length, position);
    position = sum(a);
    return { start, stop, length, by: [a, b, c] };
  });
}

function ofChebyshev(coefficients) {
  let [before, polynomial] = [[ONE], [ZERO, ONE]];
  const total = coefficients.map(() => ZERO);
  coefficients.forEach((coefficient, i) => {
    const own = i === 0 ? before : polynomial;
    own.forEach((entry, j) => { total[j] = total[j].plus(coefficient.times(entry)); });
    if (i > 0) {
      const next = [ZERO, ...polynomial.map((entry) => entry.times(TWO))];
      before.forEach((entry, j) => { next[j] = next[j].minus(entry); });
      [before, polynomial] = [polynomial, next];
    }
  });
  return total;
}

function integral(polynomial, length, start) {
  return [start, ...polynomial.map((entry, i) => entry.times(length).over(whole(i + 1)))];
}

/* The derivative of order nu by k on a piece, over t. */
function of(piece, nu) {
  while (piece.by.length <= nu) piece.by.push(derivative(piece.by.at(-1)).map((entry) => entry.over(piece.length)));
  return piece.by[nu];
}

/* A constant of a law between two numbers. */
export function enclosed(motion, name) {
  if (machineName(name)) return ofMachine(motion, machineConstant(name));
  if (name in MEANS) {
    const square = sum(motion.map((piece) => sum(integral(multiplied(of(piece, MEANS[name]), of(piece, MEANS[name])), piece.length, ZERO))));
    const high = square.rootAbove();
    return [high.sign ? square.over(high).rounded(-1) : ZERO, high];
  }
  if (name === "D") return extreme(motion.map((piece) => multiplied(of(piece, 1), of(piece, 2))), [1, -1]);
  const form = name in PEAKS ? null : peakOf(name);
  if (form) return extreme(motion.map((piece) => formAlong(piece, form)), form.signs);
  if (!(name in PEAKS)) throw new Unknown(`the constant ${name}`);
  const [nu, signs] = PEAKS[name];
  return extreme(motion.map((piece) => of(piece, nu)), signs);
}

/* A formula that is affine in the law on a piece, over t. */
function formAlong(piece, { factors, rest }) {
  const parts = Object.entries(factors).map(([name, factor]) => of(piece, ORDERS[name]).map((entry) => entry.times(factor)));
  const length = Math.max(1, ...parts.map((part) => part.length));
  return Array.from({ length }, (_, i) => sum([i ? ZERO : rest, ...parts.map((part) => part[i] ?? ZERO)]));
}

function ofMachine(motion, constant) {
  if (motion.length > 1) throw new Unknown("outputs under laws of pieces");
  const { polynomials, off, size } = outputOf(constant, of(motion[0], 0));
  if (size) return [below(size), above(size)];
  const [low, high] = extreme(polynomials, [1, -1]);
  return [low.minus(off), high.plus(off)];
}

/* The greatest value of signs times polynomials over [0, 1], between two numbers; near 0 to a share of their size. */
function extreme(polynomials, signs) {
  const parts = polynomials.flatMap((polynomial) => signs.map((sign) => bernstein(polynomial).map((entry) => entry.times(whole(sign)))));
  let low = parts.map((part) => greatest(part[0], part.at(-1))).reduce(greatest);
  const size = parts.flat().map((entry) => entry.magnitude()).reduce(greatest, ZERO);
  if (size.sign === 0) return [ZERO, ZERO];
  const unit = BITS - Math.ceil(Math.log2(size.rounded(1, 60).toNumber() || 1));
  let waiting = parts.map((part) => [part.map((entry) => entry.floorIn(unit)), part.map((entry) => -entry.negative().floorIn(unit))]);
  let best = low.floorIn(unit);
  const room = size.times(NARROW).floorIn(unit) >> 6n;
  let high = best;
  for (let depth = 0; waiting.length && depth < 200; depth += 1) {
    const halves = [];
    for (const [lows, highs] of waiting) {
      const most = highs.reduce((first, second) => (first > second ? first : second));
      if (most <= best + room) {
        if (most > high) high = most;
        continue;
      }
      const [firstLows, secondLows] = halved(lows, 0n);
      const [firstHighs, secondHighs] = halved(highs, 1n);
      if (firstLows.at(-1) > best) best = firstLows.at(-1);
      halves.push([firstLows, firstHighs], [secondLows, secondHighs]);
    }
    waiting = halves;
  }
  if (waiting.length) throw new Unknown("a peak that is flat");
  low = new Rational(best, 1n, -unit);
  return [low, new Rational(high > best ? high : best, 1n, -unit)];
}

/* De Casteljau's halves, each rounding down (0) or up (1). */
function halved(coefficients, up) {
  let row = [...coefficients];
  const [first, second] = [[row[0]], [row.at(-1)]];
  while (row.length > 1) {
    row = row.slice(1).map((entry, i) => (entry + row[i] + up) >> 1n);
    first.push(row[0]);
    second.unshift(row.at(-1));
  }
  return [first, second];
}

function bernstein(polynomial) {
  const degree = Math.max(polynomial.length - 1, 0);
  const choose = (n, k) => {
    let value = 1n;
    for (let i = 1n; i <= BigInt(k); i += 1n) value = (value * (BigInt(n) - i + 1n)) / i;
    return value;
  };
  return Array.from({ length: degree + 1 }, (_, i) => {
    let value = ZERO;
    for (let j = 0; j <= i && j < polynomial.length; j += 1) {
      value = value.plus(polynomial[j].times(new Rational(choose(i, j)).over(new Rational(choose(degree, j)))));
    }
    return value;
  });
}

/* The value of an objective along a law, between two numbers. */
export function objectiveOf(motion, terms) {
  const known = new Map();
  const constant = (name) => {
    if (!known.has(name)) known.set(name, enclosed(motion, name));
    return known.get(name);
  };
  const total = (parts) => parts.reduce(([low, high], [weight, term]) => {
    const [least, most] = term.parts ? term.parts.map(total).reduce((a, b) => [greatest(a[0], b[0]), greatest(a[1], b[1])]) : constant(term.name);
    return [low.plus(weight.times(least)), high.plus(weight.times(most))];
  }, [ZERO, ZERO]);
  return total(terms);
}

/* By how much a law misses the derivatives that its ends are given. */
export function missesOf(motion, ends) {
  return ends.flatMap((values, end) => values.map((value, nu) => {
    const polynomial = of(end ? motion.at(-1) : motion[0], nu);
    const there = end ? sum(polynomial) : polynomial[0] ?? ZERO;
    return { nu, end, by: there.minus(value).magnitude(), size: polynomial.map((entry) => entry.magnitude()).reduce(greatest, ONE) };
  }));
}

/* The conditions of a problem beside its ends, each with what computes by how much of its bound a law breaks it at most. */
export function conditionsOf(motion, problem) {
  const conditions = [];
  const beyond = (value, bound) => value.minus(bound).over(greatest(ONE, bound.magnitude()));
  const named = [...["B", "C", "D", "J"].filter((name) => (problem[name] ?? null) !== null), ...Object.keys(problem.bounds ?? {})];
  for (const name of named) {
    const { low, high } = rangeOf(problem, name);
    conditions.push({
      name: `bound of ${name.split("(")[0]}`,
      by: () => {
        const [least, most] = enclosed(motion, name);
        return greatest(beyond(least.negative(), low.negative()), high ? beyond(most, high) : beyond(least.negative(), low.negative()));
      },
    });
  }
  (problem.windows ?? []).forEach((window, i) => {
    conditions.push({ name: `window ${i + 1}`, by: () => beyondWindow(motion, window, beyond) });
  });
  if (problem.monotone) conditions.push({ name: "monotone", by: () => extreme(motion.map((piece) => of(piece, 1)), [-1])[1] });
  if (problem.symmetric) conditions.push({ name: "symmetric", by: () => unevenness(motion) });
  return conditions;
}

function beyondWindow(motion, { quantity, low = null, high = null, start = 0, stop = 1 }, beyond) {
  const [first, last] = [exact(start), exact(stop)];
  if (!(quantity in ORDERS)) {
    const formula = formulaOf(quantity);
    const above = high === null ? [] : [formulaBeyond(motion, formula, exact(high), [first, last], beyond)];
    return [...above, ...(low === null ? [] : [formulaBeyond(motion, opposed(formula), exact(low).negative(), [first, last], beyond)])].reduce(greatest);
  }
  const parts = motion.filter((piece) => !last.below(piece.start) && !piece.stop.below(first)).map((piece) => {
    const from = greatest(piece.start, first).minus(piece.start).over(piece.length);
    const to = least(piece.stop, last).minus(piece.start).over(piece.length);
    return inPlace(of(piece, ORDERS[quantity]), from, to.minus(from));
  });
  const sides = [];
  if (high !== null) sides.push(beyond(extreme(parts, [1])[1], exact(high)));
  if (low !== null) sides.push(beyond(extreme(parts, [-1])[1], exact(low).negative()));
  return sides.reduce(greatest, ONE.negative());
}

/* By how much of its bound a formula of a law is above it at most, where that is little. */
function formulaBeyond(motion, formula, high, [first, last], beyond) {
  const names = namesIn(formula);
  let most = ONE.negative();
  let left = FORMULA_CELLS;
  for (const piece of motion) {
    const from = greatest(piece.start, first).minus(piece.start).over(piece.length).rounded(-1, BITS);
    const to = least(piece.stop, last).minus(piece.start).over(piece.length).rounded(1, BITS);
    const waiting = to.below(from) ? [] : [[from, to]];
    while (waiting.length) {
      const [low, top] = waiting.pop();
      left -= 1;
      if (left < 0) throw new Unknown("so fine a place of a formula");
      const { reached, within } = greatestIn(piece, formula, names, [low, top]);
      const by = beyond(within, high);
      if (KEPT.below(beyond(reached, high))) return by;
      if (!KEPT.below(by)) {
        most = greatest(most, by);
        continue;
      }
      const middle = low.plus(top).over(TWO);
      waiting.push([low, middle], [middle, top]);
    }
  }
  return most;
}

/* What a formula reaches in the middle of a cell, and is within: by Taylor's formula about it where that is less. */
function greatestIn(piece, formula, names, [low, high]) {
  const middle = low.plus(high).over(TWO);
  const reach = high.minus(low).over(TWO);
  const ofLaw = (cell) => Object.fromEntries(names.map((name) => [name, [0, 1, 2].map((more) => cell(ORDERS[name] + more))]));
  const scaled = (nu) => inPlace(of(piece, nu), low, high.minus(low));
  const over = ofLaw((nu) => hull(bernstein(scaled(nu))));
  const there = ofLaw((nu) => interval(valueAt(of(piece, nu), middle)));
  const [value, , bend] = along(formula, over);
  const [centre, slope] = along(formula, there);
  const steep = greatest(slope[0].magnitude(), slope[1].magnitude()).times(piece.length).times(reach);
  const round = greatest(bend[1], ZERO).times(piece.length.times(reach).power(2)).over(TWO);
  return { reached: centre[0], within: least(value[1], centre[1].plus(steep).plus(round)).rounded(1, BITS_OF_CELL) };
}

function hull(values) {
  return interval(values.reduce(least), values.reduce(greatest));
}

/* By how much a(k) + a(1 - k) is off what both ends give. */
function unevenness(motion) {
  const both = of(motion[0], 0)[0].plus(sum(of(motion.at(-1), 0)));
  const parts = motion.map((piece, i) => {
    const other = motion[motion.length - 1 - i];
    if (EVEN.below(piece.start.plus(other.stop).minus(ONE).magnitude())) throw new Unknown("breaks that are not symmetric");
    const mirrored = inPlace(of(other, 0), ONE, ONE.negative());
    const whole_ = of(piece, 0).map((entry, j) => entry.plus(mirrored[j] ?? ZERO));
    whole_[0] = whole_[0].minus(both);
    return whole_;
  });
  return extreme(parts, [1, -1])[1];
}

/* How far a law of one polynomial is from another at most. */
export function distance([piece], polynomial) {
  const position = of(piece, 0);
  const longer = Array.from({ length: Math.max(position.length, polynomial.length) }, (_, i) => (position[i] ?? ZERO).minus(polynomial[i] ?? ZERO));
  return extreme([longer], [1, -1])[1];
}

/* Whether a peak is where it is said to be, but for rounding of the place. */
export function reachedAt(motion, name, k, stated) {
  const least = stated.minus(PLACE.times(greatest(ONE, stated)));
  return motion.some((piece) => {
    if (k.below(piece.start) || piece.stop.below(k)) return false;
    const t = k.minus(piece.start).over(piece.length);
    const value = name === "D" ? valueAt(of(piece, 1), t).times(valueAt(of(piece, 2), t)) : valueAt(of(piece, (PEAKS[name] ?? [2])[0]), t);
    return !value.magnitude().below(least);
  });
}

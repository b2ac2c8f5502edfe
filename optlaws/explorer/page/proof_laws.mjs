/* The laws of a problem as a linear space of piecewise polynomials of k, in exact numbers. */

import { HALF, ONE, Rational, TWO, ZERO, exact, solved, sum, whole } from "./proof_numbers.mjs";

/* Bases of laws that are one polynomial. */
export const POLYNOMIALS = ["chebyshev", "bernstein", "powers"];

/* Polynomials are lists of coefficients of powers of k. */
export function valueAt(polynomial, k) {
  let value = ZERO;
  for (let i = polynomial.length - 1; i >= 0; i -= 1) value = value.times(k).plus(polynomial[i]);
  return value;
}

export function derivative(polynomial) {
  return polynomial.slice(1).map((coefficient, i) => coefficient.times(whole(i + 1)));
}

export function multiplied(first, second) {
  if (!first.length || !second.length) return [];
  const product = Array(first.length + second.length - 1).fill(ZERO);
  first.forEach((a, i) => {
    if (a.sign) second.forEach((b, j) => { product[i + j] = product[i + j].plus(a.times(b)); });
  });
  return product;
}

function added(first, second) {
  const longer = first.length < second.length ? second : first;
  return longer.map((_, i) => (first[i] ?? ZERO).plus(second[i] ?? ZERO));
}

function powerOf(polynomial, exponent) {
  let product = [ONE];
  for (let i = 0; i < exponent; i += 1) product = multiplied(product, polynomial);
  return product;
}

function monomial(exponent) {
  return [...Array(exponent).fill(ZERO), ONE];
}

/* (k - place)^exponent, or (place - k)^exponent. */
function shifted(place, exponent, backwards = false) {
  return powerOf(backwards ? [place, ONE.negative()] : [place.negative(), ONE], exponent);
}

/* The quotient by a polynomial; what remains is left out. */
export function quotient(polynomial, divisor) {
  const rest = [...polynomial];
  const parts = [];
  const lead = divisor[divisor.length - 1];
  for (let i = rest.length - divisor.length; i >= 0; i -= 1) {
    const part = rest[i + divisor.length - 1].over(lead);
    parts[i] = part;
    divisor.forEach((coefficient, j) => { rest[i + j] = rest[i + j].minus(part.times(coefficient)); });
  }
  return parts;
}

/* The same polynomial in t, k = start + length t. */
export function inPlace(polynomial, start, length) {
  let moved = [];
  for (let i = polynomial.length - 1; i >= 0; i -= 1) moved = added(multiplied(moved, [start, length]), [polynomial[i]]);
  return moved;
}

export class Laws {
  /* pieces: on each the free functions and, as the last, the base law. */
  constructor(problem, breaks, pieces, { continuity = null, conditions = [], divided = false, ratios = null } = {}) {
    Object.assign(this, { problem, breaks, continuity, conditions, divided, ratios });
    this.derivatives = [pieces];
    this.terms = pieces[0].length - 1;
  }

  /* Whether the acceleration is continuous at k in every law. */
  smoothAt(k) {
    return this.continuity === null || this.continuity > 1 || !this.breaks.some((place) => place.same(k));
  }

  derivative(nu) {
    while (this.derivatives.length <= nu) this.derivatives.push(this.derivatives.at(-1).map((part) => part.map(derivative)));
    return this.derivatives[nu];
  }

  /* The piece that k belongs to, the later one at a break; null beyond the breaks. */
  piece(k) {
    if (k.below(this.breaks[0]) || this.breaks.at(-1).below(k)) return null;
    let piece = 0;
    for (let i = 1; i < this.breaks.length - 1; i += 1) if (!k.below(this.breaks[i])) piece = i;
    return piece;
  }

  /* The derivative of order nu of every function at k, of the base law as the last. */
  values(nu, k) {
    const piece = this.piece(k);
    return piece === null ? null : this.derivative(nu)[piece].map((function_) => valueAt(function_, k));
  }

  /* (b - b(peak)) / w of laws whose acceleration is 0 at the peak. */
  chord(peak, k) {
    const piece = this.piece(k);
    const touching = this.breaks.slice(1).map((stop, i) => (!stop.below(peak) && !peak.below(this.breaks[i]) ? i : -1)).filter((i) => i >= 0);
    if (piece === null || !touching.length) return null;
    const [b, c] = [this.derivative(1), this.derivative(2)];
    const heights = b[touching[0]].map((function_) => valueAt(function_, peak));
    const smooth = this.smoothAt(peak);
    const power = smooth ? 2 : 1;
    const way = powerOf([peak.times(TWO).negative(), TWO], power);
    if (touching.includes(piece)) {
      const falling = !smooth && this.breaks[piece + 1].same(peak);
      const divided = b[piece].map((function_, i) => valueAt(quotient(added(function_, [heights[i].negative()]), way), k));
      return falling ? divided.map((value) => value.negative()) : divided;
    }
    const before = piece < touching[0];
    const inner = before ? touching[0] : touching.at(-1);
    const joint = this.breaks[before ? inner : inner + 1];
    const nearest = this.breaks[before ? piece + 1 : piece];
    const scale = nearest.minus(peak).times(TWO).magnitude().power(power);
    return b[piece].map((function_, i) => {
      const slope = smooth ? valueAt(c[inner][i], peak).times(joint.minus(peak)) : ZERO;
      return valueAt(function_, k).minus(heights[i]).minus(slope).over(scale);
    });
  }

  /* -b / w of laws from rest to rest. */
  ratio(k) {
    const piece = this.piece(k);
    if (piece === null || !this.divided) return null;
    const order = this.problem.order;
    const b = this.derivative(1);
    if (this.ratios) return b[piece].map((function_) => valueAt(quotient(function_, this.ratios[piece]), k).negative());
    const weight = powerOf([ZERO, whole(4), whole(-4)], order - 1);
    const middle = valueAt(b[this.piece(HALF)].at(-1), HALF).negative();
    return b[piece].map((function_) => valueAt(quotient(function_, weight), k).over(middle));
  }

  /* Integrals over k of the derivatives of order nu times Legendre polynomials on a piece: one list for each. */
  moments(nu) {
    const rows = [];
    this.derivative(nu).forEach((part, i) => {
      const length = this.breaks[i + 1].minus(this.breaks[i]);
      const local = part.map((function_) => inPlace(function_, this.breaks[i], length));
      const degree = Math.max(-1, ...local.slice(0, -1).map((function_) => function_.length - 1));
      for (let m = 0; m <= degree; m += 1) {
        const row = local.map((function_) => sum(function_.map((coefficient, j) => coefficient.times(legendreMoment(m, j)))).times(length));
        if (row.slice(0, -1).some((entry) => entry.sign)) rows.push(Object.assign(row, { piece: i }));
      }
    });
    return rows;
  }
}

/* The integral of P_m(2t - 1) t^j from 0 to 1: j!² / ((j - m)! (j + m + 1)!). */
export function legendreMoment(m, j) {
  if (j < m) return ZERO;
  let [n, d] = [1n, BigInt(j + m + 1)];
  for (let i = 0; i < m; i += 1) {
    n *= BigInt(j - i);
    d *= BigInt(j + m - i);
  }
  return new Rational(n).over(new Rational(d));
}

/* The polynomial of degree 2l - 1 with these derivatives at 0 and at 1. */
function between(start, end) {
  const order = start.length;
  const low = start.map((value, i) => value.over(factorial(i)));
  const rows = [];
  const right = [];
  for (let nu = 0; nu < order; nu += 1) {
    const at1 = (i) => (i < nu ? ZERO : factorial(i).over(factorial(i - nu)));
    rows.push(Array.from({ length: order }, (_, i) => at1(order + i)));
    right.push(end[nu].minus(sum(low.map((coefficient, i) => coefficient.times(at1(i))))));
  }
  return [...low, ...solved(rows, right)];
}

function factorial(i) {
  let product = 1n;
  for (let factor = 2n; factor <= BigInt(i); factor += 1n) product *= factor;
  return new Rational(product);
}

/* The derivatives of a problem's laws at both ends. */
export function ends(problem) {
  const rest = (value) => Array.from({ length: problem.order }, (_, i) => (i ? ZERO : whole(value)));
  const of = (given, value) => (given ? rest(0).map((_, i) => exact(given[i] ?? 0)) : rest(value));
  return [of(problem.start, 0), of(problem.end, 1)];
}

export function stroke(problem) {
  const [start, end] = ends(problem);
  return end[0].minus(start[0]);
}

/* b(1) - b(0), and b(0); null where nothing is given. */
export function endVelocities(problem) {
  const [start, end] = ends(problem);
  return problem.order < 2 ? null : { start: start[1], change: end[1].minus(start[1]) };
}

/* The space of a problem's laws; null where this program does not know its basis. */
export function lawsOf(problem) {
  const rest = !problem.start && !problem.end;
  const [start, end] = ends(problem);
  const edge = powerOf([ZERO, ONE.negative(), ONE], problem.order);
  const { degree, continuity, symmetric } = problem;
  if (POLYNOMIALS.includes(problem.basis)) {
    const odd = [ONE.negative(), TWO];
    const free = [];
    for (let i = symmetric ? 1 : 0; i <= degree; i += symmetric ? 2 : 1) free.push(symmetric ? powerOf(odd, i) : monomial(i));
    const part = [...free.map((z) => multiplied(edge, z)), between(start, end)];
    return new Laws(problem, [ZERO, ONE], [part], { divided: rest });
  }
  const all = problem.breaks?.map(exact);
  if (problem.straight?.length || !all) return null;
  if (problem.basis === "bsplines") {
    const [breaks, splines] = symmetric ? oddSplines(all, degree, continuity) : [all, splinesOf(all, degree, continuity)];
    const base = between(start, end);
    const pieces = splines.map((part) => [...part.map((z) => multiplied(edge, z)), base]);
    return new Laws(problem, breaks, pieces, { continuity, divided: rest });
  }
  if (problem.basis !== "pieces") return null;
  const breaks = symmetric ? all.filter((k) => !HALF.below(k)) : all;
  const conditions = [];
  for (let nu = 2; nu < problem.order; nu += 1) conditions.push({ nu, k: ZERO, value: start[nu] });
  if (symmetric) {
    conditions.push({ nu: 0, k: HALF, value: start[0].plus(end[0]).over(TWO) });
    for (let nu = 2; nu <= Math.min(continuity, degree); nu += 2) conditions.push({ nu, k: HALF, value: ZERO });
  } else {
    end.forEach((value, nu) => conditions.push({ nu, k: ONE, value }));
  }
  const base = start.slice(0, degree + 1).map((value, i) => value.over(factorial(i)));
  const pieces = splinesOf(breaks, degree, continuity, problem.order).map((part) => [...part, base]);
  const divided = rest && problem.order > 1 && (symmetric || breaks.length > 2);
  const ratios = breaks.slice(1).map(() => [ONE]);
  ratios[0] = powerOf([ZERO, ONE.over(breaks[1])], problem.order - 1);
  if (breaks.at(-1).same(ONE)) {
    const last = ONE.minus(breaks.at(-2));
    ratios[ratios.length - 1] = powerOf([ONE.over(last), ONE.over(last).negative()], problem.order - 1);
  }
  return new Laws(problem, breaks, pieces, { continuity, conditions, divided, ratios });
}

/* The law of a polynomial Z by powers of k; null where laws have none. */
export function lawOfZ(problem, z) {
  if (!POLYNOMIALS.includes(problem.basis)) return null;
  return added(between(...ends(problem)), multiplied(powerOf([ZERO, ONE.negative(), ONE], problem.order), z));
}

/* On each piece: powers of k from the lowest on, then what begins at each inner break. */
function splinesOf(breaks, degree, continuity, lowest = 0) {
  return breaks.slice(0, -1).map((start) => {
    const part = [];
    for (let i = lowest; i <= degree; i += 1) part.push(monomial(i));
    for (const place of breaks.slice(1, -1)) {
      for (let j = continuity + 1; j <= degree; j += 1) part.push(start.below(place) ? [] : shifted(place, j));
    }
    return part;
  });
}

/* Breaks of the first half, and the splines that are odd about 1/2, there. */
function oddSplines(breaks, degree, continuity) {
  const inner = breaks.filter((k) => ZERO.below(k) && k.below(HALF));
  const broken = breaks.some((k) => k.same(HALF));
  const starts = [ZERO, ...inner];
  const pieces = starts.map((start) => {
    const part = [];
    for (let j = 1; j <= degree; j += 2) part.push(shifted(HALF, j, true));
    for (let j = 2; broken && j <= degree; j += 2) if (j > continuity) part.push(shifted(HALF, j, true));
    for (const place of inner) {
      for (let j = continuity + 1; j <= degree; j += 1) part.push(start.below(place) ? shifted(place, j, true) : []);
    }
    return part;
  });
  return [[...starts, HALF], pieces];
}

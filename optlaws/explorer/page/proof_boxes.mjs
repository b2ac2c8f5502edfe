/* Trees over boxes of velocities and constants, for problems with the power D or windows of formulas. */

import { ONE, Rational, TWO, Unknown, ZERO, exact, greatest, least, quotientRounded, whole } from "./proof_numbers.mjs";
import { BITS, NOTHING, added, interval, inverse, negative, product, ratio, signedRoot } from "./proof_intervals.mjs";
import { namesIn, planeBelow } from "./proof_formulas.mjs";
import { ORDERS, Rows, rangeOf } from "./proof_rows.mjs";
import { POLYNOMIALS, endVelocities, stroke } from "./proof_laws.mjs";

/* The peak of a derivative that is in a formula. */
const MOST = { b: "B", c: "C", j: "J" };

class Boxes {
  constructor(certificate) {
    const { problem, points } = certificate;
    this.rows = new Rows(problem, "objective");
    const { laws, names } = this.rows;
    if (!POLYNOMIALS.includes(problem.basis) || problem.order < 2) throw new Unknown(`boxes of laws in ${problem.basis}`);
    if (names.some((name) => name.startsWith("C_") || name.startsWith("max"))) throw new Unknown(`boxes of ${problem.minimise}`);
    this.problem = problem;
    this.claim = exact(certificate.claim);
    this.points = points.map(exact);
    if (points.length !== laws.terms) throw new TypeError("the points do not determine the law");
    const velocities = this.points.map((k) => laws.values(1, k));
    this.base = velocities.map((row) => row.at(-1));
    this.adjugate = adjugate(velocities.map((row) => row.slice(0, -1)));
    if (this.adjugate.determinant.sign === 0) throw new TypeError("the points do not determine the law");
    const { start, change } = endVelocities(problem);
    this.ends = [start, start.plus(change)];
    this.most = new Map();
    const lower = (name, value) => this.most.set(name, this.most.has(name) ? least(this.most.get(name), value) : value);
    for (const [weight, term] of this.rows.objective) lower(term.name, quotientRounded(this.claim, weight, 1, BITS));
    for (const name of ["B", "C", "D", "J", ...Object.keys(problem.bounds ?? {})]) {
      const range = rangeOf(problem, name);
      if (range?.high) lower(name, range.high);
    }
    if (this.most.has("D")) {
      const fastest = this.ends.map((end) => end.magnitude()).reduce(greatest);
      lower("B", signedRoot(fastest.times(fastest).plus(this.most.get("D")), 1));
    } else {
      if (problem.start || problem.end) throw new Unknown("boxes of laws that are not from rest to rest");
      for (const name of ["C", "rms_c", "J", "rms_j"]) if (this.most.has(name)) lower("B", stroke(problem).magnitude().plus(this.most.get(name)));
      if (!this.most.has("B")) throw new Unknown("boxes without a bound of the velocity");
    }
    this.anchors = [[ZERO, this.ends[0], this.ends[0]], [ONE, this.ends[1], this.ends[1]]];
    const { velocity, peak } = this.rows;
    if (velocity && velocity.low.sign > 0 && peak) this.anchors.push([peak, velocity.low, this.most.get("B")]);
  }

  /* Whether the steps leave no box. */
  hold(steps) {
    const regions = [this.first()];
    for (const step of steps) {
      const box = regions.pop();
      if (!box) return false;
      const inside = step.variable >= 0 && step.variable < box.low.length;
      if (step.at !== undefined && step.at !== null) {
        if (!inside) return false;
        const at = exact(step.at);
        regions.push(cut(box, step.variable, { low: at }), cut(box, step.variable, { high: at }));
      } else {
        if (step.variable !== -1 && !inside) return false;
        const left = this.moved(box, step);
        if (left) regions.push(left);
      }
    }
    return regions.length === 0;
  }

  first() {
    const sides = this.points.map((k) => this.outer(k, this.anchors));
    for (const name of this.rows.names) {
      const range = name === "B" ? rangeOf(this.problem, "B") : null;
      if (!this.most.has(name)) throw new Unknown(`boxes of ${name}`);
      sides.push([range ? range.low : ZERO, this.most.get(name)]);
    }
    return { low: sides.map(([low]) => low.rounded(-1, BITS)), high: sides.map(([, high]) => high.rounded(1, BITS)) };
  }

  /* Between what values b(k) is: b |b| changes no faster than 2 D, b from its ends no faster than C. */
  outer(k, anchors) {
    let [low, high] = [this.most.get("B").negative(), this.most.get("B")];
    if (!this.most.has("D")) {
      for (const [at, slowest, fastest] of this.most.has("C") ? anchors : []) {
        const change = this.most.get("C").times(k.minus(at).magnitude());
        [low, high] = [greatest(low, slowest.minus(change)), least(high, fastest.plus(change))];
      }
      return [this.problem.monotone ? greatest(low, ZERO) : low, high];
    }
    for (const [at, slowest, fastest] of anchors) {
      const change = this.most.get("D").times(TWO).times(k.minus(at).magnitude());
      low = greatest(low, signedRoot(slowest.times(slowest.magnitude()).minus(change), -1));
      high = least(high, signedRoot(fastest.times(fastest.magnitude()).plus(change), 1));
    }
    return [this.problem.monotone ? greatest(low, ZERO) : low, high];
  }

  /* The box after a leaf or a tightening; null where it is closed. */
  moved(box, step) {
    const size = box.low.length + 1;
    let total = Array(size).fill(NOTHING);
    const tightening = step.variable >= 0;
    if (tightening) {
      if (step.side !== 1 && step.side !== -1) throw new TypeError("a side is 1 or -1");
      total[step.variable] = interval(whole(step.side));
    }
    const add = (multiplier, row) => { total = total.map((entry, i) => added(entry, product(interval(multiplier), row[i]))); };
    for (const contact of step.contacts ?? []) {
      const multiplier = exact(contact.multiplier);
      const row = multiplier.sign > 0 ? this.row(contact, box) : null;
      if (row) add(multiplier, row);
    }
    this.rows.equations.forEach((row, i) => { if (step.equations?.[i]) add(exact(step.equations[i]), this.mapped(row)); });
    const weight = greatest(exact(step.claim ?? 0), ZERO);
    if (weight.sign) add(weight, [...this.points.map(() => NOTHING), ...this.rows.names.map((name) => interval(this.rows.cost.get(name) ?? ZERO)), interval(this.claim.negative())]);
    const value = leastIn(box, total);
    if (!tightening) return value.sign > 0 ? null : box;
    const [low, high] = [box.low[step.variable], box.high[step.variable]];
    if (step.side > 0) return high.below(value) ? null : cut(box, step.variable, { low: greatest(low, value) });
    const side = value.negative();
    return side.below(low) ? null : cut(box, step.variable, { high: least(high, side) });
  }

  row(contact, box) {
    if (contact.constraint.startsWith("power")) return this.power(contact, box);
    if (contact.constraint.startsWith("plane ")) return this.plane(contact, box);
    const row = this.rows.row(contact);
    return row && this.mapped(row);
  }

  /* A row over the law's coordinates as one over the velocities at the points: intervals, the constant as the last. */
  mapped({ z, names, constant }) {
    const { matrix, determinant } = this.adjugate;
    const weights = matrix.map((column) => column.reduce((total, entry, i) => total.plus(entry.times(z[i])), ZERO));
    const shift = weights.reduce((total, weight, i) => total.plus(weight.times(this.base[i])), ZERO);
    return [
      ...weights.map((weight) => ratio(weight, determinant)),
      ...this.rows.names.map((name) => interval(names[name] ?? ZERO)),
      added(interval(constant), negative(ratio(shift, determinant))),
    ];
  }

  derivative(nu, k) {
    const values = this.rows.laws.values(nu, k);
    return this.mapped({ z: values.slice(0, -1), names: {}, constant: values.at(-1) });
  }

  /* The plane that is nowhere above the formula of a window while the law is in the box. */
  plane(contact, box) {
    const [, number, name] = /^plane (\d+) of (window .*)$/.exec(contact.constraint) ?? [];
    const side = name && this.rows.formulaSide(name, contact.sign);
    if (!side) throw new Unknown(`rows ${contact.constraint}`);
    const k = exact(contact.k);
    if (k.below(side.start) || side.stop.below(k)) return null;
    const names = namesIn(side.formula);
    const rows = names.map((each) => this.derivative(ORDERS[each], k));
    const ranges = names.map((each, i) => {
      const inBox = [leastIn(box, rows[i]), leastIn(box, rows[i].map(negative)).negative()];
      const most = this.most.get(MOST[each]);
      const known = each === "b" ? this.outer(k, this.anchors) : most ? [most.negative(), most] : inBox;
      return interval(greatest(inBox[0], known[0]), least(inBox[1], known[1]));
    });
    if (ranges.some(([low, high]) => high.below(low))) return null;
    const corner = Number(number) - 1;
    const touch = ranges.map(([low, high], i) => {
      if (corner < 0) return low.plus(high).over(TWO).rounded(-1, BITS);
      return (corner >> (names.length - 1 - i)) & 1 ? high : low;
    });
    const { slopes, height } = planeBelow(side.formula, names, ranges, touch);
    const row = rows[0].map((_, column) => rows.map((own, i) => product(slopes[i], own[column])).reduce(added));
    row[row.length - 1] = added(row.at(-1), [height[0].minus(side.high), height[0].minus(side.high)]);
    return row;
  }

  /* s c <= D / |b| by the chord of 1 / |b| and of its product with D; null where b may be 0 in the box. */
  power(contact, box) {
    const k = exact(contact.k);
    const velocity = this.derivative(1, k);
    const known = [...this.anchors, ...this.points.map((at, i) => [at, box.low[i], box.high[i]])];
    const [slowest, fastest] = this.outer(k, known);
    const low = greatest(slowest, leastIn(box, velocity));
    const high = least(fastest, leastIn(box, velocity.map(negative)).negative());
    const forth = low.sign > 0 ? ONE : ONE.negative();
    const [near, far] = low.sign > 0 ? [low, high] : [high.negative(), low.negative()];
    if (near.sign <= 0 || far.below(near)) return null;
    const place = this.rows.names.indexOf("D");
    const fromLeast = contact.constraint === "power, from the least D";
    if (!fromLeast && contact.constraint !== "power") throw new Unknown(`rows ${contact.constraint}`);
    const at = this.points.length + place;
    const D = interval(place < 0 ? this.most.get("D") : (fromLeast ? box.low : box.high)[at]);
    const [overNear, overFar] = [inverse(interval(near)), inverse(interval(far))];
    const slope = product(product(D, interval(forth)), product(overNear, overFar));
    const sign = interval(whole(contact.sign));
    const row = this.derivative(2, k).map((entry, i) => added(product(sign, entry), product(slope, velocity[i])));
    row[row.length - 1] = added(row.at(-1), negative(product(D, added(overNear, overFar))));
    if (place >= 0) {
      const other = fromLeast ? overNear : overFar;
      row[at] = added(row[at], negative(other));
      row[row.length - 1] = added(row.at(-1), product(D, other));
    }
    return row;
  }
}

/* What a row of intervals is at least in a box. */
function leastIn(box, row) {
  return row.slice(0, -1).reduce((total, entry, i) => total.plus(product(entry, [box.low[i], box.high[i]])[0]), row.at(-1)[0]).rounded(-1, BITS);
}

function cut(box, variable, { low = null, high = null }) {
  const moved = { low: [...box.low], high: [...box.high] };
  if (low) moved.low[variable] = low;
  if (high) moved.high[variable] = high;
  return moved;
}

/* The adjugate of a matrix, by columns, and its determinant: exact, and without a quotient. */
function adjugate(matrix) {
  const size = matrix.length;
  const minor = (rows, columns) => determinantOf(rows.map((i) => columns.map((j) => matrix[i][j])));
  const all = [...matrix.keys()];
  const without = (i) => all.filter((j) => j !== i);
  // velocities = matrix z + base, so z = adjugate (velocities - base) / determinant
  const columns = all.map((j) => all.map((i) => {
    const value = minor(without(j), without(i));
    return (i + j) % 2 ? value.negative() : value;
  }));
  return { matrix: columns, determinant: size ? determinantOf(matrix) : ONE };
}

/* Bareiss's elimination over whole numbers; entries are dyadic. */
function determinantOf(matrix) {
  if (!matrix.length) return ONE;
  const e = Math.min(0, ...matrix.flat().map((entry) => entry.e));
  const rows = matrix.map((row) => row.map((entry) => entry.n << BigInt(entry.e - e)));
  let [divisor, sign] = [1n, 1n];
  for (let i = 0; i < rows.length; i += 1) {
    const pivot = rows.findIndex((row, j) => j >= i && row[i] !== 0n);
    if (pivot < 0) return ZERO;
    if (pivot !== i) {
      [rows[i], rows[pivot]] = [rows[pivot], rows[i]];
      sign = -sign;
    }
    for (let j = i + 1; j < rows.length; j += 1) {
      for (let m = rows.length - 1; m >= i; m -= 1) rows[j][m] = (rows[j][m] * rows[i][i] - rows[j][i] * rows[i][m]) / divisor;
    }
    divisor = rows[i][i];
  }
  return new Rational(sign * divisor, 1n, e * rows.length);
}

/* Whether the tree of a certificate over boxes shows that no law has an objective below its claim. */
export function boxesHold(certificate) {
  if (!(certificate.claim > 0) || !Array.isArray(certificate.steps)) throw new TypeError("a claim above 0 and steps are needed");
  return new Boxes(certificate).hold(certificate.steps);
}

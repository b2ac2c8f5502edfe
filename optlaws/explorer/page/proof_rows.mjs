/* The rows that every law of a problem obeys, by the names that certificates use, in exact numbers. */

import { HALF, ONE, TWO, Unknown, ZERO, exact, greatest, solved, sum, whole } from "./proof_numbers.mjs";
import { POLYNOMIALS, endVelocities, inPlace, lawsOf, legendreMoment } from "./proof_laws.mjs";
import { ball, middle, plus, times } from "./proof_balls.mjs";
import { affineIn, formulaOf, opposed } from "./proof_formulas.mjs";
import { Mode, Outputs, machineConstant, machineName } from "./proof_machines.mjs";

const PEAKS = {
  B: [1, [1, -1]], C: [2, [1, -1]], J: [3, [1, -1]], snap: [4, [1, -1]], C_plus: [2, [1]], C_minus: [2, [-1]],
};
const MEANS = { rms_c: 2, rms_j: 3, rms_snap: 4 };
const ORDERS = { a: 0, b: 1, c: 2, j: 3 };
const ROOT = "root of D";
const NEAR = exact(1e-9);
const BESIDE = exact(2 ** -51);
/* The weights of an objective between which they are no part of its scale. */
const LEAST_WEIGHT = 1e-3;
const GREATEST_WEIGHT = 1e3;

/* "0.5*C + max(B, 0.2*J)" as [[weight, term]]; a term has a name and, of a maximum, parts. */
export function parsed(text) {
  let at = 0;
  const skip = () => { while (text[at] === " ") at += 1; };
  function terms() {
    const read = [term()];
    for (skip(); text[at] === "+"; skip()) {
      at += 1;
      read.push(term());
    }
    return read;
  }
  function term() {
    skip();
    const number = /^\d+(\.\d*)?(e[+-]?\d+)?\*/.exec(text.slice(at));
    if (number) at += number[0].length;
    const weight = number ? exact(Number(number[0].slice(0, -1))) : ONE;
    const start = at;
    const name = machineName(text.slice(at)) ?? peakName(text.slice(at)) ?? /^\w+/.exec(text.slice(at))?.[0];
    at += name?.length ?? 0;
    if (name === "max" && text[at] === "(") {
      const parts = [];
      do {
        at += 1;
        parts.push(terms());
        skip();
      } while (text[at] === ",");
      if (text[at] !== ")") throw new Unknown(`the objective ${text}`);
      at += 1;
      return [weight, { name: text.slice(start, at), parts }];
    }
    if (!(name in PEAKS) && !(name in MEANS) && name !== "D" && !peakOf(name ?? "") && !machineConstant(name ?? "")) throw new Unknown(`the objective ${text}`);
    return [weight, { name }];
  }
  const read = terms();
  if (at !== text.length) throw new Unknown(`the objective ${text}`);
  return read;
}

/* The text of a formula's peak at the beginning of a text; null where there is none. */
function peakName(text) {
  if (!text.startsWith("peak(")) return null;
  let depth = 0;
  const last = [...text].findIndex((sign) => {
    depth += sign === "(" ? 1 : sign === ")" ? -1 : 0;
    return sign === ")" && depth === 0;
  });
  return last < 0 ? null : text.slice(0, last + 1);
}

/* The peak of a formula that is affine in the law, of its value or of its magnitude; null where this program knows no such. */
export function peakOf(name) {
  const [, text, side] = /^peak\(([^,]*)(, side=high)?\)$/.exec(name) ?? [];
  const form = text === undefined ? null : affineIn(formulaOf(text));
  return form && { ...form, signs: side ? [1] : [1, -1] };
}

/* The names of the constants in an objective. */
export function leavesOf(terms) {
  return terms.flatMap(([, term]) => (term.parts ? term.parts.flatMap(leavesOf) : [term.name]));
}

/* The size of an objective in smooth laws, a power of 2, with which numbers near 0 are compared; 0 where it is not known. */
export function scaleOf(terms) {
  const sizes = terms.map(([, { name, parts }]) => {
    if (parts) return parts.map(scaleOf).reduce(greatest);
    return name in PEAKS || name in MEANS || name === "D" ? ONE : ZERO;
  });
  const unit = sizes.reduce(greatest);
  if (sizes.some((size) => size.sign === 0)) return ZERO;
  const share = terms.map(([weight], i) => weight.times(sizes[i].over(unit)).toNumber()).reduce((one, other) => Math.max(one, other));
  return share > LEAST_WEIGHT && share < GREATEST_WEIGHT ? unit : unit.times(exact(2 ** Math.floor(Math.log2(share))));
}

function maximaOf(terms) {
  return terms.flatMap(([, term]) => (term.parts ? [term, ...term.parts.flatMap(maximaOf)] : []));
}

/* A range of a problem's constant: null where it is free, `high` null where there is no upper bound. */
export function rangeOf(problem, name) {
  const given = problem[name] ?? problem.bounds?.[name] ?? null;
  if (given === null || "minimise order degree".includes(name)) return null;
  const [low, high] = Array.isArray(given) ? given : [given, given];
  return { low: exact(low ?? 0), high: high === null ? null : exact(high) };
}

/* Whether a constant is never below 0 in a law of a problem. */
export function neverNegative(problem, name) {
  if (name.startsWith("max(") && parsed(name)[0][1].parts.some((part) => part.every(([, term]) => neverNegative(problem, term.name)))) return true;
  if (name.includes("side=")) return false;
  const velocities = endVelocities(problem);
  return !["C_plus", "C_minus"].some((constant) => name.includes(constant)) || (velocities !== null && velocities.change.sign === 0);
}

/* Whether a range is one value. */
export function fixed(range) {
  return range !== null && range.high !== null && range.low.same(range.high);
}

export class Rows {
  constructor(problem, program, tangent = 0) {
    this.problem = problem;
    this.relaxed = program === "relaxed";
    this.tangent = exact(tangent);
    this.laws = lawsOf(problem);
    if (!this.laws) throw new Unknown(`laws of the basis ${problem.basis}`);
    this.objective = parsed(problem.minimise);
    const others = Object.keys(problem.bounds ?? {}).filter((name) => !(name in PEAKS) && !(name in MEANS) && name !== "D");
    this.machines = new Map();
    const named = [...others, ...leavesOf(this.objective).filter((leaf) => leaf.includes("("))];
    for (const name of named.filter((each) => !peakOf(each))) this.#addMachine(name);
    const formulas = (problem.windows ?? []).filter((window) => !(window.quantity in ORDERS));
    if (formulas.some(({ low, high, start, stop }) => low === high && start === stop)) throw new Unknown("values of a formula");
    this.velocity = rangeOf(problem, "B");
    const rest = !problem.start && !problem.end;
    const inTheMiddle = rest && fixed(this.velocity) && ONE.below(this.velocity.high);
    this.peak = problem.inflexion !== undefined && problem.inflexion !== null ? exact(problem.inflexion) : inTheMiddle ? HALF : null;
    this.peakIsVariable = this.velocity !== null
      && (fixed(this.velocity) ? !problem.symmetric : this.velocity.low.sign > 0 && this.peak !== null);
    this.cost = new Map();
    this.maxima = [];
    const names = [];
    if (program !== "violation") {
      this.maxima = maximaOf(this.objective);
      names.push(...leavesOf(this.objective), ...this.maxima.map((term) => term.name));
      for (const [weight, term] of this.objective) this.cost.set(term.name, (this.cost.get(term.name) ?? ZERO).plus(weight));
    }
    if (this.peakIsVariable) names.push("B");
    const power = rangeOf(problem, "D");
    if (this.relaxed && (names.includes("D") || (power && power.high))) names.push(ROOT);
    this.names = [...new Set(names)];
    this.equations = this.#equations();
  }

  /* A row: factors of the law's coordinates, factors of the variables by name, and a constant; their sum is <= 0. */
  #row(values, sign = ONE, names = {}, high = ZERO) {
    const own = values ?? Array(this.laws.terms + 1).fill(ZERO);
    const scaled = own.map((value) => value.times(sign));
    return { z: scaled.slice(0, -1), names, constant: scaled.at(-1).minus(high) };
  }

  /* A row below a constant: its variable, or its upper bound; null where it has neither. */
  #below(values, sign, name) {
    if (this.names.includes(name)) return this.#row(values, sign, { [name]: ONE.negative() });
    const range = rangeOf(this.problem, name);
    return range?.high ? this.#row(values, sign, {}, range.high) : null;
  }

  /* The row of a contact; null where the problem has none of the kind. */
  row(contact) {
    const { constraint: name, direction = [] } = contact;
    const { problem, laws } = this;
    const k = exact(contact.k);
    const sign = whole(contact.sign);
    const signs = (...allowed) => allowed.includes(contact.sign);
    if (name in PEAKS) {
      const [nu, both] = PEAKS[name];
      const known = problem.symmetric && nu % 2 === 0 ? [1, -1] : both;
      const values = signs(...known) ? laws.values(nu, k) : null;
      if (name === "B" && this.peakIsVariable) return null;
      return values && this.#below(values, sign, name);
    }
    if (name in MEANS) return this.#mean(name, direction);
    if (peakName(name) === name) return this.#peak(name, contact.sign, k);
    if (machineName(name)) return this.machines.has(name) ? this.#ofMachine(name, sign, k, direction) : this.#strange(name);
    if (name === "b" && this.velocity && signs(1, -1)) {
      const values = laws.values(1, k);
      if (!values) return null;
      if (this.peakIsVariable) return this.#row(values, sign, { B: ONE.negative() });
      if (!fixed(this.velocity)) return null;
      const middle = laws.values(1, HALF);
      return this.#row(values.map((value, i) => value.times(sign).minus(middle[i])));
    }
    if (name === "chord" && this.peak && signs(1)) return this.#known(laws.chord(this.peak, k));
    if (name === "ratio" && problem.monotone && signs(1)) return this.#known(laws.ratio(k));
    if (name === "forward" && problem.monotone && signs(-1)) return this.#known(laws.values(1, k), ONE.negative());
    if (name.endsWith(" at most") || name.endsWith(" at least")) return this.#bound(name, contact.sign);
    if (name.startsWith("part ")) return this.#part(name);
    if (name.startsWith("window ")) return this.#window(name, contact.sign, k);
    if (name.startsWith("b / sqrt(") && signs(1, -1)) return this.#fromRest(name, sign, k);
    if (name === "tangent" && this.names.includes(ROOT)) return this.#tangent();
    if (!["b", "chord", "ratio", "forward", "tangent"].includes(name)) throw new Unknown(`rows ${name}`);
    return null;
  }

  #strange(name) {
    if (machineName(name) !== name) throw new Unknown(`rows ${name}`);
    return null;
  }

  #addMachine(name) {
    const constant = machineConstant(name);
    if (!constant) throw new Unknown(`the constant ${name}`);
    const { problem, laws } = this;
    if (problem.start || problem.end || problem.order < 2 || !POLYNOMIALS.includes(problem.basis)) throw new Unknown("machines that such laws drive");
    this.machines.set(name, constant.kind === "mode_residual" ? new Mode(constant, laws) : new Outputs(constant, laws));
  }

  /* A row of a machine's constant; `loose` where its unit is the machine's and its variable is to be balanced. */
  #ofMachine(name, sign, k, direction) {
    const machine = this.machines.get(name);
    const variable = this.names.includes(name);
    const { kind } = machine.constant;
    if (kind !== "mode_residual") {
      if (!variable) throw new Unknown("the unit of an output that is bounded");
      if (kind === "output_rms") return { rms: name };
      const values = sign.magnitude().same(ONE) ? machine.at(k) : null;
      return values && { ...this.#enclosed(values.map(middle), sign, { [name]: ONE.negative() }), loose: name };
    }
    if (direction.length !== 2) return null;
    const [e1, e2] = direction.map(exact);
    const length = greatest(ONE, e1.times(e1).plus(e2.times(e2)).rootAbove());
    const values = machine.at(k).map(([real, imaginary]) => middle(plus(times(real, ball(e1)), times(imaginary, ball(e2)))));
    if (variable) return { ...this.#enclosed(values, ONE.over(length), { [name]: ONE.negative() }), loose: name };
    const { high } = rangeOf(this.problem, name) ?? {};
    if (!high) return null;
    if (high.sign <= 0) throw new Unknown("the unit of a residual whose bound is 0");
    return this.#enclosed(values, ONE.over(length.times(high)), {}, ONE);
  }

  /* A row of numbers that are off by no more than they say. */
  #enclosed(values, factor, names, high = ZERO) {
    const size = factor.magnitude();
    const off = values.map((value) => value.off.times(size).rounded(1, 64));
    return { ...this.#row(values.map(({ centre }) => centre), factor, names, high), off: off.slice(0, -1), offConstant: off.at(-1) };
  }

  /* The row of an output's RMS that balances slopes: the output times the function g, over the RMS of g. */
  beside(name, slopes) {
    const machine = this.machines.get(name);
    const { start, stop } = machine.constant;
    if (start.sign || !stop.same(ONE)) throw new Unknown("means beyond the rise");
    const products = machine.products().map((row) => row.map((entry) => entry && middle(entry)));
    const gram = (i, j) => (i <= j ? products[i][j] : products[j][i]);
    const base = this.laws.terms;
    const free = [...slopes.keys()];
    const matrix = free.map((i) => free.map((j) => gram(i, j).centre));
    const aim = slopes.map((slope) => slope.negative().rounded(1, 400));
    const across = free.map((i) => gram(i, base).centre);
    const [along, part] = [solved(matrix, aim), solved(matrix, across)];
    if (!along || !part) return null;
    const dot = (x, y) => sum(x.map((entry, i) => entry.times(y[i])));
    const left = ONE.minus(dot(along, aim));
    const rest = gram(base, base).centre.minus(dot(part, across));
    if (left.sign < 0 || rest.sign <= 0) return null;
    const share = left.over(rest).rootAbove();
    const g = [...along.map((entry, i) => entry.minus(share.times(part[i])).rounded(1, 400)), share.rounded(1, 400)];
    const all = [...g.keys()];
    const columns = all.map((j) => ({
      centre: sum(all.map((i) => g[i].times(gram(i, j).centre))),
      off: sum(all.map((i) => g[i].magnitude().times(gram(i, j).off))),
    }));
    const square = sum(columns.map(({ centre, off }, j) => g[j].times(centre).plus(g[j].magnitude().times(off))));
    const norm = square.rootAbove();
    return norm.sign ? this.#enclosed(columns, ONE.over(norm), { [name]: ONE.negative() }) : null;
  }

  /* Means over the rise of outputs times Legendre's polynomials, and by how much an entry may be off. */
  outputMoments(name) {
    const moments = this.machines.get(name).moments(2 * this.laws.terms + 2).map((column) => column.map(middle));
    const off = moments.flat().map((entry) => entry.off).reduce(greatest);
    return { rows: moments[0].map((_, m) => moments.map((column) => column[m].centre)), off };
  }

  #known(values, sign = ONE) {
    return values && this.#row(values, sign);
  }

  #bound(name, sign) {
    const most = name.endsWith(" at most");
    const constant = name.slice(0, most ? -" at most".length : -" at least".length);
    const range = rangeOf(this.problem, constant);
    if (sign !== 1 || !this.names.includes(constant)) return null;
    if (this.relaxed && !most && !(constant in PEAKS) && !(constant in MEANS) && constant !== "D") return null;
    if (most) return range?.high ? this.#row(null, ONE, { [constant]: ONE }, range.high) : null;
    return range && range.low.sign > 0 ? this.#row(null, ONE, { [constant]: ONE.negative() }, range.low.negative()) : null;
  }

  #part(name) {
    const [, number, greatest] = /^part (\d+) of (.*)$/s.exec(name) ?? [];
    const term = this.maxima.find((maximum) => maximum.name === greatest);
    const part = term?.parts[Number(number) - 1];
    if (!part) return null;
    const names = { [greatest]: ONE.negative() };
    for (const [weight, inner] of part) names[inner.name] = (names[inner.name] ?? ZERO).plus(weight);
    return this.#balanced(this.#row(null, ONE, names), greatest);
  }

  #window(name, sign, k) {
    const [, number, mirrored, side] = /^window (\d+)( mirrored)?, (above|below)$/.exec(name) ?? [];
    const window = this.problem.windows?.[Number(number) - 1];
    if (window && !(window.quantity in ORDERS)) return this.#affine(name, sign, k);
    const part = window && this.#parts(window)[mirrored ? 1 : 0];
    if (!part || (side === "above") !== (sign > 0) || part.value) return null;
    const bound = sign > 0 ? part.high : part.low;
    if (bound === null || k.plus(NEAR).below(part.start) || part.stop.plus(NEAR).below(k)) return null;
    // what a function has beyond a break where the window ends says nothing of the window
    const last = this.laws.breaks.slice(1, -1).some((edge) => edge.same(part.stop)) ? part.stop.minus(BESIDE) : part.stop;
    const place = k.below(part.start) ? part.start : last.below(k) ? last : k;
    const s = whole(sign);
    return this.#row(this.laws.values(part.nu, place), s, {}, s.times(bound));
  }

  /* The side of a window of a formula that a row is of: the formula is at most `high` from start to stop. */
  formulaSide(name, sign) {
    const [, number, side] = /^window (\d+), (above|below)$/.exec(name) ?? [];
    const window = this.problem.windows?.[Number(number) - 1];
    if (!window || this.problem.symmetric || (side === "above") !== (sign > 0)) return null;
    const bound = side === "above" ? window.high : window.low;
    if (bound === null || bound === undefined) return null;
    const formula = formulaOf(window.quantity);
    const ends = { start: exact(window.start ?? 0), stop: exact(window.stop ?? 1) };
    return sign > 0 ? { formula, high: exact(bound), ...ends } : { formula: opposed(formula), high: exact(bound).negative(), ...ends };
  }

  /* The row of a window of a formula that is affine in the law. */
  #affine(name, sign, k) {
    const side = this.formulaSide(name, sign);
    const form = side && affineIn(side.formula);
    if (!form) throw new Unknown(`rows ${name}`);
    if (k.plus(NEAR).below(side.start) || side.stop.plus(NEAR).below(k)) return null;
    const place = k.below(side.start) ? side.start : side.stop.below(k) ? side.stop : k;
    return this.#row(this.#valuesOf(form, place), ONE, {}, side.high);
  }

  /* The row of a peak of a formula that is affine in the law. */
  #peak(name, sign, k) {
    const form = peakOf(name);
    if (!form) throw new Unknown(`rows ${name}`);
    const row = form.signs.includes(sign) ? this.#below(this.#valuesOf(form, k), whole(sign), name) : null;
    return row && this.#balanced(row, name);
  }

  /* A row of a variable that may be below 0: what rounding of multipliers leaves of it would take any amount. */
  #balanced(row, name) {
    return this.names.includes(name) && !neverNegative(this.problem, name) ? { ...row, loose: name } : row;
  }

  /* The values of a formula at a place, by the law's coordinates and a constant. */
  #valuesOf(form, place) {
    const total = Array(this.laws.terms + 1).fill(ZERO);
    total[this.laws.terms] = form.rest;
    for (const [each, factor] of Object.entries(form.factors)) {
      const values = this.laws.values(ORDERS[each], place);
      values.forEach((value, i) => { total[i] = total[i].plus(factor.times(value)); });
    }
    return total;
  }

  /* A window and, of symmetric laws, what the mirror image of its second half says of the first. */
  #parts(window) {
    const nu = ORDERS[window.quantity];
    const number = (value) => (value === null || value === undefined ? null : exact(value));
    const [low, high] = [number(window.low), number(window.high)];
    const [start, stop] = [exact(window.start ?? 0), exact(window.stop ?? 1)];
    const value = low !== null && high !== null && low.same(high) && start.same(stop);
    if (!this.problem.symmetric || !HALF.below(stop)) return [{ nu, low, high, start, stop, value }];
    const parts = start.below(HALF) ? [{ nu, low, high, start, stop: HALF, value }] : [];
    const about = (bound) => (bound === null ? null : whole(1 - nu / 2).minus(bound));
    const [mirroredLow, mirroredHigh] = nu % 2 === 0 ? [about(high), about(low)] : [low, high];
    const from = start.below(HALF) ? HALF : start;
    parts.push({ nu, low: mirroredLow, high: mirroredHigh, start: ONE.minus(stop), stop: ONE.minus(from), value });
    return parts;
  }

  /* The integral of the derivative times a polynomial on each piece, whose norm is at most 1: at most the norm. */
  #mean(name, direction) {
    const { laws } = this;
    const nu = MEANS[name];
    const pieces = laws.breaks.length - 1;
    const count = direction.length / pieces;
    if (!Number.isInteger(count) || count < 1) return null;
    const { nodes, weights } = gauss(count);
    const totals = Array(laws.terms + 1).fill(ZERO);
    const span = laws.breaks.at(-1).minus(laws.breaks[0]);
    let square = ZERO;
    laws.derivative(nu).forEach((part, i) => {
      const length = laws.breaks[i + 1].minus(laws.breaks[i]).over(span);
      const local = part.map((function_) => inPlace(function_, laws.breaks[i], laws.breaks[i + 1].minus(laws.breaks[i])));
      // the Legendre polynomials of a function that is the direction over the root of the weights at the nodes
      const values = nodes.map((_, m) => direction[i * count + (count - 1 - m)] / Math.sqrt(weights[m] * length.toNumber()));
      for (let degree = 0; degree < count; degree += 1) {
        const factor = (2 * degree + 1) * nodes.reduce((total, x, m) => total + weights[m] * values[m] * legendre(degree, x), 0);
        if (!Number.isFinite(factor) || factor === 0) continue;
        const coefficient = exact(factor).times(length);
        local.forEach((function_, j) => {
          totals[j] = totals[j].plus(coefficient.times(sum(function_.map((entry, power) => entry.times(legendreMoment(degree, power))))));
        });
        square = square.plus(exact(factor).times(exact(factor)).times(length).over(whole(2 * degree + 1)));
      }
    });
    const norm = greatest(square.rootAbove(), ONE);
    return this.#below(totals.map((total) => total.over(norm)), ONE, name);
  }

  #fromRest(name, sign, k) {
    const velocities = endVelocities(this.problem);
    if (!this.names.includes(ROOT) || !velocities) return null;
    const fromStart = name === "b / sqrt(2k)";
    if (!fromStart && name !== "b / sqrt(2 - 2k)") throw new Unknown(`rows ${name}`);
    if (fromStart ? velocities.start.sign : velocities.start.plus(velocities.change).sign) return null;
    if (!fromStart && this.problem.symmetric) return null;
    const way = (fromStart ? k : ONE.minus(k)).times(TWO);
    const values = this.laws.values(1, k);
    if (!values || way.sign <= 0) return null;
    const divisor = way.rootAbove();
    return this.#row(values.map((value) => value.over(divisor)), sign, { [ROOT]: ONE.negative() });
  }

  #tangent() {
    const names = { [ROOT]: this.tangent.times(TWO) };
    const square = this.tangent.times(this.tangent);
    if (this.names.includes("D")) return this.#row(null, ONE, { ...names, D: ONE.negative() }, square);
    const range = rangeOf(this.problem, "D");
    return range?.high ? this.#row(null, ONE, names, range.high.plus(square)) : null;
  }

  #equations() {
    const { problem, laws, velocity, peak } = this;
    const rows = [];
    const given = fixed(velocity) ? velocity.high : null;
    if (given && !problem.symmetric) rows.push(this.#row(null, ONE, { B: ONE }, given));
    if (peak) {
      const values = laws.values(1, peak);
      if (given && problem.symmetric) rows.push(this.#row(values, ONE, {}, given));
      else if (this.peakIsVariable) rows.push(this.#row(values, ONE, { B: ONE.negative() }));
      if (!problem.symmetric) rows.push(this.#row(laws.values(2, peak)));
    }
    for (const { nu, k, value } of laws.conditions) rows.push(this.#row(laws.values(nu, k), ONE, {}, value));
    for (const window of (problem.windows ?? []).filter(({ quantity }) => quantity in ORDERS)) {
      for (const part of this.#parts(window)) {
        if (part.value) rows.push(this.#row(laws.values(part.nu, part.start), ONE, {}, part.high));
      }
    }
    return rows;
  }
}

function legendre(degree, x) {
  let [before, value] = [1, x];
  if (degree === 0) return 1;
  for (let i = 1; i < degree; i += 1) [before, value] = [value, ((2 * i + 1) * x * value - i * before) / (i + 1)];
  return value;
}

/* Gauss's and Legendre's rule on [-1, 1] with weights that add up to 1, ascending; in doubles, for nothing rests on it. */
function gauss(count) {
  const nodes = [];
  const weights = [];
  for (let i = 0; i < count; i += 1) {
    let x = -Math.cos((Math.PI * (i + 0.75)) / (count + 0.5));
    let slope = 1;
    for (let step = 0; step < 50; step += 1) {
      slope = (count * (legendre(count - 1, x) - x * legendre(count, x))) / (1 - x * x);
      const change = legendre(count, x) / slope;
      x -= change;
      if (Math.abs(change) < 1e-16) break;
    }
    nodes.push(x);
    weights.push(1 / ((1 - x * x) * slope * slope));
  }
  return { nodes, weights };
}

export { MEANS, ORDERS, PEAKS, ROOT };

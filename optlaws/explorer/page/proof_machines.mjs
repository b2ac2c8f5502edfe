/* Machines x' = A x + B w, y = C x + D w that laws drive from rest: outputs, and what modes are left with, enclosed. */

import { NOTHING, above, around, ball, complex, inverse, magnitude, middle, minus, part, plus, root, times } from "./proof_balls.mjs";
import { ONE, Rational, TWO, Unknown, ZERO, exact, greatest, whole } from "./proof_numbers.mjs";
import { derivative } from "./proof_laws.mjs";

const NAME = /^(output_peak|output_rms|mode_residual)\(of='(\{.*?\})'((?:, \w+=(?:\([^()]*\)|[^,()]+))*)\)/;
const KNOWN = { output_peak: ["within"], output_rms: ["within"], mode_residual: ["mode", "spread"] };
const INPUTS = { a: 0, b: 1, c: 2 };
const NEAR = exact(1e-9);
/* A term this small, in units of 2^-640, ends a series. */
const SMALL = 1n << 40n;
const MOST_TERMS = 4000;
/* What of a Legendre series is left out of peaks, in the same units. */
const ENOUGH = 1n << 420n;

/* The text of a machine's constant at the beginning of a text; null where there is none. */
export function machineName(text) {
  return NAME.exec(text)?.[0] ?? null;
}

/* What the name of a constant of a machine says; null where this program does not know it. */
export function machineConstant(name) {
  const [text, kind, machine, words] = NAME.exec(name) ?? [];
  if (text !== name) return null;
  const said = Object.fromEntries([...words.matchAll(/, (\w+)=(\([^()]*\)|[^,()]+)/g)].map(([, key, value]) => [key, value]));
  if (Object.keys(said).some((key) => !KNOWN[kind].includes(key))) return null;
  const { A, B, C, D, inputs } = JSON.parse(machine);
  if (![...inputs].every((symbol) => symbol in INPUTS) || C.length !== 1 || A.length === 0) return null;
  const [start, stop] = (said.within ?? "(0, 1)").slice(1, -1).split(",").map((number) => exact(Number(number)));
  return {
    kind, inputs: [...inputs], start, stop, mode: Number(said.mode ?? 1), spread: exact(Number(said.spread ?? 0)),
    matrices: { A: A.map((row) => row.map(exact)), B: B.map((row) => row.map(exact)), C: C[0].map(exact), D: D[0].map(exact) },
  };
}

/* States in other units, powers of 2, so that no row of A is large without need; and the greatest sum of a row. */
function balanced({ A, B, C, D }) {
  const powers = A.map(() => 0);
  const size = (i, j) => Math.abs(A[i][j].toNumber()) * 2 ** (powers[j] - powers[i]);
  for (let round = 0; round < 20; round += 1) {
    powers.forEach((_, i) => {
      const others = [...powers.keys()].filter((j) => j !== i);
      const row = others.reduce((total, j) => total + size(i, j), 0);
      const column = others.reduce((total, j) => total + size(j, i), 0);
      if (row && column) powers[i] += Math.round(Math.log2(row / column) / 2);
    });
  }
  const scale = powers.map((power) => new Rational(1n, 1n, power));
  const scaled = A.map((row, i) => row.map((entry, j) => entry.times(scale[j]).over(scale[i])));
  const growth = scaled.map((row) => row.reduce((total, entry) => total.plus(entry.magnitude()), ZERO)).reduce(greatest);
  return { A: scaled, B: B.map((row, i) => row.map((entry) => entry.over(scale[i]))), C: C.map((entry, i) => entry.times(scale[i])), D, growth };
}

/* The output of a machine for each function of a space of laws, as power series in time: exact but for `rest`. */
export class Outputs {
  constructor(constant, laws) {
    this.constant = constant;
    this.machine = balanced(constant.matrices);
    const positions = laws.derivative(0)[0];
    this.drives = positions.map((position) => constant.inputs.map((symbol) => {
      let polynomial = position;
      for (let nu = 0; nu < INPUTS[symbol]; nu += 1) polynomial = derivative(polynomial);
      return polynomial;
    }));
    const still = this.machine.A.map(() => NOTHING);
    this.rise = this.drives.map((drive) => this.#series(drive, still, ONE));
    this.levels = positions.map((position) => position.reduce((total, entry) => total.plus(entry), ZERO));
  }

  /* The output driven by polynomials, from a state on over a length of time, and the state at its end. */
  #series(drive, state, length) {
    const { A, B, C, D, growth } = this.machine;
    const [rows, inputs, outputs] = [A.map((row) => row.map(ball)), B.map((row) => row.map(ball)), C.map(ball)];
    const direct = D.map(ball);
    const last = Math.max(...drive.map((polynomial) => polynomial.length));
    const enough = Math.ceil(growth.times(length).toNumber() * 2.001) + 1;
    const step = ball(length);
    const dot = (factors, values) => factors.reduce((total, factor, i) => plus(total, times(factor, values[i])), NOTHING);
    const terms = [];
    let [x, end, power] = [state, state, step];
    for (let n = 0; ; n += 1) {
      const w = drive.map((polynomial) => (n < polynomial.length ? ball(polynomial[n]) : NOTHING));
      terms.push(plus(dot(outputs, x), dot(direct, w)));
      x = rows.map((row, i) => part(plus(dot(row, x), dot(inputs[i], w)), BigInt(n + 1)));
      const now = x.map((entry) => times(entry, power));
      end = end.map((entry, i) => plus(entry, now[i]));
      power = times(power, step);
      const size = now.map(magnitude).reduce((first, second) => (first > second ? first : second));
      if (n >= last && n >= enough && size < SMALL) {
        // what follows is at most half of what is before it, from twice this size on
        const rest = around([0n, 2n * size]);
        const seen = outputs.map(magnitude).reduce((total, entry) => total + entry, 0n);
        return { terms, rest: times([0n, seen], rest), end: end.map((entry) => plus(entry, rest)) };
      }
      if (n > MOST_TERMS) throw new Unknown("the machine is too fast for a power series");
    }
  }

  /* What follows the rise, for a length of time. */
  dwell(length) {
    return this.rise.map(({ end }, i) => {
      const drive = this.constant.inputs.map((symbol) => (symbol === "a" ? [this.levels[i]] : []));
      return this.#series(drive, end, length);
    });
  }

  /* The outputs at a share of all the time; null where it does not count. */
  at(share) {
    const { start, stop } = this.constant;
    const given = share.times(stop);
    if (given.plus(NEAR).below(start)) return null;
    const time = given.below(start) ? start : given;
    if (!ONE.below(time)) return this.rise.map((series) => valueOf(series, time));
    const after = time.minus(ONE);
    return this.dwell(after).map((series) => valueOf(series, after));
  }

  /* Integrals over the rise of the outputs times Legendre's polynomials, a list for each output. */
  moments(count) {
    return momentsOf(this.rise, count);
  }

  /* Integrals over the rise of the products of outputs. */
  products() {
    const moments = this.moments(Infinity);
    const sizes = this.rise.map(({ terms, rest }) => terms.reduce((total, term) => total + magnitude(term), magnitude(rest)));
    return moments.map((first, i) => moments.map((second, j) => {
      if (j < i) return null;
      const total = first.reduce((value, entry, m) => (m < second.length ? plus(value, times(times(entry, second[m]), ball(whole(2 * m + 1)))) : value), NOTHING);
      const [one, other] = [magnitude(this.rise[i].rest), magnitude(this.rise[j].rest)];
      return plus(total, around(plus(times([0n, sizes[i]], [0n, other]), times([0n, one], [0n, sizes[j]]))));
    }));
  }
}

/* Integrals from 0 to 1 of power series times Legendre's polynomials, a list for each series. */
function momentsOf(several, count) {
  const longest = Math.max(...several.map(({ terms }) => terms.length));
  const totals = several.map(() => []);
  // the integral of P_m t^j, from that of P_(m-1)
  let weights = Array.from({ length: longest }, (_, j) => inverse(ball(whole(j + 1))));
  for (let m = 0; m < Math.min(count, longest); m += 1) {
    if (m) weights = weights.map((weight, j) => (j < m ? NOTHING : part(times(weight, ball(whole(j - m + 1))), BigInt(j + m + 1))));
    several.forEach(({ terms, rest }, i) => {
      totals[i].push(terms.reduce((total, term, j) => (j < m ? total : plus(total, times(term, weights[j]))), rest));
    });
  }
  return totals;
}

/* Polynomials of the share of each stretch of time, which the output of one law is but for `off`; or its mean square. */
export function outputOf(constant, position) {
  if (constant.kind === "mode_residual") throw new Unknown("how great the residual of a law is over a box");
  if (constant.start.sign || constant.stop.below(ONE)) throw new Unknown("an output that counts later");
  const outputs = new Outputs(constant, { derivative: () => [[position]] });
  const after = constant.stop.minus(ONE);
  if (constant.kind === "output_rms") {
    if (after.sign) throw new Unknown("means beyond the rise");
    return { size: root(outputs.products()[0][0]) };
  }
  const stretches = [outputs.rise[0]];
  if (after.sign) {
    const [{ terms, rest }] = outputs.dwell(after);
    let power = ONE;
    const scaled = terms.map((term) => {
      const value = times(term, ball(power));
      power = power.times(after);
      return value;
    });
    stretches.push({ terms: scaled, rest });
  }
  const short = stretches.map(shortened);
  return { polynomials: short.map(({ polynomial }) => polynomial), off: short.map(({ off }) => off).reduce(greatest) };
}

/* A polynomial of low degree that a power series is from 0 to 1 but for `off`: its Legendre series, cut. */
function shortened(series) {
  const parts = momentsOf([series], Infinity)[0].map((moment, m) => times(moment, ball(whole(2 * m + 1))));
  let off = magnitude(series.rest);
  let count = parts.length;
  while (count > 1 && magnitude(parts[count - 1]) < ENOUGH) {
    count -= 1;
    off += magnitude(parts[count]);
  }
  let left = above([0n, off]);
  let polynomial = [];
  parts.slice(0, count).forEach((entry, m) => {
    const { centre, off: rounding } = middle(entry);
    left = left.plus(rounding);
    let coefficient = whole(m % 2 ? -1 : 1);
    for (let j = 0; j <= m; j += 1) {
      polynomial[j] = (polynomial[j] ?? ZERO).plus(centre.times(coefficient));
      coefficient = coefficient.times(whole(-(m - j) * (m + j + 1))).over(whole((j + 1) * (j + 1)));
    }
  });
  return { polynomial, off: left };
}

function valueOf({ terms, rest }, time) {
  const at = ball(time);
  return plus(terms.reduceRight((value, term) => plus(times(value, at), term), NOTHING), rest);
}

/* The characteristic polynomial of A, lowest power first, and the matrices M_i with adj(s - A) = sum of M_i s^i. */
function faddeev(A) {
  const size = A.length;
  const product = (X, Y) => X.map((row) => Y[0].map((_, j) => row.reduce((total, entry, i) => total.plus(entry.times(Y[i][j])), ZERO)));
  const coefficients = Array(size + 1).fill(ONE);
  const matrices = [];
  let M = A.map((row, i) => row.map((_, j) => (i === j ? ONE : ZERO)));
  for (let i = 1; i <= size; i += 1) {
    matrices[size - i] = M;
    const AM = product(A, M);
    const trace = AM.reduce((total, row, j) => total.plus(row[j]), ZERO);
    const coefficient = trace.over(whole(i)).negative();
    coefficients[size - i] = coefficient;
    M = AM.map((row, j) => row.map((entry, k) => (j === k ? entry.plus(coefficient) : entry)));
  }
  return { coefficients, matrices };
}

function atComplex(polynomial, s) {
  return polynomial.reduceRight((value, entry) => complex.plus(complex.times(value, s), complex.of(ball(entry))), complex.of(NOTHING));
}

/* All roots of a polynomial, each in a square of its own; null where they cannot be told apart. */
function rootsOf(polynomial) {
  const size = polynomial.length - 1;
  const slope = derivative(polynomial);
  const found = approximateRoots(polynomial.map((entry) => entry.toNumber())).map((start) => {
    let s = start.map((entry) => ball(exact(entry)));
    for (let round = 0; round < 9; round += 1) {
      const step = complex.over(atComplex(polynomial, s), atComplex(slope, s));
      s = s.map((entry, i) => {
        const { centre } = middle(minus(entry, step[i]));
        return round < 7 ? ball(centre) : fine(minus(entry, step[i]));
      });
    }
    // within so many times |p / p'| there is a root
    const step = complex.over(atComplex(polynomial, s), atComplex(slope, s));
    const radius = times(root(complex.square(step)), ball(whole(size)));
    return s.map((entry) => plus(entry, around(radius)));
  });
  const apart = (x, y) => x.some(([low, high], i) => high < y[i][0] || y[i][1] < low);
  return found.every((x, i) => found.every((y, j) => j <= i || apart(x, y))) ? found : null;
}

function fine([low, high]) {
  const centre = (low + high) >> 1n;
  return [centre, centre];
}

/* Durand and Kerner's iteration, in doubles. */
function approximateRoots(coefficients) {
  const size = coefficients.length - 1;
  const reach = Math.max(...coefficients.slice(0, -1).map((entry, i) => Math.abs(entry) ** (1 / (size - i))), 1e-300);
  const roots = Array.from({ length: size }, (_, i) => [reach * Math.cos((2 * Math.PI * i) / size + 0.4), reach * Math.sin((2 * Math.PI * i) / size + 0.4)]);
  const product = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
  for (let round = 0; round < 500; round += 1) {
    roots.forEach((at, i) => {
      const value = coefficients.reduceRight((total, entry) => {
        const [x, y] = product(total, at);
        return [x + entry, y];
      }, [0, 0]);
      const [c, d] = roots.reduce((total, other, j) => (j === i ? total : product(total, [at[0] - other[0], at[1] - other[1]])), [1, 0]);
      const square = c * c + d * d || 1;
      roots[i] = [at[0] - (value[0] * c + value[1] * d) / square, at[1] - (value[1] * c - value[0] * d) / square];
    });
  }
  return roots;
}

/* The amplitude that laws leave a mode with, at shares of the box of its frequency. */
export class Mode {
  constructor(constant, laws) {
    this.constant = constant;
    const { A, B, C } = constant.matrices;
    const { coefficients, matrices } = faddeev(A);
    const roots = rootsOf(coefficients);
    const upper = roots?.filter(([, imaginary]) => imaginary[0] > 0n).map((s) => ({ s, size: root(complex.square(s)) }));
    // decays that rounding has split are no vibrations, and modes of one frequency cannot be told apart
    const clear = upper?.every(({ s, size }) => times(size, ball(exact(1e-6)))[1] < s[1][0]);
    const sorted = upper?.sort((x, y) => (x.size[0] < y.size[0] ? -1 : 1));
    const told = clear && sorted.every(({ size }, i) => i === 0 || times(sorted[i - 1].size, ball(exact(1 + 2e-6)))[1] < size[0]);
    const mode = told ? sorted[constant.mode - 1] : undefined;
    if (!mode) throw new Unknown(`mode ${constant.mode} cannot be told from others`);
    this.root = mode.s;
    let amplitude = complex.of(NOTHING);
    constant.inputs.forEach((symbol, column) => {
      const numerator = matrices.map((M) => M.reduce((total, row, i) => total.plus(C[i].times(row.reduce((value, entry, j) => value.plus(entry.times(B[j][column])), ZERO))), ZERO));
      let share = complex.over(atComplex(numerator, mode.s), atComplex(derivative(coefficients), mode.s));
      if (symbol === "a") share = complex.over(share, mode.s);
      if (symbol === "c") share = complex.times(share, mode.s);
      amplitude = complex.plus(amplitude, share);
    });
    this.share = times(root(complex.square(amplitude)), ball(TWO));
    this.velocities = laws.derivative(1)[0];
    this.known = new Map();
  }

  /* The complex amplitude of every function. */
  at(share) {
    const key = share.toNumber();
    if (!this.known.has(key)) this.known.set(key, this.#amplitudes(share));
    return this.known.get(key);
  }

  #amplitudes(share) {
    const { spread } = this.constant;
    const factor = ball(ONE.minus(spread).plus(TWO.times(spread).times(share)));
    const s = complex.scaled(this.root, factor);
    const most = Math.max(...this.velocities.map((polynomial) => polynomial.length));
    const integrals = exponentialIntegrals(s, most);
    return this.velocities.map((polynomial) => {
      const total = polynomial.reduce((value, entry, n) => complex.plus(value, complex.scaled(integrals[n], ball(entry))), complex.of(NOTHING));
      return complex.scaled(total, this.share);
    });
  }
}

/* Integrals of exp(s (1 - k)) k^n from 0 to 1: s I_(n+1) = (n + 1) I_n - 1, backwards. */
function exponentialIntegrals(s, count) {
  const size = above(root(complex.square(s))).toNumber();
  let [last, digits] = [count, 0];
  while (digits < 680 && last < MOST_TERMS) {
    last += 1;
    digits += Math.log2(last / size);
  }
  const growth = s[0][1] > 0n ? 3 ** Math.ceil(above(s[0]).toNumber()) : 1;
  const any = around([0n, ball(exact(growth))[1]]);
  let value = complex.of(any, any);
  const integrals = [];
  for (let n = last - 1; n >= 0; n -= 1) {
    value = complex.part(complex.plus(complex.of(ball(ONE)), complex.times(s, value)), BigInt(n + 1));
    if (n < count) integrals[n] = value;
  }
  return integrals;
}

/* Intervals of whole multiples of 2^-BITS, every rounding outward, and complex numbers of them. */

import { Rational, Unknown, rootOf } from "./proof_numbers.mjs";

const BITS = 640n;
const UNIT = 1n << BITS;
/* Multiples of 2^-MIDDLE stand for intervals in sums that are exact. */
const MIDDLE = 320;

export const NOTHING = [0n, 0n];

function up(n) {
  return -(-n >> BITS);
}

export function ball(number) {
  const low = number.floorIn(Number(BITS));
  return [low, -number.negative().floorIn(Number(BITS))];
}

export function plus([a, b], [c, d]) {
  return [a + c, b + d];
}

export function minus([a, b], [c, d]) {
  return [a - d, b - c];
}

export function times([a, b], [c, d]) {
  if (a >= 0n && c >= 0n) return [(a * c) >> BITS, up(b * d)];
  const products = [a * c, a * d, b * c, b * d];
  return [least(products) >> BITS, up(most(products))];
}

/* Divided by a whole number above 0. */
export function part([a, b], count) {
  return [floored(a, count), -floored(-b, count)];
}

/* 1 over an interval above 0. */
export function inverse([a, b]) {
  if (a <= 0n) throw new Unknown("division by what may be zero");
  return [(UNIT * UNIT) / b, (UNIT * UNIT) / a + 1n];
}

/* Between an interval and its opposite. */
export function around([a, b]) {
  const size = magnitude([a, b]);
  return [-size, size];
}

export function magnitude([a, b]) {
  return -a > b ? -a : b;
}

export function root([a, b]) {
  const low = a > 0n ? rootOf(a << BITS) : 0n;
  return [low, rootOf(b << BITS) + 1n];
}

export function above([, b]) {
  return new Rational(b, 1n, -Number(BITS));
}

export function below([a]) {
  return new Rational(a, 1n, -Number(BITS));
}

/* A number of few bits in the middle, and by how much the interval may be off it. */
export function middle([a, b]) {
  const centre = new Rational((a + b) >> (BITS + 1n - BigInt(MIDDLE)), 1n, -MIDDLE);
  const [low, high] = [centre.minus(below([a])), above([a, b]).minus(centre)];
  return { centre, off: low.below(high) ? high : low };
}

/* Complex numbers are pairs of intervals. */
export const complex = {
  of: (real, imaginary = NOTHING) => [real, imaginary],
  plus: (x, y) => [plus(x[0], y[0]), plus(x[1], y[1])],
  times: (x, y) => [minus(times(x[0], y[0]), times(x[1], y[1])), plus(times(x[0], y[1]), times(x[1], y[0]))],
  scaled: (x, y) => [times(x[0], y), times(x[1], y)],
  part: (x, count) => [part(x[0], count), part(x[1], count)],
  square: (x) => plus(squared(x[0]), squared(x[1])),
  over: (x, y) => {
    const size = inverse(complex.square(y));
    const conjugate = [y[0], [-y[1][1], -y[1][0]]];
    return complex.scaled(complex.times(x, conjugate), size);
  },
};

function squared([a, b]) {
  if (a >= 0n) return times([a, b], [a, b]);
  if (b <= 0n) return times([-b, -a], [-b, -a]);
  const size = magnitude([a, b]);
  return [0n, up(size * size)];
}

function least(numbers) {
  return numbers.reduce((first, second) => (second < first ? second : first));
}

function most(numbers) {
  return numbers.reduce((first, second) => (second > first ? second : first));
}

function floored(n, count) {
  const quotient = n / count;
  return n < 0n && quotient * count !== n ? quotient - 1n : quotient;
}

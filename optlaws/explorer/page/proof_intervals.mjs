/* Intervals of numbers of few bits, every rounding outward: pairs of a low and a high end. */

import { ONE, TWO, Unknown, ZERO, greatest, least, quotientRounded, whole } from "./proof_numbers.mjs";

export const BITS = 192;
export const NOTHING = [ZERO, ZERO];

export function interval(low, high = low) {
  return [low.rounded(-1, BITS), high.rounded(1, BITS)];
}

export function added(first, second) {
  return interval(first[0].plus(second[0]), first[1].plus(second[1]));
}

export function product(first, second) {
  const ends = first.flatMap((x) => second.map((y) => x.times(y)));
  return interval(ends.reduce(least), ends.reduce(greatest));
}

export function negative([low, high]) {
  return [high.negative(), low.negative()];
}

export function ratio(first, second) {
  return [quotientRounded(first, second, -1, BITS), quotientRounded(first, second, 1, BITS)];
}

/* 1 over an interval without 0. */
export function inverse([low, high]) {
  if (low.sign <= 0 && high.sign >= 0) throw new Unknown("division by what may be zero");
  return [quotientRounded(ONE, high, -1, BITS), quotientRounded(ONE, low, 1, BITS)];
}

/* The root of a number with its sign, rounded to a side. */
export function signedRoot(square, side) {
  const away = square.magnitude().rootAbove();
  const towards = away.sign ? quotientRounded(square.magnitude().rounded(-1, 2 * BITS), away, -1, BITS) : ZERO;
  const root = (square.sign >= 0) === side > 0 ? away : towards;
  return (square.sign < 0 ? root.negative() : root).rounded(side, BITS);
}

/* The square of an interval, which is nowhere below 0. */
function squared(x) {
  const [low, high] = product(x, x);
  return x[0].sign < 0 && x[1].sign > 0 ? [ZERO, high] : [greatest(low, ZERO), high];
}

/* The power of a whole number or a half of one; of an interval above 0 unless the exponent is whole and not below 0. */
export function power(x, exponent) {
  if (exponent < 0) return inverse(power(x, -exponent));
  if (!Number.isInteger(exponent)) {
    if (!Number.isInteger(2 * exponent) || x[0].sign < 0) throw new Unknown(`the power ${exponent}`);
    return power([signedRoot(x[0], -1), signedRoot(x[1], 1)], 2 * exponent);
  }
  if (exponent > 64) throw new Unknown(`the power ${exponent}`);
  if (exponent === 0) return interval(ONE);
  const half = power(x, Math.floor(exponent / 2));
  const even = squared(half);
  return exponent % 2 ? product(even, x) : even;
}

/* Terms of a sine and a cosine, whose sum is off by no more than the next one: angles are halved until they are small. */
const TERMS = 24;

/* Sine and cosine of a point, each an interval. */
function circular(angle) {
  let small = angle;
  let doublings = 0;
  while (ONE.below(small.magnitude().times(whole(4)))) {
    small = small.over(TWO);
    doublings += 1;
    if (doublings > 32) throw new Unknown("so large an angle");
  }
  const x = interval(small);
  const series = (first, from) => {
    let [term, total] = [first, first];
    for (let i = from; i < from + 2 * TERMS; i += 2) {
      term = negative(product(product(term, product(x, x)), ratio(ONE, whole((i + 1) * (i + 2)))));
      total = added(total, term);
    }
    const off = term[0].magnitude().below(term[1].magnitude()) ? term[1].magnitude() : term[0].magnitude();
    return added(total, [off.negative(), off]);
  };
  let [sine, cosine] = [series(x, 1), series(interval(ONE), 0)];
  for (let i = 0; i < doublings; i += 1) {
    const both = product(sine, cosine);
    [sine, cosine] = [added(both, both), added(squared(cosine), negative(squared(sine)))];
  }
  return { sine, cosine };
}

/* Sine and cosine over an interval: those of its middle, from which no angle of it is further than half its width. */
export function circularOver([low, high]) {
  const middle = low.plus(high).over(TWO);
  const reach = high.minus(low).over(TWO);
  const there = circular(middle);
  const away = (value, slope) => {
    const steep = least(greatest(slope[0].magnitude(), slope[1].magnitude()).plus(reach), ONE).times(reach);
    const [from, to] = added(value, [steep.negative(), steep]);
    return [greatest(from, ONE.negative()), least(to, ONE)];
  };
  return { sine: away(there.sine, there.cosine), cosine: away(there.cosine, there.sine) };
}


/* Limits of C and D over laws of any degree from rest to rest, by their closed forms, rounded down. */

import { HALF, ONE, Rational, TWO, ZERO, exact, greatest, quotientRounded, whole } from "./proof_numbers.mjs";
import { fixed, leavesOf, neverNegative, rangeOf } from "./proof_rows.mjs";

const THREE_HALVES = exact(1.5);

/* What the objective is at least in every law with an acceleration, whatever its degree; null where nothing is known. */
export function limitOf(problem, objective) {
  if (problem.start || problem.end || problem.order < 2) return null;
  const velocity = rangeOf(problem, "B");
  const free = !velocity?.high || !ONE.below(velocity.high) || (problem.inflexion ?? null) !== null;
  // of all lower velocities the greatest one has the lowest limit, up to that of the least of all
  const most = (best) => (free || (!fixed(velocity) && best.below(velocity.high)) ? null : velocity.high);
  const least = { C: () => accelerationLimit(most(TWO), problem.monotone), D: () => powerLimit(most(THREE_HALVES), problem.monotone) };
  if (leavesOf(objective).some((name) => !neverNegative(problem, name))) return null;
  const total = (terms) => terms.reduce((value, [weight, term]) => {
    if (term.parts) return value.plus(weight.times(term.parts.map(total).reduce(greatest)));
    return term.name in least ? value.plus(weight.times(least[term.name]())) : value;
  }, ZERO);
  const value = total(objective);
  return value.sign > 0 ? value : null;
}

/* B² / (B - 1) up to B = 2; then B² of laws that never turn back, and 2 (B - 2 + root((B - 2)² + B²)) of others. */
function accelerationLimit(B, monotone) {
  if (!B) return whole(4);
  const square = B.times(B);
  if (!TWO.below(B)) return square.over(B.minus(ONE));
  if (monotone) return square;
  const back = B.minus(TWO);
  const sum = back.times(back).plus(square);
  const root = quotientRounded(sum, sum.rootAbove(), -1, 160);
  return back.plus(root).times(TWO);
}

/* B³ / (3 (B - 1)) up to B = 3/2; then 2 B³ / 3 of laws that never turn back, and B² + 2 u², 2 u³ + 3 u² = B² (B - 3/2). */
function powerLimit(B, monotone) {
  if (!B) return new Rational(9n, 1n, -2);
  if (!THREE_HALVES.below(B)) return B.power(3).over(whole(3).times(B.minus(ONE)));
  if (monotone) return B.power(3).times(TWO).over(whole(3));
  const most = B.times(B).times(B.minus(THREE_HALVES));
  let [low, high] = [ZERO, B];
  for (let step = 0; step < 100; step += 1) {
    const u = low.plus(high).times(HALF);
    const value = u.times(u).times(u.times(TWO).plus(whole(3)));
    if (most.below(value)) high = u;
    else low = u;
  }
  return B.times(B).plus(low.times(low).times(TWO));
}

/* Exact numbers: rationals n / d * 2^e of BigInt, d odd. Doubles are such numbers, and stay exact. */

/* What this program does not know, so that nothing is checked. */
export class Unknown extends Error {}

const WORD = 64n;
const MASK = (1n << WORD) - 1n;

export class Rational {
  constructor(n, d = 1n, e = 0) {
    if (n === 0n) {
      this.n = 0n;
      this.d = 1n;
      this.e = 0;
      return;
    }
    while ((n & MASK) === 0n) {
      n >>= WORD;
      e += Number(WORD);
    }
    if (d !== 1n) {
      const common = greatestDivisor(n < 0n ? -n : n, d);
      if (common !== 1n) {
        n /= common;
        d /= common;
      }
    }
    this.n = n;
    this.d = d;
    this.e = e;
  }

  plus(other) {
    if (this.n === 0n) return other;
    if (other.n === 0n) return this;
    const e = Math.min(this.e, other.e);
    const first = this.n << BigInt(this.e - e);
    const second = other.n << BigInt(other.e - e);
    if (this.d === other.d) return new Rational(first + second, this.d, e);
    return new Rational(first * other.d + second * this.d, this.d * other.d, e);
  }

  minus(other) {
    return this.plus(other.negative());
  }

  times(other) {
    return new Rational(this.n * other.n, this.d * other.d, this.e + other.e);
  }

  over(other) {
    if (other.n === 0n) throw new RangeError("division by zero");
    let odd = other.n < 0n ? -other.n : other.n;
    let twos = 0;
    while ((odd & 1n) === 0n) {
      odd >>= 1n;
      twos += 1;
    }
    const n = this.n * other.d;
    return new Rational(other.n < 0n ? -n : n, this.d * odd, this.e - other.e - twos);
  }

  negative() {
    return new Rational(-this.n, this.d, this.e);
  }

  magnitude() {
    return this.n < 0n ? this.negative() : this;
  }

  power(exponent) {
    let product = ONE;
    for (let i = 0; i < exponent; i += 1) product = product.times(this);
    return product;
  }

  get sign() {
    return this.n > 0n ? 1 : this.n < 0n ? -1 : 0;
  }

  compare(other) {
    return this.minus(other).sign;
  }

  below(other) {
    return this.compare(other) < 0;
  }

  same(other) {
    return this.compare(other) === 0;
  }

  /* The greatest whole number of units 2^-bits that is not above it. */
  floorIn(bits) {
    const shift = this.e + bits;
    const n = shift >= 0 ? this.n << BigInt(shift) : this.n;
    const d = shift >= 0 ? this.d : this.d << BigInt(-shift);
    const quotient = n / d;
    return n < 0n && quotient * d !== n ? quotient - 1n : quotient;
  }

  /* A number of so many significant bits that is not above (side -1) or not below it (side 1). */
  rounded(side, bits = 160) {
    if (this.n === 0n) return this;
    const unit = bits - (bitLength(this.n < 0n ? -this.n : this.n) - bitLength(this.d) + this.e);
    const low = this.floorIn(unit);
    const exact = new Rational(low, 1n, -unit).same(this);
    return new Rational(side > 0 && !exact ? low + 1n : low, 1n, -unit);
  }

  /* A rational that is not below the root, by a relative 2^-150 at most. */
  rootAbove() {
    if (this.n <= 0n) return ZERO;
    const bits = 2 * Math.ceil((320 - bitLength(this.n) + bitLength(this.d) - this.e) / 2);
    return new Rational(rootOf(this.floorIn(bits) + 1n) + 1n, 1n, -bits / 2);
  }

  /* The double next to it. */
  toNumber() {
    if (this.n === 0n) return 0;
    const near = this.rounded(-1, 64);
    const shift = bitLength(near.n < 0n ? -near.n : near.n) - 53;
    const whole = shift > 0 ? near.n >> BigInt(shift) : near.n;
    const e = near.e + Math.max(shift, 0);
    return e < -1000 ? Number(whole) * 2 ** (e + 500) * 2 ** -500 : Number(whole) * 2 ** e;
  }
}

export const ZERO = new Rational(0n);
export const ONE = new Rational(1n);
export const TWO = new Rational(2n);
export const HALF = new Rational(1n, 1n, -1);

export function whole(number) {
  return new Rational(BigInt(number));
}

/* The rational that a double is. */
export function exact(number) {
  if (typeof number !== "number" || !Number.isFinite(number)) throw new TypeError(`a finite number is needed, not ${number}`);
  if (Number.isInteger(number)) return new Rational(BigInt(number));
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, number);
  const bits = view.getBigUint64(0);
  const exponent = Number((bits >> 52n) & 0x7ffn);
  const fraction = bits & ((1n << 52n) - 1n);
  const n = exponent ? fraction | (1n << 52n) : fraction;
  return new Rational(bits >> 63n ? -n : n, 1n, Math.max(exponent, 1) - 1075);
}

export function sum(numbers) {
  return numbers.reduce((total, number) => total.plus(number), ZERO);
}

export function least(first, second) {
  return second.below(first) ? second : first;
}

export function greatest(first, second) {
  return first.below(second) ? second : first;
}

/* x with matrix x = right, of whole numbers: numerators over one divisor; null where the matrix is singular. */
export function solvedWhole(matrix, right) {
  const rows = matrix.map((row, i) => [...row, right[i]]);
  const size = rows.length;
  let divisor = 1n;
  for (let column = 0; column < size; column += 1) {
    const pivot = rows.findIndex((row, i) => i >= column && row[column] !== 0n);
    if (pivot < 0) return null;
    if (pivot !== column) [rows[column], rows[pivot]] = [rows[pivot], rows[column].map((entry) => -entry)];
    const head = rows[column];
    for (let i = column + 1; i < size; i += 1) {
      const factor = rows[i][column];
      for (let j = column; j <= size; j += 1) rows[i][j] = (rows[i][j] * head[column] - factor * head[j]) / divisor;
    }
    divisor = head[column];
  }
  const numerators = Array(size).fill(0n);
  for (let i = size - 1; i >= 0; i -= 1) {
    let rest = rows[i][size] * divisor;
    for (let j = i + 1; j < size; j += 1) rest -= rows[i][j] * numerators[j];
    numerators[i] = rest / rows[i][i];
  }
  return { numerators, divisor };
}

/* The same of rationals. */
export function solved(matrix, right) {
  const rows = matrix.map((row, i) => wholeRow([...row, right[i]]));
  const solution = solvedWhole(rows.map((row) => row.slice(0, -1)), rows.map((row) => row.at(-1)));
  return solution && solution.numerators.map((numerator) => new Rational(numerator).over(new Rational(solution.divisor)));
}

/* Numbers times the least power of 2 and of the odd number that makes all of them whole, and that factor. */
export function wholeNumbers(numbers) {
  const e = Math.min(0, ...numbers.map((number) => number.e));
  let common = 1n;
  for (const { d } of numbers) common *= d / greatestDivisor(common, d);
  return { whole: numbers.map(({ n, d, e: own }) => (n << BigInt(own - e)) * (common / d)), factor: new Rational(common, 1n, -e) };
}

/* A quotient of numbers whose d is 1, rounded to a side, to so many significant bits. */
export function quotientRounded(first, second, side, bits) {
  if (first.n === 0n) return ZERO;
  const [n, d] = second.n < 0n ? [-first.n, -second.n] : [first.n, second.n];
  const shift = bits - bitLength(absolute(n)) + bitLength(d);
  const top = shift >= 0 ? n << BigInt(shift) : n;
  const bottom = shift >= 0 ? d : d << BigInt(-shift);
  let low = top / bottom;
  if (low * bottom > top) low -= 1n;
  return new Rational(side > 0 && low * bottom !== top ? low + 1n : low, 1n, first.e - second.e - shift);
}

function wholeRow(row) {
  return wholeNumbers(row).whole;
}

function greatestDivisor(a, b) {
  while (b) [a, b] = [b, a % b];
  return a;
}

function absolute(n) {
  return n < 0n ? -n : n;
}

function bitLength(n) {
  return n.toString(16).length * 4;
}

/* The greatest whole number whose square is not above n. */
export function rootOf(n) {
  if (n < 2n) return n;
  let guess = 1n << BigInt((bitLength(n) + 1) >> 1);
  for (;;) {
    const next = (guess + n / guess) >> 1n;
    if (next >= guess) return guess;
    guess = next;
  }
}

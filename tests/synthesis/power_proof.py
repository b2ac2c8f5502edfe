"""A power certificate checked from its JSON alone, in rational arithmetic, without a line of the package.

Laws are S_l plus derivatives of k^l (k-1)^l T_i(2k-1), i odd. Known are symmetric problems with C and D in the
objective, with B fixed or free. Roots are rounded to the safe side, and so are the sides of boxes.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import isqrt
from typing import Any

Polynomial = list[Fraction]
Row = list[Fraction]

HALF = Fraction(1, 2)
PLACES = 2**90


def proven_exactly(data: Mapping[str, Any]) -> bool:
    """Whether the steps empty the box of all laws with an objective below the claim."""
    proof = Proof(data)
    boxes = [proof.root()]
    for step in data["steps"]:
        if not boxes:
            return False
        low, high = boxes.pop()
        i = step["variable"]
        if "at" in step:
            at = Fraction(step["at"])
            boxes += [([*low[:i], at, *low[i + 1 :]], high), (low, [*high[:i], at, *high[i + 1 :]])]
            continue
        least = proof.least(step, low, high)
        if i < 0:
            boxes += [] if least > 0 else [(low, high)]
        elif step["side"] > 0:
            moved = [*low[:i], max(low[i], down(least)), *low[i + 1 :]]
            boxes += [(moved, high)] if moved[i] <= high[i] else []
        else:
            moved = [*high[:i], min(high[i], -down(least)), *high[i + 1 :]]
            boxes += [(low, moved)] if low[i] <= moved[i] else []
    return not boxes


class Proof:
    """The rows of a proof over the velocities at its points and the constants of its objective."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        problem = data["problem"]
        assert problem["symmetric"]
        assert not problem["monotone"]
        self.B = Fraction(problem["B"]) if "B" in problem else None
        self.weights = {name: Fraction(float(weight)) for weight, name in terms(problem["minimise"])}
        assert set(self.weights) <= {"C", "D"}
        self.claim = Fraction(data["claim"])
        self.D = self.claim / self.weights["D"]
        self.names = list(self.weights)
        l = problem["order"]
        edge = power([Fraction(0), Fraction(-1), Fraction(1)], l)
        whole = integral(power([Fraction(0), Fraction(-1), Fraction(1)], l - 1))
        base = [one / value(whole, Fraction(1)) for one in power([Fraction(0), Fraction(-1), Fraction(1)], l - 1)]
        free = [derivative(product(edge, chebyshev(i))) for i in range(1, problem["degree"] + 1, 2)]
        self.points = [Fraction(k) for k in data["points"]]
        assert len(self.points) == len(free)
        rows = [[value(f, k) for f in free] + [value(base, k)] for k in self.points]
        # the velocity is the sum over the points of the velocity there times a polynomial, plus one more
        self.parts = combined([*free, base], inverse(rows))

    def root(self) -> tuple[list[Fraction], list[Fraction]]:
        brackets = [self.outer(k) for k in self.points]
        constants = [self.claim / self.weights[name] for name in self.names]
        return [low for low, _ in brackets] + [Fraction(0)] * len(constants), [high for _, high in brackets] + constants

    def outer(self, k: Fraction) -> tuple[Fraction, Fraction]:
        known = [(Fraction(0), Fraction(0), Fraction(0)), (Fraction(1), Fraction(0), Fraction(0))]
        return self.bracketed(k, known + ([(HALF, self.B, self.B)] if self.B is not None else []))

    def bracketed(self, k: Fraction, known: Sequence[tuple[Fraction, Fraction, Fraction]]) -> tuple[Fraction, Fraction]:
        lows = [signed_root(low * abs(low) - 2 * self.D * abs(k - at)) for at, low, _ in known]
        highs = [-signed_root(-high * abs(high) - 2 * self.D * abs(k - at)) for at, _, high in known]
        return max(lows), min(highs + ([self.B] if self.B is not None else []))

    def row(self, k: Fraction, order: int) -> Row:
        """Velocity or its derivative at k over the variables, the constant last."""
        found = [value(derivative(part) if order == 2 else part, k) for part in self.parts]
        return [*found[:-1], *[Fraction(0)] * len(self.names), found[-1]]

    def velocity(self, k: Fraction, low: Sequence[Fraction], high: Sequence[Fraction]) -> tuple[Fraction, Fraction]:
        """Its least and its greatest value in a box."""
        row = self.row(k, 1)
        known = [*zip(self.points, low, high, strict=False)]
        outer, inner = self.outer(k), self.bracketed(k, known)
        box = extent(row, low, high), -extent([-one for one in row], low, high)
        return max(outer[0], inner[0], box[0]), min(outer[1], inner[1], box[1])

    def contact(self, one: Mapping[str, Any], low: Sequence[Fraction], high: Sequence[Fraction]) -> Row:
        """Its row, at most 0 for every law in the box."""
        k, s, name = Fraction(one["k"]), Fraction(one["sign"]), one["constraint"]
        if name == "chord":
            # b(k) <= b(1/2) over (1-2k)²
            assert self.B is not None
            assert k != HALF
            return [(x - y) / (1 - 2 * k) ** 2 for x, y in zip(self.row(k, 1), self.row(HALF, 1), strict=True)]
        found = [s * x for x in self.row(k, 2)]
        if name == "C":
            found[len(self.points) + self.names.index("C")] -= 1
            return found
        assert name in {"power", "power, from the least D"}
        least, greatest = self.velocity(k, low, high)
        forth = 1 if least > 0 else -1
        near, far = (down(least), -down(-greatest)) if forth > 0 else (down(-greatest), -down(least))
        assert near > 0
        place = len(self.points) + self.names.index("D")
        # D / b <= D (1/near + 1/far - b / (near far)), and the product of D and the bracket by its envelope
        D, other = (low[place], near) if name != "power" else (high[place], far)
        found = [x + D * forth / (near * far) * y for x, y in zip(found, self.row(k, 1), strict=True)]
        found[place] -= 1 / other
        found[-1] += D / other - D / near - D / far
        return found

    def least(self, step: Mapping[str, Any], low: Sequence[Fraction], high: Sequence[Fraction]) -> Fraction:
        """What the side moved by a step is at least, times its sign."""
        total = [Fraction(0)] * (len(low) + 1)
        if step["variable"] >= 0:
            total[step["variable"]] = Fraction(step["side"])
        parts = [(Fraction(max(one["multiplier"], 0.0)), self.contact(one, low, high)) for one in step["contacts"]]
        objective = [Fraction(0)] * len(self.points) + [self.weights[name] for name in self.names]
        parts.append((Fraction(max(step["claim"], 0.0)), [*objective, -self.claim]))
        if self.B is not None:
            middle = self.row(HALF, 1)
            parts += [(Fraction(weight), [*middle[:-1], middle[-1] - self.B]) for weight in step["equations"]]
        for weight, row in parts:
            total = [x + weight * y for x, y in zip(total, row, strict=True)]
        return extent(total, low, high)


def terms(text: str) -> Iterator[tuple[str, str]]:
    """Weights and names of a sum."""
    for part in text.split(" + "):
        weight, _, name = part.rpartition("*")
        yield weight or "1", name


def extent(row: Row, low: Sequence[Fraction], high: Sequence[Fraction]) -> Fraction:
    """The least value in the box."""
    return sum((x * (a if x > 0 else b) for x, a, b in zip(row, low, high, strict=False)), row[-1])


def down(x: Fraction) -> Fraction:
    """A short number that is no greater."""
    return Fraction((x.numerator * PLACES) // x.denominator, PLACES)


def signed_root(x: Fraction) -> Fraction:
    """At most the root of x, with its sign."""
    size = abs(x.numerator) * PLACES**2 // x.denominator
    return Fraction(isqrt(size), PLACES) if x >= 0 else -Fraction(isqrt(size) + 1, PLACES)


def product(first: Polynomial, second: Polynomial) -> Polynomial:
    """Ascending powers."""
    found = [Fraction(0)] * (len(first) + len(second) - 1)
    for i, x in enumerate(first):
        for j, y in enumerate(second):
            found[i + j] += x * y
    return found


def power(one: Polynomial, count: int) -> Polynomial:
    """The product of so many."""
    found = [Fraction(1)]
    for _ in range(count):
        found = product(found, one)
    return found


def derivative(one: Polynomial) -> Polynomial:
    """By k."""
    return [i * x for i, x in enumerate(one)][1:]


def integral(one: Polynomial) -> Polynomial:
    """From 0."""
    return [Fraction(0), *(x / (i + 1) for i, x in enumerate(one))]


def value(one: Polynomial, k: Fraction) -> Fraction:
    """By Horner's rule."""
    fraction = Fraction(0)
    for x in reversed(one):
        fraction = fraction * k + x
    return fraction


def chebyshev(degree: int) -> Polynomial:
    """T(2k-1)."""
    before, last = [Fraction(1)], [Fraction(-1), Fraction(2)]
    for _ in range(degree - 1):
        twice = product([Fraction(-2), Fraction(4)], last)
        before, last = last, [x - y for x, y in zip(twice, [*before, *[Fraction(0)] * 2], strict=True)]
    return last


def inverse(rows: Sequence[Row]) -> list[Row]:
    """For each velocity at a point, and for the base's, the weights of the free functions: rows (A | base)."""
    size = len(rows)
    table = [[*row[:-1], *(Fraction(int(i == j)) for j in range(size)), -row[-1]] for i, row in enumerate(rows)]
    for i in range(size):
        pivot = next(j for j in range(i, size) if table[j][i] != 0)
        table[i], table[pivot] = table[pivot], table[i]
        table[i] = [x / table[i][i] for x in table[i]]
        for j in range(size):
            if j != i:
                table[j] = [x - table[j][i] * y for x, y in zip(table[j], table[i], strict=True)]
    return [[row[size + j] for row in table] for j in range(size + 1)]


def combined(functions: Sequence[Polynomial], weights: Sequence[Row]) -> list[Polynomial]:
    """The polynomials that belong to the velocities at the points, and the one that belongs to none."""
    *free, base = functions
    length = max(map(len, functions))
    found = []
    for row in weights:
        total = [Fraction(0)] * length
        for weight, one in zip(row, free, strict=True):
            for i, x in enumerate(one):
                total[i] += weight * x
        found.append(total)
    found[-1] = [x + (base[i] if i < len(base) else 0) for i, x in enumerate(found[-1])]
    return found

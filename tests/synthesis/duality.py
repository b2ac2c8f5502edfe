"""The weak duality sum of a certificate, made again from eq. 8 in rational numbers, without asking optlaws.synthesis.

A law of order l is a = S + k^l (k-1)^l sum z_i (2k-1)^i for end conditions of rest, S the smoothstep; its constants are
variables too. Each contact says row . x <= right. Added up with the multipliers to the objective, the rows leave
nothing of the z_i and of the variables, and what remains is the bound.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from math import comb, inf

import numpy as np
from mpmath import mp, mpf, sqrt  # type: ignore[import-untyped]

from optlaws import Certificate, Contact, Problem
from optlaws.synthesis import Maximum
from tests.synthesis.independent import polynomial

HALF = Fraction(1, 2)
ORDER = {"b": 1, "C": 2, "C_plus": 2, "C_minus": 2, "J": 3, "snap": 4}
NORM = {"rms_c": 2, "rms_j": 3}


class Exact:
    """A polynomial in h = k - 1/2 with rational coefficients."""

    def __init__(self, powers: list[Fraction]) -> None:
        self.powers = powers

    def __call__(self, k: Fraction) -> Fraction:
        total = Fraction(0)
        for value in reversed(self.powers):
            total = total * (k - HALF) + value
        return total

    def __mul__(self, other: "Exact") -> "Exact":
        product = [Fraction(0)] * (len(self.powers) + len(other.powers) - 1)
        for i, p in enumerate(self.powers):
            for j, q in enumerate(other.powers):
                product[i + j] += p * q
        return Exact(product)

    def derivative(self, times: int = 1) -> "Exact":
        powers = self.powers
        for _ in range(times):
            powers = [n * value for n, value in enumerate(powers)][1:] or [Fraction(0)]
        return Exact(powers)


def edge(order: int) -> Exact:
    """k^l (k-1)^l = (h² - 1/4)^l."""
    powers = [Fraction(0)] * (2 * order + 1)
    for i in range(order + 1):
        powers[2 * i] = comb(order, i) * Fraction(-1, 4) ** (order - i)
    return Exact(powers)


@cache
def velocities(order: int, degree: int) -> tuple[Exact, ...]:
    """b of S_l, then of k^l (k-1)^l (2k-1)^i for every i: even i too, which symmetric laws do not have."""
    shape = edge(order - 1)
    whole = Exact([Fraction(0), *(value / (n + 1) for n, value in enumerate(shape.powers))])
    stroke = whole(Fraction(1)) - whole(Fraction(0))
    found = [Exact([value / stroke for value in shape.powers])]
    for i in range(degree + 1):
        odd = Exact([*[Fraction(0)] * i, Fraction(2) ** i])
        found.append((edge(order) * odd).derivative())
    return tuple(found)


def quotient(order: int, b: Exact, k: Fraction) -> Fraction:
    """b / (k(1-k))^(l-1); at an end, the derivative of order l - 1 of both."""
    if k not in {0, 1}:
        return b(k) / (k * (1 - k)) ** (order - 1)
    lower = Exact([(-1) ** (order - 1) * value for value in edge(order - 1).powers])
    return b.derivative(order - 1)(k) / lower.derivative(order - 1)(k)


def root(value: Fraction) -> Fraction:
    """The square root to 50 digits."""
    with mp.workdps(60):
        return Fraction(int(sqrt(mpf(value.numerator) / value.denominator) * mpf(10) ** 50), 10**50)


def functional(order: int, degree: int, b: Exact, contact: Contact) -> Fraction:
    """The left side of a constraint for the velocity b, its sign included; 0 for a row that no law enters."""
    name, k, sign = contact.constraint, Fraction(contact.k), int(contact.sign)
    if name in ORDER:
        return sign * b.derivative(ORDER[name] - 1)(k)
    if name in NORM:
        return along(order, degree, b.derivative(NORM[name] - 1), contact, NORM[name])
    return SPECIAL[name](order, b, k, sign) if name in SPECIAL else Fraction(0)


def chord(_: int, b: Exact, k: Fraction, __: int) -> Fraction:
    """-(b(1/2) - b) / (1-2k)² by the powers of h, without that of c(1/2) = 0."""
    return Exact([value / 4 for value in b.powers[2:]] or [Fraction(0)])(k)


def ratio(order: int, b: Exact, k: Fraction, _: int) -> Fraction:
    """-b / (k(1-k))^(l-1) in units of the base law's."""
    return -quotient(order, b, k) / quotient(order, velocities(order, 0)[0], HALF)


SPECIAL: dict[str, Callable[[int, Exact, Fraction, int], Fraction]] = {
    "chord": chord,
    "ratio": ratio,
    "forward": lambda _, b, k, __: -b(k),
    "b / sqrt(2k)": lambda _, b, k, sign: sign * b(k) / root(2 * k) if k else Fraction(0),
    "b / sqrt(2 - 2k)": lambda _, b, k, sign: sign * b(k) / root(2 - 2 * k) if k != 1 else Fraction(0),
}


def along(order: int, degree: int, function: Exact, contact: Contact, nu: int) -> Fraction:
    """The mean of a function times that unit function which the direction gives on Gauss's points; at most its RMS."""
    # a law has degree 2 l + n; enough points for the square of a derivative of a symmetric or unsymmetric law
    count = len(contact.direction)
    assert 2 * count - 1 >= 2 * (2 * order + degree - nu), "the rule must be exact for squares"
    u, weights = np.polynomial.legendre.leggauss(count)
    direction = np.array(contact.direction)
    direction = direction / np.linalg.norm(direction)
    return sum(
        (
            Fraction(float(d * np.sqrt(w / 2.0))) * function((1 - Fraction(float(x))) / 2)
            for d, w, x in zip(direction, weights, u, strict=True)
        ),
        Fraction(0),
    )


def mirror_image(contact: Contact) -> Contact:
    """What a contact asks of the mirror image a*(k) = 1 - a(1-k) of a law: b and j are even, c and c'' odd."""
    name = {"b / sqrt(2k)": "b / sqrt(2 - 2k)", "b / sqrt(2 - 2k)": "b / sqrt(2k)"}
    odd = ORDER.get(contact.constraint, 1) % 2 == 0
    return Contact(
        name.get(contact.constraint, contact.constraint),
        -contact.sign if odd else contact.sign,
        float(1 - Fraction(contact.k)),
        contact.multiplier,
        contact.direction,
    )


@dataclass
class Sum:
    """The bound, and what is left of each z_i and each variable beside the size of the terms that cancel there."""

    constant: Fraction = Fraction(0)
    laws: list[tuple[Fraction, Fraction]] = field(default_factory=list)
    variables: dict[str, Fraction] = field(default_factory=dict)
    used: list[tuple[Contact, Fraction]] = field(default_factory=list)

    def slack(self, name: str, weight: Fraction) -> None:
        self.variables[name] = self.variables.get(name, Fraction(0)) + weight


def weak_duality(certificate: Certificate, *, mirrored: bool = False) -> Sum:
    """The sum; `mirrored` takes half of each contact at its mirror image, so that it speaks of unsymmetric laws too."""
    problem = certificate.problem
    found = Sum()
    if certificate.program != "violation":
        for weight, term in problem.objective.terms:
            found.slack(repr(term), Fraction(weight))
    contacts = [c for c in certificate.contacts if c.multiplier > 0]
    halves = [(c, Fraction(c.multiplier) / (2 if mirrored else 1)) for c in contacts]
    if mirrored:
        halves += [(mirror_image(c), Fraction(c.multiplier) / 2) for c in contacts]
    found.used = halves
    for contact, m in halves:
        _right_side(found, certificate, contact, m)
    degree = polynomial(problem).degree
    base, *free = velocities(problem.order, degree)
    if problem.symmetric and not mirrored:
        free = free[1::2]
    found.constant += sum((m * functional(problem.order, degree, base, c) for c, m in halves), Fraction(0))
    middle, bend = _equations(found, certificate)
    found.constant += middle * base(HALF) + bend * base.derivative()(HALF)
    for b in free:
        terms = [m * functional(problem.order, degree, b, c) for c, m in halves]
        terms += [middle * b(HALF), bend * b.derivative()(HALF)]
        size = sum((m * _largest(problem.order, degree, b, c) for c, m in halves), abs(terms[-2]) + abs(terms[-1]))
        found.laws.append((sum(terms, Fraction(0)), size))
    return found


def _largest(order: int, degree: int, b: Exact, contact: Contact) -> Fraction:
    if contact.constraint in NORM:
        return abs(functional(order, degree, b, contact)) + 1
    places = [Contact(contact.constraint, contact.sign, i / 16, 1.0) for i in range(17)]
    return max(abs(functional(order, degree, b, place)) for place in places)


def _right_side(found: Sum, certificate: Certificate, contact: Contact, m: Fraction) -> None:
    """What row . x <= right has beside the law: variables to the left, numbers to the right."""
    problem, name = certificate.problem, contact.constraint
    # a variable of the program: what the objective names, B, the root of D
    leaves = _variables(problem, certificate.program)
    if name.endswith((" at most", " at least")):
        constant, _, way = name.partition(" at ")
        sign = 1 if way == "most" else -1
        expected = problem.range(constant)
        assert expected is not None
        found.slack(constant, sign * m)
        found.constant -= sign * m * Fraction(expected.high if sign > 0 else expected.low)
    elif name.startswith("part "):
        index, _, text = name.removeprefix("part ").partition(" of ")
        (term,) = (t for t in _maxima(problem) if repr(t) == text)
        for weight, inner in term.parts[int(index) - 1].terms:
            found.slack(repr(inner), m * Fraction(weight))
        found.slack(text, -m)
    elif name == "tangent":
        t = Fraction(certificate.tangent)  # type: ignore[arg-type]
        found.slack("root of D", 2 * t * m)
        found.constant -= m * t * t
        if "D" in leaves:
            found.slack("D", -m)
        else:
            expected = problem.range("D")
            assert expected is not None
            found.constant -= m * Fraction(expected.high)
    elif name.startswith("b / sqrt"):
        found.slack("root of D", -m)
    elif name in {"chord", "ratio", "forward"}:
        pass
    elif name == "b":
        found.slack("B", -m)
    elif name in leaves:
        found.slack(name, -m)
    else:
        expected = problem.range(name)
        assert expected is not None
        assert expected.high < inf
        found.constant -= m * Fraction(expected.high)


def _equations(found: Sum, certificate: Certificate) -> tuple[Fraction, Fraction]:
    """Count in the equations; returns the weights of b(1/2) and c(1/2)."""
    problem = certificate.problem
    expected = problem.range("B")
    weights = [Fraction(w) for w in certificate.equations]
    if expected is None:
        assert not weights
        return Fraction(0), Fraction(0)
    if problem.symmetric:
        (middle,) = weights
        if expected.fixed:
            found.constant -= middle * Fraction(expected.high)
        else:
            found.slack("B", -middle)
        return middle, Fraction(0)
    if expected.fixed:
        fixed = weights.pop(0)
        found.slack("B", fixed)
        found.constant -= fixed * Fraction(expected.high)
    middle, bend = weights or (Fraction(0), Fraction(0))
    found.slack("B", -middle)
    return middle, bend


def _maxima(problem: Problem) -> list[Maximum]:
    return [term for _, term in problem.objective.terms if isinstance(term, Maximum)]


def _variables(problem: Problem, program: str) -> set[str]:
    if program == "violation":
        return set()
    names = {repr(term) for _, term in problem.objective.terms}
    for term in _maxima(problem):
        names |= {repr(inner) for part in term.parts for _, inner in part.terms}
    return names

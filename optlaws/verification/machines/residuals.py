"""The residual vibration that a law leaves in a follower or in a mode of a machine, in complex balls."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial, reduce
from itertools import accumulate, takewhile
from operator import mul
from typing import Any, TypeVar

from flint import acb, acb_poly, acb_series, arb, arb_poly

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.mechanisms.machine.residual import BandResidual, ModeResidual, Residual
from optlaws.tolerances import SAME_FREQUENCY, SAME_ROOT, TAYLOR_REST, VIBRATING
from optlaws.verification.enclosing.balls import ball, root
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.taylor_models import Taylor, cells, greatest_magnitude
from optlaws.verification.machines.output_motion import DrivenStretch, of_pieces
from optlaws.verification.machines.transfer import Rational, roots, transforms

Number = TypeVar("Number", acb, acb_series)
#: no stretch with a Taylor polynomial of its own is shorter
_SHORTEST = Fraction(1, 2**20)


def velocity_transforms(w: Number, drives: Sequence[DrivenStretch]) -> list[Number]:
    """Integrals of exp(w (1-k)) b(k) for all laws: by parts, from their derivatives at the ends of stretches."""
    nothing = w * 0
    powers = list(accumulate([1 / w] * max(len(drive.ends[0]) - 1 for drive in drives), mul))
    total = [nothing] * len(drives[0].columns)
    for drive in drives:
        for k, rows, sign in zip((drive.start, drive.stop), drive.ends, (1, -1), strict=True):
            wave = (w * acb(ball(1 - k))).exp() * sign
            for i, column in enumerate(zip(*rows[1:], strict=True)):
                terms = zip(powers, column, strict=False)
                total[i] += wave * sum((power * acb(arb(value)) for power, value in terms if value != 0), nothing)
    return total


def greatest_modulus(functions: Sequence[Callable[[Any], Any]], low: Fraction, high: Fraction) -> arb:
    """A ball that holds the greatest magnitude of complex functions of a real number, given for numbers and series."""
    if low == high:
        sizes: list[arb] = [abs(function(acb(ball(low)))) for function in functions]
        return reduce(arb.max, sizes)
    several = [taylor for function in functions for _, taylor in _stretches(function, low, high)]
    return _greatest((_squared(centre), rest) for centre, rest in several)


def _greatest(parts: Iterable[tuple[arb_poly, arb]]) -> arb:
    """A ball that holds the greatest magnitude, from polynomials of its square and the errors of the magnitude."""
    squares, errors = zip(*parts, strict=True)
    size = root(greatest_magnitude([(square, arb(0)) for square in squares]))
    return (size + arb(0, reduce(arb.max, errors))).max(arb(0))


def _stretches(
    function: Callable[[acb_series], acb_series], low: Fraction, high: Fraction
) -> Iterator[tuple[tuple[Fraction, Fraction], Taylor]]:
    """Short stretches with polynomials of a function there, and their errors."""
    several = cells(lambda nu: [function(nu)], acb_series, (low, high), 2 * _SHORTEST, _next_to_nothing)
    yield from ((ends, taylor) for ends, [taylor] in several)


def _next_to_nothing(parts: Sequence[Taylor], _: Fraction) -> bool:
    centre, rest = parts[0]
    return bool(rest <= TAYLOR_REST * sum(map(abs, centre[:2]), arb(0)))


def _squared(series: list[acb]) -> arb_poly:
    """The squared magnitude of a polynomial of a real number."""
    real, imaginary = arb_poly([term.real for term in series]), arb_poly([term.imag for term in series])
    return real * real + imaginary * imaginary


_I = acb(0, 1)


class ExactBandResidual:
    """The complex amplitude, of an acceleration times nu², and the weight, as a function of the frequency, in parts."""

    def __init__(self, constant: BandResidual) -> None:
        self.parts = [tuple(map(Fraction, part)) for part in constant.parts]
        self.damping, self.design_damping = Fraction(constant.damping), Fraction(constant.design_damping)
        self.design = None if constant.design is None else Fraction(constant.design)
        self.displacement = constant.displacement

    def amplitudes(self, frequency: Number, drives: Sequence[DrivenStretch]) -> list[Number]:
        """The amplitudes of laws given by the ends of their pieces; where the breaks end at 1/2, b(1-k) = b(k)."""
        sine = ball((1 - self.damping) * (1 + self.damping)).sqrt()
        root = acb(ball(-self.damping), sine)
        w = frequency * root
        scale = self._detuning(frequency, w) * (-_I * acb(ball(-self.damping), -sine) / sine)
        scale = scale if self.displacement else frequency * frequency * scale
        return [scale * transform for transform in velocity_transforms(w, drives)]

    def _detuning(self, frequency: Number, w: Number) -> Number:
        """The factor of the residual of a cam for the design frequency."""
        if self.design is None:
            return frequency * 0 + 1
        square = 1 / ball(self.design**2)
        apart = frequency * acb(ball(-self.damping)) + acb(ball(self.design_damping * self.design))
        return 1 - frequency * frequency * acb(square) + apart * w * acb(2 * square)

    def rows(self, drives: Sequence[DrivenStretch], part: int, place: Fraction) -> list[acb]:
        """Amplitudes of a space's free functions and of its base law, at a place of a part from 0 to 1."""
        low, high, first, last = self.parts[part]
        weight = ball((1 - place) * first + place * last)
        return [weight * value for value in self.amplitudes(acb(ball((1 - place) * low + place * high)), drives)]

    def peak(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that holds the greatest magnitude over all frequencies, at the precision at work."""
        drives = of_pieces(pieces)
        low, high = self.parts[0][0], self.parts[-1][1]
        if low == high:
            return abs(self.rows(drives, 0, Fraction(0))[0])
        # the amplitude is smooth over the whole interval, the weight in each part
        several = _stretches(lambda frequency: self.amplitudes(frequency, drives)[0], low, high)
        return _greatest(weighed for ends, taylor in several for weighed in self._weighed(ends, taylor))

    def _weighed(self, ends: tuple[Fraction, Fraction], taylor: Taylor) -> Iterator[tuple[arb_poly, arb]]:
        """The squared magnitude, weighed, on each part of a stretch with a polynomial of the amplitude, and errors."""
        (low, high), (centre, rest) = ends, taylor
        first_of_all = bisect_right(self.parts, low, key=lambda part: part[1])
        for start, stop, first, last in takewhile(lambda part: part[0] < high, self.parts[first_of_all:]):
            begin, end = max(low, start), min(high, stop)
            left, right = (2 * (place - low) / (high - low) - 1 for place in (begin, end))
            inner = acb_poly([acb(ball((left + right) / 2)), acb(ball((right - left) / 2))])
            a, b = (first + (place - start) / (stop - start) * (last - first) for place in (begin, end))
            polynomial = acb_poly(centre)(inner) * acb_poly([acb(ball((a + b) / 2)), acb(ball((b - a) / 2))])
            yield _squared(polynomial.coeffs()), rest * ball(max(a, b))


Corner = tuple[arb, arb]


@dataclass(frozen=True)
class ExactEdge:
    """Roots i nu exp(i angle) between two corners (frequency, angle), sin(angle) being the damping ratio."""

    first: Corner
    last: Corner
    single: bool = False

    def root(self, place: Number) -> Number:
        """The root at a place from 0 to 1."""
        frequency, angle = (acb(a) + place * acb(b - a) for a, b in zip(self.first, self.last, strict=True))
        return _I * frequency * (_I * angle).exp()


class ExactModeResidual:
    """The greatest amplitude over the box, at the working precision of its first use."""

    def __init__(self, constant: ModeResidual) -> None:
        self.constant = constant

    @kept_property
    def mode(self) -> list[tuple[acb, int]]:
        """The roots that are the mode, nearly the same, with their multiplicities."""
        below, _ = transforms(self.constant.machine, self.constant.output)
        groups = vibrations(roots(below))
        if not 1 <= self.constant.mode <= len(groups):
            raise InputError(f"the machine has no mode {self.constant.mode}")
        return groups[self.constant.mode - 1]

    @kept_property
    def root(self) -> acb:
        """The mean of the roots that are the mode."""
        whole = sum(count for _, count in self.mode)
        return sum((root * count for root, count in self.mode), acb(0)) / whole

    @kept_property
    def share(self) -> arb:
        """The mode's amplitude in the output over the magnitude of the integral of exp(root (1 - k)) b(k)."""
        below, parts = transforms(self.constant.machine, self.constant.output)
        total = acb(0)
        for i, part in enumerate(parts):
            for pole in Rational(part, below).poles():
                if not any(bool(pole.root.overlaps(root)) for root, _ in self.mode):
                    continue
                if len(pole.shares) > 1:
                    raise InputError(f"mode {self.constant.mode} is defective: it has no amplitude")
                total += pole.shares[0] * self.root ** (i - 1)
        return abs(2 * total)

    @kept_property
    def edges(self) -> list[ExactEdge]:
        """The edges of the box, one where it is thin, as optlaws.mechanisms numbers them."""
        angle = (-self.root.real / abs(self.root)).asin()
        spread, dampings = Fraction(self.constant.spread), self.constant.dampings
        low, high = abs(self.root) * ball(1 - spread), abs(self.root) * ball(1 + spread)
        least, most = (angle, angle) if dampings is None else (ball(damping).asin() for damping in dampings)
        if dampings is None or dampings[0] == dampings[1]:
            return [ExactEdge((low, least), (high, least), single=not spread)]
        if not spread:
            return [ExactEdge((low, least), (low, most))]
        lower, upper = ((low, least), (high, least)), ((low, most), (high, most))
        return [ExactEdge(*lower), ExactEdge(lower[1], upper[1]), ExactEdge(*upper), ExactEdge(lower[0], upper[0])]

    def rows(self, drives: Sequence[DrivenStretch], edge: int, place: Fraction) -> list[acb]:
        """Amplitudes of a space's free functions and of its base law, at a place of an edge from 0 to 1."""
        transforms = velocity_transforms(self.edges[edge].root(acb(ball(place))), drives)
        return [self.share * transform for transform in transforms]

    def peak(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that holds the greatest over the box, at the precision at work."""
        drives = of_pieces(pieces)

        def amplitude(edge: ExactEdge, place: Number) -> Number:
            return velocity_transforms(edge.root(place), drives)[0]

        along = [partial(amplitude, edge) for edge in self.edges]
        return self.share * greatest_modulus(along, Fraction(0), Fraction(0 if self.edges[0].single else 1))


def exact_residual(constant: Residual) -> ExactBandResidual | ExactModeResidual:
    """A residual in balls."""
    if isinstance(constant, BandResidual):
        return ExactBandResidual(constant)
    if not isinstance(constant, ModeResidual):
        raise InputError(f"{constant.title} is a residual of no band and of no mode: it is not checked")
    return ExactModeResidual(constant)


def vibrations(poles: Sequence[tuple[acb, int]]) -> list[list[tuple[acb, int]]]:
    """Roots of vibrations above the real line, the slowest first, those that are nearly the same together."""
    upper = [pole for pole in poles if pole[0].imag > ball(VIBRATING) * abs(pole[0])]
    groups: list[list[tuple[acb, int]]] = []
    for pole in sorted(upper, key=lambda pole: float(abs(pole[0]).mid())):
        size = abs(pole[0])
        near = [group for group in groups if abs(group[0][0] - pole[0]) <= ball(SAME_ROOT) * size.max(arb(1))]
        if near:
            near[0].append(pole)
            continue
        if groups and not size > abs(groups[-1][0][0]) * ball(1 + SAME_FREQUENCY):
            raise InputError("two modes of the machine have the same frequency: their order cannot be decided")
        groups.append([pole])
    return groups

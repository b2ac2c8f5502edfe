"""Peaks and root mean squares of a machine's outputs, over stored laws and over all laws of a problem."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from math import inf, pi, sin

from flint import arb, arb_mat, arb_poly, arb_series, ctx

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.mechanisms.machine.output_constants import OutputConstant, OutputPeak
from optlaws.verification.enclosing.balls import ball, rational, root
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.space import ExactSpace
from optlaws.verification.enclosing.taylor_models import Ends, Taylor, cells, greatest_magnitude, integrals_of_products
from optlaws.verification.machines.output_motion import (
    DrivenStretch,
    OutputMotion,
    cycle,
    followed,
    of_pieces,
    of_space,
    response,
    with_column,
)
from optlaws.verification.machines.transfer import Transfer

_OUTPUT_REST = 2.0**-150  # of what an output is made of: what a Taylor polynomial may leave of it


class ExactOutput:
    """An output over all the time that counts, and what is before it."""

    def __init__(self, constant: OutputConstant) -> None:
        self.constant = constant
        self.start, self.stop = map(Fraction, constant.within)
        self.transfer = Transfer(constant.machine, constant.output)

    @property
    def repeats(self) -> bool:
        """Whether a cycle is meant that comes back."""
        return self.constant.steady or self.constant.cycle is not None

    @property
    def impulsive(self) -> bool:
        """Whether the acceleration is part of the output: it has no bound where the velocity jumps."""
        return self.transfer.order + self.transfer.direct.degree() > 1

    def response(self, rise: Sequence[DrivenStretch], laws: Sequence[int]) -> OutputMotion:
        """The output at the precision at work; to columns that are laws, and no parts of one, the offset is added."""
        return self._moved(rise).raised(rational(self.constant.offset), laws)

    @property
    def both(self) -> bool:
        """Whether the output is small wherever the constant is, on both sides."""
        return not isinstance(self.constant, OutputPeak) or len(self.constant.signs) == 2

    def _moved(self, rise: Sequence[DrivenStretch]) -> OutputMotion:
        if self.constant.cycle is not None:
            dwell, pause = map(Fraction, self.constant.cycle)
            return response(self.transfer, cycle(rise, dwell, pause), repeats=True)
        if self.constant.steady:
            return response(self.transfer, rise, repeats=True)
        return response(self.transfer, followed(rise, self.stop))

    def peak(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that contains the greatest magnitude, or the one-sided peak, under a stored law."""
        signs = self.constant.signs if isinstance(self.constant, OutputPeak) else (1.0, -1.0)
        several = _cells(self.response(of_pieces(pieces), [0]), self.start, self.stop)
        return greatest_magnitude([(arb_poly(centre), off) for _, [(centre, off)] in several], signs)

    def rms(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that holds the root mean square under a stored law."""
        (square,) = products(self.response(of_pieces(pieces), [0]), self.start, self.stop)
        return root(square / ball(self.stop - self.start))


class OutputRows:
    """An output under all laws of a problem, at the working precision of its first use."""

    def __init__(self, constant: OutputConstant, space: ExactSpace) -> None:
        self.exact, self.space = ExactOutput(constant), space

    @kept_property
    def _response(self) -> OutputMotion:
        rise = of_space(self.space)
        return self.exact.response(rise, [len(rise[0].columns) - 1])

    def beside(self, pieces: Sequence[PolynomialPiece]) -> list[arb]:
        """The mean of the output times another law's, over the latter's RMS: at most the RMS of the output (Cauchy)."""
        exact = self.exact
        rise = with_column(of_space(self.space), of_pieces(pieces))
        *moments, square = products(exact.response(rise, [-2, -1]), exact.start, exact.stop)
        whole = ball(exact.stop - exact.start)
        size = (square * whole).sqrt()
        return [moment / size for moment in moments]

    def moments(self) -> list[list[arb]]:
        """Values of a peak's output, or means of others times functions of at most 1: enough of these for all laws."""
        start, stop, count = self.exact.start, self.exact.stop, 2 * self._response.laws
        if not isinstance(self.exact.constant, OutputPeak):
            return moments(self._response, start, stop, count)
        shares = (Fraction(sin(pi * (i + 0.5) / (2 * count)) ** 2) for i in range(count))
        return [self._response.row(start + share * (stop - start)) for share in shares]

    def at(self, place: Fraction) -> list[arb]:
        """The output of the free functions, then of the base law, at a certificate's place, a share of all the time.

        LookupError where the time does not count.
        """
        time = place * self.exact.stop
        if time < self.exact.start - NEAR:
            raise LookupError
        return self._response.row(max(time, self.exact.start))


#: by how much a place may be beyond an end
NEAR = Fraction(1, 10**9)


#: terms of Taylor polynomials, beside those that the law itself needs, and how many cells are too many
_TERMS, _MOST = 48, 20000


def _cells(motion: OutputMotion, start: Fraction, stop: Fraction) -> Iterator[tuple[Ends, list[Taylor]]]:
    """Cells between two times, on each of which outputs are polynomials up to a negligible error."""
    tries = iter(range(2 * _MOST))

    def enough(least: arb, parts: Sequence[Taylor], _: Fraction) -> bool:
        # of all cells that are tried, wholes and halves, nearly half are cut again
        if next(tries, None) is None:
            raise InputError(f"the output vibrates too fast to be enclosed: more than {_MOST} pieces")
        # errors of rounding alone need no smaller cells
        return all(bool(rest < least) for _, rest in parts) or not any(bool(rest > 0) for _, rest in parts)

    for stretch in motion.stretches:
        ends = max(start, stretch.start), min(stop, stretch.start + stretch.length)
        functions, negligible = partial(motion.series, stretch), partial(enough, _OUTPUT_REST * stretch.size)
        terms = max(_TERMS, stretch.degree + 1)
        if ends[0] < ends[1]:
            yield from cells(functions, arb_series, ends, Fraction(0), negligible, terms=terms, most=inf)


def products(motion: OutputMotion, start: Fraction, stop: Fraction) -> list[arb]:
    """Balls that contain the integrals between two times of each law's output times the last law's output."""
    total = arb_mat(1, motion.laws)
    for (low, high), parts in _cells(motion, start, stop):
        total += integrals_of_products(parts[-1:], parts) * ball((high - low) / 2)
    return list(total.entries())


def moments(motion: OutputMotion, start: Fraction, stop: Fraction, count: int) -> list[list[arb]]:
    """Balls that hold the means between two times of each law's output times Legendre's polynomials."""
    total, whole = arb_mat(count, motion.laws), stop - start
    for (low, high), parts in _cells(motion, start, stop):
        share = (high - low) / whole
        local = _legendre((low + high - 2 * start) / whole - 1, share, count)
        factors = [([polynomial[i] for i in range(count)], arb(0)) for polynomial in local]
        total += integrals_of_products(factors, parts) * ball(share / 2)
    return total.tolist()


def _legendre(middle: Fraction, half: Fraction, count: int) -> list[arb_poly]:
    """Legendre's polynomials on a cell of the interval from -1 to 1, in what runs from -1 to 1 over the cell."""
    with ctx.workprec(ctx.prec + 2 * count):  # the recurrence loses 1.3 bits a degree
        place = arb_poly([ball(middle), ball(half)])
        known = [arb_poly([1]), place]
        for n in range(1, count - 1):
            known.append(((2 * n + 1) * place * known[n] - n * known[n - 1]) * (1 / arb(n + 1)))
    return known[:count]

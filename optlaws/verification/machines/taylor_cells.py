"""A motion between two times, cut into cells on each of which it is a polynomial but for next to nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import comb, factorial

from flint import acb, acb_mat, arb, arb_mat, arb_poly

from optlaws.errors import InputError
from optlaws.tolerances import OUTPUT_REST
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.taylor_models import greatest_magnitude
from optlaws.verification.machines.output_motion import OutputMotion, OutputStretch
from optlaws.verification.machines.transfer import Pole

#: terms of the polynomials, beside those that the law itself needs
_TERMS = 48
_MOST = 20000


@dataclass(frozen=True, eq=False)
class Cell:
    """Outputs of several laws on a stretch of time that is short enough."""

    #: start, stop: when, in durations of the rise
    start: Fraction
    stop: Fraction
    #: coefficients of u^i, a row for each power, a column for each law; u runs from -1 at the start to 1 at the stop
    series: arb_mat
    off: list[arb]  #: for each law, how far the output may be from its polynomial

    @property
    def half(self) -> arb:
        """Half the length of the cell."""
        return ball((self.stop - self.start) / 2)

    def polynomial(self, law: int = 0) -> arb_poly:
        """The polynomial of one of the laws."""
        return arb_poly([self.series[i, law] for i in range(self.series.nrows())])


def cells(motion: OutputMotion, start: Fraction, stop: Fraction) -> Iterator[Cell]:
    """Cells from one time to another."""
    count = 0
    for stretch in motion.stretches:
        low, high = max(start, stretch.start), min(stop, stretch.start + stretch.length)
        left = [(low, high)] if low < high else []
        while left:
            low, high = left.pop()
            cell = _cell(motion, stretch, low, high)
            if cell is None:
                left += [((low + high) / 2, high), (low, (low + high) / 2)]
                continue
            yield cell
            if (count := count + 1) > _MOST:
                raise InputError(f"the output vibrates too fast to be enclosed: more than {_MOST} pieces")


def _cell(motion: OutputMotion, stretch: OutputStretch, low: Fraction, high: Fraction) -> Cell | None:
    """What the output is between two times of a stretch; None where so many terms do not suffice."""
    centre, half = ball((low + high) / 2 - stretch.start), ball((high - low) / 2)
    whole = ball(low - stretch.start).union(ball(high - stretch.start))
    count = max(_TERMS, stretch.polynomials.nrows())
    off, size = [arb(0)] * motion.laws, arb(0)
    for pole, free in zip(motion.poles, stretch.free, strict=True):
        rest = _rest(pole, whole, half, count, free.nrows())
        for i, row in enumerate(free.tolist()):
            off = [total + rest[i] * abs(value) for total, value in zip(off, row, strict=True)]
            size += sum(map(abs, row), arb(0))
    size += sum((abs(value) for value in stretch.polynomials.entries()), arb(0))
    # what only rounding is made of needs no smaller cells
    if any(not distance < OUTPUT_REST * size for distance in off) and any(bool(distance > 0) for distance in off):
        return None
    series = _shifted(stretch.polynomials, centre, half, count)
    for pole, free in zip(motion.poles, stretch.free, strict=True):
        waves = acb_mat(_waves(pole, centre, half, count, free.nrows())) * free
        series += arb_mat(waves.nrows(), waves.ncols(), [value.real for value in waves.entries()])
    return Cell(low, high, series, [distance.upper() for distance in off])


def _waves(pole: Pole, centre: arb, half: arb, count: int, chain: int) -> list[list[acb]]:
    """Taylor coefficients of s^l/l! exp(root s), times the root's count: a row for each power, a column for each l."""
    wave = (pole.root * centre).exp() * pole.count
    powers = [wave]
    for i in range(1, count):
        powers.append(powers[-1] * pole.root / i)
    heights = [centre**i / factorial(i) for i in range(chain)]
    rows = []
    scale = arb(1)
    for m in range(count):
        row = [
            sum((powers[m - i] * (heights[j - i] / factorial(i)) for i in range(min(j, m) + 1)), acb(0)) * scale
            for j in range(chain)
        ]
        rows.append(row)
        scale *= half
    return rows


def _rest(pole: Pole, whole: arb, half: arb, count: int, chain: int) -> list[arb]:
    """What the terms beyond add up to at most, by Lagrange's remainder."""
    size = abs(pole.root)
    powers = [size ** (count - i) / factorial(count - i) / factorial(i) for i in range(min(chain, count))]
    wave = (pole.root.real * whole).exp().upper() * pole.count
    heights = [abs(whole).upper() ** i / factorial(i) for i in range(chain)]
    cells = []
    for j in range(chain):
        total = sum((power * heights[j - i] for i, power in enumerate(powers[: j + 1])), arb(0))
        cells.append((total * wave * half**count).upper())
    return cells


def _shifted(polynomials: arb_mat, centre: arb, half: arb, count: int) -> arb_mat:
    """Polynomials of s as polynomials of u, s = centre + half u."""
    size = polynomials.nrows()
    powers = [arb(1)]
    for _ in range(size):
        powers.append(powers[-1] * centre)
    turn, scale = [], arb(1)
    for m in range(count):
        turn.append([powers[i - m] * comb(i, m) * scale if i >= m else arb(0) for i in range(size)])
        scale *= half
    return arb_mat(turn) * polynomials


def greatest_value(motion: OutputMotion, start: Fraction, stop: Fraction, signs: Sequence[float] = (1.0, -1.0)) -> arb:
    """A ball that holds the greatest magnitude of a single law's output between two times, or that of one side."""
    parts = [(cell.polynomial(), cell.off[0]) for cell in cells(motion, start, stop)]
    return greatest_magnitude(parts, signs)


def products(motion: OutputMotion, start: Fraction, stop: Fraction) -> list[arb]:
    """Balls that hold the integrals between two times of each law's output times that of the last law."""
    total = [arb(0)] * motion.laws
    for cell in cells(motion, start, stop):
        total = [term + more for term, more in zip(total, _integrals(cell), strict=True)]
    return total


def _integrals(cell: Cell) -> list[arb]:
    count = cell.series.nrows()
    last = [cell.series[i, len(cell.off) - 1] for i in range(count)]
    means = [sum((last[j] * arb(2) / (i + j + 1) for j in range(i % 2, count, 2)), arb(0)) for i in range(count)]
    exact = (arb_mat([means]) * cell.series).entries()
    sizes = [sum((abs(cell.series[i, law]) for i in range(count)), arb(0)) for law in range(len(cell.off))]
    places = []
    for value, size, off in zip(exact, sizes, cell.off, strict=True):
        room = 2 * (off * sizes[-1] + cell.off[-1] * size + off * cell.off[-1])
        places.append(cell.half * (value + arb(0, room.upper())))
    return places


def moments(motion: OutputMotion, start: Fraction, stop: Fraction, count: int) -> list[list[arb]]:
    """Balls that hold the means between two times of each law's output times Legendre's polynomials."""
    total = arb_mat(count, motion.laws)
    for cell in cells(motion, start, stop):
        size = cell.series.nrows()
        means = arb_mat(
            [[arb(2) / (i + j + 1) if (i + j) % 2 == 0 else arb(0) for j in range(size)] for i in range(count)]
        )
        room = arb_mat([[arb(0, (2 * off).upper()) for off in cell.off]] * count)
        total += (_legendre(cell, start, stop, count) * means * cell.series + room) * cell.half
    return (total / ball(stop - start)).tolist()


def _legendre(cell: Cell, start: Fraction, stop: Fraction, count: int) -> arb_mat:
    """Coefficients of the polynomials on a cell, a row for each."""
    whole = stop - start
    middle = (cell.start + cell.stop - 2 * start) / whole - 1
    place = arb_poly([ball(middle), ball((cell.stop - cell.start) / whole)])
    powers = [arb_poly([1]), place]
    for n in range(1, count - 1):
        powers.append((place * powers[n] * (2 * n + 1) - powers[n - 1] * n) * (arb(1) / (n + 1)))
    return arb_mat([[power[i] for i in range(count)] for power in powers[:count]])


def root(square: arb) -> arb:
    """The root of what is not negative, though its ball may reach below 0."""
    return square.sqrt() if square > 0 else arb(0).union(square.upper().max(arb(0)).sqrt())

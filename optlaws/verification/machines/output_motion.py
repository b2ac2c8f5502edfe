"""An output of a machine while laws, dwells and returns drive it: polynomials and exponentials in time, in balls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import comb, factorial

from flint import acb, acb_mat, acb_series, arb, arb_mat, arb_series, ctx, fmpq, fmpq_poly

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.verification.enclosing.balls import ball, composed, rational, series_length
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.space import ExactSpace
from optlaws.verification.machines.transfer import Pole, Transfer

Columns = list[fmpq_poly]
_HALF = Fraction(1, 2)


@dataclass(frozen=True)
class DrivenStretch:
    """Displacements on one stretch of time, as polynomials of the time since it began."""

    #: start, length: where it begins and how long it is, in durations of the rise
    start: Fraction
    length: Fraction
    columns: Columns  #: one polynomial for each law

    @property
    def stop(self) -> Fraction:
        return self.start + self.length

    @property
    def first(self) -> list[fmpq]:
        """The displacements where the stretch begins."""
        return [column(fmpq(0)) for column in self.columns]

    @property
    def last(self) -> list[fmpq]:
        """The displacements where the stretch ends."""
        return [column(rational(self.length)) for column in self.columns]

    @kept_property
    def ends(self) -> tuple[list[list[fmpq]], list[list[fmpq]]]:
        """All derivatives of the displacements at both ends of the stretch, a row for each order."""
        begin, end, columns = [self.first], [self.last], self.columns
        while any(column.degree() > 0 for column in columns):
            columns = [column.derivative() for column in columns]
            begin.append([column(fmpq(0)) for column in columns])
            end.append([column(rational(self.length)) for column in columns])
        return begin, end


def of_pieces(pieces: Sequence[PolynomialPiece]) -> list[DrivenStretch]:
    """The motion of a stored law, in a single column."""
    drives = []
    for piece in pieces:
        local = fmpq_poly([fmpq(-1), piece.rate])
        drives.append(DrivenStretch(piece.start, piece.stop - piece.start, [piece.derivative(0)(local)]))
    return drives


def of_space(space: ExactSpace) -> list[DrivenStretch]:
    """The motion of all laws of a space: free functions, then the base law; symmetric laws are mirrored at 1/2."""
    drives = []
    for part, (low, high) in zip(space.derivative(0), pairwise(space.breaks), strict=True):
        local = fmpq_poly([rational(2 * low - 1), fmpq(2)])
        drives.append(DrivenStretch(low, high - low, [function(local) for function in part]))
    if space.breaks[-1] == _HALF:
        middle = drives[-1].last
        drives += [_mirrored(drive, middle) for drive in reversed(drives)]
    return drives


def _mirrored(drive: DrivenStretch, middle: list[fmpq]) -> DrivenStretch:
    back = fmpq_poly([rational(drive.length), fmpq(-1)])
    columns = [2 * height - column(back) for column, height in zip(drive.columns, middle, strict=True)]
    return DrivenStretch(1 - drive.stop, drive.length, columns)


def rest(start: Fraction, length: Fraction, levels: Sequence[fmpq]) -> DrivenStretch:
    """A stretch on which nothing moves."""
    return DrivenStretch(start, length, [fmpq_poly([level]) for level in levels])


def followed(rise: Sequence[DrivenStretch], last: Fraction) -> list[DrivenStretch]:
    """A rise with the dwell after it, up to a time."""
    dwell = [rest(rise[-1].stop, last - rise[-1].stop, rise[-1].last)] if last > rise[-1].stop else []
    return [*rise, *dwell]


def cycle(rise: Sequence[DrivenStretch], dwell: Fraction, pause: Fraction) -> list[DrivenStretch]:
    """Rise, dwell, the same law back, and a rest."""
    low, high = rise[0].first, rise[-1].last
    back = 1 + dwell
    both = [low_part + other for low_part, other in zip(low, high, strict=True)]
    fall = [
        DrivenStretch(
            back + drive.start,
            drive.length,
            [total - column for total, column in zip(both, drive.columns, strict=True)],
        )
        for drive in rise
    ]
    around = [*rise, *([rest(Fraction(1), dwell, high)] if dwell else []), *fall]
    return [*around, *([rest(back + 1, pause, low)] if pause else [])]


def with_column(rise: Sequence[DrivenStretch], other: Sequence[DrivenStretch]) -> list[DrivenStretch]:
    """The motion with one more law, whose stretches are continued over the stretches around their middles."""
    drives = []
    for drive in rise:
        middle = drive.start + drive.length / 2
        covering = [part for part in other if part.start <= middle][-1]
        later = fmpq_poly([rational(drive.start - covering.start), fmpq(1)])
        drives.append(DrivenStretch(drive.start, drive.length, [*drive.columns, covering.columns[0](later)]))
    return drives


States = list[acb_mat]


@dataclass(frozen=True, eq=False)
class OutputStretch:
    """The output on a stretch: polynomials of the time s since it began, and s^l/l! exp(root s) of each pole."""

    #: start, length: when, in durations of the rise
    start: Fraction
    length: Fraction
    polynomials: Columns  #: one for each law
    #: for each pole factors of s^l/l! exp(root s), a column for each law, a row for each l: real parts, then imaginary
    free: list[arb_mat]

    @property
    def degree(self) -> int:
        """The greatest degree of the polynomials."""
        return max(polynomial.degree() for polynomial in self.polynomials)

    @property
    def size(self) -> arb:
        """The sum of the magnitudes of the outputs' terms."""
        numbers = [*(arb(value) for polynomial in self.polynomials for value in polynomial.coeffs())]
        return sum(map(abs, [*numbers, *(value for free in self.free for value in free.entries())]), arb(0))


@dataclass(frozen=True, eq=False)
class OutputMotion:
    """Outputs of several laws over consecutive stretches."""

    poles: Sequence[Pole]
    stretches: Sequence[OutputStretch]
    laws: int  #: how many there are

    def raised(self, by: fmpq, columns: Sequence[int]) -> OutputMotion:
        """The motion with a number added to some of the outputs."""
        if by == 0:
            return self
        chosen = {range(self.laws)[column] for column in columns}
        stretches = []
        for stretch in self.stretches:
            raised = [column + by if i in chosen else column for i, column in enumerate(stretch.polynomials)]
            stretches.append(replace(stretch, polynomials=raised))
        return replace(self, stretches=stretches)

    def row(self, time: Fraction) -> list[arb]:
        """The outputs of all laws at a time; where they jump, those after it."""
        stretch = [part for part in self.stretches if part.start <= time][-1]
        with series_length(2):
            return [output[0] for output in self.series(stretch, arb_series([ball(time), arb(1)]))]

    def series(self, stretch: OutputStretch, time: arb_series) -> list[arb_series]:
        """The outputs of all laws on a stretch as Taylor series, from the Taylor series of the time."""
        s = time - ball(stretch.start)
        total = [composed(polynomial, s) for polynomial in stretch.polynomials]
        for pole, free in zip(self.poles, stretch.free, strict=True):
            wave, waves = (acb_series(s.coeffs()) * pole.root).exp() * pole.count, []
            for i in range(1, len(pole.shares) + 1):
                waves.append([wave[j] for j in range(ctx.cap)])
                wave = wave * acb_series(s.coeffs()) / i
            rows = [
                *([value.real for value in row] for row in waves),
                *([-value.imag for value in row] for row in waves),
            ]
            outputs = (free.transpose() * arb_mat(rows)).tolist()
            total = [term + arb_series(row) for term, row in zip(total, outputs, strict=True)]
        return total


def response(transfer: Transfer, drives: Sequence[DrivenStretch], *, repeats: bool = False) -> OutputMotion:
    """The output over consecutive drives from rest, or the steady one where they are a cycle that `repeats`."""
    chains = _Chains(transfer, len(drives[0].columns))
    driven = [_driving(drive, transfer.order) for drive in drives]
    states = chains.returned(driven) if repeats else chains.settled(drives[0])
    return OutputMotion(chains.poles, list(chains.moved(driven, states)), chains.laws)


class _Chains:
    """States of each pole, as a chain: the law drives the first, and each state drives the next."""

    def __init__(self, transfer: Transfer, laws: int) -> None:
        self.transfer, self.poles, self.laws = transfer, transfer.poles(), laws
        self.last: States = []

    def settled(self, first: DrivenStretch) -> States:
        """The states of rest where a drive begins."""
        levels = first.first if self.transfer.order == 0 else [fmpq(0)] * self.laws
        if any(level != 0 for level in levels) and self.transfer.characteristic(fmpq(0)) == 0:
            raise InputError("exact verification knows no state of rest, away from 0, of a machine that drifts")
        states = []
        for pole in self.poles:
            rows = []
            state = [acb(arb(level)) for level in levels]
            for _ in pole.shares:
                state = [acb(0) if value == 0 else -value / pole.root for value in state]
                rows.append(state)
            states.append(acb_mat(rows))
        return states

    def moved(self, driven: Sequence[DrivenStretch], states: States) -> Iterator[OutputStretch]:
        """The output on each stretch, from given states on; the states are updated."""
        for drive in driven:
            forced = [_forced(pole, drive) for pole in self.poles]
            away = [state - part for state, (part, _) in zip(states, forced, strict=True)]
            free = [_weighted(pole, rows) for pole, rows in zip(self.poles, away, strict=True)]
            yield OutputStretch(drive.start, drive.length, self._polynomials(drive), free)
            states = [
                part + _chain(pole, ball(drive.length)) * rows
                for pole, rows, (_, part) in zip(self.poles, away, forced, strict=True)
            ]
        self.last = states

    def returned(self, driven: Sequence[DrivenStretch]) -> States:
        """The states that come back after a cycle."""
        list(self.moved(driven, [acb_mat(len(pole.shares), self.laws) for pole in self.poles]))
        period = ball(driven[-1].stop - driven[0].start)
        return [_returned(pole, period, rows) for pole, rows in zip(self.poles, self.last, strict=True)]

    def _polynomials(self, drive: DrivenStretch) -> Columns:
        """The output without free motion: the transfer function's series at 0, applied to the law."""
        columns, total = drive.columns, [fmpq_poly([0])] * self.laws
        for _ in range(self.transfer.zeros):
            columns = [column.integral() for column in columns]
        for factor in self.transfer.laurent(max(0, *(column.degree() for column in drive.columns))).values():
            total = [term + factor * column for term, column in zip(total, columns, strict=True)]
            columns = [column.derivative() for column in columns]
        return total


def _driving(drive: DrivenStretch, nu: int) -> DrivenStretch:
    """The derivative that drives the machine."""
    return DrivenStretch(drive.start, drive.length, [column.derivative() for column in drive.columns]) if nu else drive


def _forced(pole: Pole, drive: DrivenStretch) -> tuple[acb_mat, acb_mat]:
    """A motion of the chain that is a polynomial: where the stretch begins and where it ends."""
    if pole.root == 0:
        return _integrated(pole, drive)
    inverse = 1 / pole.root
    first, last = (acb_mat([[acb(arb(value)) for value in row] for row in rows]) for rows in drive.ends)
    orders = range(first.nrows())
    turn = acb_mat(
        [[comb(j + i - 1, i) * (-1) ** j * inverse ** (j + i) for i in orders] for j in range(1, len(pole.shares) + 1)]
    )
    return turn * first, turn * last


def _integrated(pole: Pole, drive: DrivenStretch) -> tuple[acb_mat, acb_mat]:
    columns, rows = drive.columns, []
    for _ in pole.shares:
        columns = [column.integral() for column in columns]
        rows.append([acb(arb(column(rational(drive.length)))) for column in columns])
    matrix = acb_mat(rows)
    return 0 * matrix, matrix


def _weighted(pole: Pole, away: acb_mat) -> arb_mat:
    """The factors of s^l/l! exp(root s) in the output, real parts above imaginary ones."""
    count = len(pole.shares)
    turn = [[pole.shares[j + row] if j + row < count else acb(0) for j in range(count)] for row in range(count)]
    rows = (acb_mat(turn) * away).tolist()
    return arb_mat([*([value.real for value in row] for row in rows), *([value.imag for value in row] for row in rows)])


def _chain(pole: Pole, length: arb) -> acb_mat:
    """The matrix from a chain's states to its states of free motion after a time."""
    wave, count = (pole.root * length).exp(), len(pole.shares)
    terms = [wave * length**i / factorial(i) for i in range(count)]
    return acb_mat([[terms[i - j] if j <= i else acb(0) for j in range(count)] for i in range(count)])


def _returned(pole: Pole, period: arb, gained: acb_mat) -> acb_mat:
    """The initial states of a chain in periodic motion, from the states after a cycle that starts at rest."""
    whole = _chain(pole, period)
    count = len(pole.shares)
    away = acb_mat([[(1 if i == j else 0) - whole[i, j] for j in range(count)] for i in range(count)])
    try:
        return away.solve(gained)
    except ZeroDivisionError:
        raise InputError("the machine is in resonance with its cycle, or drifts: it has no steady motion") from None

"""Which splines the noise of rows allows: with how many pieces, and with which joints and corners."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import log
from types import MappingProxyType

import numpy as np

from optlaws.cycles.old_tables.curve_fit import CANDIDATES, DEGREE, CurveFit, End, Joint
from optlaws.cycles.old_tables.least_squares import ROUGH, LeastSquares
from optlaws.numbers import Array

#: pieces of a spline that is simple enough to stand beside standard laws, at most
SIMPLE = 6
#: variance about a spline, over that of the noise: it is no model
UNRESOLVED = 9.0
#: numbers of pieces that are tried
_PIECES = (1, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22, 29, 38, 50, 65, 85, 110, 145)
#: rows for each free coefficient at least
_ROWS_EACH = 1.6
#: numbers of pieces between which a joint is looked for
_COARSE = (1, 2, 4)
_MOST_JOINTS = 8
#: of the greatest velocity: what is slower may turn by chance
_SLOW = 0.01
#: at which ends a fit may leave lines or rests with another velocity
_CORNERS = ((True, True), (True, False), (False, True))
#: of places at which a turn is looked for: where a corner is smoothed a fit may turn back
_NEAR_END = CANDIDATES // 8
#: parameters of a likely spline from which on corners are looked for where it begins and ends
_CORNERED = 12
#: steps within which a corner is where the rows of a line end
_NEAR_CORNER = 4.0
#: how many numbers of pieces are tried without a jump of the acceleration at rests
_MORE = 6
#: places within a piece at which a joint is tried that is to be smoother
_MOVED = 19
#: how often joints and ends are placed by each other
_SETTLED = 2
#: how many models with more pieces than the best one are looked at beside it
_FINER = 2
#: by how much the criterion of Schwarz must fall for a joint or a corner to be there
EVIDENT = 12.0
#: with as few pieces no joint is looked for: the motion is smooth
_SIMPLE = 4
#: a polynomial of more degrees is looked at beside joints
_FEW_DEGREES = 15
#: degrees of one polynomial for a whole move, and how many derivatives it may have in common with the rests beside it
_DEGREES, _CONTACTS = range(7, 34, 2), (3, 2)
#: steps to which places are rounded where the rows allow it, in parts of a turn
_ROUND = (1.0 / 36.0, 1.0 / 72.0, 1.0 / 360.0, 1.0 / 720.0, 1.0 / 3600.0)
#: a master that is longer is no turn in radians or turns
_RADIANS = 12.0
#: by how much the sum of squares may grow for each place that is rounded
AS_LIKELY = 4.0
#: with more pieces the ends of rests are no longer looked for: the pieces begin to take part in the rests
_ENDS_BY = 6


def fits_of(
    places: Array,
    heights: Array,
    noise: Array,
    ends: tuple[End, End],
    advance: float | None = None,
    *,
    smooth: int | None = None,
) -> list[CurveFit]:
    """Splines that explain rows as well as any, the simplest one first; none where the rows are too few.

    Parameters
    ----------
    places, heights, noise
        Rows, arrays of shape (n,).
    ends
        What is before the first and behind the last row of the motion.
    advance
        Of a whole turn, at whose end the motion goes on as at its start: what it advances by.
    smooth
        If given, splines without joints alone are of interest, of so many pieces at most.
    """
    fitter = LeastSquares(places, heights, noise, ends, advance)
    rough = _Search(fitter.thinned(), _PIECES[-1] if smooth is None else smooth)
    middle = [
        (end.low + end.high) / 2.0 if end.line is not None else float(places[0 if side == 0 else -1])
        for side, end in enumerate(ends)
    ]
    fits = rough.climbed((), (middle[0], middle[1]), None)
    if not fits:
        return []
    for continuity in (1, 0) if advance is not None and rough.best(fits).pieces > _SIMPLE else ():
        other = _Search(replace(rough.fitter, continuity=continuity), rough.most)
        family = other.climbed((), (middle[0], middle[1]), None)
        if family and other.criterion(other.best(family)) < rough.criterion(rough.best(fits)) - EVIDENT:
            rough, fits, fitter = other, family, replace(fitter, continuity=continuity)
    best = rough.best(fits)
    polynomials = rough.polynomials((best.start, best.stop)) if best.pieces > _SIMPLE else []
    plain = [fit for fit in polynomials if rough.criterion(fit) < rough.criterion(best)]
    explaining = plain if plain and likely(rough.best(plain).squares, rough.rows) else []
    few = bool(explaining) and rough.best(plain).degree <= _FEW_DEGREES
    joints: tuple[Joint, ...] = ()
    smoothly = rough, joints, fits
    if smooth is None and not few:
        joints, fits = rough.jointed(fits)
        smoothly = rough, joints, fits
        rough, joints, fits = rough.with_corners(joints, fits)
        joints, fits = rough.without_redundant_joints(joints, fits)
    if explaining and rough.criterion(rough.best(plain)) < rough.criterion(rough.best(fits)):
        refined = [_refined(fitter, fit) for fit in rough.accepted(polynomials)]
        if likely(min(fit.squares for fit in refined), len(places)):
            return refined
    family, price = _of_all_rows(fitter, rough, joints, fits), log(len(places))
    if any(rough.fitter.corners):
        # where places are as near as all rows tell, a corner may be no likelier
        without = _of_all_rows(fitter, *smoothly)
        if without and (not family or without[0].criterion(price) <= family[0].criterion(price) + EVIDENT):
            return without
    return family


def _of_all_rows(
    rows: LeastSquares, search: _Search, joints: tuple[Joint, ...], fits: Sequence[CurveFit]
) -> list[CurveFit]:
    """The likeliest fits to all rows, near those of a search that some of them did for."""
    best = search.best(fits)
    at = best.start, best.stop
    if joints:
        joints = search.fitter.placed(at, joints, best.pieces)
    whole = _Search(replace(rows, corners=search.fitter.corners, ends=search.fitter.ends), search.most)
    starts = {fit.pieces: (fit.start, fit.stop) for fit in fits}
    near = float(np.median(np.diff(rows.x)))
    # of rows of which some were left out in the search, fewer pieces tell no more than these did
    fewest = best.pieces if search.rows < len(rows.x) else 1
    return whole.accepted(whole.climbed(joints, at, near, starts, fewest=fewest))


def with_jumps(places: Array, heights: Array, noise: Array, fits: Sequence[CurveFit]) -> Sequence[CurveFit]:
    """Fits that know whether the acceleration jumps at a rest: whether the first one without is far less likely."""
    fit = fits[0]
    at_rests = np.array([fit.start, fit.stop])[[end.line is not None for end in fit.ends]]
    if fit.contact > 2 or not np.any(np.abs(fit.values(at_rests, 2)) > 3.0 * fit.deviation(at_rests, 2)):
        return fits
    fitter = LeastSquares(
        places, heights, noise, fit.ends, None, fine=ROUGH, degree=fit.degree, contact=3, corners=fit.corners
    )
    near, price = 4.0 * float(np.median(np.diff(places))), log(len(places))
    for pieces in range(fit.pieces, fit.pieces + _MORE):
        at = fitter.ends_of(fit.start, fit.stop, fit.joints, pieces, near)
        smooth = fitter.solved(*at, fit.joints, pieces, whole=True)[2]
        if smooth is not None and smooth.criterion(price) <= fit.criterion(price) + EVIDENT:
            return fits
    return [replace(each, jumps=True) for each in fits]


def likely(squares: float, rows: int) -> bool:
    """Whether noise alone makes a sum of squares of rows as great."""
    return bool(squares <= rows + 3.0 * np.sqrt(2.0 * rows))


def rounded_places(places: Array, master: Array) -> Iterator[Array]:
    """Places rounded to parts of a turn, whole tens of degrees first, in the units of a master."""
    turn = 360.0 if np.ptp(master) > _RADIANS else 1.0
    for share in _ROUND:
        yield np.round(places / (share * turn)) * share * turn


def _refined(rows: LeastSquares, fit: CurveFit) -> CurveFit:
    """A polynomial, fitted to all rows; its ends are as round as these allow."""
    fitter = replace(rows, degree=fit.degree, contact=fit.contact)
    at = fitter.polynomial_ends((fit.start, fit.stop))
    most = fitter.polynomial_squares(at) + len(at) * AS_LIKELY
    for start, stop in map(tuple, rounded_places(np.array(at), rows.x)):
        inside = all(end.low <= place <= end.high for end, place in zip(rows.ends, (start, stop), strict=True))
        if inside and start < stop and fitter.polynomial_squares((start, stop)) <= most:
            at = start, stop
            break
    return fitter.solved(*at, (), 1, whole=True)[2] or fit


class _Search:
    """Models of rows: with more and more pieces, and with joints."""

    def __init__(self, fitter: LeastSquares, most: int) -> None:
        self.fitter, self.most = fitter, most
        self.rows, self.price = len(fitter.x), log(len(fitter.x))

    def criterion(self, fit: CurveFit) -> float:
        """Schwarz's criterion for these rows."""
        return fit.criterion(self.price)

    def best(self, fits: Sequence[CurveFit]) -> CurveFit:
        """The likeliest one of several fits."""
        return min(fits, key=self.criterion)

    def climbed(
        self,
        joints: Sequence[Joint],
        at: tuple[float, float],
        near: float | None,
        starts: Mapping[int, tuple[float, float]] = MappingProxyType({}),
        *,
        fewest: int = 1,
    ) -> list[CurveFit]:
        """Fits with more and more pieces, until these serve no more; ends are looked for everywhere, or near.

        Near means within a length of where fits with so many pieces start, else of where the last one does.
        """
        fits: list[CurveFit] = []
        for pieces in _PIECES:
            if pieces < min(fewest, _ENDS_BY) - 1:
                continue
            # rows of the rests tell nothing of the pieces between them
            free = pieces + DEGREE + (DEGREE - 1) * len(joints) - self.fitter.fixed
            if pieces > self.most or (pieces > 1 and not self._tell(free, at)):
                break
            if pieces <= _ENDS_BY:
                at = min({at, starts.get(pieces, at)}, key=partial(self._squares, joints, pieces))
                at = self.fitter.ends_of(*at, joints, pieces, near)
            elif fits:
                best = self.best(fits).start, self.best(fits).stop
                at = min({best, starts.get(pieces, best)}, key=partial(self._squares, joints, pieces))
            fit = self.fitter.solved(*at, joints, pieces, whole=True)[2]
            if fit is None:
                continue
            fits.append(fit)
            least = min(fit.criterion(2.0) for fit in fits)
            resolved = any(fit.variance <= UNRESOLVED for fit in fits)
            # an even number of pieces may fit a crest far better than the odd one behind it
            resolved = resolved and (pieces > _ENDS_BY or any(likely(fit.squares, self.rows) for fit in fits))
            if resolved and len(fits) > 3 and all(fit.criterion(2.0) > least + 2.0 for fit in fits[-2:]):
                break
        return fits

    def _tell(self, free: int, at: tuple[float, float]) -> bool:
        """Whether the rows between two places are enough for so many free coefficients."""
        first, last = self.fitter.x.searchsorted(at).tolist()
        return bool(free * _ROWS_EACH <= last - first)

    def _squares(self, joints: Sequence[Joint], pieces: int, at: tuple[float, float]) -> float:
        return self.fitter.squares(*at, joints, pieces)

    def polynomials(self, at: tuple[float, float]) -> list[CurveFit]:
        """Fits of one polynomial between two rests, of more and more degrees."""
        families = []
        at_rests = None not in (end.line for end in self.fitter.ends) and not any(self.fitter.corners)
        for contact in _CONTACTS if at_rests else ():
            fits = []
            for degree in _DEGREES:
                fitter = replace(self.fitter, degree=degree, contact=contact)
                if not self._tell(degree + 1 - fitter.fixed, at) or degree > self.most + DEGREE:
                    break
                at = fitter.polynomial_ends(at)
                fit = fitter.solved(*at, (), 1, whole=True)[2]
                fits += [] if fit is None else [fit]
                best = self.best(fits) if fits else None
                if len(fits) > 3 and all(other is not best for other in fits[-3:]):
                    break
            families += [fits] if fits else []
        return min(families, key=lambda fits: self.criterion(self.best(fits)), default=[])

    def with_corners(
        self, joints: tuple[Joint, ...], fits: list[CurveFit]
    ) -> tuple[_Search, tuple[Joint, ...], list[CurveFit]]:
        """The search, joints and fits that leave lines or rests with other velocities where these are far likelier."""
        best, (before, after) = self.best(fits), self.fitter.ends
        sides = [(first, last) for first, last in _CORNERS if (before.line or not first) and (after.line or not last)]
        simple = best.free <= _CORNERED and likely(best.squares, self.rows)
        if simple or self.fitter.advance is not None:
            return self, joints, fits
        tried = {corners: each for corners in sides if (each := self._cornered(best, corners))[2]}
        corners = min(
            tried, key=lambda each: tried[each][0].criterion(tried[each][0].best(tried[each][2])), default=None
        )
        while corners in tried:
            search, more, family = tried.pop(corners)
            if search.criterion(search.best(family)) > self.criterion(best) - EVIDENT:
                break
            evident = search.evident_corners(search.best(family))
            if evident == corners:
                return search, *search.jointed(family, more)
            corners = evident
        return self, joints, fits

    def evident_corners(self, fit: CurveFit) -> tuple[bool, bool]:
        """Where a fit leaves lines or rests at corners, not where a line might end by more than is looked at."""
        if not self._tell(fit.free, (fit.start, fit.stop)):
            return False, False  # it goes through the rows, whatever these are
        (before, after), changes = self.fitter.ends, fit.changes()
        near = self.fitter.fine * float(np.median(np.diff(self.fitter.x)))
        return changes[0] and bool(fit.start > before.low + near), changes[1] and bool(fit.stop < after.high - near)

    def _cornered(
        self, best: CurveFit, corners: tuple[bool, bool]
    ) -> tuple[_Search, tuple[Joint, ...], list[CurveFit]]:
        """The likeliest fits with corners where the rows of lines end, maybe with a joint where the best fit turns."""
        (before, after), step = self.fitter.ends, float(np.median(np.diff(self.fitter.x)))
        first = max(before.low, before.high - _NEAR_CORNER * step) if corners[0] else before.low
        last = min(after.high, after.low + _NEAR_CORNER * step) if corners[1] else after.high
        ends = before._replace(low=first), after._replace(high=last)
        search = _Search(replace(self.fitter, corners=corners, ends=ends), self.most)
        middles = [0.5 * (end.low + end.high) for end in ends]
        begun = middles[0] if corners[0] else best.start, middles[1] if corners[1] else best.stop
        tried = []
        for joint in ((), *((Joint(turn, 2),) for turn in _turns(best))):
            at, joints = search.fitter.placed_together(begun, joint, _SIMPLE) if joint else (begun, joint)
            if family := search.climbed(joints, at, 0.0):
                # few pieces do not tell where a corner is
                at = search.fitter.ends_of(*at, joints, search.best(family).pieces, step)
                tried.append((search, joints, search.climbed(joints, at, 0.0) or family))
        return min(tried, key=lambda each: search.criterion(search.best(each[2])), default=(search, (), []))

    def jointed(self, fits: list[CurveFit], joints: tuple[Joint, ...] = ()) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Further joints, as smooth as may be, and fits with these, as long as they make the rows far likelier."""
        while len(joints) < _MOST_JOINTS and self.best(fits).pieces > _SIMPLE:
            tried = [self.joined(fits, joints, pieces) for pieces in _COARSE]
            families = [each for each in (*tried, self.joined_where_it_turns(fits, joints)) if each]
            if not families:
                break
            more, family = min(families, key=lambda each: self.criterion(self.best(each[1])))
            if self.criterion(self.best(family)) > self.criterion(self.best(fits)) - EVIDENT:
                break
            joints, fits = more, family
        return self.smoothed(joints, fits)

    def without_redundant_joints(
        self, joints: tuple[Joint, ...], fits: list[CurveFit]
    ) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints less smooth ones that served wrong ends or missing joints, and fits whose ends are looked for anew."""
        for joint in [each for each in joints if each.continuity] if len(joints) > 1 else ():
            best = self.best(fits)
            others = tuple(each for each in joints if each is not joint)
            family = self.climbed(others, (best.start, best.stop), None)
            if family and self.criterion(self.best(family)) < self.criterion(best) - EVIDENT:
                joints, fits = others, family
        return joints, fits

    def joined(
        self, fits: Sequence[CurveFit], joints: tuple[Joint, ...], pieces: int
    ) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with a joint more, which a model of so many pieces shows; None where it shows none."""
        base = next((fit for fit in fits if fit.pieces == pieces), None)
        joint = None if base is None else self.fitter.joint(base.start, base.stop, joints, pieces)
        return None if base is None or joint is None else self._with(base, (*joints, joint))

    def joined_where_it_turns(
        self, fits: Sequence[CurveFit], joints: tuple[Joint, ...]
    ) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with a joint where they turn, as two laws often meet; None where they do not turn once alone."""
        best, near = self.best(fits), 2.0 * float(np.median(np.diff(self.fitter.x)))
        turns = [turn for turn in _turns(best) if all(abs(joint.place - turn) >= near for joint in joints)]
        return self._with(best, (*joints, Joint(turns[0], 2))) if turns else None

    def _with(self, base: CurveFit, joints: tuple[Joint, ...]) -> tuple[tuple[Joint, ...], list[CurveFit]] | None:
        """Fits with joints about given places, whose ends are near those of another fit; None where there are none."""
        at = base.start, base.stop
        placed = self.fitter.placed(at, sorted(joints), base.pieces)
        more = tuple(joint for joint in placed if at[0] < joint.place < at[1])
        family = self.climbed(more, at, 2.0 * float(np.median(np.diff(self.fitter.x))))
        return (more, family) if family else None

    def smoothed(self, joints: tuple[Joint, ...], fits: list[CurveFit]) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints as smooth as fits are about as likely, which models of too few pieces showed as jumps."""
        for i in range(len(joints)):
            most = self.criterion(self.best(fits)) + EVIDENT
            for continuity in range(joints[i].continuity + 1, 3):
                tried, family = self._settled(self._moved(joints, i, continuity, self.best(fits)), fits)
                if family and self.criterion(self.best(family)) <= most:
                    joints, fits = tried, family
        return joints, fits

    def _moved(self, joints: tuple[Joint, ...], i: int, continuity: int, fit: CurveFit) -> tuple[Joint, ...]:
        """Joints of which one has another continuity, where this is likeliest within the length of a piece."""
        at, length = joints[i].place, (fit.stop - fit.start) / fit.pieces
        low, high = max(at - length, fit.start), min(at + length, fit.stop)
        others = [*joints[:i], *joints[i + 1 :]]
        tried = [
            tuple(sorted([*others, Joint(float(place), continuity)]))
            for place in np.append(np.linspace(low, high, _MOVED)[1:-1], at)
        ]
        return min(tried, key=lambda each: self.fitter.squares(fit.start, fit.stop, each, fit.pieces))

    def _settled(self, joints: tuple[Joint, ...], fits: list[CurveFit]) -> tuple[tuple[Joint, ...], list[CurveFit]]:
        """Joints and fits with these, which move each other's places."""
        near = 2.0 * float(np.median(np.diff(self.fitter.x)))
        for _ in range(_SETTLED):
            best = self.best(fits)
            joints = self.fitter.placed((best.start, best.stop), joints, best.pieces)
            fits = self.climbed(joints, (best.start, best.stop), near)
            if not fits:
                break
        return joints, fits

    def accepted(self, family: Sequence[CurveFit]) -> list[CurveFit]:
        """The likeliest model, and those with more pieces or degrees that are looked at beside it."""
        if not family:
            return []
        place = family.index(self.best(family))
        fits = list(family[place : place + 1 + _FINER])
        while len(fits) <= _FINER:  # rows that are too few to make them likelier do not exclude them
            last = fits[-1]
            pieces = next((count for count in _PIECES if count > last.pieces), 0)
            fitter, joints = self.fitter, [joint for joint in last.joints if last.start < joint.place < last.stop]
            if last.degree != DEGREE:
                fitter, pieces = replace(fitter, degree=last.degree + 2, contact=last.contact), 1
            fit = fitter.solved(last.start, last.stop, joints, pieces, whole=True)[2] if pieces else None
            if fit is None:
                break
            fits.append(fit)
        return fits


def _turns(fit: CurveFit) -> list[float]:
    """About where a fit turns, if it does so once alone, but near its ends."""
    at = np.linspace(fit.start, fit.stop, 2 * CANDIDATES + 1)[_NEAR_END:-_NEAR_END]
    velocity = fit.values(at, 1)
    fast = np.abs(velocity) > _SLOW * np.abs(velocity).max()
    signs = np.sign(velocity[fast])
    turns = at[fast][np.flatnonzero(signs[:-1] != signs[1:])].tolist()
    return turns if len(turns) == 1 else []

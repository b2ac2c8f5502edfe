"""The report of an old cam: what its table is, its moves with better laws beside them, and panels of both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import isfinite, nan
from typing import Any

import numpy as np

from optlaws.cycles.old_tables.better_laws import HARDLY_KNOWN, MoveGain
from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.stretches import Stretch, law_of_move
from optlaws.cycles.old_tables.table import OldTable
from optlaws.kept import kept_property
from optlaws.laws.report import law_panels
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import bounded
from optlaws.sentences import Amount, sentence
from optlaws.shown.report import Panel, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import NO_MARK

_OLD, _NEW, _POINTS = 0, 1, 2  # colours
_DIGITS = 9  # of percents behind the point, as far as they are no rounding
_HARDER = 1.3  # times what is known of an old peak, which a new jerk may be above by a fifth


@dataclass(frozen=True)
class OldTableReport:
    """The report of a table, with the laws that better it where there are such; places are those of its master."""

    table: OldTable
    new: OldTable | None = None

    @property
    def facts(self) -> Summary:
        """What the file is, how near the laws are to its points, and which moves keep their laws."""
        read = Row(f"{self.table.layout}, {len(self.table.places)} points")
        return Summary([read, *map(Row, [*self.table.remarks, *self.unchanged, *self.harder])])

    @property
    def unchanged(self) -> Iterator[str]:
        """Moves that keep their laws or corners, and why; corners that are taken away."""
        for part in () if self.new is None else self.new.moves:
            start, reason = f"{part.start:g}", self.table.reason_in_words(part)
            if part.corner is not None:
                yield self.table.blend_in_words(part)
            elif part.solution is None and reason:
                yield sentence("the {} from {} keeps its law: {}", part.kind, start, reason)
            elif reason:
                yield sentence("the {} from {}: {}", part.kind, start, reason)

    @property
    def harder(self) -> Iterator[str]:
        """Acceleration and jerk of the whole cycle where they are far above what is known of those of the table."""
        if self.new is None:
            return
        if any(None in row[9:12] for row in self._rows_of_gains):
            yield sentence("a change that is empty cannot be known from this table")
        *_, whole = self._gains
        for nu in (2, 3):
            (low, high), new = whole.intervals[nu - 1], whole.new[nu - 1]
            name, unit = QUANTITIES[nu], self.table.unit_of(nu)
            if not isfinite(new):
                continue
            if isfinite(high) and new > _HARDER * high:
                old = sentence("at most {}", Amount(high, unit, 3))
            elif high > HARDLY_KNOWN * low and 0.0 < _HARDER * low < new:
                ends = Amount(low, unit, 3), Amount(high, unit, 3)
                old = sentence("between {} and {}", *ends) if isfinite(high) else sentence("above {}", ends[0])
            else:
                continue
            yield sentence(
                "the greatest {} of the new cycle is {}, that of the old one {}", name, Amount(new, unit, 3), old
            )

    @kept_property
    def tables(self) -> tuple[ReportTable, ...]:
        """The stretches with their laws; the peaks of moves with better laws beside those of the old ones.

        A change is that from the fitted old law; the points of the table leave it open between its ends.
        """
        old, new = self.table, self._rows_of_gains
        ends = [f"from, {old.master}", f"to, {old.master}"]
        rows = [
            [part.kind, part.start, part.stop, part.stroke or None, old.law_in_words(part) if part.law else ""]
            for part in old.stretches
        ]
        stretches = ReportTable(["what", *ends, f"by, {old.unit}", "law"], rows)
        change = ["change, %", "lower end, %", "upper end, %"]
        gains = ["what", *ends, "peak", "old", "new", "lower bound", "status", "unit", *change, f"off by, {old.unit}"]
        return (stretches, ReportTable(gains, new)) if new else (stretches,)

    @kept_property
    def _gains(self) -> tuple[MoveGain, ...]:
        """The gains of the moves, and last that of the whole cycle; none without better laws."""
        return () if self.new is None else (*self.new.gains(self.table), self.new.gain_of_cycle(self.table))

    @kept_property
    def _rows_of_gains(self) -> list[list[Any]]:
        if self.new is None:
            return []
        rows = []
        *moves, whole = self._gains
        changed = [each for each in moves if each.deviation]
        for each in [*changed, whole] if changed or any(part.corner is not None for part in self.new.moves) else ():
            for nu in (1, 2, 3):
                proof = [bounded(each.lower_bound), each.status] if nu == 2 else [None, ""]
                peaks = [each.old[nu - 1], each.new[nu - 1], *proof, self.table.unit_of(nu)]
                change = [bounded(round(100.0 * share, _DIGITS)) for share in (each.share(nu), *each.shares(nu))]
                first = [each.kind, each.start, each.stop] if nu == 1 else ["", None, None]
                rows.append([*first, QUANTITIES[nu], *peaks, *change, each.deviation if nu == 1 else None])
        return rows

    @property
    def segments(self) -> tuple[ReportSegment, ...]:
        """The dwells and moves with their ends."""
        return tuple(ReportSegment(part.kind, part.start, part.stop) for part in self.table.stretches)

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """Position with the points, how far points and new laws are off the old ones, and derivatives by the master."""
        position, *derivatives = (self._panel(nu) for nu in range(len(QUANTITIES)))
        old, points = self.table, Series(self.table.places, self.table.heights, _POINTS, "points", dots=True)
        curves = [curve for curve in position.series if curve.law == _NEW]
        off = [curve._replace(values=curve.values - old.at(curve.at)) for curve in (points, *curves)]
        position = replace(position, series=(*position.series, points), peaks=())
        return (position, replace(position, name="off the old law", series=tuple(off)), *derivatives)

    def _panel(self, nu: int) -> Panel:
        """A derivative by the master, with the greatest magnitude of every move."""
        series, peaks = [], list[tuple[float, float]]()
        old = (_OLD, "old law", self.table.stretches)
        for law, name, stretches in [old] if self.new is None else [old, (_NEW, "new law", self.new.stretches)]:
            panels = [_of_part(part)[nu] for part in stretches]
            at, values = (np.concatenate([panel.series[0][i] for panel in panels]) for i in (0, 1))
            series.append(Series(at, values, law, name))
            peaks += [peak for panel in panels for peak in panel.peaks]
        marked, across = tuple(dict.fromkeys(peaks)), f"master, {self.table.master}"
        return Panel(QUANTITIES[nu], self.table.unit_of(nu), tuple(series), (), marked, across=across, per=1.0)

    @property
    def data(self) -> dict[str, Any]:
        """The table for programs, with the gains of better laws."""
        old, new = self.table, self.new
        stretches = [_data_of(part) for part in (new or old).stretches]
        known = {name: getattr(old, name) for name in ("unit", "master", "room", "scatter", "seam")}
        peaks = [_plain(interval) for interval in old.peaks]
        facts = {"layout": old.layout, "points": len(old.places), **known, "stretches": stretches, "peaks": peaks}
        facts["corners"] = list(old.corners)
        facts["outliers"] = [float(old.places[i]) for i in old.outliers]
        if new is None:
            return facts
        ends = (
            {
                "old": list(map(bounded, each.old)),
                "new": list(map(bounded, each.new)),
                "intervals": list(map(_plain, each.intervals)),
                "lower_bound": bounded(each.lower_bound),
                "status": each.status or None,
            }
            for each in self._gains
        )
        *moves, whole = (each._asdict() | end for each, end in zip(self._gains, ends, strict=True))
        before = [_data_of(part) for part in old.stretches]
        return facts | {"old_stretches": before, "gains": moves, "gain_of_cycle": whole}


def _data_of(part: Stretch) -> dict[str, Any]:
    """A stretch for programs, with its law, and why it keeps this where it does."""
    law = part.law if part.law is None or isinstance(part.law, str) else part.law.to_dict()
    nearest = {"nearest": part.nearest or None, "distance": part.distance if part.nearest else None}
    data = {"kind": part.kind, "start": part.start, "stop": part.stop, "low": part.low, "high": part.high}
    reason = {"reason": part.reason, "sufficient_tolerance": part.sufficient_tolerance or None} if part.reason else {}
    return data | {"law": law} | nearest | reason


def _plain(interval: PeakInterval) -> dict[str, float | None]:
    """An interval for JSON; None where a peak has no bound, or none that can be known from the table."""
    return {"low": bounded(interval.low), "high": bounded(interval.high)}


@lru_cache(maxsize=256)
def _of_part(part: Stretch) -> tuple[Panel, ...]:
    """Position and its derivatives by the master in a stretch, through the extremes of its law."""
    length = part.stop - part.start
    if part.law is None:
        at = np.array([part.start, part.stop])
        return tuple(Panel("", "", (Series(at, np.full(2, 0.0 if nu else part.low)),)) for nu in range(len(QUANTITIES)))
    panels = []
    for nu, panel in enumerate(law_panels(law_of_move(part), "abcj")):
        size, base, (curve,) = part.stroke / length**nu, 0.0 if nu else part.low, panel.series
        peaks = [(part.start + length * k, size * value) for k, value in panel.peaks if nu and isfinite(value)]
        greatest = max(peaks, key=lambda peak: abs(peak[1]), default=(nan, 0.0))
        marked = (greatest,) if abs(greatest[1]) > NO_MARK else ()
        panels.append(
            Panel("", "", (Series(part.start + length * curve.at, base + size * curve.values),), peaks=marked)
        )
    return tuple(panels)

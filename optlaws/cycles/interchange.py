"""The forms in which a cycle leaves: plain data, problem files, tables, files for controllers, pictures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Unpack, get_args

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, entries_of
from optlaws.errors import InputError, OptlawsError
from optlaws.extras import needed
from optlaws.files.reading import check_names
from optlaws.files.tables import to_toml
from optlaws.laws import MotionLaw
from optlaws.laws.exporting import ExportOptions
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.motion import Motion, motion_of_pieces
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Quantity
from optlaws.shown.report import Report
from optlaws.shown.summary import Summary
from optlaws.suggest import keywords_of

#: what a picture of a cycle is over
PlotOver = Literal["time", "speed"]
FORMAT = "optlaws cycle 1"
CLOCK = ("speed", "period")
_SHOWN = 6  # segments in a line


class CycleInterchange(Declared, title="a stored cycle"):
    """The forms in which a cycle leaves, apart from the search of its laws: data, files, tables, motions, pictures."""

    @property
    def _cycle(self) -> Any:
        """The cycle itself, with its laws, peaks and proofs."""
        return self

    def to_dict(self) -> dict[str, Any]:
        """The entries of the cycle, plain and JSON-able; its laws are optimised again after reading.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_dict()["segments"][0]
        {'kind': 'rise', 'by': '35 mm', 'duration': '120 deg'}
        """
        entries = {each.name: (each, getattr(self, each.name)) for each in entries_of(type(self)).values()}
        plain = {name: each.type.plain(value) for name, (each, value) in entries.items() if value not in (None, {})}
        segments = plain.pop("segments")
        return {"format": FORMAT, **plain, "segments": segments}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        if data.get("format", FORMAT) != FORMAT:
            raise InputError(f"a stored cycle has format {FORMAT!r}, got {shortened(data['format'])}")
        return {name: value for name, value in data.items() if name != "format"}

    def to_toml(self, title: str = "Cycle", *, axis: str = "axis") -> str:
        """A problem file for `optlaws cycle`, with this cycle as its only axis; a law that is a value as its JSON text.

        Raises
        ------
        InputError
            If the load is a `Machine`: a problem file takes a mass on a spring only.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> print(Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_toml("Press", axis="slide"))
        job = "cycle"
        title = "Press"
        speed = "200 rpm"
        ...
        """
        data = self.to_dict()
        clock = {name: data[name] for name in CLOCK if name in data}
        return problem_file(title, clock, {axis: self})

    def to_pandas(self) -> Any:
        """A data frame with a row for each segment: start, duration, end, peaks, jumps; SI units.

        Needs the extra `optlaws[studies]`.
        """
        pd = needed("pandas", "to_pandas")
        cycle = self._cycle
        units = {name: unit_of(cycle.axis, nu) for nu, name in enumerate(QUANTITIES)}
        rows = []
        for peaks, joint in zip(cycle.peaks, cycle.joints, strict=True):
            row = {"segment": peaks.name, "start, s": peaks.start, "duration, s": peaks.duration}
            row |= {f"peak {name}, {units[name]}": peaks.peak(nu) for nu, name in enumerate(QUANTITIES)}
            rows.append(row | {f"jump of {name}, {units[name]}": joint[name] for name in QUANTITIES[1:3]})
        for row, taken in zip(rows, cycle.efforts if cycle.drive is not None else (), strict=False):
            name, unit = ("force", "N") if cycle.axis == "length" else ("torque", "N m")
            row |= {f"peak {name}, {unit}": taken.peak_force, f"RMS {name}, {unit}": taken.rms_force}
            row |= {"motoring power, W": taken.motoring_power, "braking power, W": taken.braking_power}
        return pd.DataFrame(rows)

    def __repr__(self) -> str:
        cycle, count = self._cycle, len(self._cycle.segments)
        names = ", ".join(segment.label for segment in cycle.segments[:_SHOWN])
        more = f", and {count - _SHOWN} more" if count > _SHOWN else ""
        return f"Cycle([{names}{more}], period={cycle.duration:.6g} s, minimise={cycle.minimise!r})"

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion over its master in machine units, which repeats; laws are optimised at this call.

        Parameters
        ----------
        master
            How far the master goes in a cycle, such as "360 deg"; None for a master that is time in seconds.
        unit
            Of positions; "mm" for lengths and "deg" for angles unless given.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> motion = cycle.motion()
        >>> round(float(motion(120.0)), 12), motion.units, round(motion.peak(1), 9)
        (35.0, Units(master='deg', slave='mm', rate=1200.0), 0.583333333)
        """
        cycle = self._cycle
        return motion_of_pieces(cycle.pieces, cycle.duration, cycle.axis, master=master, unit=unit, proof=_proof(cycle))

    @keywords_of(ExportOptions)
    def export(
        self,
        to: str,
        *,
        master: Quantity | None = "360 deg",
        unit: str | None = None,
        **options: Unpack[ExportOptions],
    ) -> Any:
        """The cycle in the format of a controller, with a report of the executed motion.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        master
            How far the master goes in a cycle; None for a master that is time in seconds.
        unit
            Of positions; "mm" for lengths and "deg" for angles unless given.
        points, counts, digits, decimal, interpolation, task, name
            As `ExportOptions` has them: how many points, of which numbers, for which task of the drive.

        Returns
        -------
        An `Export`: its `text`, its `report`, its `run`; `write(file)` writes it.

        Raises
        ------
        InputError
            If there is no such format, it takes no such option, or it cannot hold the motion.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> export = cycle.export("rockwell-cam", points=61)
        >>> export.points, round(export.report.ratio(2), 3)
        (61, 1.008)
        """
        from optlaws.exports.export import export_cycle

        return export_cycle(self, to, {"master": master, "unit": unit}, **options)

    def polynomials(self, *, master: Quantity | None = None, unit: str | None = None, tolerance: float = 1e-9) -> Any:
        """Times and polynomial coefficients of the cycle, as a `PiecewiseMotion`: `breaks` and `coefficients`.

        Over time in seconds unless a master is given; exact where laws are made of polynomials, else within
        `tolerance`, a share of the greatest stroke, over the whole cycle.

        Raises
        ------
        InputError
            If a quantity is wrong, or a law's derivatives grow without limit.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("1 m", "1 s", law="cubic"), Return(law="cubic")], period="3 s")
        >>> pieces = cycle.polynomials(unit="m")
        >>> pieces.breaks, [[round(coefficient, 9) for coefficient in row] for row in pieces.coefficients]
        ((0.0, 1.0, 3.0), [[0.0, 0.0, 3.0, -2.0], [1.0, 0.0, -0.75, 0.25]])
        """
        from optlaws.exports.polynomial_pieces import pieces_of_motion

        return pieces_of_motion(self.motion(master, unit), tolerance)

    def plot(self, ax: Any = None, *, over: PlotOver = "time", **style: Any) -> list[Any]:
        """Draw position, velocity, acceleration and jerk over time, with segments and limits; return the artists.

        `ax` are four axes of matplotlib, six of a cycle with a drive, which have torque and power as well, or one for
        all, where every curve is divided by its peak; a new figure unless given. Over the "speed" it is torque over
        speed at the motor, with the motor's curves, into one pair of axes. `style` is what `Axes.plot` takes, for the
        curves.

        Raises
        ------
        InputError
            If the cycle has no motor, or is drawn over something else.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [artist.axes.get_ylabel() for artist in cycle.plot()][2]
        'acceleration, m/s²'
        """
        from optlaws.plots.cycle import draw_cycle
        from optlaws.plots.machine import draw_motor_of_cycle

        cycle = self._cycle
        check_names([over], get_args(PlotOver), "over")
        if over == "time":
            return draw_cycle(cycle, ax, **style)
        return draw_motor_of_cycle(cycle, ax, **style)

    def summary(self) -> Summary:
        """The proof of the cycle, its peaks, its drive and its joints, as rows in SI units.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [f"{row.name} {row.text(4)} {row.unit} at {row.place:g} s" for row in cycle.summary()[:2]]
        ['peak velocity 0.7 m/s at 0.05 s', 'peak acceleration 21.99 m/s² at 0.075 s']
        """
        return self.report().facts

    def report(self) -> Report:
        """The facts of the cycle, the table of its segments and its curves, as tables, pictures and pages show them.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> report = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s").report()
        >>> [(panel.title, round(panel.peak, 3)) for panel in report.panels[:2]]
        [('position, mm', 35.0), ('velocity, mm/s', 700.0)]
        """
        from optlaws.cycles.report import CycleReport

        return CycleReport(self._cycle)

    def _repr_html_(self) -> str:
        """A cycle as HTML; where its laws cannot be had, the error in their place.

        >>> from optlaws import Cycle, Return, Rise
        >>> shown = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")._repr_html_()
        >>> shown.count("<svg"), "acceleration, m/s²" in shown
        (4, True)
        """
        from optlaws.shown.report import report_page
        from optlaws.shown.showing import facts, page

        try:
            return report_page("Cycle", self.report())
        except OptlawsError as error:
            return page("Cycle", facts({"turn, s": self._cycle.duration, "error": error}))


def problem_file(
    title: str, clock: Mapping[str, Any], cycles: Mapping[str, CycleInterchange], more: Mapping[str, Any] | None = None
) -> str:
    """A problem file of the job "cycle" with a clock, its speed or period, an axis for each cycle, and more entries."""
    axes = [_axis_entries(name, cycle) for name, cycle in cycles.items()]
    return to_toml(
        {
            "job": "cycle",
            "title": title,
            **clock,
            "axis": axes,
            **{name: value for name, value in (more or {}).items() if value},
        }
    )


def _axis_entries(axis: str, cycle: CycleInterchange) -> dict[str, Any]:
    data = {name: value for name, value in cycle.to_dict().items() if name not in {"format", *CLOCK}}
    segments = data.pop("segments")
    for segment in segments:
        if isinstance(segment.get("law"), dict):
            segment["law"] = MotionLaw.from_dict(segment["law"]).to_json()
    if "A" in data.get("load", {}):
        raise InputError("load: a problem file takes a mass on a spring only: Cycle.to_json stores a machine")
    return {"name": axis, **data, **_drive_tables(cycle._cycle.drive), "segment": segments}  # noqa: SLF001


def _drive_tables(drive: Any) -> dict[str, Any]:
    """A mechanism, and the motor before it, as the tables of an axis; nothing of a drive of constants."""
    if isinstance(drive, Mechanism):
        entries = {name: value for name, value in drive.to_dict().items() if name != "format"}
        return {"drive": None, "mechanism": {"kind": "table", **entries}}
    if isinstance(drive, Drive):
        entries = {name: value for name, value in drive.to_dict().items() if name != "mechanism"}
        return {**_drive_tables(drive.mechanism), "drive": entries}
    return {}


def _proof(cycle: Any) -> tuple[str, ...]:
    """The proof of the optimised laws, as text for files."""
    if not cycle.solutions:
        return ()
    bound = "" if cycle.lower_bound is None else f", none below {cycle.lower_bound:.9g}"
    least = f"least {cycle.minimise} {cycle.objective:.9g}{bound} (SI units) of {cycle.search_space}"
    return (f"laws looked for: {len(cycle.solutions)}, status {cycle.status.value}; {least}", *cycle.remarks)

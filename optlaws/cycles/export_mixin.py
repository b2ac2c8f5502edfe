"""The exports of a cycle: its motion in units, tables for controllers, polynomials, pictures, a notebook page."""

from __future__ import annotations

from typing import Any, Unpack

from optlaws.laws.exporting import ExportOptions
from optlaws.motion.motion import Motion, motion_of_pieces
from optlaws.numbers import Quantity
from optlaws.shown.summary import Summary
from optlaws.suggest import keywords_of


class ExportMixin:
    """The exports of a cycle, apart from how its laws are found."""

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion over its master in machine units, which repeats; optimal laws are looked for now.

        Parameters
        ----------
        master
            How far the master goes in a cycle, such as "360 deg"; None for a master that is time in seconds.
        unit
            Of positions; "mm" for lengths and "deg" for angles unless given.

        Raises
        ------
        InputError
            If the quantity or the unit is wrong.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> motion = cycle.motion()
        >>> round(float(motion(120.0)), 12), motion.units, round(motion.peak(1), 9)
        (35.0, Units(master='deg', slave='mm', rate=1200.0), 0.583333333)
        """
        cycle: Any = self
        return motion_of_pieces(cycle.pieces, cycle.duration, cycle.axis, master=master, unit=unit, proof=_proof(cycle))

    @keywords_of(ExportOptions)
    def export(
        self,
        to: str,
        *,
        master: Quantity | None = "360 deg",
        unit: str | None = None,
        **options: Unpack[ExportOptions],
    ) -> Any:  # noqa: ANN401 - made a layer above
        """The cycle in the format of a controller, with what the controller will run.

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
        >>> made = cycle.export("rockwell-cam", points=61)
        >>> made.points, round(made.report.ratio(2), 3)
        (61, 1.008)
        """
        from optlaws.exports.export import export_cycle

        return export_cycle(self, to, {"master": master, "unit": unit}, **options)

    def polynomials(self, *, master: Quantity | None = None, unit: str | None = None, tolerance: float = 1e-9) -> Any:  # noqa: ANN401
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

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:  # noqa: ANN401 - matplotlib's
        """Draw position, velocity, acceleration and jerk over time, with segments and limits, by matplotlib.

        Parameters
        ----------
        ax
            Four axes, or one for all, where every curve is divided by its peak; a new figure unless given.
        style
            What `Axes.plot` takes, for the curves.

        Returns
        -------
        The artists; `[0].figure` is the figure.

        Raises
        ------
        InputError
            If there are neither one nor four axes.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [artist.axes.get_ylabel() for artist in cycle.plot()][2]
        'acceleration, m/s²'
        """
        from optlaws.plots.cycle import draw_cycle

        cycle: Any = self
        return draw_cycle(cycle, ax, **style)

    def summary(self) -> Summary:
        """The proof of the cycle, its peaks, its drive and its joints, as rows in SI units.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If there are no laws.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [f"{row.name} {row.text(4)} {row.unit} at {row.place:g} s" for row in cycle.summary()[:2]]
        ['peak velocity 0.7 m/s at 0.05 s', 'peak acceleration 21.99 m/s² at 0.075 s']
        """
        from optlaws.cycles.summary import summary

        cycle: Any = self
        return summary(cycle)

    def _repr_html_(self) -> str:
        from optlaws.cycles.summary import cycle_page

        cycle: Any = self
        return cycle_page(cycle)


def _proof(cycle: Any) -> tuple[str, ...]:  # noqa: ANN401 - a Cycle
    """The proof of the laws that were looked for, as files say it."""
    if not cycle.solutions:
        return ()
    bound = "" if cycle.lower_bound is None else f", none below {cycle.lower_bound:.9g}"
    least = f"least {cycle.minimise} {cycle.objective:.9g}{bound} (SI units) of {cycle.search_space}"
    return (f"laws looked for: {len(cycle.solutions)}, status {cycle.status.value}; {least}", *cycle.remarks)

"""The forms in which an exact motion leaves: files for controllers, polynomials, a report, a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

from optlaws.echo import keywords_of
from optlaws.errors import OptlawsError
from optlaws.laws.law import ExportOptions
from optlaws.numbers import Quantity

if TYPE_CHECKING:
    from optlaws.motion.motion import Motion
    from optlaws.shown.report import Report
    from optlaws.shown.summary import Summary


class Exportable:
    """The forms in which an exact motion leaves: files for controllers, polynomials, a report, a page."""

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion over its master in machine units; laws are optimised at this call.

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
        raise NotImplementedError

    def report(self) -> Report:
        """The facts, the table of the segments and the curves, as tables, pictures and pages show them.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> report = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s").report()
        >>> [(panel.title, round(panel.peak, 3)) for panel in report.panels[:2]]
        [('position, mm', 35.0), ('velocity, mm/s', 700.0)]
        """
        raise NotImplementedError

    def summary(self) -> Summary:
        """The facts of the report: proofs, peaks and what is taken of drives and limits, as rows in SI units."""
        return self.report().facts

    @keywords_of(ExportOptions)
    def export(
        self, to: str, *, master: Quantity | None = "360 deg", unit: str | None = None, **options: Unpack[ExportOptions]
    ) -> Any:
        """The motion in the format of a controller, with a report of the executed motion: an `Export`.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        master, unit
            As of `motion`; the master of a transition begins at 0.
        points, counts, digits, decimal, interpolation, task, name
            As `ExportOptions` has them: how many points, of which numbers, for which task of the drive.

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
        """Times and polynomial coefficients of the motion, as a `PiecewiseMotion`: `breaks` and `coefficients`.

        Over time in seconds unless a master is given; exact where laws are made of polynomials, else within
        `tolerance`, a share of the greatest stroke, over the whole motion.

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

    def _repr_html_(self) -> str:
        """The report as HTML; where laws cannot be had, the error in its place."""
        from optlaws.shown.report import report_page
        from optlaws.shown.showing import facts, page

        try:
            return report_page(type(self).__name__, self.report())
        except OptlawsError as error:
            return page(type(self).__name__, facts({"error": error}))

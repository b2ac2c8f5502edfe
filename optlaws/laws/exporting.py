"""The export of laws: what every export takes, and how a law, or what has one, is handed to a format."""

from __future__ import annotations

from typing import Any, Literal, TypedDict, Unpack

from optlaws.numbers import Quantity
from optlaws.suggest import keywords_of

#: of which each format takes some
Interpolation = Literal["linear", "cubic", "spline", "akima", "c1", "quintic", "septic"]


class AxesExportOptions(TypedDict, total=False):
    """The options of exports to controllers; each format has some of them, as `optlaws export --list` shows.

    Parameters
    ----------
    points
        How many points, or "best", as it is unless given: the fewest whose run is as good as that of any number.
        Formats of polynomials take a number, or as few pieces as will do unless given.
    counts
        Steps of the slave's encoder over the stroke, to which positions are rounded.
    digits, decimal
        Digits behind the decimal sign, and the sign, "." or ",", of tables as text.
    interpolation
        The interpolation of the controller, where the format can state it.
    task
        Time of the drive's task, such as "1 ms": the report then says what it samples once in each.
    """

    points: int | Literal["best"] | None
    counts: int | None
    digits: int | None
    decimal: Literal[".", ","] | None
    interpolation: Interpolation | None
    task: Quantity | None


class ExportOptions(AxesExportOptions, total=False):
    """The options of an export of one motion: `name` of the variable, the table or the joint, "Cam" unless given."""

    name: str | None


class LawExport:
    """The export of a law, or of a value with a law and its proof."""

    @keywords_of(ExportOptions)
    def export(
        self,
        to: str,
        *,
        stroke: Quantity | None = None,
        duration: Quantity | None = None,
        master: Quantity | None = None,
        start: Quantity | None = None,
        **options: Unpack[ExportOptions],
    ) -> Any:
        """The law in the format of a controller, with the executed motion and the proof of the law.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        stroke
            How far the slave moves, "35 mm" or "-20 deg": positions are in its unit.
        duration, master
            How long it takes, "0.1 s", and how far the master goes meanwhile, "120 deg"; one of them or both. Without
            a master it is time in seconds.
        start
            Position at the start; 0 unless given.
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
        >>> from optlaws import smoothstep
        >>> table = smoothstep(4).export("csv", stroke="40 mm", master="120 deg", counts=65536, points=361)
        >>> round(table.report.ratio(2), 1), round(table.report.bound / table.report.law.peak(2), 1)
        (1.9, 1.6)
        >>> import optlaws
        >>> basis = optlaws.Pieces(8, degree=7, continuity=3)
        >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=basis))
        >>> program = solution.export("codesys-cambuilder", stroke="35 mm", duration="0.1 s", master="120 deg")
        >>> [line.strip() for line in program.text.splitlines() if "none below" in line]
        ['law: least C = 4.59646..., none below 4.59646... in its space; status optimal']
        """
        from optlaws.exports.export import export_law

        law, proof = self._exported()
        return export_law(
            law, to, {"stroke": stroke, "duration": duration, "master": master, "start": start}, proof, **options
        )

    def _exported(self) -> tuple[Any, tuple[str, ...]]:
        """The law and its proof, as text for files."""
        return self, ()

"""What axes of a machine have in common with the plan of axes that overlap: motions, clearances, exports, pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal, TypeAlias, Unpack

from optlaws.cycles.axes.interlock import LeastClearance
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specified import CLOCK, problem_file
from optlaws.echo import keywords_of
from optlaws.errors import needed
from optlaws.files.reading import check_names
from optlaws.laws.law import AxesExportOptions
from optlaws.motion.quantities import Derived, Exact
from optlaws.numbers import Quantity
from optlaws.shown.report import Report

#: what pictures of axes show
AxesPicture: TypeAlias = Literal["motion", "timing", "plane", "clearance"]


class AxesAnswers(Mapping[str, Cycle]):
    """What axes, and axes that overlap, have of the cycles of their axes by their names."""

    def solve(self) -> Any:
        """The axes that answer."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> Cycle:
        check_names([name], tuple(self), "axis")
        cycle: Cycle = self.solve().cycles[name]
        return cycle

    def __contains__(self, name: object) -> bool:
        return name in self.solve().cycles

    def __iter__(self) -> Iterator[str]:
        return iter(self.solve().cycles)

    def __len__(self) -> int:
        return len(self.solve().cycles)

    def __call__(self, time: Any, nu: int = 0) -> dict[str, Any]:
        """Position (nu 0), velocity, acceleration, jerk of every axis at times in seconds, in SI units."""
        return {name: cycle(time, nu) for name, cycle in self.items()}

    def at_angle(self, degrees: Any, nu: int = 0) -> dict[str, Any]:
        """The motion of every axis at an angle of the master, in degrees or a text such as "0.5 rad"."""
        return {name: cycle.at_angle(degrees, nu) for name, cycle in self.items()}

    @property
    def duration(self) -> float:
        """Duration of the cycle in seconds."""
        return next(iter(self.values())).duration

    @property
    def clearances(self) -> tuple[LeastClearance, ...]:
        """The least clearance of every interlock, its place and its margin, proven over the whole cycle."""
        clearances: tuple[LeastClearance, ...] = self.solve().drawn.clearances
        return clearances

    @property
    def broken(self) -> tuple[LeastClearance, ...]:
        """The interlocks that are not proven clear."""
        return tuple(least for least in self.clearances if least.status != "clear")

    @keywords_of(AxesExportOptions)
    def export(
        self,
        to: str | Mapping[str, str],
        *,
        master: Quantity | None = "360 deg",
        together: bool = False,
        **options: Unpack[AxesExportOptions],
    ) -> dict[str, Any]:
        """Every axis in the format of a controller, or each named axis in its own: an `Export` by the name of the axis.

        Variables and tables are called as the axes are, in letters and digits: `weld_head` for a "weld head".

        Parameters
        ----------
        to
            A format for all, or formats by the names of axes.
        together
            One file for all axes, where the format holds several: "ros2" one trajectory of several joints, "csv" one
            table with columns for each axis.
            The `text` of every export is then that of all, and each joint has the points of all.
        master, points, counts, digits, decimal, interpolation, task
            As in `Cycle.export`, for every axis.

        Raises
        ------
        InputError
            If an axis is unknown, or a format cannot hold its motion; the error names the axis.

        Examples
        --------
        >>> from optlaws import Axes, Return, Rise
        >>> both = Axes(
        ...     {"x": [Rise("35 mm", "0.1 s"), Return()], "y": [Rise("9 deg", "0.1 s"), Return()]}, period="0.3 s"
        ... )
        >>> [(name, export.points) for name, export in both.export("codesys-xyva", points=91).items()]
        [('x', 91), ('y', 91)]
        >>> joints = both.export("ros2", together=True, points=7)
        >>> joints["x"].text.splitlines()[1:5], joints["x"].text == joints["y"].text
        (['joint_names:', '- "x"', '- "y"', 'points:'], True)
        """
        from optlaws.exports.export import export_axes, export_together

        if together:
            return export_together(self, to, {"master": master}, **options)
        formats = to if isinstance(to, Mapping) else dict.fromkeys(self, to)
        return export_axes(self, formats, {"master": master}, **options)

    def to_toml(self, title: str = "Machine") -> str:
        """A problem file for `optlaws cycle` with all axes.

        Raises
        ------
        InputError
            If a law is a value: a problem file names laws, or JSON files that hold them.

        Examples
        --------
        >>> from optlaws import Axes, Return, Rise
        >>> print(Axes({"slide": [Rise("35 mm", "120 deg"), Return()]}, speed="200 rpm").to_toml("Press"))
        job = "cycle"
        title = "Press"
        speed = "200 rpm"
        ...
        """
        interlocks = [interlock.to_dict() for interlock in self.solve().rules]
        cycles = [cycle.specification for cycle in self.values()]
        given = {name: {getattr(cycle, name) for cycle in cycles} for name in CLOCK}
        # the words of what was given, where all axes have the same
        clock = next(
            ({name: each} for name, (each, *more) in given.items() if not more and not isinstance(each, Derived)),
            {"period": Exact(self.duration, "s")},
        )
        return problem_file(title, clock, self, {"interlocks": interlocks})

    def to_pandas(self) -> Any:
        """A data frame with a row for each segment of each axis: start, duration, peaks, jumps; SI units.

        Needs the extra `optlaws[studies]`.
        """
        pd = needed("pandas", "to_pandas")
        return pd.concat({name: cycle.to_pandas() for name, cycle in self.items()}, names=["axis", "segment number"])

    def plot(
        self,
        ax: Any = None,
        *,
        what: AxesPicture = "motion",
        nu: int = 0,
        interlock: int | str = 0,
        **style: Any,
    ) -> list[Any]:
        """Draw all axes by matplotlib, and return the artists.

        Parameters
        ----------
        ax
            Axes of matplotlib, else of a new figure. Motions are drawn into as many as there are axes, or into one,
            where every curve is divided by its peak; clearances into as many as there are interlocks.
        what
            "motion": all axes over one time, one below the other. "timing": the timing diagram, a bar for each move,
            with an arrow for each `After`. "plane": the path in the plane of two positions, with what is forbidden.
            "clearance": the clearance of every interlock over time.
        nu
            Of motions: position (0), velocity, acceleration or jerk (3).
        interlock
            Of a plane: the number of an interlock or its name; its axes are drawn, with all that is forbidden to them.
        style
            What `Axes.plot` of matplotlib takes.

        Raises
        ------
        InputError
            If `ax` are not as many as are drawn, or an interlock is not there.

        Examples
        --------
        >>> from optlaws import After, Axes, Dwell, Return, Rise
        >>> table = {"segments": [Rise("45 deg", "0.4 s", law="cycloidal"), Dwell()], "advance": "45 deg"}
        >>> head = [Dwell("0.3 s"), Rise("250 mm", "0.2 s", law="cycloidal"), Dwell("1.2 s"), Return(law="cycloidal")]
        >>> rule = After("head", "50 mm", of="table", above="44 deg", way="up")
        >>> machine = Axes({"table": table, "head": head}, period="2 s", interlocks=[rule])
        >>> [label.get_text() for label in machine.plot(what="timing")[0].axes.get_yticklabels()]
        ['table', 'head']
        """
        if what == "motion":
            from optlaws.plots.cycle import draw_axes

            return draw_axes(self, ax, nu=nu, **style)
        from optlaws.plots.interlocks import draw_interlocked

        return draw_interlocked(self.solve().drawn, ax, what, interlock, style)

    def report(self) -> Report:
        """The proven clearances, limits that axes break, and every position and clearance over the master."""
        drawn: Report = self.solve().drawn
        return drawn

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import Html, page

        return page(
            type(self).__name__, *(Html(f"<h4>{name}</h4>{cycle._repr_html_()}") for name, cycle in self.items())
        )

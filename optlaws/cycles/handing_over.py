"""What a cycle is handed over as: tables for controllers, polynomials, pictures, a page in a notebook."""

from __future__ import annotations

from typing import Any

from optlaws.exporting import exported
from optlaws.plotting import plotted


class Handed:
    """What a cycle is handed over as."""

    def export(
        self,
        to: str,
        *,
        master: Any = "360 deg",  # noqa: ANN401 - a quantity
        unit: str | None = None,
        points: int | str | None = None,
        counts: int | None = None,
        digits: int | None = None,
        decimal: str | None = None,
        interpolation: str | None = None,
        task: str | None = None,
        name: str | None = None,
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
            As in `MotionLaw.export`.

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
        said = {"master": master, "unit": unit}
        asked = {"points": points, "counts": counts, "digits": digits, "decimal": decimal}
        return exported("cycle", self, to, said, **asked, interpolation=interpolation, task=task, name=name)

    def polynomials(self, *, master: Any = None, unit: str | None = None, tolerance: float = 1e-9) -> Any:  # noqa: ANN401
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
        return exported("pieces_of_cycle", self, tolerance, master=master, unit=unit)

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
        return plotted("cycle", self, ax, **style)

    def _repr_html_(self) -> str:
        from optlaws.cycles.notebook import cycle_page

        return cycle_page(self)

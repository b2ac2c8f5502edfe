"""The option --fastest of `optlaws solve`: the least time of a move within limits, and its proof."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import Signed, save, save_figure
from optlaws.cli.show import print_json, show, table
from optlaws.echo import shortened
from optlaws.errors import InputError

_OPTIONS = {"limits": "--limit", "stroke": "--stroke", "start_velocity": "--start-velocity"}


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class MoveOptions:
    """Options of a move whose least time is computed.

    Parameters
    ----------
    fastest
        Find the least time of a move within limits, and the law that takes it; with --stroke and --limit.
    stroke
        Of the fastest move, such as "100 mm" or "90 deg".
    limits
        Of the fastest move: "velocity=1 m/s", "acceleration=-8 m/s^2, 12 m/s^2", deceleration, jerk, snap; may be
        repeated.
    start_velocity
        Of the fastest move at its start, such as "0.2 m/s"; rest unless given.
    end_velocity
        The same at its end.
    """

    fastest: Annotated[bool, Parameter(negative="")] = False
    stroke: Signed = None
    limits: Annotated[list[str] | None, Parameter(name="--limit", allow_leading_hyphen=True)] = None
    start_velocity: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None
    end_velocity: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None

    def check(self) -> None:
        """Refuse options of a move without --fastest, and --fastest without its compulsory options."""
        if self.fastest and (self.stroke is None or not self.limits):
            raise InputError('--fastest needs --stroke, such as "100 mm", and --limit, such as "jerk=300 m/s^3"')
        given = [name for name, value in asdict(self).items() if value is not None and name != "fastest"]
        if given and not self.fastest:
            raise InputError(f"{_OPTIONS.get(given[0], '--end-velocity')} goes with --fastest")


WITHOUT_MOVE = MoveOptions()


def answer(
    problem: optlaws.Problem, move: MoveOptions, *, as_json: bool, output: Path | None, plot: Path | None
) -> None:
    """Print the least time, write law and proof into a file, and draw the motion into another."""
    given = {name: value for name, value in asdict(move).items() if name != "fastest"}
    result = optlaws.fastest(problem, **given | {"limits": read_limits(move.limits or [])})
    whole = result.to_dict()
    if output is not None:
        save(output, whole)
    if plot is not None:
        from optlaws.plots.moves import motion_figure

        save_figure(plot, motion_figure(result, f"{move.stroke} in {result.duration:.6g} s"))
    if as_json:
        rest = {"none_below": result.none_below, "binding": list(result.binding), "gains": result.gains()}
        print_json({name: whole[name] for name in ("unit", "stroke", "limits", "duration", "limit")} | rest)
    else:
        rows = ([row.name, row.text(), row.unit, row.note] for row in result.summary())
        show(table("", "value", "unit", "note", rows=rows))


def read_limits(texts: list[str]) -> dict[str, Any]:
    """Limits by name from texts such as "velocity=1 m/s"; a comma separates a least and a greatest value."""
    limits: dict[str, Any] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or name in limits:
            what = "is given twice" if name in limits else 'is a name = a quantity, such as "velocity=1 m/s"'
            raise InputError(f"--limit {shortened(text)}: a limit {what}")
        parts = [part.strip() for part in value.split(",")]
        limits[name] = parts[0] if len(parts) == 1 else parts
    return limits

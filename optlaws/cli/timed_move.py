"""The option --fastest of `optlaws solve`: the least time of a move within limits, and its proof."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import optlaws
from optlaws.cli.options import given, options, save, save_figure
from optlaws.cli.show import print_json, show
from optlaws.echo import shortened
from optlaws.errors import InputError


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


#: of limits, each of which is an option of its own
LIMITS: dict[str, Any] = {"name": "--limit", "type": list[str], "read": read_limits, "signed": True}
#: of a move whose least time is computed
MOVE = options(
    optlaws.fastest, "stroke", "start_velocity", "end_velocity", group="The move of --fastest", limits=LIMITS
)


def check_move(move: Mapping[str, Any], *, fastest: bool) -> None:
    """Refuse options of a move without --fastest, and --fastest without its compulsory options."""
    if fastest and (move["stroke"] is None or not move["limits"]):
        raise InputError('--fastest needs --stroke, such as "100 mm", and --limit, such as "jerk=300 m/s^3"')
    for name in () if fastest else given(move):
        raise InputError(f"{MOVE[name].name} goes with --fastest")


def answer(
    problem: optlaws.Problem, move: Mapping[str, Any], *, as_json: bool, output: Path | None, plot: Path | None
) -> None:
    """Print the least time, write law and proof into a file, and draw the motion into another."""
    result = optlaws.fastest(problem, **move)
    whole = result.to_dict()
    save(output, whole)
    if plot is not None:
        from optlaws.plots.moves import motion_figure

        save_figure(plot, motion_figure(result, f"{move['stroke']} in {result.duration:.6g} s"))
    if as_json:
        rest = {"none_below": result.none_below, "binding": list(result.binding), "gains": result.gains()}
        print_json({name: whole[name] for name in ("unit", "stroke", "limits", "duration", "limit")} | rest)
    else:
        show(result.summary())

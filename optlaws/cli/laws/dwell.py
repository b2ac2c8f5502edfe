"""The command `optlaws dwell`: balancing mechanisms for motions with dwells, compared."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from importlib import import_module
from math import degrees, gcd, inf
from typing import TYPE_CHECKING, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Plot, Whole, check_files, read_law, save_figure
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.balancing.dwells.choice import DwellComparison
    from optlaws.balancing.dwells.clutch import Teeth

_TEETH = 3
_SIZES = ("a", "b", "S1", "S2")
_TURN = 360.0 * (1.0 + 1e-9)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class DwellAngles:
    """Angles of the mechanism, and ratios.

    Parameters
    ----------
    dwell
        Upper dwell, degrees.
    rise
        Rise, and return, degrees.
    swing
        Swing of the executive rocker, degrees.
    radius_ratio
        Least radius of the cams over the stroke of the executive link.
    inertia_ratio
        Inertia of the loader's rocker over the executive inertia.
    clutch_angle
        Angle in which the clutch acts at either end of a dwell, degrees.
    lower_dwell
        Lower dwell, degrees; 0 for none, the upper one unless given.
    """

    dwell: float
    rise: float
    swing: float
    radius_ratio: float
    inertia_ratio: float
    clutch_angle: float
    lower_dwell: float | None = None

    def in_radians(self) -> dict[str, Any]:
        """All angles of the command, in radians."""
        given = {name: value for name, value in asdict(self).items() if value is not None}
        return {name: value if name.endswith("ratio") else optlaws.deg(value) for name, value in given.items()}


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class DwellLaws:
    """Laws of the loader in the dwells, as names of the catalogue or files.

    Parameters
    ----------
    law_1
        Law of run-out and run-up of type II; the executive law by default.
    law_2
        Law of the reverse motion of type II and of run-out and run-up of type III; the executive law by default.
    """

    law_1: str | None = None
    law_2: str | None = None

    def read(self) -> dict[str, Any]:
        """The given laws by their names."""
        return {name: read_law(text) for name, text in asdict(self).items() if text is not None}


_EXECUTIVE = DwellLaws()


def dwell(
    name: str,
    /,
    *,
    angles: DwellAngles,
    most_torque: float,
    most_size: float = inf,
    laws: DwellLaws = _EXECUTIVE,
    teeth: Whole = 120,
    plot: Plot = None,
    as_json: AsJson = False,
) -> None:
    """Compare balancing mechanisms of types I, II and III for an executive link that dwells, and choose one.

    Parameters
    ----------
    name
        Executive law: a name or code of the catalogue, or a JSON or CSV file with a law.
    most_torque
        Greatest residual torque b that is acceptable.
    most_size
        Greatest size a of the cam that is acceptable.
    teeth
        Greatest number of teeth of the clutch.
    plot
        Draw position and speed of each type's loader over the cam's angle into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else; angles in radians.
    """
    check_files(plot=plot)
    _check_turn(angles.rise, angles.dwell, angles.lower_dwell)
    comparison = optlaws.compare_dwell_mechanisms(
        law=read_law(name),
        most_torque=most_torque,
        most_size=most_size,
        **laws.read(),
        **angles.in_radians(),
    )
    clutches = {kind: optlaws.Clutch(mechanism) for kind, mechanism in comparison.mechanisms.items() if kind != "I"}
    if plot is not None:
        # a script that comes with optlaws, which type checkers find under problems/
        save_figure(plot, import_module("optlaws.problems.dwell_drawing").draw_motions(comparison.mechanisms))
    if as_json:
        print_json(_plain(comparison, clutches, teeth))
    else:
        _show(comparison, clutches, teeth)


def _check_turn(rise: float, dwell: float, lower_dwell: float | None) -> None:
    """Refuse angles that exceed one turn of the cam; the answer reports angles that fill less than a turn."""
    cycle = 2.0 * rise + dwell + (dwell if lower_dwell is None else lower_dwell)
    if cycle > _TURN:
        lower = "the lower dwell, as long as the upper one," if lower_dwell is None else "--lower-dwell"
        raise InputError(
            f"--rise, the return as long, --dwell and {lower} add up to {cycle:.6g} degrees, more than one turn; "
            "shorten them, or give a shorter --lower-dwell"
        )


def _show(comparison: DwellComparison, clutches: dict[str, optlaws.Clutch], teeth: int) -> None:
    types = table("type", "a", "b", "S1", "S2", "usable")
    for kind, reason in comparison.reasons.items():
        known = comparison.mechanisms.get(kind)
        types.add_row(kind, *("" if known is None else f"{getattr(known, name):.6g}" for name in _SIZES), reason)
    chosen = (
        "none is usable" if comparison.chosen is None else f"type {comparison.chosen}, the smallest cam of those usable"
    )
    remarks = {remark for mechanism in comparison.mechanisms.values() for remark in mechanism.remarks}
    show(*(f"mind: {remark}" for remark in sorted(remarks)))
    show(types, f"take {chosen}; the paper's rule of thumb says {comparison.by_rule}")
    teeth_of = table("clutch", "p/N wanted", "p", "N", "off by, deg", "exact with")
    for kind, clutch in clutches.items():
        for choice in _choices(clutch, teeth):
            error = f"{degrees(choice.error):.4f}"
            teeth_of.add_row(kind, f"{clutch.ratio:.8g}", str(choice.p), str(choice.N), error, _remedy(choice))
    if clutches:
        show(teeth_of)


def _choices(clutch: optlaws.Clutch, teeth: int) -> tuple[Teeth, ...]:
    choices = [choice for choice in clutch.choices(1, teeth) if gcd(choice.p, choice.N) == 1]
    return tuple(choices[:_TEETH]) or (clutch.nearest(teeth),)


def _remedy(choice: Teeth) -> str:
    angles = {"swing": choice.swing, "dwell": choice.dwell, "rise": choice.rise}
    remedies = [f"{name} {degrees(value):.5g}" for name, value in angles.items() if value is not None]
    remedies += [] if choice.B2 is None else [f"B2 = {choice.B2:.5g}"]
    return " or ".join(remedies)


def _plain(comparison: DwellComparison, clutches: dict[str, optlaws.Clutch], teeth: int) -> dict[str, Any]:
    return {
        "chosen": comparison.chosen,
        "by_rule": comparison.by_rule,
        "reasons": dict(comparison.reasons),
        "types": {kind: mechanism.to_dict() for kind, mechanism in comparison.mechanisms.items()},
        "clutches": {
            kind: {
                "ratio": clutch.ratio,
                "teeth": [
                    {"p": choice.p, "N": choice.N, "error": choice.error, "swing": choice.swing, "B2": choice.B2}
                    for choice in _choices(clutch, teeth)
                ],
            }
            for kind, clutch in clutches.items()
        },
    }

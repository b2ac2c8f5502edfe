"""The commands `optlaws loader` and `optlaws dwell`: inertial loaders, and balancing mechanisms for dwells."""

from __future__ import annotations

import json
from math import degrees, gcd, inf
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.table import Table

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.choice import DwellComparison, compare_dwell_mechanisms
from optlaws.mechanisms.dwell.clutch import Clutch, Teeth
from optlaws.mechanisms.loader.loader import Loader
from optlaws.mechanisms.loader.loader import loader as loader_of

_TEETH = 3


def loader(
    name: str,
    /,
    *,
    executive_mass: float | None = None,
    executive_stroke: float | None = None,
    mass: float | None = None,
    stroke: float | None = None,
    as_json: Annotated[bool, Parameter(name="--json")] = False,
    output: Path | None = None,
) -> None:
    """Inertial loader that balances a law: energy parameter Y, peaks of its motion, its mass or stroke.

    Parameters
    ----------
    name
        Executive law: a name or code of the catalogue, or a JSON file with a law or a solution.
    executive_mass
        Mass that the executive link moves, kg (or moment of inertia, kg m²).
    executive_stroke
        Its stroke, m (or swing, rad).
    mass
        Mass of the loader, for which its stroke is sought.
    stroke
        Stroke of the loader, for which its mass is sought.
    as_json
        Print one JSON object on stdout and nothing else.
    output
        Write the loader's law to this JSON file.
    """
    one = loader_of(_law(name))
    machine = _machine(one, executive_mass, executive_stroke, mass, stroke)
    if output is not None:
        from optlaws.files.writing import MARK, write

        write(output, json.dumps({"about": MARK, "law": one.law.to_dict()}, indent=1) + "\n")
    if as_json:
        print(json.dumps(one.to_dict() | machine))  # noqa: T201
    else:
        _show_loader(one, machine)


def dwell(
    name: str,
    /,
    *,
    dwell: float,
    rise: float,
    swing: float,
    radius_ratio: float,
    inertia_ratio: float,
    clutch_angle: float,
    most_torque: float,
    most_size: float = inf,
    lower_dwell: float | None = None,
    law_1: str | None = None,
    law_2: str | None = None,
    teeth: int = 120,
    as_json: Annotated[bool, Parameter(name="--json")] = False,
) -> None:
    """Balancing mechanisms of types I, II and III for an executive link that dwells, and which of them to take.

    Parameters
    ----------
    name
        Executive law: a name or code of the catalogue, or a JSON file with a law or a solution.
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
    most_torque
        Greatest residual torque b that is acceptable.
    most_size
        Greatest size a of the cam that is acceptable.
    lower_dwell
        Lower dwell, degrees; 0 for none, the upper one unless given.
    law_1
        Law of run-out and run-up of type II; the executive law unless given.
    law_2
        Law of the reverse motion of type II and of run-out and run-up of type III; the executive law unless given.
    teeth
        Greatest number of teeth of the clutch.
    as_json
        Print one JSON object on stdout and nothing else; angles in radians.
    """
    found = compare_dwell_mechanisms(
        law=_law(name),
        dwell=deg(dwell),
        rise=deg(rise),
        swing=deg(swing),
        radius_ratio=radius_ratio,
        inertia_ratio=inertia_ratio,
        clutch_angle=deg(clutch_angle),
        most_torque=most_torque,
        most_size=most_size,
        lower_dwell=None if lower_dwell is None else deg(lower_dwell),
        law_1=None if law_1 is None else _law(law_1),
        law_2=None if law_2 is None else _law(law_2),
    )
    clutches = {kind: Clutch(one) for kind, one in found.mechanisms.items() if kind != "I"}
    if as_json:
        print(json.dumps(_plain(found, clutches, teeth)))  # noqa: T201
    else:
        _show_dwell(found, clutches, teeth)


def _law(text: str) -> MotionLaw:
    if not text.endswith(".json"):
        return catalogue[text].law
    data = reading.json_file(Path(text))
    if isinstance(data, dict) and "kind" not in data and "law" in data:
        data = data["law"]
    try:
        return MotionLaw.from_dict(data)
    except InputError as error:
        raise InputError(f"{text}: {error}") from None


def _machine(
    one: Loader, executive_mass: float | None, executive_stroke: float | None, mass: float | None, stroke: float | None
) -> dict[str, float]:
    if executive_mass is None and executive_stroke is None and mass is None and stroke is None:
        return {}
    if executive_mass is None or executive_stroke is None or (mass is None) == (stroke is None):
        raise InputError("--executive-mass and --executive-stroke go together with either --mass or --stroke")
    given = {"executive_mass": executive_mass, "executive_stroke": executive_stroke}
    if stroke is not None:
        return {"mass": one.mass(**given, stroke=stroke), "stroke": stroke}
    if mass is None:  # the check above leaves nothing else
        return {}
    return {"mass": mass, "stroke": one.stroke(**given, mass=mass)}


def _show_loader(one: Loader, machine: dict[str, float]) -> None:
    console = Console()
    head = Table(show_header=False, box=None, pad_edge=False)
    head.add_row("Y", f"{one.Y:.10g}")
    for name, value in machine.items():
        head.add_row(f"{name} of the loader", f"{value:.8g}")
    if not one.peaks_at_turn:
        head.add_row("C at the turn", f"{one.C_at_turn:.10g}, which the paper's formula gives: the peak lies elsewhere")
    if not one.symmetric:
        head.add_row("", "unsymmetric: the loader closes its swing if the return runs the same law")
    console.print(head)
    table = Table("constant", "loader", "at k", "executive", "at k", box=None, pad_edge=False)
    own, other = one.law.constants, one.executive.constants
    for name in ("B", "C", "D", "J"):
        peaks = getattr(own, name), getattr(other, name)
        table.add_row(name, *(cell for peak in peaks for cell in (f"{peak.value:.10g}", f"{peak.k:.6g}")))
    console.print(table)


def _show_dwell(found: DwellComparison, clutches: dict[str, Clutch], teeth: int) -> None:
    console = Console()
    table = Table("type", "a", "b", "S1", "S2", "usable", box=None, pad_edge=False)
    for kind, reason in found.reasons.items():
        one = found.mechanisms.get(kind)
        cells = ["", "", "", ""] if one is None else [f"{value:.6g}" for value in (one.a, one.b, one.S1, one.S2)]
        table.add_row(kind, *cells, reason)
    console.print(table)
    chosen = "none is usable" if found.chosen is None else f"type {found.chosen}, the smallest cam of those usable"
    console.print(f"take {chosen}; the paper's rule of thumb says {found.by_rule}", highlight=False)
    table = Table("clutch", "p/N wanted", "p", "N", "off by, deg", "exact with", box=None, pad_edge=False)
    for kind, clutch in clutches.items():
        for choice in _choices(clutch, teeth):
            error = f"{degrees(choice.error):.4f}"
            table.add_row(kind, f"{clutch.ratio:.8g}", str(choice.p), str(choice.N), error, _remedy(choice))
    if clutches:
        console.print(table)
    remarks = {remark for one in found.mechanisms.values() for remark in one.remarks}
    for remark in sorted(remarks):
        console.print(f"mind: {remark}", highlight=False)


def _choices(clutch: Clutch, teeth: int) -> tuple[Teeth, ...]:
    found = [one for one in clutch.choices(1, teeth) if gcd(one.p, one.N) == 1]
    return tuple(found[:_TEETH]) or (clutch.nearest(teeth),)


def _remedy(one: Teeth) -> str:
    angles = {"swing": one.swing, "dwell": one.dwell, "rise": one.rise}
    said = [f"{name} {degrees(value):.5g}" for name, value in angles.items() if value is not None]
    said += [] if one.B2 is None else [f"B2 = {one.B2:.5g}"]
    return " or ".join(said)


def _plain(found: DwellComparison, clutches: dict[str, Clutch], teeth: int) -> dict[str, Any]:
    return {
        "chosen": found.chosen,
        "by_rule": found.by_rule,
        "reasons": dict(found.reasons),
        "types": {kind: one.to_dict() for kind, one in found.mechanisms.items()},
        "clutches": {
            kind: {
                "ratio": clutch.ratio,
                "teeth": [
                    {"p": one.p, "N": one.N, "error": one.error, "swing": one.swing, "B2": one.B2}
                    for one in _choices(clutch, teeth)
                ],
            }
            for kind, clutch in clutches.items()
        },
    }

"""The command `optlaws loader`: an inertial loader that balances a law."""

from __future__ import annotations

from pathlib import Path

import optlaws
from optlaws.cli.options import AsJson, Plot, check_files, read_law, save, save_laws
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError


def loader(
    name: str,
    /,
    *,
    executive_mass: float | None = None,
    executive_stroke: float | None = None,
    mass: float | None = None,
    stroke: float | None = None,
    plot: Plot = None,
    as_json: AsJson = False,
    output: Path | None = None,
) -> None:
    """Inertial loader that balances a law: energy parameter Y, peaks of its motion, its mass or stroke.

    Parameters
    ----------
    name
        Executive law: a name or code of the catalogue, or a JSON or CSV file with a law.
    executive_mass
        Mass that the executive link moves, kg (or moment of inertia, kg m²).
    executive_stroke
        Its stroke, m (or swing, rad).
    mass
        Mass of the loader, for which its stroke is sought.
    stroke
        Stroke of the loader, for which its mass is sought.
    plot
        Draw the laws of the executive link and of the loader into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else.
    output
        Write the loader's law to this JSON file.
    """
    check_files(output, plot=plot)
    balancer = optlaws.inertial_loader(read_law(name))
    machine = _machine(balancer, executive_mass, executive_stroke, mass, stroke)
    if output is not None:
        save(output, {"law": balancer.law.to_dict()})
    if plot is not None:
        save_laws(plot, {"executive link": balancer.executive, "loader": balancer.law})
    if as_json:
        print_json(balancer.to_dict() | machine)
    else:
        _show(balancer, machine)


def _machine(
    balancer: optlaws.Loader,
    executive_mass: float | None,
    executive_stroke: float | None,
    mass: float | None,
    stroke: float | None,
) -> dict[str, float]:
    if executive_mass is None and executive_stroke is None and mass is None and stroke is None:
        return {}
    if executive_mass is None or executive_stroke is None or (mass is None) == (stroke is None):
        raise InputError("--executive-mass and --executive-stroke go together with either --mass or --stroke")
    given = {"executive_mass": executive_mass, "executive_stroke": executive_stroke}
    if stroke is not None:
        return {"mass": balancer.mass(**given, stroke=stroke), "stroke": stroke}
    if mass is None:  # the check above leaves nothing else
        return {}
    return {"mass": mass, "stroke": balancer.stroke(**given, mass=mass)}


def _show(balancer: optlaws.Loader, machine: dict[str, float]) -> None:
    head = table()
    head.add_row("Y", f"{balancer.Y:.10g}")
    for name, value in machine.items():
        head.add_row(f"{name} of the loader", f"{value:.8g}")
    if not balancer.peaks_at_turn:
        head.add_row(
            "C at the turn", f"{balancer.C_at_turn:.10g}, which the paper's formula gives: the peak lies elsewhere"
        )
    if not balancer.symmetric:
        head.add_row("", "unsymmetric: the loader closes its swing if the return runs the same law")
    constants = table("constant", "loader", "at k", "executive", "at k")
    loader_peaks, executive_peaks = balancer.law.constants, balancer.executive.constants
    for name in ("B", "C", "D", "J"):
        peaks = getattr(loader_peaks, name), getattr(executive_peaks, name)
        constants.add_row(name, *(cell for peak in peaks for cell in (f"{peak.value:.10g}", f"{peak.k:.6g}")))
    show(head, constants)

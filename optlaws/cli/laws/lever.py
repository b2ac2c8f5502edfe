"""The command `optlaws lever`: the cam-lever mechanism with torsion bars."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Plot, check_files, save, save_laws
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError

if TYPE_CHECKING:
    from rich.table import Table

    from optlaws.balancing.levers.motion import LeverMotion

_ANGLES = ("chi01", "chi02")
_CONSTANTS = ("zeta", "B1", "B3", "C1", "C3")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class LeverOptions:
    """The lever: its swing, its lengths, what is left of its twists, and its limits.

    Parameters
    ----------
    swing
        Swing of the driven link from extreme to extreme, degrees.
    beta
        Length of the driven link in units of the rocker; computed where --target needs it.
    lam
        Length of the coupler in units of the rocker; computed where --target needs it.
    rho
        Part of the first bar's pre-twist that is left at its extreme.
    nu
        Part of the second bar's pre-twist that is left at its extreme.
    least_transmission
        Least angle between the coupler and either link, degrees; the greatest is its supplement.
    most_rocker_swing
        Greatest swing of the rocker, degrees.
    """

    swing: float
    beta: float | None = None
    lam: float | None = None
    rho: float = 0.15
    nu: float = 0.15
    least_transmission: float = 30.0
    most_rocker_swing: float = 60.0

    @property
    def given(self) -> dict[str, float]:
        """Arguments of `TorsionLever` other than the lengths.

        Raises
        ------
        InputError
            If an angle is out of range.
        """
        most = {"swing": 180.0, "least_transmission": 90.0, "most_rocker_swing": 180.0}
        for name, limit in most.items():
            angle = getattr(self, name)
            if not 0.0 < angle < limit:
                option = f"--{name.replace('_', '-')}"
                raise InputError(f"{option} must be above 0 and below {limit:g} degrees, got {angle:g}")
        return {"rho": self.rho, "nu": self.nu} | {name: optlaws.deg(getattr(self, name)) for name in most}


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class BarOptions:
    """The bars in a machine.

    Parameters
    ----------
    inertia
        Moment of inertia of the driven mass, kg m².
    stiffness
        Stiffness c1 of the first bar, N m/rad: with --inertia, gives the period in seconds.
    period
        Wanted period, seconds: with --inertia, gives the stiffness of both bars.
    """

    inertia: float | None = None
    stiffness: float | None = None
    period: float | None = None

    def check(self) -> None:
        """Refuse options without the options that they need."""
        if self.period is not None and self.stiffness is not None:
            raise InputError("--period and --stiffness exclude each other: one gives the other")
        if (self.inertia is None) != (self.period is None and self.stiffness is None):
            raise InputError("--inertia goes with --stiffness or --period")


_BARS = BarOptions()


def lever(
    *,
    options: LeverOptions,
    target: list[str] | None = None,
    bars: BarOptions = _BARS,
    plot: Plot = None,
    as_json: AsJson = False,
    output: Path | None = None,
) -> None:
    """Law of motion of a mass that swings between torsion bars on a cam-lever mechanism: exact and asymptotic.

    Parameters
    ----------
    target
        A constant of the exact motion, such as B1/B3=0.99 or T=6.1, for which the length not given is sought; twice for
        two of them and both lengths.
    plot
        Draw the exact law of the stroke into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else; angles in radians.
    output
        Write the exact law of the stroke to this JSON file.
    """
    check_files(output, plot=plot)
    bars.check()
    levers = _levers(options, target or [])
    machines = [_machine(lever.exact, bars, lever.xi) for lever in levers]
    if output is not None:
        _save(output, levers)
    if plot is not None:
        save_laws(plot, {f"beta {lever.beta:.6g}, lambda {lever.lam:.6g}": lever.law() for lever in levers})
    if as_json:
        plain = [_plain(lever) | machine for lever, machine in zip(levers, machines, strict=True)]
        print_json(plain[0] if target is None else {"levers": plain})
        return
    for lever, machine in zip(levers, machines, strict=True):
        _show(lever, machine)


def _levers(options: LeverOptions, target: list[str]) -> tuple[optlaws.TorsionLever, ...]:
    beta, lam, given = options.beta, options.lam, options.given
    if target:
        from optlaws.balancing.levers.design import BETA, LAM

        values = dict(_value(text) for text in target)
        return optlaws.find_torsion_levers(
            values, beta=BETA if beta is None else beta, lam=LAM if lam is None else lam, **given
        )
    if beta is None or lam is None:
        raise InputError("give --beta and --lam, or with --target one for each that is left out")
    return (optlaws.TorsionLever(beta=beta, lam=lam, **given),)


def _value(text: str) -> tuple[str, float]:
    name, _, number = text.partition("=")
    try:
        return name.strip(), float(number)
    except ValueError:
        raise InputError(f"--target takes NAME=NUMBER, such as B1/B3=0.99, got {text!r}") from None


def _machine(motion: LeverMotion, bars: BarOptions, xi: float) -> dict[str, float]:
    if bars.inertia is None:
        return {}
    first = motion.stiffness(bars.period, bars.inertia) if bars.period is not None else bars.stiffness
    if first is None:
        return {}
    return {
        "period_seconds": motion.seconds(first, bars.inertia),
        "stiffness_1": first,
        "stiffness_2": xi * first,
    }


def _plain(lever: optlaws.TorsionLever) -> dict[str, Any]:
    linkage = lever.linkage
    return {
        **{name: getattr(lever, name) for name in ("beta", "lam", "rho", "nu", "swing")},
        **{name: getattr(linkage, name) for name in ("alpha", "psi0", *"QPSR")},
        **{name: getattr(lever, name) for name in ("xi", "gamma01", "n", "q", "p", "T0")},
        "twists": list(lever.twists),
        "twists_left": list(lever.twists_left),
        "exact": _motion(lever.exact),
        "asymptotic": _motion(lever.asymptotic),
        "errors": lever.errors,
        "law": lever.law().to_dict(),
    }


def _motion(motion: LeverMotion) -> dict[str, Any]:
    return {"T": motion.period, **{name: getattr(motion, name) for name in (*_ANGLES, *_CONSTANTS)}}


def _save(file: Path, levers: tuple[optlaws.TorsionLever, ...]) -> None:
    if len(levers) > 1:
        raise InputError(f"--output takes one law, found are {len(levers)}: give --beta or --lam of one of them")
    save(file, {"law": levers[0].law().to_dict()})


def _show(lever: optlaws.TorsionLever, machine: dict[str, float]) -> None:
    linkage = lever.linkage
    facts = [
        ("beta, lambda", f"{lever.beta:.8g}, {lever.lam:.8g}"),
        ("alpha, psi0", f"{linkage.alpha:.8g}, {degrees(linkage.psi0):.6g} deg"),
        ("xi = c2/c1", f"{lever.xi:.8g}"),
    ]
    for name, twist, left in zip(("1", "2"), lever.twists, lever.twists_left, strict=True):
        ends = f"{degrees(twist):.6g} deg at equilibrium, {degrees(left):.4g} deg at least"
        facts.append((f"twist of bar {name}", ends if left > 0.0 else f"{ends}: slack"))
    for name, value in machine.items():
        unit = "s" if name == "period_seconds" else "N m/rad"
        facts.append((name.replace("_", " ").replace(" seconds", ""), f"{value:.8g} {unit}"))
    show(table(rows=facts), _compared(lever))


def _compared(lever: optlaws.TorsionLever) -> Table:
    units = {"T": ", sqrt(I/c1)"} | dict.fromkeys(_ANGLES, ", deg")
    motions, rows = (_motion(lever.exact), _motion(lever.asymptotic)), []
    for name in motions[0]:
        scale = degrees(1.0) if name in _ANGLES else 1.0
        values = (f"{scale * motion[name]:.8g}" for motion in motions)
        rows.append([f"{name}{units.get(name, '')}", *values, f"{100 * lever.errors[name]:.2g}"])
    rows.append(["max |da|", "", "", f"{100 * lever.errors['max |da|']:.2g}"])
    return table("", "exact", "asymptotic", "off by, %", rows=rows)

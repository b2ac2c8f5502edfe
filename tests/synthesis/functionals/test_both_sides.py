"""What an error writes in place of a magnitude that cannot be minimised can be, and is never less."""

import re
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Drive,
    InputError,
    Mechanism,
    Motor,
    Problem,
    catalogue,
    maximum,
    peak,
    synthesize,
)

SHOWN = re.compile(r"for both sides write (maximum\(.*\)), which is never less")


def written(text: str, **part: Any) -> Any:
    """What the error of a magnitude writes, read as Python."""
    with pytest.raises(InputError) as error:
        peak(text, **part)
    shown = SHOWN.search(str(error.value))
    assert shown is not None
    return eval(shown.group(1), {"maximum": maximum, "peak": peak})  # noqa: S307


def lossy(load: str, efficiency: float) -> tuple[Drive, str, float]:
    """A drive whose gear loses power, its torque over one stroke, and the unit of that."""
    mechanism = Mechanism("0.8 kg m^2", load=load)
    drive = Drive(mechanism, Motor("3e-4 kg m^2"), ratio=20, efficiency=efficiency)
    moved = drive.dimensionless("0 deg", "45 deg", "0.25 s")
    return drive, moved.torque, moved.unit


@pytest.mark.parametrize("text", ["b*c + 0.1*abs(b)", "b*c - 0.1*abs(b)", "c + max(1.2*(c + 0.3), 0.8*(c + 0.3))"])
@pytest.mark.parametrize("part", [{}, {"start": 0.25, "stop": 0.75}])
def test_what_is_written_is_never_less_than_the_magnitude(text: str, part: dict[str, float]) -> None:
    both, k = written(text, **part), np.linspace(part.get("start", 0.0), part.get("stop", 1.0), 4001)
    for law in (catalogue[name].law for name in ("345", "cycloidal", "modified sine", "4567")):
        values = {"abs": np.abs, "max": np.maximum, "b": law(k, 1), "c": law(k, 2)}
        size = np.abs(eval(text, values)).max()  # noqa: S307
        value = max(term.value(law) for part in both.parts for _, term in part.terms)
        assert size * (1.0 - 1e-7) <= value <= 2.0 * size


@pytest.mark.parametrize("load", ["3 N m", "-3 N m", "0 N m"])
@pytest.mark.parametrize("efficiency", [0.5, 0.85])
def test_what_is_written_for_a_drive_is_its_peak_torque(load: str, efficiency: float) -> None:
    drive, torque, unit = lossy(load, efficiency)
    with pytest.raises(InputError, match=r"of a drive they are `torque` and `branches\[-1\]`"):
        synthesize(Problem(order=3, minimise=f"peak({torque})", monotone=True))
    best = synthesize(Problem(order=3, minimise=written(torque), monotone=True))
    known = drive.sheet(best.law, 0.0, np.pi / 4.0, 0.25).peak_torque
    assert best.objective * unit == pytest.approx(known, rel=1e-6)

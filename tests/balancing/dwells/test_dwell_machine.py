from math import pi, radians
from typing import Any

import numpy as np
import pytest

from optlaws import CamForces, DwellMachine, InputError, catalogue, dwell_machine
from optlaws.balancing import DwellType

DATA: dict[str, Any] = {
    "law": catalogue["3-4-5"].law,
    "dwell": "90 deg",
    "rise": "90 deg",
    "swing": "20 deg",
    "arm": "100 mm",
    "prime_radius": "45 mm",
    "inertia": "0.05 kg m^2",
    "loader_inertia": "0.005 kg m^2",
}


def machine(kind: DwellType, **arguments: Any) -> DwellMachine:
    return dwell_machine(kind, **DATA | {"speed": "100 rpm", "clutch_time": "20 ms"} | arguments)


def test_the_clutch_s_time_is_an_angle_that_grows_with_the_speed() -> None:
    # eq. (16): phi_sp = 6 n t_sp degrees
    for rpm in (60.0, 100.0, 150.0):
        assert machine("III", speed=f"{rpm} rpm").clutch_angle == pytest.approx(radians(6.0 * rpm * 0.02))


@pytest.mark.parametrize("kind", ["I", "II", "III"])
def test_torques_by_the_paper_s_formulas(kind: DwellType) -> None:
    model = machine(kind)
    law, time, gS = DATA["law"], 0.15, radians(20.0)
    D, C = law.power_peak().value, law.peak(2).value
    assert model.balanced_torque == pytest.approx(D * 0.05 * gS**2 / (0.5 * pi * time**2))
    # (22): the same through what the rocker itself takes
    assert model.balanced_torque == pytest.approx(D * gS * model.driven_torque / (C * 0.5 * pi))
    assert model.reduction == pytest.approx(model.mechanism.b, rel=1e-9)
    if kind == "II":
        g2, ph2 = model.mechanism.S2 * gS, model.mechanism.phi2
        assert model.residual_torque == pytest.approx(D * 0.005 * g2**2 / (ph2 * (ph2 / model.rate) ** 2))
        assert model.loader_driven_torque == pytest.approx(C * g2 * 0.005 / (ph2 / model.rate) ** 2)
        # by eq. (21)
        assert model.residual_torque == pytest.approx(D * g2 * model.loader_driven_torque / (C * ph2))


@pytest.mark.parametrize("kind", ["I", "III"])
def test_both_cams_on_one_shaft_take_no_torque_but_in_the_dwells(kind: DwellType) -> None:
    model = machine(kind)
    cams = model.cams("8 mm", "115 mm")
    moved = {
        # the loader's inertia while it is coupled: eq. (2) with the same swing
        "executive": 0.05,
        "loader": 0.05 / model.mechanism.loader.Y**2,
    }
    angles = np.linspace(0.01, 1.55, 60)
    speed = f"{model.rate!r} rad/s"
    torques = [
        CamForces(cam, speed=speed, drive={"inertia": f"{moved[name]!r} kg m^2"}).shaft_torque(angles)
        for name, cam in cams.items()
    ]
    assert np.abs(torques[0]).max() == pytest.approx(model.balanced_torque, rel=1e-2)
    # S is the swing of the executive rocker; the loader's way in the rise is that of its law
    assert np.abs(torques[0] + torques[1]).max() < 1e-9 * model.balanced_torque


def test_what_makes_no_turn_or_leaves_no_room_says_so() -> None:
    with pytest.raises(InputError, match="no cam comes back"):
        machine("III", dwell="100 deg").cams("8 mm", "115 mm")
    with pytest.raises(InputError, match="dwell must exceed twice clutch_angle"):
        machine("III", speed="400 rpm")
    with pytest.raises(InputError, match="clutch_time must be at least 0"):
        machine("II", clutch_time="-1 ms")
    with pytest.raises(InputError, match="loader_inertia must be a moment of inertia"):
        machine("II", loader_inertia="1 kg")

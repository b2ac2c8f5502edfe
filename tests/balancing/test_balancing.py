from math import pi

import numpy as np
import pytest

from optlaws import Balancing, CamForces, Cycle, DiscCam, Dwell, InputError, Loader, Return, Rise, TranslatingRoller


def cycle(law: str, back: str = "90 deg", **drive: str) -> Cycle:
    moves = [Rise("40 mm", "90 deg", law=law), Dwell("90 deg"), Return(duration=back, law=law), Dwell()]
    return Cycle(moves, speed="120 rpm", drive={"mass": "3 kg", **drive})


@pytest.mark.sample(2)
@pytest.mark.parametrize("law", ["K", "3-4-5", "modified sine"])
def test_a_loader_takes_all_of_the_inertia_s_torque(law: str) -> None:
    balancing = Balancing(cycle(law))
    # m h² D/T³ over the shaft's speed
    peak = 3.0 * 0.04**2 * balancing.cycle.pieces[0].law.power_peak().value / 0.125**3 / (4.0 * pi)
    assert balancing.before.peak == pytest.approx(peak, rel=1e-6)
    assert balancing.after.peak < 1e-9 * peak
    assert balancing.after.rms < 1e-9 * peak


@pytest.mark.sample(3)
@pytest.mark.parametrize("law", ["K", "3-4-5", "modified trapezoid"])
def test_torques_are_enclosed_over_the_turn(law: str) -> None:
    balancing = Balancing(cycle(law, stiffness="1 N/mm", dry="5 N", viscous="20 N s/m", gravity="9 N"), share=0.7)
    degrees = np.linspace(0.0, 360.0, 36_001)[1:-1]
    for balanced, over_turn in ((False, balancing.before), (True, balancing.after)):
        values, slack = balancing.torque(degrees, balanced=balanced), 1e-9 * over_turn.peak
        assert over_turn.extremes.low - slack <= values.min() <= over_turn.extremes.low + 1e-3 * over_turn.peak
        assert over_turn.extremes.high - 1e-3 * over_turn.peak <= values.max() <= over_turn.extremes.high + slack
        assert over_turn.rms == pytest.approx(np.sqrt(np.mean(values**2)), rel=1e-3)


def test_what_no_loader_balances_is_left() -> None:
    balancing = Balancing(cycle("3-4-5", stiffness="1 N/mm", dry="5 N"))
    rest = Balancing(cycle("3-4-5", stiffness="1 N/mm", dry="5 N", mass="0 kg"))
    degrees = np.linspace(0.0, 359.0, 200)
    assert balancing.torque(degrees) == pytest.approx(rest.torque(degrees, balanced=False), abs=1e-9)
    assert balancing.before.peak == pytest.approx(balancing.cycle.effort.peak_power / balancing.rate)


def test_a_lighter_loader_leaves_its_share() -> None:
    full, most = Balancing(cycle("3-4-5")), Balancing(cycle("3-4-5"), share=0.9)
    assert most.after.peak == pytest.approx(0.1 * full.before.peak, rel=1e-6)
    assert most.after.rms == pytest.approx(0.1 * full.before.rms, rel=1e-6)


def test_what_cannot_be_balanced_says_why() -> None:
    with pytest.raises(InputError, match="different peak speeds"):
        Balancing(cycle("3-4-5", back="100 deg"))
    with pytest.raises(InputError, match="no drive"):
        Balancing(Cycle(cycle("K").segments, speed="120 rpm"))
    with pytest.raises(InputError, match="share must be at least 0"):
        Balancing(cycle("K"), share=-0.1)


@pytest.mark.parametrize("law", ["K", "3-4-5"])
def test_the_loader_s_own_cam_gives_the_torque_that_the_executive_takes(law: str) -> None:
    moves = [Rise("40 mm", "180 deg", law=law), Return(law=law)]
    balancing = Balancing(Cycle(moves, speed="120 rpm", drive={"mass": "3 kg"}))
    roller = TranslatingRoller("12 mm")
    cams = DiscCam(balancing.cycle, "60 mm", roller), DiscCam(balancing.loader_motion("30 mm"), "60 mm", roller)
    assert cams[1].displacement.range == pytest.approx((-0.015, 0.015))
    mass = Loader(balancing.cycle.pieces[0].law).mass(executive_mass=3.0, executive_stroke=0.04, stroke=0.03)
    angles = np.linspace(0.01, 6.27, 101)
    torques = [
        CamForces(cam, speed="120 rpm", drive={"mass": f"{kilograms!r} kg"}).shaft_torque(angles)
        for cam, kilograms in zip(cams, (3.0, mass), strict=True)
    ]
    assert np.abs(torques[0]).max() > 0.05
    assert np.abs(torques[0] + torques[1]).max() < 1e-9
    with pytest.raises(InputError, match="take dwell_machine"):
        Balancing(cycle("K")).loader_motion("30 mm")
    with pytest.raises(InputError, match="stroke must be above 0"):
        balancing.loader_motion("0 mm")

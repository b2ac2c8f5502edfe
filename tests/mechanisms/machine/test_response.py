"""What machines do: against an integrator and followers; flat outputs and spectra over a parameter."""

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy import signal

from optlaws import (
    Follower,
    InputError,
    Link,
    Machine,
    MotionLaw,
    PiecewiseLaw,
    catalogue,
    driving_law,
    flat_output,
    machine_spectrum,
    polydyne,
    response_spectrum,
    savin,
    smoothstep,
)
from tests.internals.laws import PolynomialSegment
from tests.internals.mechanisms import cam_factors
from tests.mechanisms.machine.random_machines import KINDS, integrated, random_case
from tests.sampling import sampled

K = np.linspace(0.0, 1.4, 29)[1:]
LAWS: dict[str, MotionLaw] = {
    "polynomial": savin("III", 7.2),
    "sines": catalogue["cycloidal"].law,
    "modified trapezoid": catalogue["modified-trapezoid"].law,
}


def follower(nu: float, damping: float) -> Machine:
    A = [[0.0, 1.0], [-(nu**2), -2.0 * damping * nu]]
    C, D = [[1.0, 0.0], A[1]], [[0.0], [nu**2]]
    return Machine(A, [[0.0], [nu**2]], C, D, outputs=["position", "acceleration"])


def misses(seed: int) -> float:
    """The greatest difference from DOP853, relative to the greatest output of a kind."""
    case = random_case(seed)
    response = case.machine.response(case.law, dwell=0.4)
    values = np.array([response[name](K) for name in case.machine.outputs])
    expected = integrated(case, K)
    return float(np.abs(values - expected).max() / max(1.0, np.abs(expected).max()))


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(2 * len(KINDS)))
def test_random_machines_against_an_integrator(seed: int) -> None:
    assert misses(seed) < 1e-9


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2 * len(KINDS), 200))
def test_many_random_machines_against_an_integrator(seed: int) -> None:
    assert misses(seed) < 1e-9


def test_a_system_of_python_control_is_its_machine() -> None:
    control = pytest.importorskip("control")
    machine = random_case(0).machine
    system = control.ss(*(np.array(one) for one in (machine.A, machine.B, machine.C, machine.D)))
    assert Machine.from_system(system, inputs=machine.inputs, outputs=machine.outputs) == machine


@pytest.mark.parametrize("law", ["polynomial", "modified trapezoid"])
def test_a_stiff_vibration_that_dies_away_is_followed_while_it_lives(law: str) -> None:
    nu, damping = 2e4, 0.05
    machine = follower(nu, damping).response(LAWS[law], dwell=0.5)["position"]
    k = np.linspace(0.0, 1.5, 301)
    assert len(machine.motion.panels) < 600  # of 3000 that are as short as the vibration asks
    assert machine(k) == pytest.approx(Follower(nu, damping).response(LAWS[law]).a(k), abs=4e-15)


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", sampled(range(60), each=6))
def test_a_follower_is_a_machine_to_rounding(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nu = 500.0 if seed % 4 == 0 else float(np.exp(rng.uniform(np.log(2.0), np.log(500.0))))
    own = Follower(nu, (0.0, float(rng.uniform(0.0, 0.3)), 1.0, float(rng.uniform(1.1, 3.0)))[seed % 3])
    law = (smoothstep(2 + seed % 5), *LAWS.values())[seed % 4]
    machine, motion = Machine.from_follower(own), own.response(law)
    response, k = machine.response(law, dwell=0.5), np.linspace(0.0, 1.5, 91)
    size = motion.peak(2).value
    phase = (1e-13 + 2e-14 * nu) * size  # what roundings of a root and of a time are worth
    assert response["position"](k) == pytest.approx(motion.a(k), abs=4e-15)
    assert response["acceleration"](k) == pytest.approx(motion(k, 2), abs=phase)
    assert response["deflection"](k) == pytest.approx(motion.a(k) - law.a(np.minimum(k, 1.0)), abs=4e-15)
    assert response["position"].extrema(0, (0.0, 1.0))[1].value == pytest.approx(motion.extrema(0)[1].value, abs=4e-15)
    assert response.rise_peak("acceleration").value == pytest.approx(size, rel=1e-11)
    if own.damping < 1.0:
        left = machine.residual(1, "acceleration").value(law)
        assert left == pytest.approx(motion.residual_acceleration, abs=phase)


def test_peaks_are_above_every_point_and_reached() -> None:
    for seed in range(len(KINDS)):
        case = random_case(seed)
        response = case.machine.response(case.law, dwell=0.7)
        grid = np.linspace(0.0, 1.7, 8001)
        for name in (case.machine.outputs[0], case.machine.outputs[-1]):
            curve, values = response[name], np.abs(response[name](grid))
            peak = response.peak(name)
            assert values.max() <= peak.value * (1.0 + 1e-12)
            assert peak.value - values.max() <= 1e-4 * peak.value + np.abs(np.diff(values)).max()
            assert abs(curve(peak.k)) == pytest.approx(peak.value, rel=1e-9, abs=np.abs(np.diff(values)).max())
            parts = (np.linspace(0.0, 1.0 - 1e-12, 4001), np.linspace(1.0, 1.7, 4001))
            square = sum(float(np.trapezoid(curve(part) ** 2, part)) for part in parts)
            assert response.rms(name) == pytest.approx(np.sqrt(square / 1.7), rel=1e-4)


@pytest.mark.parametrize(("dwell", "rest", "fall_duration"), [(0.5, 1.0, 1.0), (0.0, 0.0, 0.7)])
def test_cycles_are_those_of_a_follower_and_come_back(dwell: float, rest: float, fall_duration: float) -> None:
    rise, fall = smoothstep(4), savin("III", 7.2)
    own = Follower(20, 0.05).cycle(rise, fall, dwell=dwell, fall_duration=fall_duration, rest=rest)
    cycle = follower(20, 0.05).cycle(rise, fall, dwell=dwell, fall_duration=fall_duration, rest=rest)
    k = np.linspace(0.0, own.period, 57)[:-1]
    assert cycle["position"](k) == pytest.approx(own.a(k), abs=1e-12)
    assert cycle.peak("acceleration").value == pytest.approx(own.peak(2).value, rel=1e-11)
    assert cycle.rms("acceleration") == pytest.approx(own.rms(2), rel=1e-11)


def test_a_law_that_never_rests_keeps_its_cycle() -> None:
    # uniform motion there and back: the velocity jumps where one cycle ends and the next begins
    uniform = PiecewiseLaw([0, 1], [PolynomialSegment((0.0,), 1.0)])
    machine = Machine([[-3.0]], [[0.0, 1.0]], [[1.0]], inputs="ac", outputs=["speed"])
    speed = machine.cycle(uniform, dwell=0.0, rest=0.0)["speed"]
    # each jump of b by -2 and 2 is followed by a decay
    decay = np.exp(-3.0)
    top = 2.0 / (1.0 + decay)
    assert speed(0.25) == pytest.approx(top * np.exp(-0.75), rel=1e-12)
    assert speed(1.25) == pytest.approx(-top * np.exp(-0.75), rel=1e-12)


def test_impulses_have_no_bound() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((0.0,), 0.5), PolynomialSegment((0.0,), 1.5)])
    machine = Machine([[-3.0]], [[1.0]], [[0.0], [1.0]], [[1.0], [0.0]], inputs="c", outputs=["force", "speed"])
    response = machine.response(law)
    assert (response.peak("force").value, response.rms("force")) == (np.inf, np.inf)
    assert response["speed"](0.25) == pytest.approx(0.5 * np.exp(-0.75), rel=1e-12)
    assert response["speed"](0.75) == pytest.approx(0.5 * np.exp(-2.25) + np.exp(-0.75), rel=1e-12)


def test_masses_keep_newtons_law_and_the_drive_does_the_work() -> None:
    links: list[Link | Sequence[Any]] = [
        Link("ground", "camshaft", 5e5, 20.0),
        ("roller", "valve", 2e5, 10.0),
        ("valve", "ground", 3e3),
    ]
    machine = Machine.from_masses(
        {"camshaft": 2.0, "roller": 0.3, "valve": 0.5}, links, drive=("camshaft", "roller"), duration=0.01, stroke=0.02
    )
    response = machine.response(savin("IV", 11.0), dwell=0.5)
    k = np.linspace(0.0, 1.5, 41)
    force = {name: response[name](k) for name in machine.outputs}
    moved = [force["position roller"] - force["position camshaft"], 0.02 * savin("IV", 11.0).a(np.minimum(k, 1.0))]
    assert moved[0] == pytest.approx(moved[1], abs=1e-15)
    roller = 0.3 * force["acceleration roller"] + force["force roller-valve"]
    assert force["drive force"] == pytest.approx(roller, abs=1e-8 * np.abs(roller).max())
    camshaft = 2.0 * force["acceleration camshaft"] - force["force ground-camshaft"]
    assert camshaft == pytest.approx(-force["drive force"], abs=1e-8 * np.abs(camshaft).max())
    valve = 0.5 * force["acceleration valve"] - force["force roller-valve"] + force["force valve-ground"]
    assert valve == pytest.approx(np.zeros(41), abs=1e-8 * np.abs(camshaft).max())


def test_a_measured_frequency_is_a_mass_on_a_spring() -> None:
    frequency, ratio, law = 8.5, 0.02, catalogue["modified sine"].law
    omega = 2.0 * np.pi * frequency
    mass = Machine.from_masses(
        {"drive": 0.0, "tip": 2.0},
        [("drive", "tip", 2.0 * omega**2, 4.0 * ratio * omega)],
        drive="drive",
        duration=0.4,
        stroke=0.3,
    ).response(law, dwell=0.5)
    arm = Machine.from_modes([(frequency, ratio)], duration=0.4, stroke=0.3)
    (mode,) = arm.modes
    assert [mode.frequency, mode.damping] == pytest.approx([0.4 * omega, ratio])
    measured, k = arm.response(law, dwell=0.5), np.linspace(0.0, 1.5, 31)
    for name in ("position", "velocity", "acceleration"):
        expected = mass[f"{name} tip"](k)
        assert measured[name](k) == pytest.approx(expected, abs=1e-11 * np.abs(expected).max())
    assert measured["deflection"](k) == pytest.approx(-mass["deflection drive-tip"](k), abs=1e-13)


def test_modes_add_up_and_their_shares_are_what_of_the_drive_they_have() -> None:
    modes = [(8.5, 0.02, 0.75), (31.0, 0.01, 0.25)]
    law = smoothstep(4)
    both = Machine.from_modes(modes, duration=0.2).response(law)
    alone = [Machine.from_modes([(f, z)], duration=0.2).response(law)["deflection"] for f, z, _ in modes]
    k = np.linspace(0.0, 1.0, 21)
    expected = sum(share * one(k) for one, (*_, share) in zip(alone, modes, strict=True))
    assert both["deflection"](k) == pytest.approx(expected, abs=1e-14)
    assert both["deflection 2"](k) == pytest.approx(0.25 * alone[1](k), abs=1e-14)
    assert both["position"](k) == pytest.approx(law(k) + expected, abs=1e-13)


def test_responses_become_tables_and_pictures() -> None:
    response = follower(20.0, 0.05).response(smoothstep(4), dwell=0.5)
    table = response.to_pandas(4)
    assert (table.index.tolist(), table.columns.tolist()) == ([0.0, 0.5, 1.0, 1.5], ["position", "acceleration"])
    assert table["position"].tolist() == response["position"].to_pandas(4)["position"].tolist()
    assert table["position"].to_numpy() == pytest.approx(response["position"](table.index.to_numpy()))
    (line,) = response["acceleration"].plot()
    assert line.axes.get_ylabel() == "acceleration"
    assert np.abs(line.get_ydata()).max() == pytest.approx(response.peak("acceleration").value, rel=1e-4)


def test_seconds_and_speeds_are_units() -> None:
    A, B = np.array([[0.0, 1.0], [-1.6e5, -40.0]]), np.array([[0.0], [1.6e5]])
    first = Machine.from_units(A, B, [[1.0, 0.0]], duration=0.05, stroke=3.0)
    second = Machine(0.05 * A, 3.0 * 0.05 * B, [[1.0, 0.0]])
    assert np.allclose(first.A, second.A)
    assert np.allclose(first.B, second.B)
    faster = Machine.from_units(A, B, [[1.0, 0.0]], duration=0.025, stroke=3.0)
    assert np.allclose(first.at_speed(2.0).A, faster.A, rtol=1e-14)
    law = smoothstep(4)
    assert first.at_speed(2.0).response(law).peak("output 1").value == pytest.approx(
        faster.response(law).peak("output 1").value, rel=1e-13
    )


def moved_twice() -> MotionLaw:
    return PiecewiseLaw([0, 1], [PolynomialSegment((0.0,), 2.0)])


# --- flat outputs ---


def chain(count: int, damping: float = 0.0) -> Machine:
    """Masses one behind the other, dampers to the ground only unless `damping`."""
    names = ["motor", *(f"m{i}" for i in range(1, count + 1))]
    masses = {name: 1.0 + 0.3 * i for i, name in enumerate(names)}
    links = [Link(names[i], names[i + 1], 300.0 + 50.0 * i, damping) for i in range(count)]
    links += [Link(name, "ground", 0.0, 0.5) for name in names[1:]]
    return Machine.from_masses(masses, links, drive="motor", outputs=[f"position {names[-1]}", "drive force"])


@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_last_mass_moves_by_the_law_and_stays(count: int) -> None:
    machine, law = chain(count), smoothstep(2 * count + 2)
    driven = driving_law(machine, law)
    response = machine.response(driven, dwell=1.0)
    k = np.linspace(0.0, 1.0, 41)
    assert response[machine.outputs[0]](k) == pytest.approx(law(k), abs=1e-9)
    after = response[machine.outputs[0]].extrema(0, (1.0, 2.0))
    assert (after[0].value, after[1].value) == pytest.approx((1.0, 1.0), abs=1e-9)
    for mode in machine.modes:
        assert machine.residual(mode.number).value(driven) < 1e-9


def test_one_mass_is_a_polydyne_cam() -> None:
    nu, damping = 20.0, 0.05
    machine = Machine([[0, 1], [-(nu**2), -2 * damping * nu]], [[0], [nu**2]], [[1, 0]], outputs=["mass"])
    assert flat_output(machine) == pytest.approx((1.0, *map(float, cam_factors(nu, damping))), rel=1e-14)
    k = np.linspace(0.0, 1.0, 21)
    law = savin("III", 7.2)
    assert driving_law(machine, law)(k) == pytest.approx(polydyne(law, nu, damping)(k), abs=1e-13)


# --- spectra over a parameter ---


def accelerated(nu: float) -> Machine:
    C, D = [[-(nu**2), -0.1 * nu]], [[nu**2]]
    return Machine([[0, 1], [-(nu**2), -0.1 * nu]], [[0], [nu**2]], C, D, outputs=["acceleration"])


def test_a_followers_spectrum_is_its_own() -> None:
    nu, law = np.linspace(5.0, 40.0, 8), savin("III", 7.2)
    found, expected = machine_spectrum(accelerated, nu, law), response_spectrum(law, nu, 0.05)
    assert found.frequencies[:, 0] == pytest.approx(nu, rel=1e-12)
    assert found.residuals[:, 0] == pytest.approx(expected.residual_acceleration, rel=1e-9)
    assert found.peaks["acceleration"] == pytest.approx(expected.peak_acceleration, rel=1e-5)


def test_machines_with_fewer_modes_have_no_number_there() -> None:
    spectrum = machine_spectrum(
        lambda c: Machine([[0, 1], [-25, -c]], [[0], [25]], [[1, 0]]), [1.0, 20.0], savin("III", 0)
    )
    assert np.isnan(spectrum.residuals).ravel().tolist() == [False, True]


def belt(stiffness: float) -> Machine:
    return Machine.from_masses({"motor": 1.0, "load": 3.0}, [("motor", "load", stiffness, 0.5)], drive="motor")


def test_a_spectrum_is_drawn_and_tabled() -> None:
    spectrum = machine_spectrum(
        belt, [100.0, 400.0, 900.0], savin("III", 0), dwell=0.5, output="force motor-load", parameter="stiffness, N/m"
    )
    left = [belt(value).residual(1, "force motor-load").value(savin("III", 0)) for value in spectrum.values]
    assert spectrum.residuals[:, 0] == pytest.approx(left, rel=1e-12)
    peak, mode = spectrum.plot()
    assert (peak.axes.get_xlabel(), peak.axes.get_ylabel()) == ("stiffness, N/m", "force motor-load")
    assert peak.get_ydata() == pytest.approx(spectrum.peaks["force motor-load"])
    assert mode.get_ydata() == pytest.approx(left)
    table = spectrum.to_pandas()
    assert table.index.name == "stiffness, N/m"
    assert table["mode 1 left in force motor-load"].tolist() == pytest.approx(left)
    assert table["frequency of mode 1"].tolist() == pytest.approx(np.sqrt(spectrum.values / 3.0).tolist())


# --- what is refused ---

WRONG: dict[str, Callable[[], object]] = {
    "A must have as many columns": lambda: Machine([[0, 1]], [[1]], [[1]]),
    "B must have a row for each of 2 states": lambda: Machine([[0, 1], [-1, 0]], [[1]], [[1, 0]]),
    "C must have a row for each output": lambda: Machine([[-1.0]], [[1]], [[1, 0]]),
    "D must have a row for each of 1 outputs": lambda: Machine([[-1.0]], [[1]], [[1]], [[1, 2]]),
    "A must be a matrix of finite numbers": lambda: Machine([[np.nan]], [[1]], [[1]]),
    "B must be a matrix, a list of rows": lambda: Machine([[-1.0]], np.array([1.0]), [[1]]),
    "unstable: its root 1": lambda: Machine([[1.0]], [[1]], [[1]]),
    "as good as rigid": lambda: Machine([[0, 1e6], [-1e6, 0]], [[0], [1]], [[1, 0]]),
    "inputs must name": lambda: Machine([[-1.0]], [[1]], [[1]], inputs="d"),
    "outputs must be 1 different names": lambda: Machine([[-1.0]], [[1]], [[1]], outputs=["x", "y"]),
    "without quotes": lambda: Machine([[-1.0]], [[1]], [[1]], outputs=["the 'best'"]),
    "did you mean 'position'": lambda: follower(20, 0.1).response(smoothstep(4))["positon"],
    "law must be a motion law": lambda: follower(20, 0.1).response("smooth"),  # type: ignore[arg-type]
    "dwell must be": lambda: follower(20, 0.1).response(smoothstep(4), dwell=-1.0),
    "has no dwell": lambda: follower(20, 0.1).response(smoothstep(4)).dwell_peak("position"),
    "of which the motion is known": lambda: follower(20, 0.1).response(smoothstep(4))["position"](1.5),
    "in resonance": lambda: follower(np.pi, 0.0).cycle(smoothstep(4), dwell=0.0, rest=0.0),
    "fall must lead back": lambda: follower(9.0, 0.1).cycle(smoothstep(4), moved_twice(), dwell=0.0, rest=0.0),
    "unknown mass 'q'": lambda: Machine.from_masses({"m": 1, "n": 2}, [("m", "q", 3)], drive="m"),
    "at least two": lambda: Machine.from_masses({"m": 1}, [], drive="m"),
    "joins two different": lambda: Link("m", "m", 3.0),
    "the mass 'q' is linked to nothing": lambda: Machine.from_masses(
        {"m": 1, "n": 1, "q": 1, "r": 2}, [("m", "n", 3), ("q", "r", 3), ("ground", "q", 3)], drive="m"
    ),
    "stiffness must be": lambda: Link("m", "n", -3.0),
    "the mass n must be": lambda: Machine.from_masses({"m": 1, "n": 0}, [("m", "n", 3)], drive="m"),
    "drive must": lambda: Machine.from_masses({"m": 1, "n": 1}, [("m", "n", 3)], drive=("m", "m")),
    "unknown output of these masses": lambda: Machine.from_masses(
        {"m": 1, "n": 1}, [("m", "n", 3)], drive="m", outputs=["torque"]
    ),
    "a system must be": lambda: Machine.from_system(3),
    "must be a Follower": lambda: Machine.from_follower(3),  # type: ignore[arg-type]
    "modes must be a list": lambda: Machine.from_modes(8.5, duration=1.0),  # type: ignore[arg-type]
    "mode 1 must be a frequency in Hz": lambda: Machine.from_modes([8.5, 0.02], duration=1.0),  # type: ignore[list-item]
    "frequency of mode 2 must be": lambda: Machine.from_modes([(8.5, 0.02), (0.0, 0.02)], duration=1.0),
    "such as 0.02 for 2 %": lambda: Machine.from_modes([(8.5, 2.0)], duration=1.0),
    "output of these modes": lambda: Machine.from_modes([(8.5, 0.0)], duration=1.0, outputs=["force"]),
    "count must be": lambda: follower(9.0, 0.1).response(smoothstep(4)).to_pandas(1),
    "factor must be": lambda: follower(9.0, 0.1).at_speed(0.0),
    "needs its A, such as A = ": lambda: Machine.from_dict({}),
    "unknown entry of a machine": lambda: Machine.from_dict({"A": [[-1]], "E": 1}),
    "continuous in time": lambda: Machine.from_system(signal.StateSpace([[0.5]], [[1.0]], [[1.0]], [[0.0]], dt=0.1)),
    "a mere gain is no machine": lambda: Machine.from_system(
        SimpleNamespace(A=np.empty((0, 0)), B=np.empty((0, 1)), C=np.empty((1, 0)), D=[[2.0]])
    ),
    "no state of rest": lambda: (
        Machine([[0.0]], [[1.0]], [[1.0]])
        .response(PiecewiseLaw([0, 1], [PolynomialSegment((0.0,), 1.0)], a0=0.5))
        .peak("output 1")
    ),
    "has zeros .-": lambda: flat_output(chain(1, damping=2.0), None),
    "enters it directly": lambda: flat_output(chain(1), "drive force"),
    "does not move it": lambda: flat_output(Machine([[0, 1], [-9, 0]], [[0], [0]], [[1, 0]]), None),
    "unknown output": lambda: flat_output(chain(1), "torque"),
    "of order 4 at least": lambda: driving_law(chain(1), smoothstep(3)),
    "values must be at least one": lambda: machine_spectrum(belt, [], savin("III", 0)),
    "did you mean 'force motor-load'": lambda: machine_spectrum(
        belt, [1.0], savin("III", 0), output="force motor load"
    ),
    "make must give a Machine": lambda: machine_spectrum(lambda _: 3, [1.0], savin("III", 0)),  # type: ignore[arg-type,return-value]
    "same outputs": lambda: machine_spectrum(
        lambda s: Machine([[-s]], [[s]], [[1.0]], outputs=[f"at {s:g}"]), [1.0, 2.0], savin("III", 0)
    ),
}


@pytest.mark.parametrize("says", WRONG)
def test_wrong_inputs_are_named(says: str) -> None:
    with pytest.raises(InputError, match=says):
        WRONG[says]()

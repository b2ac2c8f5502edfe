"""What leaves the library as JSON is JSON: no Infinity and no NaN, whatever jumps a law has."""

import inspect
import json
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import Any, NoReturn

import pytest
from jsonschema import Draft202012Validator

import optlaws
from optlaws import (
    AsMade,
    Chebyshev,
    DwellMachine,
    MotionLaw,
    Pieces,
    Powers,
    Problem,
    Solution,
    Spring,
    Window,
    deg,
    pareto_front,
    synthesize,
)
from tests.contracts.test_faces import STUBS, package
from tests.internals.laws import Segment
from tests.internals.synthesis import FollowerResidual, MotorTorque, MoveObjective
from tests.laws.examples import EXAMPLES

#: an acceleration that jumps: J has no bound
JUMPS = Problem(order=2, basis=Pieces(degree=3, breaks=4, continuity=1), B=1.8)


def refuse(constant: str) -> NoReturn:
    raise AssertionError(f"{constant} is not JSON")


def strict(text: str) -> Any:
    return json.loads(text, parse_constant=refuse)


@pytest.fixture(scope="module")
def jumping() -> Solution:
    return synthesize(JUMPS)


def test_an_infinite_constant_is_null(jumping: Solution) -> None:
    assert jumping.constants.J.value == float("inf")
    assert jumping.to_dict()["constants"]["J"]["value"] is None
    assert jumping.constants.to_dict()["J"] == jumping.constants.J.to_dict()
    assert replace(jumping.constants, rms_c=float("inf")).to_dict()["rms_c"] is None


@pytest.mark.parametrize("name", EXAMPLES)
def test_laws_and_their_constants(name: str) -> None:
    law = EXAMPLES[name]
    assert strict(json.dumps([law.to_dict(), law.constants.to_dict()]))


@pytest.fixture(scope="module")
def values(jumping: Solution) -> dict[str, Any]:
    """A value of every kind that gives plain data, each with something infinite in it where it can have it."""
    mechanism = optlaws.dwell_mechanism(
        "I",
        law=optlaws.catalogue["K"].law,
        dwell=deg(120),
        rise=deg(90),
        swing=deg(20),
        clutch_angle=deg(15),
        radius_ratio=1.0,
        inertia_ratio=0.1,
    )
    power = synthesize(Problem(order=2, basis=Powers(3), B=1.8, minimise="D"), bound="tight")
    front = pareto_front(replace(JUMPS, B=None), points=2, between=(1.7, 1.9))
    proven = optlaws.proven_front(Problem(order=2, basis=Chebyshev(3)), "B", between=(1.6, 1.61), gap=1e-4)
    slide = optlaws.Cycle([optlaws.Rise("35 mm", law="cycloidal"), optlaws.Return(law="cycloidal")], period="0.2 s")
    turns = [optlaws.Rise("35 deg", law="cycloidal"), optlaws.Return(law="cycloidal")]
    rack = optlaws.rack("20 mm", "5 kg", loads=optlaws.Loads({"0 mm": "0 N", "20 mm": "-3 N"}))
    crank = optlaws.Cycle(turns, period="0.2 s", drive=rack, minimise="rms torque")
    motor = optlaws.Drive(rack, optlaws.Motor("3e-4 kg m^2"), ratio=3.0, efficiency=0.9)
    moved = optlaws.Mechanism("0.8 kg m^2").limit("rms torque", "0 deg", "45 deg", "0.25 s")
    fastest = optlaws.fastest(Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
    return {
        "Solution": jumping,
        "Solution with a power certificate": power,
        "Problem": jumping.problem,
        "Bernstein": optlaws.Bernstein(5),
        "BSplines": optlaws.BSplines(4),
        "Chebyshev": Chebyshev(9),
        "PeriodicPieces": optlaws.PeriodicPieces(8, 5, 3, straight=[1]),
        "Pieces": jumping.problem.basis,
        "Powers": Powers(3),
        "Certificate": jumping.certificate,
        "Certificate of boxes": power.power_certificate,
        "Constants": jumping.constants,
        "Peak": jumping.constants.J,
        "Front": front,
        "Front with errors": replace(front, errors={1.1: no_law(), 1.2: optlaws.SolverFailure("lost", problem=JUMPS)}),
        "FastestMove": fastest,
        "FastestMove with ends that move": optlaws.fastest(
            Problem(order=3), stroke="90 deg", limits={"jerk": "900 rad/s^3"}, start_velocity="2 rad/s"
        ),
        "LeastTime": fastest.least,
        "TransitionCam": slide.run_in("90 deg", rest="-1 mm", over="0.1 s"),
        "TransitionCam of least time": replace(slide, limits={"jerk": "4000 m/s^3"}).run_out("90 deg", rest="40 mm"),
        "TimeFront": optlaws.time_front(fastest, "rms jerk", points=2),
        "MoveObjective": MoveObjective("torque", torque=MotorTorque("1 + 0.3*a", 0.1, "0.2", 2.0, rms=1.0)),
        "FollowerResidual": FollowerResidual(95.0, 105.0, 0.05, most=0.4),
        "MotorTorque": MotorTorque("1 + 0.3*a", 0.1, "0.2", 2.0, peak=3.0),
        "MoveLimits": fastest.least.move.limits,
        "TimedMove": fastest.least.move,
        "TimeProof": fastest.least.proofs[0],
        "FrontPoint": proven(1.605),
        "ProvenFront": proven,
        "SolutionArray": optlaws.synthesize_array(optlaws.ProblemArray(B=[1.05, float("nan"), 1.7, 1.8], order=4)),
        "Window": Window("b", high=1.9),
        "Loader": optlaws.inertial_loader(optlaws.catalogue["0050"].law),
        "BalancedLaw": optlaws.balanced_law(order=4, B=1.8, basis=Chebyshev(3)),
        "DwellMechanism": replace(mechanism, law_1=optlaws.smoothstep(3)),
        "TorsionLever": optlaws.TorsionLever(0.75, 1, 0.15, 0.15, "60 deg"),
        "LeverCam": optlaws.LeverCam(
            optlaws.TorsionLever(0.75, 1, 0.15, 0.15, "60 deg"), "0.05 kg m^2", "120 deg", "150 rpm"
        ),
        "DwellMachine": DwellMachine(mechanism, 10.0, 0.05, 0.005, 0.1, 0.035),
        "Comparison": optlaws.compare_laws(
            "0050", "cycloidal", stroke="35 mm", duration="0.1 s", frequency=(18.0, 20.0)
        ),
        "CatalogueEntry": optlaws.catalogue["constant velocity"],
        "CatalogueEntry of terms": optlaws.catalogue["modified sine"],
        "Segment": EXAMPLES["power of time"].segments[0],  # type: ignore[attr-defined] # a piecewise law
        "PolynomialLaw": optlaws.smoothstep(3),
        "PiecewiseLaw": optlaws.catalogue["modified sine"].law,
        "Machine": optlaws.Machine.from_modes([(8.0, 0.02)], duration=0.4),
        "Drive": optlaws.Drive(optlaws.rack("20 mm", "5 kg"), optlaws.Motor("3e-4 kg m^2"), ratio=3.0),
        "Mechanism": optlaws.rack("20 mm", "5 kg"),
        "LinkGeometry": optlaws.rack("20 mm", "5 kg").linkage,
        "Motor": optlaws.Motor("3e-4 kg m^2"),
        "Body": optlaws.Body("2 kg", centre=("0.1 m", "20 mm")),
        "Loads": optlaws.Loads({"0.3 m": "0 N", "0.5 m": "-400 N"}, gravity="180 deg"),
        "DriveLimit": optlaws.drive_limit("c + 0.5*a", "rms torque", C=9.0),
        "PhasePlane": optlaws.drive_limit("c + 0.5*a", B=1.8).plane,
        "MoveLimit": moved,
        "Overlap": optlaws.Axes({"slide": slide}).fastest(),
        "LimitedMove": moved.move,
        "DriveSheet": optlaws.Drive(optlaws.rack("20 mm", "5 kg"), optlaws.Motor(0.0)).sheet("0050", 0.0, 1.0, 1.0),
        "Effort": optlaws.Cycle(
            [optlaws.Rise("1 rad", "1 s", law="0050")], period="1 s", advance="1 rad", drive={"inertia": "1 kg m^2"}
        ).effort,
        "SegmentEffort": optlaws.Cycle(
            [optlaws.Rise("1 rad", "1 s", law="0050")], period="1 s", advance="1 rad", drive={"inertia": "1 kg m^2"}
        ).efforts[0],
        "CycleSheet": optlaws.Cycle(
            [optlaws.Rise("1 rad", "1 s", law="0050")],
            period="1 s",
            advance="1 rad",
            drive=optlaws.Drive(optlaws.rack("20 mm", "5 kg"), optlaws.Motor(0.0)),
        ).sheet,
        "Cycle": slide,
        "FastestCycle": (fastest_slide := replace(slide, limits={"acceleration": "20 m/s^2"}).fastest()),
        "LeastDuration": fastest_slide.segments[0],
        "Plan": replace(slide, segments=[optlaws.Rise("35 mm"), optlaws.Return(law="cycloidal")]).solve(),
        "Cycle with a mechanism": crank,
        "Axes": optlaws.Axes({"slide": slide}),
        "Axes with a mechanism and a motor": optlaws.Axes(
            {"crank": crank, "motor": {"segments": turns, "drive": motor}}, period="0.2 s"
        ),
        "Dwell": optlaws.Dwell("40 deg", least="0 ms"),
        "ConstantVelocity": optlaws.ConstantVelocity("1 m/s", ["20 deg", "40 deg"], name="belt"),
        "Move": optlaws.Move(to="3 mm", law=optlaws.smoothstep(2), end_velocity="1 m/s"),
        "Rise": optlaws.Rise("35 mm", limits={"acceleration": ("-8 m/s^2", "12 m/s^2"), "snap": "9 m/s^4"}),
        "Return": optlaws.Return(),
        "Free": optlaws.Free("3 mm", "0.3 s", via=[("0.1 s", "2 mm")]),
        "After": optlaws.After("x", "9 mm", of="z", above="31 mm", way="up"),
        "Clearance": optlaws.Clearance("x", over="z", least=[("0 mm", "1 mm"), ("9 mm", "3 mm")]),
        "Forbidden": optlaws.Forbidden("x", "z", [("0 mm", "1 mm"), ("9 mm", "3 mm"), ("9 mm", "1 mm")]),
        "Synchronous": optlaws.Synchronous("x", "z", during=("0.1 s", "0.2 s"), within="1 mm/s"),
        "TranslatingRoller": optlaws.TranslatingRoller("12 mm", offset="3 mm"),
        "TranslatingFlat": optlaws.TranslatingFlat(),
        "InclinedFlat": optlaws.InclinedFlat("10 deg"),
        "OscillatingRoller": optlaws.OscillatingRoller("14 mm", "110 mm", "140 mm"),
        "OscillatingFlat": optlaws.OscillatingFlat("120 mm", "8 mm"),
        "AsMade": AsMade(1e-5, 1.0, float("inf"), 0.1, 1.01, float("inf")),
        "EnergyFluctuation": optlaws.EnergyFluctuation(4.0, 120.0, 30.0, 16.0, 0.5, 2.5),
        "Spring": Spring(3000.0, 20.0, 140.0, "stiffness", 3000.0, 0.0, (92.0, 31.4)),
    }


def no_law() -> optlaws.InfeasibleProblem:
    with pytest.raises(optlaws.InfeasibleProblem) as caught:
        synthesize(Problem(B=1.05, order=4))
    return caught.value


def test_every_value_is_read_again_as_it_was(values: dict[str, Any]) -> None:
    for name, value in values.items():
        stored = value.to_json()
        again = type(value).from_json(stored)
        assert type(again) is type(value), name
        if name in {"SolutionArray", "Front with errors", "Overlap"}:  # which are equal to themselves alone
            assert strict(again.to_json()) == strict(stored), name
        else:
            assert again == value, name


def test_what_a_declared_value_keeps_is_taken_again(values: dict[str, Any]) -> None:
    for name, value in values.items():
        # a mechanism takes its formulas by other names
        if hasattr(value, "json_schema") and not isinstance(value, optlaws.Mechanism):
            assert strict(replace(value).to_json()) == strict(value.to_json()), name


def test_plain_data_is_what_its_schema_says(values: dict[str, Any]) -> None:
    declared = {name: value for name, value in values.items() if hasattr(value, "json_schema")}
    assert {"Motor", "Drive", "Body", "Loads", "LimitedMove", "TranslatingRoller"} <= declared.keys()
    for name, value in declared.items():
        data = {key: part for key, part in strict(value.to_json()).items() if key not in {"format", "about"}}
        errors = [error.message for error in Draft202012Validator(value.json_schema()).iter_errors(data)]
        assert errors == [], name


def test_what_gives_plain_data_reads_it_again(values: dict[str, Any]) -> None:
    four = ("to_dict", "from_dict", "to_json", "from_json")
    has = {one: [name for name in four if hasattr(one, name)] for one in public_classes()}
    assert {one.__name__: names for one, names in has.items() if names and len(names) < len(four)} == {}
    tried = {base for value in values.values() for base in type(value).__mro__}
    # laws and segments are examples of their own
    assert {one for one, names in has.items() if names and not issubclass(one, MotionLaw | Segment)} <= tried


@cache
def public_classes() -> set[type]:
    """The classes behind the names of optlaws and of its rooms."""
    rooms = [import_module(package(stub)) for stub in STUBS]
    found = [getattr(room, name) for room in rooms for name in room.__all__]
    return {one for one in found if inspect.isclass(one)}


@pytest.mark.parametrize("value", ["{", "[]", "{}", '{"law": 3, "value": "x", "over": [1]}'])
def test_what_is_no_such_value_is_refused(value: str) -> None:
    for one in public_classes():
        if hasattr(one, "from_json") and not (value == "{}" and has_all_defaults(one)):
            with pytest.raises(optlaws.InputError):
                one.from_json(value)


def has_all_defaults(one: Any) -> bool:
    """Whether a declared value needs no entry, as a body without mass."""
    return hasattr(one, "json_schema") and not one.json_schema().get("required", ["kind"])

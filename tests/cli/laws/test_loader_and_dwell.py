"""The commands `optlaws loader` and `optlaws dwell`."""

import json
from math import degrees, gcd, radians
from pathlib import Path

import pytest

from optlaws import Clutch, MotionLaw, catalogue, deg, dwell_mechanism, inertial_loader, smoothstep
from tests.internals.cli import BAD_INPUT, exit_code

DWELL = (
    "--dwell 90 --rise 90 --swing 20 --clutch-angle 15 --radius-ratio 1.0026761 --inertia-ratio 0.1 --most-torque 0.5"
)


def test_a_loader_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["loader", "0050", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["Y"] == pytest.approx(0.6366197724)
    assert data["constants"]["C"]["value"] is None
    assert MotionLaw.from_dict(data["law"]).b(0.5) == 0.0


def test_a_loader_of_a_file_and_its_mass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "law.json", tmp_path / "loader.json"
    machine = ["--executive-mass", "2.5", "--executive-stroke", "0.04"]
    for text in (smoothstep(4).to_json(), json.dumps({"law": smoothstep(4).to_dict()})):
        file.write_text(text, "utf-8")
        assert exit_code(["loader", str(file), *machine, "--stroke", "0.03", "--output", str(out)]) == 0
        shown = capsys.readouterr().out
        assert (
            f"{inertial_loader(smoothstep(4)).mass(executive_mass=2.5, executive_stroke=0.04, stroke=0.03):.8g}"
            in shown
        )
        assert MotionLaw.from_dict(json.loads(out.read_text("utf-8"))["law"]) == inertial_loader(smoothstep(4)).law
    assert exit_code(["loader", str(file), *machine, "--mass", "3"]) == 0
    assert "stroke of the loader" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["loader", "nonsense law"], "no law is called"),
        (["loader", "constant velocity"], "inside the motion"),
        (["loader", "K", "--stroke", "2"], "go together"),
        (["loader", "missing.json"], "No such file"),
        (["loader", "K", "--executive-mass", "1", "--executive-stroke", "1", "--mass", "1", "--stroke", "1"], "either"),
        (["dwell", "K", *DWELL.replace("--dwell 90", "--dwell -90").split()], "dwell must be positive"),
        (["dwell", "K", *DWELL.replace("0.5", "0").split()], "most_torque must be positive"),
    ],
)
def test_wrong_input(arguments: list[str], text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(arguments) == BAD_INPUT
    assert text in capsys.readouterr().err


def test_a_file_that_holds_no_law(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "law.json"
    for content, why in (("nothing", "must be JSON text"), ("[1]", "must be a dict"), ('{"format": 1}', "kind of law")):
        file.write_text(content, "utf-8")
        assert exit_code(["loader", str(file)]) == BAD_INPUT
        assert why in capsys.readouterr().err


def test_dwell_compares_and_chooses(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["dwell", "K", *DWELL.split()]) == 0
    shown = capsys.readouterr().out
    for part in ("take type III", "1.78435", "1.9827", "1.59434", "0.021140605"):
        assert part in shown
    assert exit_code(["dwell", "K", *DWELL.split(), "--law-2", "3-4-5 polynomial", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["chosen"] == "III"
    assert data["types"]["II"]["dwell"] == pytest.approx(radians(90))
    assert all(one["p"] >= 1 for one in data["clutches"]["III"]["teeth"])


def test_dwell_tells_what_would_make_the_teeth_exact(capsys: pytest.CaptureFixture[str]) -> None:
    mechanism = dwell_mechanism(
        "III",
        law=catalogue["K"].law,
        dwell=deg(90),
        rise=deg(90),
        clutch_angle=deg(15),
        swing=deg(20),
        radius_ratio=1.0026761,
        inertia_ratio=0.1,
    )
    clutch = Clutch(mechanism)
    best = [choice for choice in clutch.choices(1, 60) if gcd(choice.p, choice.N) == 1][:3]
    assert exit_code(["dwell", "K", *DWELL.split(), "--teeth", "60"]) == 0
    lines = [line.split(maxsplit=5) for line in capsys.readouterr().out.splitlines()]
    rows = [line for line in lines if line[:2] == ["III", "0.021140605"]]
    assert [row[:5] for row in rows] == [
        ["III", "0.021140605", str(one.p), str(one.N), f"{degrees(one.error):.4f}"] for one in best
    ]
    for row, one in zip(rows, best, strict=True):
        assert one.swing is not None
        assert one.dwell is not None
        assert one.rise is not None
        assert one.B2 is not None
        assert row[5].strip() == (
            f"swing {degrees(one.swing):.5g} or dwell {degrees(one.dwell):.5g} or rise {degrees(one.rise):.5g} "
            f"or B2 = {one.B2:.5g}"
        )
    assert exit_code(["dwell", "K", *DWELL.split(), "--teeth", "60", "--json"]) == 0
    teeth = json.loads(capsys.readouterr().out)["clutches"]["III"]["teeth"]
    assert [(one["p"], one["N"], one["swing"], one["B2"]) for one in teeth] == [
        (one.p, one.N, pytest.approx(one.swing), pytest.approx(one.B2)) for one in best
    ]
    # of so few teeth none meet: the nearest is told
    assert exit_code(["dwell", "K", *DWELL.split(), "--teeth", "20", "--json"]) == 0
    teeth = json.loads(capsys.readouterr().out)["clutches"]["III"]["teeth"]
    assert [(one["p"], one["N"]) for one in teeth] == [(clutch.nearest(20).p, clutch.nearest(20).N)]


@pytest.mark.parametrize(
    ("rise", "dwell", "lower", "fits"),
    [
        ("90", "90", None, True),
        ("90.01", "90", None, False),
        ("100", "100", "60", True),
        ("100", "100", "60.01", False),
        ("100", "100", None, False),
    ],
)
def test_a_turn_has_room_for_its_angles(
    rise: str, dwell: str, lower: str | None, *, fits: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = DWELL.replace("--dwell 90 --rise 90", f"--dwell {dwell} --rise {rise}").split()
    asked += [] if lower is None else ["--lower-dwell", lower]
    assert exit_code(["dwell", "K", *asked]) == (0 if fits else BAD_INPUT)
    message = " ".join(capsys.readouterr().err.split())
    assert ("more than one turn" in message) is not fits
    if not fits:
        total = 2 * float(rise) + float(dwell) + float(lower or dwell)
        assert f"{total:.6g} degrees" in message
        assert ("as long as the upper one" in message) is (lower is None)


def test_dwell_says_why_a_type_cannot_be_built(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["dwell", "K", *DWELL.split(), "--lower-dwell", "0"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "cannot be built" in shown
    assert "add up to 270 degrees" in shown


def test_more_than_one_turn_is_refused_and_less_is_said_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["dwell", "K", *DWELL.split(), "--lower-dwell", "150"]) == 2
    assert "add up to 420 degrees, more than one turn" in capsys.readouterr().err
    assert exit_code(["dwell", "K", *DWELL.split(), "--lower-dwell", "0"]) == 0
    assert capsys.readouterr().out.startswith("mind: rise, return and dwells add up to 270 degrees")

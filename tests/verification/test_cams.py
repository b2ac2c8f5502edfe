"""Cams in files: the laws are proven, and each number of a cam is computed again from its entries and its laws."""

import json
import tomllib
from functools import cache
from pathlib import Path as FilePath
from typing import Any

import pytest

from optlaws.errors import InputError
from optlaws.verification import verify, verify_all
from tests.documents import ROOT
from tests.internals.jobs import read_of_cam, stored_cam
from tests.internals.verification import differences
from tests.verification.tampering import Path, changed, places, value_at


@cache
def stored(name: str) -> dict[str, Any]:
    return json.loads((ROOT / "results" / name / "cam.json").read_text("utf-8"))  # type: ignore[no-any-return]


def other(value: Any) -> Any:
    """A value beside one: a number off by a millionth, a 0 by a thousandth, another text, the opposite."""
    if isinstance(value, bool) or value is None:
        return not value
    return f"{value} or so" if isinstance(value, str) else value + (1e-6 * abs(value) if abs(value) > 1e-9 else 1e-3)


def part(data: dict[str, Any], path: Path) -> dict[str, Any]:
    """The entry of a place alone."""
    return {key: value for key, value in data.items() if key == path[0]}


CAMS = list((ROOT / "results").glob("*/cam.json"))


def numbers(data: dict[str, Any]) -> list[Path]:
    """The places of what is stated of a cam."""
    known = (path for path in places(data) if path[0] not in {"about", "unit", "cam", "solutions"})
    return [path for path in known if isinstance(value_at(data, path), int | float | str)]


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("cam_best_laws", {"best.objective", "best.lower_bound", "laws.objective", "laws.lower_bound"}),
        ("cam_best_prime_circle", {"laws.objective"}),
    ],
)
def test_the_laws_of_a_cam_are_proven_and_its_numbers_computed_again(name: str, more: set[str]) -> None:
    verification = verify(stored(name))
    assert verification.proven
    places_of_claims = {claim.name.split(":")[0] for claim in verification.claims}
    assert places_of_claims == {"solutions[0]", "solutions[1]", *more}
    assert {claim.name for claim in verification.recomputed} == {"the laws of the motion", "the numbers"}


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", [file.parent.name for file in sorted(CAMS, key=lambda file: file.stat().st_size)])
def test_every_number_of_a_cam_that_is_changed_is_found(name: str) -> None:
    data = stored(name)
    known = stored_cam(data).data
    assert list(differences(data, known | {"about": data["about"]}, "")) == []
    believed = []
    for path in numbers(data):
        wrong = changed(part(data, path), path, other(value_at(data, path)))
        believed += [] if list(differences(wrong, known, "")) else [path]
    assert believed == []


def test_a_number_of_a_cam_that_is_changed_is_not_proven() -> None:
    data = stored("cam_rocker")
    path = ("greatest_pressure_angle", "high")
    verification = verify(changed(data, path, other(value_at(data, path))))
    assert [claim.name for claim in verification.claims if not claim.proven] == ["greatest_pressure_angle.high"]


def test_a_cam_with_the_names_of_earlier_files_is_proven() -> None:
    data = dict(stored("cam_pair"))
    least, greatest = (data["pressure_angles"][name] for name in ("least", "greatest"))
    data |= {"least_pressure_angle": least, "largest_pressure_angle": greatest, "hollow_radius": data["concave_radius"]}
    data |= {"bulging_radius": data["convex_radius"]}
    data["usual_law"] = data["usual_law"] | {"values": data["usual_law"]["values"][1:]}
    for name in ("pressure_angles", "convex_radius", "concave_radius"):
        del data[name]
    assert verify(data).proven
    assert not verify(changed(data, ("bulging_radius", "low"), 0.9 * data["bulging_radius"]["low"])).proven


def test_what_a_cam_does_not_state_though_its_page_does_is_named() -> None:
    data = {name: value for name, value in stored("cam_pair").items() if name != "usual_law"}
    missing = [claim for claim in verify(data).unchecked if "does not state" in claim.detail]
    assert [claim.name for claim in missing] == ["usual_law"]


def test_entries_of_a_cam_that_are_changed_are_found() -> None:
    data = stored("cam_best_laws")
    for path, value in (
        (("cam", "prime_radius"), "51 mm"),
        (("cam", "speed"), "201 rpm"),
        (("solutions", 0, "objective"), 1.001 * data["solutions"][0]["objective"]),
        (("best", "lower_bound"), 1.001 * data["best"]["lower_bound"]),
    ):
        assert not verify(changed(data, path, value)).proven, path


def test_a_cam_without_its_entries_is_refused() -> None:
    data = {name: value for name, value in stored("cam_best_laws").items() if name != "cam"}
    with pytest.raises(InputError, match=r"states .* without a certificate"):
        verify_all(data)


ROCKER = """
job = "cam"
title = "A rocker"
speed = "120 rpm"
prime_radius = "62 mm"
pressure_angle = "27 deg"
best = "laws"
follower = { kind = "oscillating roller", radius = "14 mm", arm = "110 mm", pivot_distance = "140 mm" }
[motion]
name = "rocker"
degree = 7
segment = [
    { kind = "rise", by = "25 deg", duration = "110 deg" },
    { kind = "dwell", duration = "60 deg" },
    { kind = "return", duration = "130 deg" },
    { kind = "dwell" },
]
"""


def test_the_bound_of_laws_for_an_arm_is_that_of_solutions_in_its_file() -> None:
    """Its limit of the pressure angle is no line: laws below lines above it have a bound of their own."""
    entries = tomllib.loads(ROCKER)
    data = json.loads(json.dumps(read_of_cam(entries, FilePath("rocker.toml")).data))
    assert data["best"]["lower_bound"] < data["best"]["objective"] * (1.0 - 1e-6)
    verification = verify(data)
    assert verification.proven
    [laws] = [claim.detail for claim in verification.recomputed if claim.name == "the laws of the motion"]
    assert (data["laws"]["status"], laws.rpartition(" ")[2]) == ("local", "local")
    assert {"best.lower_bound", "bounding_solutions[0]", "bounding_solutions[1]"} <= {
        claim.name.split(":")[0] for claim in verification.claims
    }
    assert json.loads(json.dumps(stored_cam(data).data)) == data
    [higher] = [claim for claim in verify(raised(data, "best")).claims if not claim.proven]
    assert higher.name == "best.lower_bound"
    # the bounds of laws below the lines that their own laws keep are none of all laws
    within = verify({**data, "bounding_solutions": data["solutions"]})
    assert "best.lower_bound" in {claim.name for claim in within.claims if not claim.proven}
    # as of files written before
    earlier = verify({name: value for name, value in data.items() if name != "bounding_solutions"})
    assert "best.lower_bound" in {claim.name for claim in earlier.unchecked}


def raised(data: dict[str, Any], name: str) -> dict[str, Any]:
    """The data with a lower bound that is between the proven one and the objective."""
    known = data[name]
    return {**data, name: {**known, "lower_bound": 0.5 * (known["lower_bound"] + known["objective"])}}

"""Cams in files: the laws are proven, and each number of a cam is computed again from its entries and its laws."""

import json
from functools import cache
from typing import Any

import numpy as np
import pytest

from optlaws.errors import InputError
from optlaws.verification import verify, verify_all
from tests.documents import ROOT
from tests.verification.tampering import Path, changed, places, value_at


@cache
def stored(name: str) -> dict[str, Any]:
    return json.loads((ROOT / "results" / name / "cam.json").read_text("utf-8"))  # type: ignore[no-any-return]


def other(value: Any) -> Any:
    """A value beside one: a number off by a millionth, another text, the opposite."""
    if isinstance(value, bool) or value is None:
        return not value
    return f"{value} or so" if isinstance(value, str) else value + 1e-6 * max(abs(value), 1e-3)


def numbers(data: dict[str, Any]) -> list[Path]:
    """The places of what is stated of a cam."""
    known = (path for path in places(data) if path[0] not in {"about", "unit", "cam", "solutions"})
    return [path for path in known if isinstance(value_at(data, path), int | float | str)]


@pytest.mark.parametrize("name", ["cam_best_laws", "cam_best_prime_circle"])
def test_the_laws_of_a_cam_are_proven_and_its_numbers_computed_again(name: str) -> None:
    verification = verify(stored(name))
    assert verification.proven
    places_of_claims = {claim.name.split(":")[0] for claim in verification.claims}
    assert places_of_claims == {"solutions[0]", "solutions[1]", "laws.objective"}
    assert {claim.name for claim in verification.unchecked} == {"the laws of the motion", "the numbers"}


@pytest.mark.parametrize("name", ["cam_barrel", "cam_best_laws", "cam_best_prime_circle", "cam_rocker"])
def test_numbers_of_a_cam_that_are_changed_are_found(name: str) -> None:
    data = stored(name)
    found = numbers(data)
    for i in np.random.default_rng(2026).permutation(len(found))[:6]:
        path = found[i]
        assert not verify(changed(data, path, other(value_at(data, path)))).proven, path


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(file.parent.name for file in (ROOT / "results").glob("*/cam.json")))
def test_every_number_of_a_cam_that_is_changed_is_found(name: str) -> None:
    data = stored(name)
    for path in numbers(data):
        assert not verify(changed(data, path, other(value_at(data, path)))).proven, path


def test_entries_of_a_cam_that_are_changed_are_found() -> None:
    data = stored("cam_best_laws")
    for path, value in (
        (("cam", "prime_radius"), "51 mm"),
        (("cam", "follower", "radius"), "13 mm"),
        (("cam", "speed"), "201 rpm"),
        (("solutions", 0, "objective"), 1.001 * data["solutions"][0]["objective"]),
        (("best", "lower_bound"), 1.001 * data["best"]["lower_bound"]),
    ):
        assert not verify(changed(data, path, value)).proven, path


def test_a_cam_without_its_entries_is_refused() -> None:
    data = {name: value for name, value in stored("cam_best_laws").items() if name != "cam"}
    with pytest.raises(InputError, match="claims something without a certificate"):
        verify_all(data)

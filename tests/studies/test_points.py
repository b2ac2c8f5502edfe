"""Study files: what varies, its points and their order, their problems, and the command."""

import json
import sys
from collections.abc import Mapping
from itertools import pairwise
from math import isclose, prod
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import BSplines, InputError, Pieces, Problem, Range, at_most, between
from tests.internals.cli import exit_code
from tests.internals.studies import StudyPoints, axes, entries, filled, key, problem, read_study
from tests.internals.synthesis import PROBLEM


def points(**study: object) -> StudyPoints:
    return StudyPoints.of(read_study({"problem": {"order": 4}, **study}))


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.integers(1, 7))
def test_every_point_is_solved_once_and_neighbours_differ_by_one_step(shape: list[int], chunk: int) -> None:
    names = ["C", "D", "J", "B"]
    places = points(
        vary={name: [2.0 + i for i in range(n)] for name, n in zip(names, shape, strict=False)}, chunk=chunk
    )
    order = [index for number in range(places.chunks) for index in places.of_chunk(number)]
    assert len(places) == prod(shape)
    assert sorted(order) == list(range(prod(shape)))
    for one, other in pairwise(order):
        first, second = places.inputs(one), places.inputs(other)
        assert sum(abs(first[name] - second[name]) for name in first) == 1.0
    assert all(places.chunk_of(index) == n for n in range(places.chunks) for index in places.of_chunk(n))


def test_the_index_counts_through_the_product_with_B_fastest() -> None:
    places = points(vary={"B": [1.5, 1.6], "order": [3, 4, 5]})
    assert [places.inputs(i) for i in (0, 1, 2)] == [
        {"order": 3, "B": 1.5},
        {"order": 3, "B": 1.6},
        {"order": 4, "B": 1.5},
    ]


def test_ranges_have_their_ends_exactly_and_equal_steps_or_ratios() -> None:
    linear, log = axes(
        read_study(
            {
                "problem": {"order": 4},
                "vary": {
                    "J": {"from": 30, "to": 3000, "steps": 5, "scale": "log"},
                    "B": {"from": 1.5, "to": 1.8, "steps": 4},
                },
            }
        )
    )[::-1]
    assert list(linear.columns["B"]) == [1.5, 1.6, 1.7, 1.8]
    values = list(log.columns["J"])
    assert values[0] == 30.0
    assert values[-1] == 3000.0
    assert all(isclose(b / a, 10.0**0.5, rel_tol=1e-12) for a, b in pairwise(values))


def test_ten_million_points_are_no_burden() -> None:
    vary = {"B": {"from": 1.2, "to": 2.5, "steps": 10_000_000}, "order": [3, 4]}
    places = points(vary=vary)
    assert len(places) == 20_000_000
    assert list(places.of_chunk(places.chunks - 1).values())[-1] == {"order": 4, "B": 1.2}


@pytest.mark.parametrize("kind", ["sobol", "latin hypercube"])
def test_samples_are_spread_evenly_and_repeat_with_their_seed(kind: str) -> None:
    over = {
        "B": {"from": 1.5, "to": 2.5},
        "degree": {"from": 5, "to": 8},
        "J": {"from": 50, "to": 5000, "scale": "log"},
    }

    def sample(seed: int) -> list[dict[str, Any]]:
        places = points(sample=[{"kind": kind, "points": 64, "seed": seed, "over": over}])
        return [places.inputs(index) for index in range(len(places))]

    sampled_values = sample(1)
    assert sampled_values == sample(1)
    assert sampled_values != sample(2)
    # one point in each 64th of the span, in every dimension: both kinds promise that
    assert sorted(int(64 * (one["B"] - 1.5)) for one in sampled_values) == list(range(64))
    assert [sum(one["degree"] == n for one in sampled_values) for n in (5, 6, 7, 8)] == [16] * 4
    assert sum(one["J"] < 500.0 for one in sampled_values) == 32


def test_lists_run_together_and_multiply_with_the_rest() -> None:
    places = points(together=[{"B": [1.5, 1.8], "degree": [9, 5]}], vary={"minimise": ["C", "rms_c"]})
    assert [tuple(places.inputs(i).values()) for i in range(4)] == [
        ("C", 1.5, 9),
        ("C", 1.8, 5),
        ("rms_c", 1.5, 9),
        ("rms_c", 1.8, 5),
    ]


def test_places_in_text_bounds_and_free_constants() -> None:
    assert filled("{w}*C/4 + {1-w}*rms_c/3.5", {"w": 0.25}) == "0.25*C/4 + 0.75*rms_c/3.5"
    base = {"order": 4, "minimise": "{w}*C/4 + {1-w}*rms_c/3.5", "B": 1.7, "bounds": {"snap": [0, 900]}}
    asked = entries(base, {"w": 0.25, "bounds.rms_c": 4.0, "B": "free", "bounds.snap": "free"})
    assert Problem.from_dict(asked) == Problem(order=4, minimise="0.25*C/4 + 0.75*rms_c/3.5", bounds={"rms_c": 4.0})


def test_upper_and_lower_bounds_vary_of_every_constant() -> None:
    base = {"order": 4, "B": 1.7, "C": [4.5, 9.0], "bounds": {"rms_c": [3.0, 5.0], "D": [0.0, 9.0]}}
    asked = {"at_most.C": 6.0, "at_most.J": 80.0, "at_least.rms_c": 3.5, "at_most.peak(c - {w}*b)": 7.0, "w": 2.0}
    expected = Problem(
        order=4,
        B=1.7,
        C=between(4.5, 6.0),
        J=at_most(80.0),
        bounds={"rms_c": between(3.5, 5.0), "D": at_most(9.0), "peak(c - 2.0*b)": at_most(7.0)},
    )
    assert Problem.from_dict(entries(base, asked)) == expected
    assert entries(base, {"at_most.C": "free", "at_least.B": 1.6})["B"] == [1.6, None]
    assert "C" not in entries(base, {"at_most.C": "free"})


def test_upper_bounds_vary_along_spans_samples_and_lists_together() -> None:
    over = {"at_most.rms_c": {"from": 3.5, "to": 5.0}, "at_least.B": {"from": 1.5, "to": 1.6}}
    places = points(
        vary={"at_most.J": {"from": 40.0, "to": 4000.0, "steps": 3, "scale": "log"}},
        together=[{"at_most.snap": [900.0, 9000.0], "degree": [9, 11]}],
        sample=[{"kind": "sobol", "points": 4, "seed": 1, "over": over}],
    )
    problems = [Problem.from_dict(entries({"order": 4}, places.inputs(i))) for i in range(len(places))]
    assert len({problem.J for problem in problems}) == 3
    assert {problem.J for problem in problems} == {at_most(40.0), at_most(400.0), at_most(4000.0)}
    assert all(
        problem.bounds["rms_c"].low == 0.0 and 3.5 <= problem.bounds["rms_c"].high <= 5.0 for problem in problems
    )
    assert all(isinstance(problem.B, Range) and 1.5 <= problem.B.low <= 1.6 for problem in problems)
    assert {problem.bounds["snap"] for problem in problems} == {at_most(900.0), at_most(9000.0)}


def test_a_key_depends_on_the_problem_alone() -> None:
    first = points(vary={"B": [1.5, 1.6], "degree": [5, 9]})
    second = StudyPoints.of(read_study({"problem": {"degree": 9}, "vary": {"order": [4], "B": [1.6]}}))
    given_first, given_second = first.study.problem, second.study.problem
    assert key(entries(given_first, first.inputs(3))) == key(entries(given_second, second.inputs(0)))
    assert len({key(entries(given_first, first.inputs(i))) for i in range(4)}) == 4


@pytest.mark.parametrize(
    ("study", "message"),
    [
        ({"vari": {"B": [1.5]}}, "unknown entry of a study 'vari'; did you mean 'vary'"),
        ({"vary": {"degre": [5]}}, "unknown entry 'degre'; did you mean 'degree'"),
        ({}, "nothing varies"),
        ({"vary": {"at_mots.J": [5.0]}}, "unknown entry 'at_mots.J'; did you mean 'at_most.NAME'"),
        ({"vary": {"J": [60.0], "at_most.J": [50.0]}}, "J varies twice"),
        ({"vary": {"bounds.rms_c": [4.0], "at_most.rms_c": [5.0]}}, "rms_c varies twice"),
        (
            {"vary": {"B": {"from": 1.5, "to": 2.0, "step": 3}}},
            "vary: B: unknown entry of a range 'step'; did you mean 'steps'",
        ),
        ({"vary": {"B": {"from": 1.5, "to": 2.0}}}, "steps"),
        ({"vary": {"B": []}}, "vary: B: it must be a list of one value at least"),
        ({"vary": {"J": {"from": 0, "to": 9, "steps": 2, "scale": "log"}}}, "a log scale needs from and to above 0"),
        (
            {"vary": {"degree": {"from": 3, "to": 6, "steps": 3}}},
            "degree must be a whole number at every point, got 4.5",
        ),
        ({"vary": {"minimise": {"from": 3, "to": 6, "steps": 3}}}, "minimise is no number"),
        ({"vary": {"minimise": [3]}}, "minimise must be a text, got 3"),
        ({"vary": {"monotone": ["yes"]}}, "monotone must be true or false"),
        ({"vary": {"B": [1.5]}, "together": [{"B": [1.5]}]}, "B varies twice"),
        ({"together": [{"B": [1.5], "degree": [3, 4]}]}, "lists of one table must be of one length"),
        ({"sample": [{"kind": "sobol", "points": 100, "seed": 1, "over": {"B": {"from": 1, "to": 2}}}]}, "64 or 128"),
        ({"sample": [{"kind": "halton", "points": 64, "seed": 1, "over": {"B": {"from": 1, "to": 2}}}]}, "halton"),
        ({"vary": {"minimise": ["{w}*C"]}}, "nothing fills the place {w}: vary w"),
        ({"vary": {"B": [1.5]}, "time_limit": -1}, "time_limit"),
    ],
)
def test_wrong_studies_are_refused(study: Mapping[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message.replace("{", r"\{").replace("}", r"\}")):
        points(**study)


# --- problems in files ---


def asked(**entries: Any) -> Problem:
    return problem("row 1", PROBLEM.read(entries, "problem"))


def test_every_entry_is_read() -> None:
    found = asked(
        order=3,
        basis="bsplines",
        degree=3,
        breaks=[0, 0.3, 0.7, 1],
        continuity=2,
        bounds={"rms_c": [0, 4], "snap": 900.0},
    )
    assert found == Problem(
        order=3, basis=BSplines((0, 0.3, 0.7, 1), 3, 2), bounds={"rms_c": at_most(4), "snap": 900.0}
    )
    assert asked(order=3, basis="pieces", degree=4, breaks=8, bounds={"rms_c": [3.5, 4]}) == Problem(
        order=3, basis=Pieces(8, 4), bounds={"rms_c": between(3.5, 4)}
    )
    assert asked(order=3, symmetric=False, inflexion=0.4).inflexion == 0.4
    assert asked(order=3, bounds={"rms_c": "free"}) == Problem(order=3)


@pytest.mark.parametrize(
    ("entries", "text"),
    [
        ({"basis": "spline"}, "basis"),
        ({"inflexion": 1.0}, "inflexion"),
        ({"inflexion": 0.4}, "symmetric=False"),
        ({"bounds": {"rmsc": 4}}, "did you mean 'rms_c'"),
        ({"basis": "bsplines", "degree": 3}, "the basis 'bsplines' needs its breaks"),
        (
            {"basis": "powers", "degree": 3, "continuity": 2},
            "has no continuity: leave it out, or take bsplines or periodic or pieces",
        ),
    ],
)
def test_entries_that_make_no_sense_are_refused(entries: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        asked(order=3, **entries)


# --- the command ---
def test_the_command_study_says_what_it_did(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "small.toml", str(tmp_path / "study")
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5, 1.2]\ndegree = [3]\n")
    assert exit_code(["study", str(file), "--out", out, "--workers", "1", "--json"]) == 0
    results = capsys.readouterr()
    assert json.loads(results.out)["counts"] == {"optimal": 1, "infeasible": 1}
    assert "2 of 2" in results.err
    assert exit_code(["study", "--status", out]) == 0
    assert "2 of 2 points (finished)" in capsys.readouterr().out
    for wrong, text in (
        ([], "name a study file"),
        ([str(file), "--status", out], "--status takes a directory and neither"),
        ([str(tmp_path / "no.toml")], "cannot read"),
        (["--status", str(tmp_path)], "contains no study"),
    ):
        assert exit_code(["study", *wrong]) == 2
        assert text in capsys.readouterr().err


def test_a_cluster_without_its_package_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "small.toml"
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5]\n")
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert exit_code(["study", str(file), "--dask", "tcp://x:1"]) == 2
    assert "pip install 'optlaws[cluster]'" in capsys.readouterr().err

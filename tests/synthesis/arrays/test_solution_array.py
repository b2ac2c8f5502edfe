"""Solutions as arrays: their shape, their numbers, what a wrong entry does, and the ordinary solutions within."""

import copy
import inspect
import json
import pickle
from dataclasses import FrozenInstanceError, fields, replace
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    InfeasibleProblem,
    InputError,
    Problem,
    ProblemArray,
    Solution,
    SolutionArray,
    at_most,
    between,
    map_arrays,
    synthesize,
    synthesize_array,
    synthesize_chunks,
    via,
)
from optlaws.verification import verify_all
from tests.internals.synthesis import solved

B = np.array([[1.6, np.nan, 1.7], [1.8, 0.5, 1.9]])


def test_a_wrong_number_spoils_its_own_place_alone_and_says_why() -> None:
    laws = synthesize_array(ProblemArray(B=B, order=4))
    assert laws.status.tolist() == [["optimal", "invalid", "optimal"], ["optimal", "invalid", "optimal"]]
    assert (np.isnan(laws.objective) == (laws.status == "invalid")).all()
    assert laws.errors.keys() == {1, 4}
    with pytest.raises(InputError, match="B must be a finite number above 1"):
        laws[0, 1]
    for at in ((0, 0), (1, 2)):
        single = synthesize(Problem(B=float(B[at]), order=4))
        assert laws.objective[at] == pytest.approx(single.objective, rel=1e-9)
        assert laws[at].objective == laws.objective[at]
        for name in ("B", "C", "D", "J"):
            assert getattr(laws, name)[at] == pytest.approx(getattr(single.constants, name).value, rel=1e-9)


def test_an_end_without_laws_is_infeasible_there_and_nowhere_else() -> None:
    laws = synthesize_array(ProblemArray(B=1.6, C=(None, np.array([5.3, 5.2])), order=4, minimise="J"))
    assert laws.status.tolist() == ["optimal", "infeasible"]
    with pytest.raises(InfeasibleProblem):
        laws[1]


def test_slices_are_arrays_and_indices_are_solutions() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(1.5, 2.0, 5), order=4))
    assert laws[1:4].shape == (3,)
    assert laws[1:4].C.tolist() == laws.C[1:4].tolist()
    assert isinstance(laws[-1], Solution)
    assert [law.objective for law in laws] == laws.objective.tolist()
    with pytest.raises(IndexError):
        laws[5]


def test_nobody_can_write_to_the_numbers() -> None:
    laws = synthesize_array(ProblemArray(B=np.array([1.5, 1.6]), order=4))
    for values in (laws.objective, laws.C, laws.gap, laws.z, laws.status, laws.contacts["k"]):
        with pytest.raises(ValueError, match="read-only"):
            values[...] = values[0]


def test_pieces_come_in_order_and_hold_what_the_whole_holds() -> None:
    problems = ProblemArray(B=np.linspace(1.5, 2.0, 5), order=4)
    pieces = list(synthesize_chunks(problems, size=2))
    assert [piece.size for piece in pieces] == [2, 2, 1]
    together = np.concatenate([piece.objective for piece in pieces])
    np.testing.assert_allclose(together, synthesize_array(problems).objective, rtol=1e-12)


def test_problems_of_several_kinds_are_solved_in_their_order() -> None:
    problems = [Problem(B=1.6, order=3), Problem(B=1.7, order=4, basis=Chebyshev(5)), Problem(order=4, J=at_most(60))]
    laws = solved(ProblemArray.of(problems))
    for i, problem in enumerate(problems):
        assert laws[i].problem == problem
        assert laws.objective[i] == pytest.approx(synthesize(problem).objective, rel=1e-9)


def test_values_that_are_no_numbers_come_from_a_function() -> None:
    bounds = map_arrays(at_most, np.array([60.0, 70.0]))
    problems = ProblemArray(J=bounds, B=1.7, order=4)
    assert problems[1] == Problem(J=at_most(70.0), B=1.7, order=4)
    assert ProblemArray(J=(None, np.array([60.0, 70.0])), B=1.7, order=4)[0] == problems[0]


MANY: dict[str, Any] = {
    "list": [1.6, 1.7, 1.8],
    "tuple": (1.6, 1.7, 1.8),
    "range": range(2, 5),
    "rows": [[1.6], [1.7]],
    "list of two": [1.6, 1.7],
    "list of texts": ["C", "J"],
    "Series": pd.Series([1.6, 1.7, 1.8], index=[3, 4, 5]),
    "Index": pd.Index([1.6, 1.7]),
    "DataArray": xr.DataArray([[1.6, 1.7]], dims=("a", "b")),
    "None among numbers": [None, 1.7],
    "a Range among numbers": [at_most(1.7), 1.7],
}


@pytest.mark.parametrize("name", MANY)
def test_whatever_holds_many_values_is_an_array(name: str) -> None:
    values = MANY[name]
    plain = np.asarray(values)
    entry = "minimise" if name == "list of texts" else "B"
    problems = ProblemArray(**{"order": 4, "B": 1.7, entry: values})
    assert problems.shape == plain.shape
    for place, value in enumerate(plain.flat):
        assert problems.problem(place) == Problem(**{"order": 4, "B": 1.7, entry: value})


def test_lists_are_arrays_within_pairs_and_bounds() -> None:
    assert ProblemArray(B=1.7, J=(None, [60.0, 70.0]), order=4)[1] == Problem(B=1.7, J=at_most(70.0), order=4)
    bounds = ProblemArray(B=1.7, bounds={"rms_c": (None, [4.0, 5.0])}, order=[3, 4])
    assert bounds[1] == Problem(B=1.7, bounds={"rms_c": at_most(5.0)}, order=4)


def test_a_pair_is_a_range_and_windows_are_one_value() -> None:
    assert ProblemArray(B=(1.5, 1.6), order=4).problem(0) == Problem(B=between(1.5, 1.6), order=4)
    windows = [via("b", 1.0, at=0.25), via("b", 1.0, at=0.75)]
    assert ProblemArray(B=[1.6, 1.7], windows=windows, order=4)[1] == Problem(B=1.7, windows=tuple(windows), order=4)


def test_what_makes_no_array_of_problems_is_refused() -> None:
    for wrong in ([[1.6, 1.7], [1.8]], {1.6, 1.7}, (value for value in (1.6, 1.7)), {"B": 1.7}.values()):
        with pytest.raises(InputError, match=r"^B (has rows of several lengths|takes many values as a list)"):
            ProblemArray(B=wrong, order=4)
    with pytest.raises(InputError, match="one shape"):
        ProblemArray(B=np.ones(2), J=np.ones(3))
    with pytest.raises(TypeError, match="unexpected keyword argument 'ordr'"):
        ProblemArray(ordr=4)  # type: ignore[call-arg]


def test_an_array_of_problems_takes_the_entries_of_a_problem_and_fills_in_none() -> None:
    assert set(inspect.signature(ProblemArray).parameters) == set(inspect.signature(Problem).parameters)
    assert ProblemArray(order=4, B=None).entries == {"order": 4, "B": None}


@pytest.fixture(scope="module")
def together() -> SolutionArray:
    return synthesize_array(ProblemArray(B=np.linspace(1.5, 2.0, 200), order=4))


def test_a_solution_of_an_array_is_a_solution_however_it_is_asked(together: SolutionArray) -> None:
    one, whole = together[50], together[50]
    values = {entry.name: getattr(whole, entry.name) for entry in fields(whole)}
    assert Solution(**values) == one == pickle.loads(pickle.dumps(one)) == copy.deepcopy(together[50])  # noqa: S301
    assert repr(together[50]) == repr(one)
    assert replace(together[50], iterations=3) == replace(one, iterations=3)
    assert together[50].to_dict() == one.to_dict()
    assert together[50].lower_bound == together.lower_bound[50]
    assert one.certificate.bound == pytest.approx(one.lower_bound, rel=1e-11)
    with pytest.raises(AttributeError, match="has no attribute 'objectiv'"):
        together[50].objectiv  # noqa: B018
    with pytest.raises(FrozenInstanceError):
        together[50].status = "local"


def test_what_is_no_array_of_problems_is_refused() -> None:
    with pytest.raises(InputError, match="takes a ProblemArray"):
        synthesize_array([Problem(order=4)])  # type: ignore[arg-type]


def test_tables_have_a_row_and_datasets_a_place_for_each_problem() -> None:
    laws = synthesize_array(ProblemArray(B=np.array([1.5, 1.6]), C=(None, np.array([[9.0], [10.0]])), order=4))
    table, dataset = laws.to_pandas(), laws.to_xarray()
    assert table["objective"].tolist() == laws.objective.reshape(-1).tolist()
    assert dataset["C"].shape == (2, 2)
    assert dataset["B asked"].to_numpy().tolist() == [1.5, 1.6]
    assert dataset.sizes["contact"] == laws.contacts["k"].shape[-1]


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    "problems",
    [
        ProblemArray(B=np.append(np.linspace(1.5, 2.0, 140), [np.nan, 1.02]), order=4),
        ProblemArray(B=np.array([[1.6], [1.7]]), J=(None, np.array([60.0, 80.0])), order=4, basis=Chebyshev(5)),
        ProblemArray(B=map_arrays(float, np.array([1.6, 0.5, np.nan])), order=4, minimise="J"),
        ProblemArray(
            B=1.7,
            order=4,
            J=map_arrays(at_most, np.array([60.0, 80.0])),
            windows=map_arrays(lambda height: via("b", height, at=0.25), np.array([1.0, 1.1])),
            minimise=map_arrays("{:g}*C".format, np.array([1.0, 2.0])),
            basis=map_arrays(Chebyshev, np.array([7, 9])),
        ),
        ProblemArray(
            order=3,
            symmetric=False,
            boundary=map_arrays(lambda v: BoundaryConditions((0.0, 0.0, 0.0), (1.0, v, 0.0)), np.array([0.2, 0.4])),
        ),
    ],
    ids=["together and alone", "a table", "objects", "objects of many kinds", "end values"],
)
def test_an_array_is_stored_and_read_as_it_was(problems: ProblemArray) -> None:
    laws = synthesize_array(problems)
    stored = json.dumps(laws.to_dict(), allow_nan=False)
    again = SolutionArray.from_dict(json.loads(stored))
    assert json.dumps(again.to_dict()) == stored
    for name in ("objective", "lower_bound", "gap", "best_possible", "status"):
        np.testing.assert_array_equal(getattr(again, name), getattr(laws, name))
    for name in ("B", "C", "D", "J", "rms_c", "z", "z_series"):
        np.testing.assert_allclose(getattr(again, name), getattr(laws, name), rtol=1e-12, atol=1e-9)
    assert {at: (type(error), str(error)) for at, error in again.errors.items()} == {
        at: (type(error), str(error)) for at, error in laws.errors.items()
    }
    for at in set(range(laws.size)) - set(laws.errors):
        assert again.result(at) == laws.result(at)
        assert again.result(at).certificate.bound == laws.result(at).certificate.bound  # type: ignore[union-attr]
    assert set(problems.varied) == set(again.problems.varied)
    assert list(again.to_pandas()) == list(laws.to_pandas())


def test_an_array_of_version_1_0_with_the_states_of_laws_beside_them_is_read() -> None:
    laws = synthesize_array(ProblemArray(B=np.append(np.linspace(1.5, 2.0, 130), 1.02), order=4))
    data = laws.to_dict()
    [part], names = laws.parts, ("x", "family", "u", "sign", "free", "multiplier", "equations", "bound")
    stored = {name: getattr(part.optima, name).tolist() for name in names}
    beside = {"places": part.places.tolist(), "problem": part.model.problem.to_dict(), "found": stored}
    rows = [{name: value for name, value in row.items() if name != "state"} for row in data["solutions"]]
    again = SolutionArray.from_dict({**data, "solutions": rows, "parts": [beside], "alone": {}})
    assert [again.result(at) == laws.result(at) for at in range(130)] == [True] * 130
    state, other = again.result(7).active_set, laws.result(7).active_set  # type: ignore[union-attr]
    for name in ("x", "family", "u", "s", "free", "multipliers", "equality_multipliers"):
        np.testing.assert_array_equal(getattr(state, name), getattr(other, name))


def test_an_array_that_was_edited_is_refused() -> None:
    data = synthesize_array(ProblemArray(B=np.linspace(1.5, 2.0, 130), order=4)).to_dict()
    data["solutions"][3]["objective"] *= 0.9
    with pytest.raises(InputError, match=r"solutions\[3\]: the objective"):
        SolutionArray.from_dict(data)
    with pytest.raises(InputError, match="130 solutions, got 129"):
        SolutionArray.from_dict({**data, "solutions": data["solutions"][1:]})
    with pytest.raises(InputError, match="this is not a stored array of solutions"):
        SolutionArray.from_dict({"shape": [1]})
    data["solutions"][3]["objective"] /= 0.9
    with pytest.raises(InputError, match=r"solutions\[0\]: its problem is another"):
        SolutionArray.from_dict({**data, "problems": {**data["problems"], "B": 1.6}})


def test_each_solution_of_a_stored_array_is_verified() -> None:
    data = synthesize_array(ProblemArray(B=np.array([1.02, 1.6, np.nan]), order=4)).to_dict()
    proven = verify_all(data)
    assert list(proven) == ["solutions[0].proof", "solutions[1]", "problems"]
    assert all(claim.proven for one in proven.values() for claim in one.claims)
    assert [str(claim).startswith("recomputed ") for claim in proven["problems"].recomputed] == [True]


def test_constants_are_those_of_the_laws_where_the_weight_of_one_varies() -> None:
    weighted = map_arrays("{:.17g}*C".format, np.linspace(1.0, 2.0, 140))
    problems = ProblemArray(B=1.7, minimise=weighted, order=4)
    for laws in (synthesize_array(problems), solved(ProblemArray.of(list(problems)))):
        np.testing.assert_allclose(laws.C, laws[0].constants.C.value, rtol=1e-9)

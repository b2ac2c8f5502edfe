"""What a file claims is checked without a solver and with every rounding enclosed."""

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path as File

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    BSplines,
    Certificate,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    InputError,
    Pieces,
    Problem,
    Window,
    at_most,
    synthesize,
    via,
)
from optlaws.verification import Verification, exact_bound, verify
from tests.sampling import examples
from tests.verification.tampering import Data, Path, changed, data_of, text_of, value_at
from tests.verification.test_piecewise import PROBLEMS as PIECEWISE

MOVING = BoundaryConditions((0, 0.3), (1, 0.1))
CONVEX = [
    Problem(B=1.859, order=4, basis=Chebyshev(9)),
    Problem(B=1.5, order=5, basis=Chebyshev(21)),
    Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True),
    Problem(B=1.4, order=2, basis=Chebyshev(15)),
    Problem(B=2.1, order=6, basis=Chebyshev(9)),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="J"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="rms_c"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="max(C/4, J/30)"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="0.5*C/4 + 0.5*J/12"),
    Problem(B=1.8, order=4, basis=Chebyshev(11), J=80.0),
    Problem(B=at_most(1.6), order=4, basis=Chebyshev(9)),
    Problem(B=1.859, order=4, basis=Chebyshev(9), symmetric=False),
    Problem(order=2, basis=Chebyshev(7), symmetric=False, boundary=MOVING),
    Problem(order=3, basis=Chebyshev(9), windows=(via("a", 0.3, at=0.4),), symmetric=False),
    Problem(order=3, basis=Chebyshev(9), windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
]
LOCAL = [
    Problem(B=1.7, order=4, basis=Chebyshev(9), minimise="D"),
    Problem(B=1.7, order=4, basis=Chebyshev(9), minimise="0.5*C/4 + 0.5*D/2.25"),
    Problem(B=1.7, order=4, basis=Chebyshev(9), D=8.0),
]
INFEASIBLE = [
    Problem(B=1.53, order=4, basis=Chebyshev(1)),
    Problem(B=1.7, order=3, basis=BSplines(4), C=4.2),
    Problem(B=1.7, order=3, basis=Pieces(4), C=4.2),
    Problem(B=2.9, order=2, basis=Chebyshev(3), monotone=True),
    Problem(B=1.7, order=4, basis=Chebyshev(5), C=4.5),
    Problem(B=1.2, order=4, basis=Chebyshev(3), symmetric=False),
]
FIRST = CONVEX[0]


@cache
def proof_text(problem: Problem) -> str:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(problem)
    assert isinstance(caught.value.proof, Certificate)
    return json.dumps(caught.value.proof.to_dict())


@pytest.mark.sample(2)
@pytest.mark.parametrize("problem", CONVEX, ids=repr)
def test_an_optimum_is_proven(problem: Problem) -> None:
    data = data_of(problem)
    verification = verify(data)
    assert verification.proven, str(verification)
    assert verification.bound is not None
    assert verification.gap is not None
    assert verification.objective is not None
    assert verification.bound == pytest.approx(data["certificate"]["bound"], rel=1e-9)
    assert verification.bound <= verification.objective[1] * (1.0 + 1e-12)
    assert abs(verification.gap) < 1e-11
    certificate = Certificate.from_dict(data["certificate"])
    exact = exact_bound(certificate)
    assert exact is not None
    assert 0.0 <= exact - verification.bound < 1e-14 * verification.bound


@pytest.mark.parametrize("problem", LOCAL, ids=repr)
def test_where_d_is_relaxed_the_gap_is_proven(problem: Problem) -> None:
    verification = verify(data_of(problem))
    assert verification.proven, str(verification)
    assert verification.gap is not None
    assert 0.0 < verification.gap < 0.3


@pytest.mark.sample(2)
@pytest.mark.parametrize("problem", INFEASIBLE, ids=repr)
def test_that_no_law_exists_is_proven(problem: Problem) -> None:
    data = json.loads(proof_text(problem))
    verification = verify(data)
    assert verification.proven
    assert verification.infeasible
    assert "no law of the problem exists" in str(verification)
    for contact in data["contacts"]:
        contact["multiplier"] = 0.0
    assert not verify(data).infeasible


@pytest.mark.parametrize("problem", [FIRST, CONVEX[6]], ids=repr)
def test_the_charge_is_what_rounding_leaves(problem: Problem) -> None:
    assert 0.0 < verify(data_of(problem)).charge < 1e-12


FIRST_CONTACT: Path = ("certificate", "contacts", 0)
#: by what is changed: places with what stands there instead, or by what a number is multiplied; and what fails
TAMPER: dict[str, tuple[list[tuple[Path, object]], str]] = {
    "law": ([(("law", "acceleration", 3), 1.0 + 1e-7)], "derivative"),
    "sign": ([((*FIRST_CONTACT, "multiplier"), -1.0)], "multipliers"),
    "bound": ([(("certificate", "bound"), 1.0 + 1e-8)], "the certificate's bound"),
    "lower bound": ([(("lower_bound",), 1.0 + 1e-7)], "the lower bound"),
    "velocity": ([(("problem", "B"), 1.0 + 1e-7)], "b(1/2) = B"),
    "velocity everywhere": (
        [(("problem", "B"), 1.0 + 1e-7), (("certificate", "problem", "B"), 1.0 + 1e-7)],
        "b(1/2) = B",
    ),
    "place": ([((*FIRST_CONTACT, "k"), 1.0 + 5e-3)], "the certificate's bound"),
    "multiplier": ([((*FIRST_CONTACT, "multiplier"), 1.01)], "the certificate's bound"),
    "name": ([((*FIRST_CONTACT, "constraint"), "ratio")], "contacts"),
    "objective": ([(("objective",), 1.0 - 1e-9)], "the objective"),
    "constant": ([(("constants", "J", "value"), 1.0 + 1e-9)], "J"),
    "degree": ([(("problem", "degree"), 7), (("certificate", "problem", "degree"), 7)], "terms above the degree"),
    "another objective": (
        [(("problem", "minimise"), "J"), (("certificate", "problem", "minimise"), "J")],
        "the objective",
    ),
}


@pytest.mark.parametrize("name", TAMPER)
def test_a_tampered_file_fails(name: str) -> None:
    changes, fails = TAMPER[name]
    data = data_of(FIRST)
    for path, new in changes:
        data = changed(data, path, new * value_at(data, path) if isinstance(new, float) else new)
    verification = verify(data)
    assert not verification.proven
    failed = [claim.name for claim in verification.claims if not claim.proven]
    assert any(name.startswith(fails) for name in failed), failed


@examples(120)
@given(st.sampled_from([*CONVEX, *PIECEWISE]), st.data())
def test_whatever_a_certificate_says_no_bound_exceeds_the_optimum(problem: Problem, data: st.DataObject) -> None:
    solution = data_of(problem)
    certificate = Certificate.from_dict(solution["certificate"])
    size = st.sampled_from([0.0, 1e-9, 1e-6, 1e-3, 0.1])
    contacts = tuple(
        replace(
            contact,
            k=min(max(contact.k + data.draw(size) * data.draw(st.floats(-1.0, 1.0)), 0.0), 1.0),
            multiplier=contact.multiplier * (1.0 + data.draw(size) * data.draw(st.floats(-2.0, 2.0))),
        )
        for contact in certificate.contacts
    )
    bound = exact_bound(certificate.with_leaf(contacts=contacts))
    rounding = 1e-12 if problem in CONVEX else 1e-11
    assert bound is None or bound <= solution["objective"] * (1.0 + rounding)


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"contacts": []},
        {"problem": {}, "law": {}, "certificate": {}},
        {"problem": 1, "law": {}, "certificate": {}},
        {"problem": {"order": 4}, "law": {}, "certificate": {}},
    ],
)
def test_what_is_no_solution_is_refused(data: Data) -> None:
    with pytest.raises(InputError):
        verify(data)


def test_numbers_must_be_numbers() -> None:
    data = data_of(FIRST)
    with pytest.raises(InputError, match="objective must be a finite number"):
        verify(data | {"objective": "4.6"})
    with pytest.raises(InputError, match="constants must be"):
        verify(data | {"constants": 3})


def test_no_solver_takes_part(tmp_path: File) -> None:
    file = tmp_path / "solution.json"
    file.write_text(text_of(CONVEX[6]), "utf-8")
    script = (
        "import sys\n"
        "sys.modules['casadi'] = sys.modules['scipy'] = None\n"
        "from optlaws.verification import verify\n"
        f"sys.exit(not verify({str(file)!r}).proven)"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


def test_a_verification_is_plain_data() -> None:
    verification = verify(data_of(FIRST))
    assert isinstance(verification, Verification)
    assert json.loads(json.dumps(verification.results()))["proven"] is True
    assert "lower bound" in str(verification)


@pytest.mark.parametrize("B", [1.2, 1.5])
def test_a_row_that_needs_rest_at_the_ends_counts_for_nothing_without(B: float) -> None:
    problem = Problem(order=1, B=B, basis=Chebyshev(7), minimise="D")
    solution = synthesize(problem)
    claim = Certificate.of_leaf(
        problem, (Contact("b / sqrt(2k)", 1.0, 0.5, 2.0), Contact("tangent", 1.0, 1.0, 1.0)), (-2.0,), "relaxed", 1.0
    )
    for certificate in (solution.certificate, claim):
        bound = exact_bound(certificate)
        assert bound is None or bound <= solution.objective

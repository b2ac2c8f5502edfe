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
    BSplines,
    Certificate,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    Pieces,
    Problem,
    synthesize,
)
from optlaws.verification import Verification, exact_bound, verify
from tests.sampling import examples
from tests.verification.problems import CONVEX, KINDS, OF_CAMS, PIECES, RESIDUALS
from tests.verification.tampering import Path, changed, data_of, text_of, value_at

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


def asked(entry: str, value: object) -> list[tuple[Path, object]]:
    """Another problem, in the solution and in its certificate."""
    return [((*of, "problem", entry), value) for of in ((), ("certificate",))]


#: by what is changed: places with what stands there instead, or by what a number is multiplied; and what fails
TAMPER: dict[str, tuple[list[tuple[Path, object]], str]] = {
    "law": ([(("law", "acceleration", 3), 1.0 + 1e-7)], "derivative"),
    "sign": ([((*FIRST_CONTACT, "multiplier"), -1.0)], "multipliers"),
    "bound": ([(("certificate", "bound"), 1.0 + 1e-8)], "the certificate's bound"),
    "lower bound": ([(("lower_bound",), 1.0 + 1e-7)], "the lower bound"),
    "velocity": ([(("problem", "B"), 1.0 + 1e-7)], "b(1/2) = B"),
    "velocity everywhere": (
        asked("B", 1.0 + 1e-7),
        "b(1/2) = B",
    ),
    "place": ([((*FIRST_CONTACT, "k"), 1.0 + 5e-3)], "the certificate's bound"),
    "multiplier": ([((*FIRST_CONTACT, "multiplier"), 1.01)], "the certificate's bound"),
    "name": ([((*FIRST_CONTACT, "constraint"), "ratio")], "contacts"),
    "objective": ([(("objective",), 1.0 - 1e-9)], "the objective"),
    "constant": ([(("constants", "J", "value"), 1.0 + 1e-9)], "J"),
    "degree": (asked("degree", 7), "terms above the degree"),
    "another objective": (
        asked("minimise", "J"),
        "the objective",
    ),
}


#: the same of laws of pieces, cams, residuals, bounds and inflexions
OTHERS: dict[Problem, dict[str, tuple[list[tuple[Path, object]], str]]] = {
    PIECES[0]: {
        "a break": ([(("law", "breaks", 1), 1.0 + 4e-9)], "breaks"),
        "a jump": ([(("law", "segments", 1, "b0"), 1.0 + 1e-9)], "continuity of derivative 1"),
        "one segment": ([(("law", "segments", 2, "acceleration", 1), 1.0 + 1e-8)], "continuity of derivative 2"),
        "other breaks": (asked("breaks", [0.0, 0.24, 0.5, 0.76, 1.0]), "breaks"),
        "smoother": (asked("continuity", 4), "continuity of derivative 4"),
        "a lower degree": (asked("degree", 4), "terms above the degree"),
        "fewer pieces": (asked("breaks", [0.0, 0.5, 1.0]), "4 pieces instead of 2"),
    },
    OF_CAMS["damped"]: {
        "a stiffer follower": (asked("minimise", "C_cam(frequency=20.001, damping=0.1)"), "the objective")
    },
    RESIDUALS["interval"]: {
        "more frequencies": (asked("minimise", "residual(frequency=(9, 12.001), damping=0.03)"), "the objective")
    },
    KINDS[2]: {"a tighter bound": (asked("bounds", {"rms_c": [0.0, 3.81]}), "rms_c at most")},
    KINDS[0]: {
        "another inflexion": (asked("inflexion", 1.025), "c(0.41) = 0"),
        "a peak elsewhere": (asked("inflexion", 1.025), "b <= b(0.41)"),
    },
}
TAMPERED = [(problem, *change) for problem, each in {FIRST: TAMPER, **OTHERS}.items() for change in each.items()]


@pytest.mark.parametrize(("problem", "name", "change"), TAMPERED, ids=lambda one: one if isinstance(one, str) else "")
def test_a_tampered_file_fails(problem: Problem, name: str, change: tuple[list[tuple[Path, object]], str]) -> None:
    assert name
    changes, fails = change
    data = data_of(problem)
    for path, new in changes:
        data = changed(data, path, new * value_at(data, path) if isinstance(new, float) else new)
    verification = verify(data)
    assert not verification.proven
    failed = [claim.name for claim in verification.claims if not claim.proven]
    assert any(name.startswith(fails) for name in failed), failed


@examples(120)
@given(st.sampled_from([*CONVEX, *PIECES, OF_CAMS["damped"], RESIDUALS["interval"]]), st.data())
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

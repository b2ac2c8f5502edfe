"""What laws and errors are beyond what every public name is: light, pickled, one tree; and constants as values."""

import pickle
import subprocess
import sys
from dataclasses import FrozenInstanceError

import pytest

from optlaws import (
    Constants,
    InfeasibleProblem,
    InputError,
    MotionLaw,
    OptlawsError,
    Peak,
    PolynomialLaw,
    SolverFailure,
    smoothstep,
)


def test_importing_laws_stays_light() -> None:
    code = "import sys, optlaws.laws; print(*{'scipy', 'casadi', 'matplotlib'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_a_new_kind_of_law_is_one_class() -> None:
    class Halved(PolynomialLaw, kind="halved"):
        pass

    try:
        law = Halved([0.0, -6.0])
        assert type(MotionLaw.from_dict(law.to_dict())) is Halved
        assert law != smoothstep(2)
    finally:
        del MotionLaw.kinds["halved"]


def test_errors_print_the_problem_so_that_it_can_be_run_again() -> None:
    error = InfeasibleProblem("no law", problem={"B": 0.5}, tried="2 bases", proof=(1, 2))
    assert str(error) == "no law\ntried: 2 bases\nproblem: {'B': 0.5}"
    assert error.proof == (1, 2)
    assert str(SolverFailure("no answer")) == "no answer"


@pytest.mark.parametrize("error", [InputError("x"), InfeasibleProblem("x", problem=1), SolverFailure("x", tried="y")])
def test_errors_survive_other_processes(error: OptlawsError) -> None:
    back = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert (type(back), str(back), back.__dict__) == (type(error), str(error), error.__dict__)


# --- constants ---


def test_peaks_are_values() -> None:
    one, again = (Constants(Peak(1.0, 0.1), Peak(2.0, 0.2), Peak(3.0, 0.3), Peak(4.0, 0.4), 2.0) for _ in range(2))
    assert {one: one.B}[again] == Peak(1.0, 0.1)
    with pytest.raises(FrozenInstanceError):
        one.rms_c = 3.0  # type: ignore[misc]

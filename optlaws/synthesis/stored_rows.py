"""Stored solutions and errors, each as a row of plain data that is read back and checked.

Nothing that is read is taken on trust: laws are those of their coordinates, numbers are those of their laws, bounds are
what the proofs beside them prove, and a problem has no law only where its proof shows that of this problem.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from math import inf
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.files.reading import is_number
from optlaws.laws import MotionLaw
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import evaluate, model_of, shortfalls
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.data import problem_of, stated
from optlaws.synthesis.proof.no_law import beyond_limit, proof_of_no_law
from optlaws.synthesis.spaces.bases import PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.status import Status, status_of
from optlaws.tolerances import STORED_VALUE

if TYPE_CHECKING:
    from optlaws.synthesis.limits.drive_limits import DriveLimit

_PROOFS = ("certificate", "power_certificate", "peak_certificate")
_STORED_COEFFICIENT = 1e-11  # of a law's coefficient: what another machine may round otherwise

Plain = dict[str, Any]
Kind = TypeVar("Kind")


class StatedActiveSet(msgspec.Struct, forbid_unknown_fields=True):
    """The stored form of an `ActiveSet`."""

    x: list[float]
    family: list[int]
    u: list[float]
    s: list[float]
    free: list[bool]
    multipliers: list[float]
    equality_multipliers: list[float]


class StatedState(msgspec.Struct, forbid_unknown_fields=True):
    """The stored state of a law solved by itself, beyond its claims."""

    z_series: list[float]
    active_set: StatedActiveSet


class StatedSolution(msgspec.Struct, forbid_unknown_fields=True):
    """The row of a problem with a law; what is not read here follows from the law and its proofs."""

    problem: Plain
    law: Plain
    certificate: Plain
    status: Status
    objective: float
    lower_bound: float | None
    iterations: int
    seconds: float
    starts: tuple[float, ...]
    gap: Any = None
    best_possible: Any = None
    constants: Any = None
    z: Any = None
    power_certificate: Plain | None = None
    peak_certificate: Plain | None = None
    drive_limit: Plain | None = None
    versions: Any = None
    state: StatedState | None = None
    about: str = ""


class StatedError(msgspec.Struct, forbid_unknown_fields=True):
    """The row of a problem without a law."""

    status: Status
    error: str
    problem: Plain | None = None
    proof: Plain | None = None
    tried: str = ""
    about: str = ""


def plain_error(error: OptlawsError) -> Plain:
    """An error as plain data, from which `read_solutions` rebuilds its text and its proof."""
    data: Plain = {"status": Status.of(error).value, "error": str(error.args[0]) if error.args else ""}
    for name in ("problem", "proof"):
        value = getattr(error, name, None)
        if value is not None:
            data[name] = value.to_dict()
    tried = getattr(error, "tried", "")
    return {**data, "tried": tried} if tried else data


def plain_state(z_series: Sequence[float], state: ActiveSet) -> Plain:
    """Data of a law solved by itself beside its claims: the series of Z, and a start for neighbours."""
    return {
        "z_series": list(z_series),
        "active_set": {field.name: getattr(state, field.name).tolist() for field in fields(state)},
    }


def read_row(data: object) -> Plain:
    """The attributes of a stored solution; every value that is read is checked.

    Raises
    ------
    InputError
        If an entry is missing or wrong, or states what does not follow from the problem, the law and the proofs.
    """
    row = stated(data, StatedSolution, "solution")
    return plainly(lambda: attributes(row, problem_of(row.problem)), "this is no solution")


def attributes(row: StatedSolution, problem: Problem) -> Plain:
    """The attributes of the solution of a row.

    Raises
    ------
    InputError
        If the law breaks its problem, the objective is not the law's, nothing proves the bound, or another status
        follows from both.
    """
    if row.state is None:
        raise InputError("this solution has no `state`, without which it is verified but not read: solve it again")
    law = MotionLaw.from_dict(row.law)
    proofs = {name: _read(Certificate.from_dict, getattr(row, name)) for name in _PROOFS}
    drive, limit = _read(_drive_limit, row.drive_limit), known_limit(problem)
    value, scale = evaluate(problem, law), problem.objective.scale
    if not value.sound or shortfalls(problem, law):
        raise InputError("its law does not keep the constraints of its problem")
    if not abs(row.objective - value.objective) <= STORED_VALUE * max(abs(value.objective), scale):
        raise InputError(f"the objective is {row.objective!r}, but that of its law {value.objective!r}")
    if any(proof is not None and proof.problem != problem for proof in proofs.values()):
        raise InputError("a proof beside its law is of another problem")
    if drive is not None and not drive.is_of(problem):
        raise InputError("the limit of a drive beside its law is of another problem")
    bound = -inf if row.lower_bound is None else row.lower_bound
    proven = max([-inf if limit is None else limit, *(each.bound for each in (*proofs.values(), drive) if each)])
    if not (bound == -inf or bound <= proven + STORED_VALUE * max(abs(proven), scale)):
        raise InputError(f"the lower bound is {bound!r}, but what is proven beside it {proven!r}")
    # whether a bound that does not meet the objective was to meet it depends on how the law was found
    possible = {status_of(row.objective, bound, scale, proven=meets) for meets in (True, False)}
    if row.status not in possible:
        raise InputError(f"the status of the solution is {row.status.value!r}, but it is {' or '.join(possible)}")
    _check_z(row.state.z_series, problem, law)
    return {
        **proofs,
        "problem": problem,
        "law": law,
        "z_series": tuple(row.state.z_series),
        "objective": row.objective,
        "lower_bound": bound,
        "best_possible": limit,
        "status": row.status,
        "iterations": row.iterations,
        "seconds": row.seconds,
        "starts": row.starts,
        "drive_limit": drive,
        "active_set": _active_set(row.state.active_set, model_of(problem).program),
    }


def _drive_limit(data: Plain) -> DriveLimit:
    from optlaws.synthesis.limits.drive_limits import DriveLimit

    return DriveLimit.from_dict(data)


def _check_z(series: list[float], problem: Problem, law: MotionLaw) -> None:
    """Refuse coefficients of Z that do not give the law."""
    basis, order = problem.basis, problem.order
    if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
        wrong = bool(series)
    else:
        k = (1.0 - np.cos((np.arange(2 * len(series) + 8) + 0.5) * (np.pi / (2 * len(series) + 8)))) / 2.0
        a0, a1 = (
            np.polynomial.polynomial.polyval(k, list(map(float, part)))
            for part in (problem.conditions.a0(), problem.conditions.a1())
        )
        a = a0 + k**order * (a1 + (k - 1.0) ** order * _z(basis, np.array(series), k))
        off = np.abs(a - np.array([float(law(place)) for place in k.tolist()]))
        wrong = not off.max() <= STORED_VALUE
    if wrong:
        raise InputError("the coefficients of Z in the arrays do not make its law")


def _z(basis: PolynomialBasis | PiecewiseBasis, series: NDArray[np.float64], k: NDArray[np.float64]) -> Any:
    """Z at times k, of its Chebyshev series, on each piece where it has some."""
    if isinstance(basis, PolynomialBasis):
        return np.polynomial.chebyshev.chebval(2.0 * k - 1.0, series)
    breaks = np.array(basis.breaks, dtype=np.float64)
    rows = series.reshape(len(breaks) - 1, -1)
    i = np.clip(np.searchsorted(breaks, k, side="right") - 1, 0, len(rows) - 1)
    x = 2.0 * (k - breaks[i]) / (breaks[i + 1] - breaks[i]) - 1.0
    return (rows[i] * np.cos(np.arange(rows.shape[1]) * np.arccos(np.clip(x, -1.0, 1.0))[:, None])).sum(axis=1)


def _active_set(entries: StatedActiveSet, program: Program) -> ActiveSet:
    """A start for a neighbouring problem: any numbers of the program's shape will do."""
    state = ActiveSet.of_columns(**msgspec.structs.asdict(entries))
    counts = {len(part) for part in (state.family, state.u, state.s, state.free, state.multipliers)}
    finite = all(np.isfinite(getattr(state, field.name)).all() for field in fields(state))
    known = ((state.family >= 0) & (state.family < len(program.families))).all()
    sizes = (len(state.x), len(state.equality_multipliers)) == (program.size, len(program.right))
    if len(counts) != 1 or not finite or not known or not sizes:
        raise InputError("the contacts and multipliers in the arrays are not of its program")
    return state


def read_error(row: StatedError, problem: Callable[[], Problem]) -> OptlawsError:
    """The error of a row without a law, which has to be so of its problem."""
    if row.status is Status.INVALID:
        if row.problem is not None or row.proof is not None:
            raise InputError(f"a row that is {row.status.value!r} has neither problem nor proof")
        if _is_problem(problem):
            raise InputError("it states that its entries are no problem, but they are one")
        return InputError(row.error)
    if row.status is Status.FAILED:
        if row.proof is not None:
            raise InputError(f"a row that is {row.status.value!r} has no proof")
        return SolverFailure(row.error, problem=problem(), tried=row.tried)
    if row.status is not Status.INFEASIBLE:
        raise InputError(f"a row without a law is infeasible, failed or invalid, got {row.status.value!r}")
    if row.proof is None:
        if not beyond_limit(problem()):
            raise InputError("it states that no law exists, but it has no proof")
        return InfeasibleProblem(row.error, problem=problem(), tried=row.tried)
    proof = proof_of_no_law(problem(), Certificate.from_dict(row.proof))
    if proof is None:
        raise InputError("it states that no law exists, but its proof does not show this for its problem")
    return InfeasibleProblem(row.error, problem=problem(), tried=row.tried, proof=proof)


def _is_problem(problem: Callable[[], Problem]) -> bool:
    try:
        model_of(problem())
    except InputError:
        return False
    return True


def equal_data(first: Any, second: Any) -> bool:
    """Whether plain data are equal, numbers up to the rounding of the greatest beside them."""
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(equal_data(first[name], second[name]) for name in first)
    if isinstance(first, list) and isinstance(second, list) and first and all(map(is_number, [*first, *second])):
        allowed = _STORED_COEFFICIENT * max(map(abs, first))
        return len(first) == len(second) and all(abs(a - b) <= allowed for a, b in zip(first, second, strict=True))
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(equal_data, first, second))
    if is_number(first) and is_number(second):
        return bool(abs(first - second) <= _STORED_COEFFICIENT * max(abs(first), 1.0))
    return bool(first == second)


def _read(read: Callable[[Plain], Kind], data: Plain | None) -> Kind | None:
    return None if data is None else read(data)


def plainly(read: Callable[[], Kind], name: str) -> Kind:
    """A value read from data of any kind."""
    try:
        return read()
    except InputError:
        raise
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"{name}: {shortened(str(error))}") from None

"""Proofs checked by the program in JavaScript, which shares no code with the library: both must agree."""

import json
import subprocess
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import pytest
from flint import arb_mat, ctx
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    BSplines,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    InputError,
    Machine,
    Mechanism,
    OptlawsError,
    Pieces,
    Problem,
    Solution,
    Window,
    at_least,
    at_most,
    drive_limit,
    maximum,
    peak,
    synthesize,
    via,
)
from optlaws.typing import Bound
from optlaws.verification import exact_bound, verify
from tests.check_proofs import PROGRAM, RESULTS, certificates, node, run
from tests.documents import ROOT
from tests.internals.verification import ExactRows
from tests.verification.tampering import SOLUTIONS, changed, data_of, numbers, places, value_at
from tests.verification.tampering import Path as Place

POWER = Problem(B=1.6, order=2, basis=Chebyshev(3), minimise="D")


Claims = list[dict[str, Any]]


def ended(files: Sequence[object], folder: Path) -> subprocess.CompletedProcess[str]:
    """The program on files that it may refuse to read."""
    paths = [folder / f"proofs{i}.json" for i in range(len(files))]
    for path, data in zip(paths, files, strict=True):
        path.write_text(json.dumps(data), encoding="utf8")
    return run(*paths)


def checked_each(files: Sequence[object], folder: Path) -> list[Claims]:
    """What the program says of each file."""
    answer = ended(files, folder)
    assert answer.returncode in {0, 1, 3}, answer.stderr
    claims: list[Claims] = [json.loads(line) for line in answer.stdout.splitlines()]
    assert len(claims) == len(files)
    return claims


def checked(data: object, folder: Path) -> Claims:
    """What the program says of a file."""
    (claims,) = checked_each([data], folder)
    return claims


def verdicts(claims: Claims) -> set[str]:
    return {claim["verdict"] for claim in claims}


def false(claims: Claims) -> list[str]:
    """The paths of what is not proven."""
    return [claim["path"] for claim in claims if claim["verdict"] == "not proven"]


@pytest.mark.parametrize(("file", "proofs"), [("cycle_fastest/fastest", 2), ("machine_hanging_load/laws", 3)])
def test_stored_proofs_hold_there_too(file: str, proofs: int, tmp_path: Path) -> None:
    data = json.loads((RESULTS / f"{file}.json").read_text(encoding="utf8"))
    results = {result["path"]: result for result in checked(data, tmp_path)}
    places_of_proofs = [path for path, _ in certificates(data)]
    assert len(places_of_proofs) == proofs
    assert {results[path]["verdict"] for path in places_of_proofs} == {"proven"}
    unchecked = [result["detail"] for result in results.values() if result["verdict"] != "proven"]
    assert all("does not know how great the residual of a law is" in detail for detail in unchecked)
    for name, row in data.get("laws", {}).items():
        bound = results[f"laws.{name}.certificate"]["bound"]
        assert row["lower_bound"] <= bound <= row["objective"] * (1 + 1e-11)


def test_what_derivatives_do_not_bound_the_equations_of_pieces_do(tmp_path: Path) -> None:
    # the fourth derivative does not see the cubic that pieces begin with
    solution = synthesize(Problem(order=3, basis=Pieces(3, 7, 3), minimise="snap", symmetric=False))
    (result,) = checked(solution.certificate.to_dict(), tmp_path)
    assert result["bound"] == pytest.approx(solution.certificate.bound, rel=1e-14)
    assert result["bound"] <= solution.objective * (1 + 1e-12)


@pytest.mark.parametrize(
    "objective",
    [
        peak("1*a + 0.67*c - 100.7", side="high"),  # below 0, as of the least prime circle of a cam
        peak("0.62*a + 0.063*c + 0.126"),  # the force of a mass on a spring
        maximum(peak("0.3*b - 0.1*a", side="high"), peak("0.05*c")),
    ],
    ids=["below 0", "force", "greatest of two"],
)
def test_peaks_of_formulas_that_are_affine_in_the_law_are_proven(objective: Any, tmp_path: Path) -> None:
    inside = (Window("a", 0.0, 1.0),)
    problem = Problem(order=3, basis=Chebyshev(7), symmetric=False, minimise=objective, C=at_most(13.6), windows=inside)
    solution = synthesize(problem)
    data, size = solution.to_dict(), abs(solution.objective)
    wrong = [
        changed(data, ("objective",), solution.objective - 1e-8 * size),
        changed(data, ("lower_bound",), solution.objective + 1e-6 * size),
        changed(data, ("certificate", "bound"), solution.objective + 1e-6 * size),
    ]
    claims, *of_wrong = checked_each([data, *wrong], tmp_path)
    assert verdicts(claims) == {"proven"}
    [bound] = [claim["bound"] for claim in claims if claim["path"] == "certificate"]
    assert bound == pytest.approx(solution.certificate.bound, rel=1e-12)
    assert all(map(false, of_wrong))
    assert "certificate" in false(of_wrong[-1])


def test_files_that_call_the_snap_jounce_are_read_by_both(tmp_path: Path) -> None:
    problem = Problem(order=4, basis=Chebyshev(5), minimise="0.5*snap + rms_snap", bounds={"snap": at_most(3000)})
    solution = synthesize(problem).to_dict()
    former = json.loads(json.dumps(solution).replace("snap", "jounce"))
    assert "jounce" in former["certificate"]["contacts"][0]["constraint"]
    assert Certificate.from_dict(former["certificate"]).to_dict() == solution["certificate"]
    assert verify(former).bound == verify(solution).bound
    first, second = checked_each([former, solution], tmp_path)
    assert first == second


def test_a_newer_format_is_refused_by_both_and_the_first_is_read(tmp_path: Path) -> None:
    solution = _solution().to_dict()
    proof = solution["certificate"]
    paths: list[Place] = [(), ("certificate",), ("law",)]
    firsts, newer = ([changed(solution, (*path, "format"), version) for path in paths] for version in (1, 3))
    now, *known = checked_each([solution, *firsts], tmp_path)
    assert known == [now] * 3
    assert all(verify(first).proven for first in firsts)
    refused = ended(newer, tmp_path)
    assert refused.returncode == 2
    for path, data, complaint in zip(paths, newer, refused.stderr.splitlines(), strict=True):
        why = f"{path[0] if path else 'the file'} was written by a newer optlaws: format 3, this reads up to 1"
        assert why in complaint
        with pytest.raises(InputError, match=why):
            verify(data)
    with pytest.raises(InputError, match="the certificate was written by a newer optlaws"):
        Certificate.from_dict(proof | {"format": 2})
    assert Certificate.from_dict(proof | {"format": 1}) == Certificate.from_dict(proof)


def test_what_nobody_knows_is_refused(tmp_path: Path) -> None:
    proof = _solution().certificate.to_dict()
    paths: list[Place] = [(), ("problem",), ("contacts", 0), ("problem", "windows", 0)]
    for result in checked([changed(proof, (*path, "further"), 1.0) for path in paths], tmp_path):
        assert result["verdict"] == "not proven"
        assert "nothing is known of the entry further" in result["detail"]


def test_what_it_does_not_know_it_says(tmp_path: Path) -> None:
    places = synthesize(
        Problem(B=at_least(2.2), order=2, basis=Chebyshev(1), minimise="rms_c"), bound="tight"
    ).to_dict()
    machine = json.loads((RESULTS / "machine_hanging_load" / "laws.json").read_text(encoding="utf8"))
    sway = machine["laws"]["least C, sway kept"]["certificate"]
    half = {"basis": "pieces", "breaks": [0.0, 0.5, 1.0], "degree": 7, "continuity": 3, "symmetric": True}
    of_pieces = sway | {"problem": sway["problem"] | half}
    damped = json.dumps(sway).replace("spread=0.1", "damping=(0.1, 0.2)")
    results = checked([places["peak_certificate"], json.loads(damped), of_pieces], tmp_path)
    assert [result["verdict"] for result in results] == ["not checked"] * 3
    assert all("does not know" in result["detail"] for result in results)


def test_lines_that_differ_in_numbers_alone_are_one(tmp_path: Path) -> None:
    machine = json.loads((RESULTS / "machine_hanging_load" / "laws.json").read_text(encoding="utf8"))
    sway = json.dumps(machine["laws"]["least C, sway kept"]["certificate"])
    file = tmp_path / "damped.json"
    damped = (sway.replace("spread=0.1", f"damping=(0.1, {share})") for share in (0.2, 0.3, 0.4))
    file.write_text(json.dumps([*map(json.loads, damped)]), encoding="utf8")
    shown = subprocess.run([node(), PROGRAM, file], capture_output=True, text=True, check=False)
    only, counts = shown.stdout.splitlines()
    assert "[0] and 2 more: not checked: this program does not know" in only
    assert counts.endswith("0 proven, 0 not proven, 3 not checked")
    assert shown.returncode == 3


def _problems(count: int, seed: int) -> Iterator[Problem]:
    rng = Random(seed)  # noqa: S311 - a sample
    objectives = ["C", "J", "rms_c", "rms_j", "C + 0.1*J", "max(C, 0.1*J)", "C_plus", "B", "snap", "D"]
    windows = [
        via("a", 0.3, at=0.4), Window("c", -5, 5, 0.2, 0.4), Window("a", 0.1, 0.9, 0.3, 0.6),
        Window("b", -1, 1.4, 0.6, 0.9), Window("j", -60, 60, 0, 0.1),
    ]  # fmt: skip
    while count:
        minimise, symmetric = rng.choice(objectives), rng.random() < 0.5
        basis = rng.choice([
            Chebyshev(rng.randrange(1, 12)),
            Chebyshev(rng.randrange(1, 12)),
            Pieces((0.0, 0.3, 0.55, 1.0), rng.choice([5, 6, 7]), rng.choice([1, 2, 3])),
            Pieces(rng.choice([3, 4]), rng.choice([5, 6, 7]), rng.choice([1, 2, 3])),
            BSplines(rng.choice([3, 4]), rng.choice([3, 4])),
        ])  # fmt: skip
        asked: dict[str, Any] = {}
        if minimise != "B":
            asked["B"] = rng.choice([None, rng.uniform(1.2, 2.2), (1.0, rng.uniform(1.3, 2.2)), (1.7, 1.9)])
        asked["C"] = rng.choice([None, None, None, (0.0, rng.uniform(4.0, 9.0))])
        asked["J"] = rng.choice([None, None, None, None, (0.0, rng.uniform(30.0, 120.0))])
        asked["windows"] = rng.choice([(), (), (rng.choice(windows),)])
        try:
            yield Problem(
                order=rng.choice([2, 3, 4]), basis=basis, minimise=minimise, symmetric=symmetric,
                monotone=rng.random() < 0.3, **asked,
            )  # fmt: skip
        except OptlawsError:
            continue
        count -= 1


def _proofs(problems: Iterator[Problem]) -> Iterator[tuple[Any, float]]:
    """Certificates of problems that have one, with the bound that the library proves in exact arithmetic."""
    for problem in problems:
        try:
            certificate: Any = synthesize(problem).certificate
        except InfeasibleProblem as error:
            certificate = error.proof
        except OptlawsError:
            continue
        if hasattr(certificate, "contacts"):
            value = exact_bound(certificate)
            yield certificate, float("-inf") if value is None else float(value)


@pytest.mark.long
@pytest.mark.parametrize(("count", "seed"), [(10, 7), pytest.param(2000, 8, marks=pytest.mark.long)])
def test_random_proofs_are_worth_the_same(count: int, seed: int, tmp_path: Path) -> None:
    proofs = list(_proofs(_problems(count, seed)))
    results = checked([certificate.to_dict() for certificate, _ in proofs], tmp_path)
    assert len(results) == len(proofs) > 0.8 * count
    for (certificate, value), result in zip(proofs, results, strict=True):
        if certificate.program == "violation":
            assert (result["verdict"] == "proven") == (value > 0.0), (certificate.problem, result)
            continue
        stated = certificate.bound
        proven = stated <= value + 1e-9 * abs(value)
        assert (result["verdict"] == "proven") == proven, (certificate.problem, value, result)
        if proven and value > 0.0:
            assert result["bound"] == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize("monotone", [False, True])
def test_of_flat_optima_multipliers_as_they_are_written_prove_the_bound(tmp_path: Path, *, monotone: bool) -> None:
    # b = B over a whole interval: contacts on many points, of which a solver leaves some 1e-8 of the bound
    basis = Pieces((0.0, 0.3, 0.55, 1.0), 6, 1)
    problem = Problem(order=2, basis=basis, minimise="B", monotone=monotone, symmetric=False)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    (result,) = checked(solution.certificate.to_dict(), tmp_path)
    assert result["verdict"] == "proven"
    assert result["bound"] == pytest.approx(solution.certificate.bound, rel=1e-11)


@pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
def test_what_the_rounding_of_multipliers_hides_is_not_called_false(tmp_path: Path) -> None:
    # smooth splines of many pieces: more coordinates than rows, and moments that take much of what is left
    certificate = synthesize(Problem(order=6, basis=BSplines(16, 7), minimise="C + 1e-05*J")).certificate
    value = exact_bound(certificate)
    assert value is not None
    data = certificate.to_dict()
    (result,) = checked(data, tmp_path)
    assert result["verdict"] == "proven"
    charged = float(value) - result["bound"]
    assert 0.0 < charged < 1e-9 * float(value)
    beyond = result["bound"] * (1.0 + 1e-9)
    bounds = (beyond + 0.5 * charged, float(value) * (1.0 + 1e-8))
    hidden, above = checked_each([data | {"bound": bound} for bound in bounds], tmp_path)
    assert verdicts(hidden) == {"not checked"}
    assert verdicts(above) == {"not proven"}


def test_rows_that_do_not_contradict_each_other_bound_no_objective_below_zero(tmp_path: Path) -> None:
    ends = BoundaryConditions(start=(0.0, 0.0), end=(1.0, 2.0))
    twice = (via("c", 1.0, at=0.2),) * 2
    problem = Problem(order=2, basis=Chebyshev(5), minimise="C_minus", symmetric=False, boundary=ends, windows=twice)
    data = synthesize(problem).to_dict()
    assert verdicts(checked(data, tmp_path)) == {"proven"}
    assert data["objective"] < -0.9
    # of both equations nothing but rounding is left, and nothing bounds the laws
    proof = {"program": "violation", "contacts": [], "equations": [1.0, 2.0**-50 - 1.0], "bound": None}
    claims = checked(data | {"lower_bound": 0.0, "certificate": data["certificate"] | proof}, tmp_path)
    assert false(claims) == ["the file: lower bound"]


def _machine_problems(count: int, seed: int) -> Iterator[Problem]:
    rng = Random(seed)  # noqa: S311 - a sample
    for i in range(count):
        frequency, damping = rng.uniform(6.0, 30.0), rng.choice([0.0, 0.02, 0.2, 0.9])
        A, B = [[0.0, 1.0], [-(frequency**2), -2.0 * damping * frequency]], [[0.0], [frequency**2]]
        machine = Machine(A, B, [A[1]], [B[1]], outputs=["y"])
        problem = Problem(
            order=3,
            basis=Chebyshev(rng.choice([3, 5, 8])),
            symmetric=rng.random() < 0.5,
            J=at_most(400.0),
            minimise="C",
        )
        minimise = [machine.peak("y"), machine.peak("y", within=(0.0, 1.6)), machine.rms("y")][i % 4 - 1]
        if i % 4:
            yield replace(problem, minimise=minimise)
        elif damping < 0.9:
            yield replace(problem, bounds={machine.residual(1, "y", spread=0.1): at_most(0.3 * frequency)})


@pytest.mark.long
def test_random_machines_are_worth_the_same(tmp_path: Path) -> None:
    proofs = list(_proofs(_machine_problems(24, 5)))
    results = checked([proof.to_dict() for proof, _ in proofs], tmp_path)
    assert len(proofs) > 15
    for (certificate, value), result in zip(proofs, results, strict=True):
        assert result["verdict"] == "proven", (certificate.problem, result)
        assert certificate.program == "violation" or result["bound"] == pytest.approx(value, rel=1e-9)


@cache
def _solution() -> Solution:
    return synthesize(Problem(B=1.859, order=3, basis=Chebyshev(7), windows=(Window("c", -6, 6, 0.0, 0.3),)))


CHANGES: list[Callable[[Any], object]] = [
    lambda value: value * 1.01 if isinstance(value, float) else value,
    lambda value: value * 0.9 - 0.01 if isinstance(value, float) else value,
    lambda value: -value if isinstance(value, float) else value,
    lambda value: "C" if isinstance(value, str) else 1e300,
    lambda _: None,
    lambda value: [value],
]


def _certificates() -> Iterator[tuple[str, dict[str, Any], float]]:
    """A certificate of each kind, and what none of its problem may be said to exceed."""
    solution = _solution()
    yield "leaf", solution.certificate.to_dict(), solution.objective
    power = synthesize(POWER, bound="tight")
    assert power.power_certificate is not None
    yield "relaxed", power.certificate.to_dict(), power.objective
    yield "boxes", power.power_certificate.to_dict(), power.objective
    laws = json.loads((RESULTS / "machine_hanging_load" / "laws.json").read_text(encoding="utf8"))["laws"]
    for name, kind in (("least C, sway kept", "residual"), ("least sway on the way, sway and J kept", "output")):
        yield kind, laws[name]["certificate"], laws[name]["objective"]


@pytest.mark.parametrize(
    ("kind", "every"),
    [
        ("leaf", 3),
        *(pytest.param(*case, marks=pytest.mark.long) for case in [
            ("leaf", 1), ("relaxed", 1), ("boxes", 1), ("residual", 1), ("output", 3)])
    ],
)  # fmt: skip
def test_a_tampered_certificate_is_refused_or_proves_less(kind: str, every: int, tmp_path: Path) -> None:
    data, objective = next((data, objective) for name, data, objective in _certificates() if name == kind)
    proof = {key: entry for key, entry in data.items() if key != "bound"}
    leaves = [
        path for path in places(proof) if path[0] != "problem" and not isinstance(value_at(proof, path), dict | list)
    ]
    tampered = [changed(proof, path, change(value_at(proof, path))) for path in leaves for change in CHANGES][::every]
    results = checked(tampered, tmp_path)
    assert len(results) > 30
    assert all(result["bound"] is None or result["bound"] <= objective * (1 + 1e-11) for result in results)
    for one in tampered if kind in {"leaf", "relaxed"} else ():
        try:
            proven = exact_bound(Certificate.from_dict(one))
        except InputError:
            continue
        assert proven is None or float(proven) <= objective * (1 + 1e-11)


def _of_type(like: float, value: float) -> float:
    """A whole number without a point where one is read so: with one it would be refused for that alone."""
    return int(value) if isinstance(like, int) and value == int(value) else value


def _tampered(data: Any) -> Iterator[Any]:
    """A file with one number after the other raised, lowered, and exchanged for the next one."""
    paths = [path for path in numbers(data) if path[-1] != "format"]
    for path, other in zip(paths, [*paths[1:], paths[0]], strict=True):
        value, neighbour = value_at(data, path), value_at(data, other)
        for new in (value * 1.001 + 1e-3, value * 0.999 - 1e-3):
            if new != value:
                yield changed(data, path, new)
        if value != neighbour:
            yield changed(changed(data, path, _of_type(value, neighbour)), other, _of_type(neighbour, value))


@pytest.mark.parametrize(
    ("problem", "bound", "every"),
    [(*SOLUTIONS["solution"], 6), *(pytest.param(*given, 1, marks=pytest.mark.long) for given in SOLUTIONS.values())],
)
def test_what_is_proven_of_a_tampered_file_both_prove(
    problem: Problem, bound: Bound, every: int, tmp_path: Path
) -> None:
    data = {key: entry for key, entry in data_of(problem, bound).items() if key != "state"}
    files = list(_tampered(data))[::every]
    found = [verdicts(claims) for claims in checked_each(files, tmp_path)]
    proven = [file for file, each in zip(files, found, strict=True) if each == {"proven"}]
    assert len(proven) < 0.5 * len(files)
    for file in files:
        try:
            verification = verify(file)
        except InputError:
            assert file not in proven
            continue
        wrong = {claim.name for claim in verification.claims if not claim.proven}
        assert not wrong or file not in proven, wrong
        # the library repairs multipliers, with which the sum loses its slopes: what they prove is true all the same
        if verification.proven and "not proven" in found[files.index(file)]:
            off = [path for path in numbers(data) if value_at(file, path) != value_at(data, path)]
            assert all("multiplier" in path or "equations" in path for path in off), off


def test_a_raised_bound_is_refused(tmp_path: Path) -> None:
    solution = _solution().to_dict()
    paths: list[Place] = [("certificate", "bound"), ("lower_bound",), ("objective",), ("constants", "C", "value")]
    raised = [changed(solution, path, value_at(solution, path) * (1 + 1e-8)) for path in paths]
    for path, claims in zip(paths, checked_each(raised, tmp_path), strict=True):
        assert false(claims) or path == ("lower_bound",), path
        assert verdicts(claims) != {"proven"}, path


def _by_boxes(problem: Problem, folder: Path) -> None:
    solution = synthesize(problem, bound="tight")
    if solution.power_certificate is None:
        return
    proof = solution.power_certificate.to_dict()
    above = proof | {"claim": solution.objective * (1.0 + 1e-6), "bound": None}
    assert [result["verdict"] for result in checked([proof, above], folder)] == ["proven", "not proven"]


@settings(max_examples=1, suppress_health_check=[HealthCheck.function_scoped_fixture])
@example(B=1.6919579422228668, degree=7)  # rounding decided which of the last two nodes leaves no box
@given(B=st.floats(1.3, 2.6), degree=st.sampled_from([3, 5, 7]))
def test_the_least_power_by_boxes_is_proven_there_too(tmp_path: Path, B: float, degree: int) -> None:
    _by_boxes(Problem(B=B, order=3, basis=Chebyshev(degree), minimise="D"), tmp_path)


WITHIN = Problem(
    order=2,
    basis=Chebyshev(1),
    symmetric=False,
    windows=(Window("0.2*b + c", high=5.9), Window("c + (1 + b^2)^1.5/9 + 0.02*cos(b)/(1 + a)", low=-4.2)),
)


def test_windows_of_formulas_are_proven_there_too(tmp_path: Path) -> None:
    solution = synthesize(WITHIN, bound="tight").to_dict()
    assert solution["power_certificate"]
    assert synthesize(replace(WITHIN, windows=())).objective < 0.99 * solution["objective"]
    assert verify(solution).proven
    raised = changed(solution["power_certificate"], ("claim",), solution["objective"] * (1.0 + 1e-6))
    first, second = (json.loads(json.dumps(solution["problem"])) for _ in range(2))
    first["windows"][1]["low"] += 1e-6
    second["windows"][1]["low"] -= 0.1
    tighter, wider = solution | {"problem": first}, solution["power_certificate"] | {"problem": second}
    claims, raised_claims, tighter_claims, wider_claims = checked_each([solution, raised, tighter, wider], tmp_path)
    assert verdicts(claims) == {"proven"}
    assert verdicts(raised_claims) == verdicts(wider_claims) == {"not proven"}
    assert any(path.endswith("window 2") for path in false(tighter_claims))


@pytest.mark.long
@pytest.mark.parametrize(("B", "degree", "minimise"), [(1.641, 9, "D"), (None, 5, "0.6*C/4 + 0.4*D/2.25")])
def test_proofs_of_many_boxes_and_of_mixtures_are_proven_there_too(
    B: float | None, degree: int, minimise: str, tmp_path: Path
) -> None:
    _by_boxes(Problem(B=B, order=4, basis=Chebyshev(degree), minimise=minimise), tmp_path)


@pytest.mark.long
def test_the_program_of_the_page_takes_every_simple_proof(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = (ROOT / "docs" / "theory" / "certificate.md").read_text(encoding="utf8")
    program = page[page.index("import json\nfrom fractions import Fraction as F") :].split("\nassert f")[0]
    monkeypatch.chdir(tmp_path)
    count = 0
    for file in RESULTS.rglob("*.json"):
        for _, proof in certificates(json.loads(file.read_text(encoding="utf8"))):
            problem = proof["problem"]
            given = not isinstance(problem.get("B"), list)
            plain = proof.get("program") == "objective" and problem["symmetric"]
            if given and plain and problem["minimise"] in {"C", "J"}:
                (tmp_path / "solution.json").write_text(json.dumps({"certificate": proof}), encoding="utf8")
                exec(program, {})  # noqa: S102 - as a reader does
                count += 1
    assert count == 345


@pytest.mark.parametrize("name", ["lower_bound", "best_possible"])
def test_a_bound_above_the_objective_is_false_at_sight(name: str, tmp_path: Path) -> None:
    data = synthesize(Problem(order=3, basis=Chebyshev(5), B=1.8)).to_dict()
    raised = [data | {name: data["objective"] * factor} for factor in (1.0 + 1e-6, 1.1, 10.0)]
    for claims in checked_each(raised, tmp_path):
        assert false(claims) == [f"the file: {name.replace('_', ' ')}"]


@pytest.mark.parametrize(
    ("file", "entry", "stated"),
    [
        ("cycle_press/cycle.json", ("axes", "slide"), ()),
        ("cycle_press/cycle.json", ("axes", "slide"), ("solutions", 0)),
        ("cam_pair/cam.json", (), ("laws",)),
        ("fastest_pick/fastest.json", ("table", "fronts", 0, "fastest", "solution"), ()),
    ],
)
def test_a_bound_above_what_it_is_a_bound_of_is_not_proven_and_said_once(
    file: str, entry: tuple[str | int, ...], stated: tuple[str | int, ...], tmp_path: Path
) -> None:
    data = value_at(json.loads((ROOT / "results" / file).read_text("utf-8")), entry)
    wrong = changed(data, (*stated, "lower_bound"), 1.5 * value_at(data, stated)["objective"])
    (by_second,) = false(checked(wrong, tmp_path))
    assert by_second.endswith("lower bound")
    assert len([claim for claim in verify(wrong).claims if not claim.proven]) == 1


def test_a_bound_above_its_certificate_and_below_the_objective_is_not_proven(tmp_path: Path) -> None:
    data = synthesize(POWER).to_dict()
    low, high = data["lower_bound"], data["objective"]
    assert high > low * 1.001
    raised = [data | {"lower_bound": low + share * (high - low)} for share in (0.05, 0.5, 0.95)]
    # a limit in the phase plane may prove more than this program knows
    limit = {"drive_limit": drive_limit("0.1*c", C=9.0).to_dict()}
    as_it_was, *above = checked_each([data, *raised, *(each | limit for each in raised)], tmp_path)
    assert not false(as_it_was)
    for file, claims, beside in zip(raised, above[:3], above[3:], strict=True):
        assert false(claims) == ["the file: lower bound"]
        assert all("is proven" in claim["detail"] for claim in claims if claim["verdict"] == "not proven")
        assert not verify(file).proven
        assert "not checked" in verdicts(beside)
        assert not false(beside)


def of_drives() -> dict[str, Any]:
    table = Mechanism("0.8 kg m^2")
    return {
        "limit of a drive": drive_limit("c + 0.5*a", "rms torque", C=9.0).to_dict(),
        "limit of a move": table.limit("peak torque", "0 deg", "45 deg", "0.25 s").to_dict(),
        "limit of rms torque": table.limit("rms torque", "0 deg", "45 deg", "0.25 s").to_dict(),
        "least time of a move": table.limit("time", "0 deg", "45 deg", limits={"torque": "50 N m"}).to_dict(),
    }


def test_limits_of_drives_are_not_checked_and_false_where_they_contradict_themselves(tmp_path: Path) -> None:
    drives, wrong, altered = of_drives(), list[Any](), list[Any]()
    for name, data in drives.items():
        limit = ("drive_limit",) if "drive_limit" in data else ()
        other: list[tuple[tuple[str, ...], Any]] = [((*limit, "minimise"), "banana")]
        other += [((*limit, "value"), value_at(data, (*limit, "attained")) * factor) for factor in (1.0 + 1e-6, 10.0)]
        other += [((*limit, "unit"), 0.0), ((*limit, "attained"), "no number")]
        of_move: list[tuple[tuple[str, ...], Any]] = [
            (("dimension",), "banana"),
            (("unit",), -1.0),
            (("further",), 1.0),
        ]
        of_move += [(("move",), {}), (("move", "minimise"), "banana"), (("move", "minimise"), "energy")]
        # a proof that no motion exists is of the least time or of a peak torque, whatever its move minimises
        other += [each for each in of_move if each[1] != "energy" or name == "limit of rms torque"] if limit else []
        wrong += [changed(data, *each) for each in other]
        leaves = [path for path in places(data) if not isinstance(value_at(data, path), dict | list)]
        altered += [changed(data, path, 7.0) for path in leaves[:: max(1, len(leaves) // 20)]]
    claims_of_each = checked_each([*drives.values(), *wrong, *altered], tmp_path)
    for claims in claims_of_each[: len(drives)]:
        assert "not checked" in verdicts(claims)
        assert not false(claims)
    changes = list(zip([*wrong, *altered], claims_of_each[len(drives) :], strict=True))
    assert [data for data, claims in changes[: len(wrong)] if not false(claims)] == []
    assert [data for data, claims in changes if not verdicts(claims) - {"proven"}] == []


def test_what_stands_beside_a_proof_is_not_passed_over(tmp_path: Path) -> None:
    solution = _solution().to_dict()
    beside: list[Any] = [
        {"table": [solution, {"best_possible": 4.0}]},
        {"table": [solution, 4.0]},
        {"best": solution, "least": 4.0},
        {"best": solution, "least": [{"best_possible": [4.0]}]},
        solution | {"value": 4.0},
        solution | {"constants": solution["constants"] | {"snap_x": 4.0}},
        {"B": 1.859, "best": solution, "least": {"best_possible": 4.0}},
    ]
    beside += [{"best_possible": 4.0}, [4.0], {"about": "nothing"}]
    wrong = [{"B": 1.8, "best": solution}, solution | {"status": "local"}, solution | {"status": "best"}]
    wrong.append(changed(solution, ("constants", "J", "value"), None))
    twice, *others = checked_each([[solution, solution], *beside, *wrong], tmp_path)
    assert verdicts(twice) == {"proven"}
    for data, claims in zip([*beside, *wrong], others, strict=True):
        assert bool(false(claims)) == (data in wrong), data
        assert data in wrong or "not checked" in verdicts(claims), data


def test_the_exit_code_says_what_is_only_partly_checked(tmp_path: Path) -> None:
    data = synthesize(Problem(order=3, basis=Chebyshev(5), B=1.8)).to_dict()
    assert ended([data], tmp_path).returncode == 0
    unknown = synthesize(Problem(order=4, minimise="J", basis=Chebyshev(5))).to_dict()
    answer = ended([data, unknown], tmp_path)
    assert answer.returncode == 3
    assert [verdicts(json.loads(line)) for line in answer.stdout.splitlines()] == [
        {"proven"},
        {"proven", "not checked"},
    ]
    above = data | {"lower_bound": 1.1 * data["objective"]}
    assert ended([unknown, above, data], tmp_path).returncode == 1


@pytest.mark.parametrize("weight", [1e-9, 1.0, 1e9])
def test_an_objective_that_can_be_zero_is_compared_with_its_scale(weight: float, tmp_path: Path) -> None:
    solution = synthesize(Problem(minimise=f"{weight!r}*snap", order=2, basis=Pieces(breaks=2, degree=7, continuity=3)))
    data = solution.to_dict()
    above = data | {"objective": 1e-6 * weight, "lower_bound": 1e-6 * weight}
    as_it_was, wrong = checked_each([data, above], tmp_path)
    assert verdicts(as_it_was) == {"proven"}
    assert set(false(wrong)) == {"the file: objective", "the file: lower bound"}


def test_an_objective_in_small_units_is_no_other_within_them(tmp_path: Path) -> None:
    data = synthesize(Problem(minimise="1e-9*C", order=3, basis=Chebyshev(5))).to_dict()
    assert false(checked({**data, "objective": data["objective"] * 1.001}, tmp_path)) == ["the file: objective"]


@pytest.mark.parametrize(
    "window", [Window("b", low=0.0, high=0.2, start=0.4, stop=0.6), Window("c", high=-1.0, start=0.1, stop=0.4)]
)
def test_a_contradiction_that_rounding_alone_hides_is_not_called_false(window: Window, tmp_path: Path) -> None:
    with pytest.raises(InfeasibleProblem) as raised:
        synthesize(Problem(order=4, basis=Chebyshev(1), windows=(window,)))
    proof = raised.value.proof
    assert isinstance(proof, Certificate)
    value = exact_bound(proof)
    assert value is not None
    assert value > 0
    data = proof.to_dict()
    heaviest = max(range(len(data["contacts"])), key=lambda i: data["contacts"][i]["multiplier"])
    moved = changed(data, ("contacts", heaviest, "k"), data["contacts"][heaviest]["k"] + 0.01)
    assert [claim["verdict"] for claim in checked([data, moved], tmp_path)] == ["not checked", "not proven"]


def test_what_jumps_at_the_end_of_a_window_is_taken_from_before_it(tmp_path: Path) -> None:
    window = Window("c", low=-1.0, high=1.0, start=0.0, stop=0.3)
    problem = Problem(order=2, basis=Pieces((0.0, 0.3, 0.7, 1.0), 4, 1), symmetric=False, windows=(window,))
    solution = synthesize(problem)
    data = solution.certificate.to_dict()
    moved = json.loads(json.dumps(data).replace(repr(0.3 - 2.0**-51), "0.3"))
    assert moved != data
    for result in checked([data, moved], tmp_path):
        assert result["bound"] == pytest.approx(solution.objective, rel=1e-9)
    value = exact_bound(Certificate.from_dict(moved))
    assert float(value or 0) == pytest.approx(solution.objective, rel=1e-9)


def test_of_the_power_over_pieces_no_more_is_proven_than_its_rows_permit(tmp_path: Path) -> None:
    breaks = (0.0, 0.17, 0.5, 0.83, 1.0)
    problems = [
        Problem(order=2, basis=Pieces(breaks, 5, 3), minimise="D"),
        Problem(order=2, basis=Pieces(breaks, 7, 4), minimise="D", J=at_most(70.0)),
        Problem(order=2, basis=Pieces(breaks, 8, 4), minimise="D", symmetric=False),
    ]
    certificates_of_all = [synthesize(problem).certificate for problem in problems]
    results = checked([certificate.to_dict() for certificate in certificates_of_all], tmp_path)
    for certificate, result in zip(certificates_of_all, results, strict=True):
        assert result["verdict"] == "proven"
        assert result["bound"] <= _least_of_rows(certificate) * (1.0 + 1e-15)


def _least_of_rows(certificate: Certificate) -> float:
    """The D of values that satisfy all rows with a multiplier, as equations, in 100 digits: no row proves more."""
    with ctx.workdps(100):
        rows = ExactRows(certificate)
        acting = [rows.row(contact) for contact in certificate.contacts if contact.multiplier > 0.0]
        vectors = [row.vector(rows.names) for row in (*acting, *rows.equations) if row is not None]
        matrix = arb_mat([[entry.mid() for entry in vector[:-1]] for vector in vectors])
        right = arb_mat(len(vectors), 1, [-vector[-1].mid() for vector in vectors])
        least = matrix.transpose() * (matrix * matrix.transpose()).solve(right)
        return float(least[rows.space.terms + rows.names.index("D"), 0].mid())

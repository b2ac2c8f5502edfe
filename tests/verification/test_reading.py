"""What is read: files of one or many solutions; wrong ones end in an error that says what is wrong."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from flint import arb

from optlaws import Basis, Chebyshev, Functional, InputError, Problem, smoothstep
from optlaws.verification import exact_bound, verify, verify_all
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.verification import built, exact_space, number, read
from tests.verification.tampering import data_of, text_of

PROBLEM = Problem(B=1.859, order=3, basis=Chebyshev(5))


def written(tmp_path: Path, text: str) -> str:
    file = tmp_path / "solution.json"
    file.write_text(text, "utf-8")
    return str(file)


WRONG: dict[str, tuple[Callable[[str], str], str]] = {
    "truncated": (lambda text: text[: len(text) // 2], "not JSON"),
    "empty": (lambda _: "", "not JSON"),
    "array": (lambda text: f"[{text}]", "not a JSON object"),
    "nan": (lambda text: text.replace('"objective": ', '"objective": NaN, "was": '), "NaN is no JSON number"),
    "infinity": (lambda text: text.replace('"gap": ', '"gap": -Infinity, "was": '), "-Infinity is no JSON number"),
    "overflow": (lambda text: text.replace('"objective": ', '"objective": 1e999, "was": '), "finite number, got inf"),
    "huge": (
        lambda text: text.replace('"objective": ', f'"objective": {"9" * 400}, "was": '),
        "outside the range of floating-point numbers",
    ),
    "endless": (lambda text: text.replace('"objective": ', f'"objective": {"9" * 5000}, "was": '), "not JSON"),
    "twice": (lambda text: text.replace('"objective": ', '"objective": 1, "objective": '), "comes twice"),
    "format": (lambda text: text.replace('"format": 1', '"format": 2'), "law was written by a newer optlaws: format 2"),
    "degree": (lambda text: text.replace('"degree": 5', '"degree": 100000'), "more than exact verification takes"),
    "program": (lambda text: text.replace('"program": "objective"', '"program": "divine"'), "program of a certificate"),
    "basis": (lambda text: text.replace('"chebyshev"', '"legendre"'), "basis 'legendre' is unknown"),
    "kind": (lambda text: text.replace('"kind": "polynomial"', '"kind": "oracle"'), "kind"),
    "deep": (lambda _: '{"a":' * 100_000 + "1" + "}" * 100_000, "nested more than 50 deep"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_file_is_refused_and_says_why(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change, message = WRONG[name]
    before = text_of(PROBLEM)
    text = change(before)
    assert text != before
    assert exit_code(["verify", written(tmp_path, text)]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("good", "bad", "why"),
    [
        ({"order": 100}, {"order": 101}, "order: 101 is more than exact verification takes, 100"),
        ({"degree": 300}, {"degree": 301}, "degree: 301 is more"),
        ({"continuity": 300}, {"continuity": 301}, "continuity: 301 is more"),
        ({"breaks": [0.0] * 1000}, {"breaks": [0.0] * 1001}, "breaks: 1001 is more"),
        ({"breaks": 1000}, {"rows": [{"breaks": 1001}]}, r"rows\[0\].breaks: 1001"),
        ({"C": 1e100}, {"C": 1.001e100}, "C: 1.001e\\+100 is beyond what exact verification takes"),
        ({"C": -1e100}, {"law": {"C": [0.0, -1.001e100]}}, r"law.C\[1\]: -1.001e\+100"),
        ({"B": 1.5}, {"B": float("nan")}, "B must be a finite number, got nan"),
        ({"B": 10**90}, {"B": 10**400}, "B is beyond the numbers of double precision"),
        ({"format": 1}, {"format": 2}, "the file was written by a newer optlaws: format 2, this reads up to 1"),
        ({"format": 1}, {"rows": [{"law": {"format": 3}}]}, r"rows\[0\].law was written by a newer .* format 3"),
        ({"format": 1}, {"law": {"format": True}}, "law: the format must be a whole number from 1 on, got True"),
        ({"format": 1}, {"format": 0}, "the file: the format must be a whole number from 1 on, got 0"),
    ],
)
def test_sizes_and_numbers_are_read_up_to_their_greatest(good: dict[str, Any], bad: dict[str, Any], why: str) -> None:
    assert read(good) == good
    with pytest.raises(InputError, match=why):
        read(bad)


def test_only_numbers_are_numbers() -> None:
    assert number({"B": 2}, "B") == 2.0
    for wrong in (True, None, "2"):
        with pytest.raises(InputError, match="B must be a finite number, got"):
            number({"B": wrong}, "B")


def test_what_cannot_be_built_is_said_by_its_name() -> None:
    assert built(int, "3", "degree") == 3
    with pytest.raises(InputError, match="degree: ValueError: invalid literal"):
        built(int, "three", "degree")
    with pytest.raises(InputError, match="problem: B must be a finite number above 1"):
        built(Problem.from_dict, {"B": 0.5, "order": 3}, "problem")


def test_the_same_of_python_data() -> None:
    data = data_of(PROBLEM)
    with pytest.raises(InputError, match=r"certificate\.tangent must be a finite number, got inf"):
        verify({**data, "certificate": {**data["certificate"], "tangent": float("inf")}})
    with pytest.raises(InputError, match="objective must be a finite number"):
        verify(data | {"objective": "4.6"})
    with pytest.raises(InputError, match="constants must be"):
        verify(data | {"constants": 3})
    with pytest.raises(InputError, match="neither a solution"):
        verify({"rows": [data]})
    for problem in ({}, 1, {"order": 4}):
        with pytest.raises(InputError):
            verify({"problem": problem, "law": {}, "certificate": {}})


def test_what_has_no_finite_enclosure_is_computed_again_in_doubles(monkeypatch: pytest.MonkeyPatch) -> None:
    """Formulas of mechanisms may be so long that their enclosures have no end: they neither prove nor refute."""
    data = data_of(PROBLEM)
    monkeypatch.setattr("optlaws.verification.exact.law.ExactLaw.sum", lambda *_: arb("nan"))
    verification = verify(data)
    assert verification.proven
    assert {claim.name for claim in verification.recomputed} == {"the objective", "the gap", "optimal"}
    refuted = verify(data | {"objective": 1.01 * data["objective"]})
    assert [claim.name for claim in refuted.claims if not claim.proven] == ["the objective"]


def test_the_command_says_what_is_not_proven_of_each_file_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    good.write_text(text_of(PROBLEM), "utf-8")
    assert verify(good) == verify(str(good)) == verify(data_of(PROBLEM))
    data = data_of(PROBLEM)
    data["certificate"]["bound"] += 1e-7
    bad.write_text(json.dumps(data), "utf-8")
    assert exit_code(["verify", str(good)]) == 0
    assert "good.json: proven" in capsys.readouterr().out
    assert exit_code(["verify", str(good), str(good), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert list(said) == [str(good)]
    assert said[str(good)]["proven"] is True
    assert exit_code(["verify", str(good), str(bad)]) == 1
    out, wrong = capsys.readouterr()
    assert "1 claim is not proven" in wrong
    unproven = out.split(str(bad))[1]
    assert unproven.startswith(": not proven\n")
    assert unproven.count("the certificate's bound") == 1
    assert exit_code(["verify"]) == 2
    assert "name at least one file" in capsys.readouterr().err


def test_every_solution_of_a_file_is_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data, law = data_of(PROBLEM), smoothstep(3)
    rows: dict[str, list[dict[str, Any]]] = {
        "rows": [{"solution": data}, {"printed": {"law": law.to_dict(), "constants": law.constants.to_dict()}}]
    }
    file = written(tmp_path, json.dumps(rows))
    verifications = verify_all(file)
    assert list(verifications) == ["rows[0].solution", "rows[1].printed"]
    assert all(one.proven for one in verifications.values())
    assert exit_code(["verify", file]) == 0
    assert "rows[0].solution: 29 claims are proven" in capsys.readouterr().out
    rows["rows"][1]["printed"]["constants"]["C"]["value"] = 5.0
    assert exit_code(["verify", written(tmp_path, json.dumps(rows))]) == 1
    assert "not proven  C: 5.0 stated" in capsys.readouterr().out


@pytest.mark.parametrize(
    "data",
    [
        {"rows": []},
        {"points": [{"lower_bound": 4.0, "problem": {}}]},
        {"rows": [{"solution": {"law": smoothstep(2).to_dict(), "objective": 6.0}}]},
    ],
)
def test_claims_without_a_certificate_are_refused(data: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="not a file of solutions"):
        verify_all(data)


#: laws made for their loaders are kept without certificates
SHIPPED = sorted({*(ROOT / "results").glob("*/laws.json")} - {ROOT / "results" / "loader_optimal" / "laws.json"})


@pytest.mark.long
@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: file.parent.name)
def test_every_shipped_law_is_proven(file: Path) -> None:
    verifications = verify_all(file)
    assert len(verifications) > 2
    assert [place for place, one in verifications.items() if not one.proven] == []


def test_shipped_laws_are_proven() -> None:
    verifications = verify_all(ROOT / "results" / "d_minimal" / "laws.json")
    assert len(verifications) > 10
    assert all(one.proven for one in verifications.values())


class Mystery(Basis):
    """A basis that nobody has put into exact arithmetic."""

    def check(self, *, symmetric: bool) -> None:
        """Whatever it is."""

    def to_dict(self) -> dict[str, Any]:
        """Nothing."""
        return {}


def test_bases_of_unknown_kinds_are_refused() -> None:
    with pytest.raises(InputError, match="exact verification knows laws with Z in polynomials or in splines"):
        exact_space(Problem(B=1.859, order=3, basis=Mystery()))


def test_own_constants_are_refused_even_if_they_look_like_known_ones() -> None:
    from dataclasses import dataclass

    from optlaws import synthesize
    from tests.internals.synthesis import PeakConstant

    @dataclass(frozen=True, repr=False)
    class Half(PeakConstant):
        """A peak of which half is told."""

        def value(self, law: Any) -> float:
            return 0.5 * super().value(law)

    half: Functional = Half("half", 2.0, convex=True, nu=2)
    solution = synthesize(Problem(B=1.859, order=3, basis=Chebyshev(5), minimise="C"))
    from dataclasses import replace

    asked = replace(solution.problem, minimise=half)
    with pytest.raises(InputError, match="as optlaws defines them, not half"):
        exact_bound(replace(solution.certificate, problem=asked))

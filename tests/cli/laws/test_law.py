"""`optlaws law` and `optlaws catalogue`."""

import json

import pytest

from optlaws import MotionLaw, SavinFamily, catalogue, savin
from optlaws.cli.app import exit_code


def output(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert exit_code(arguments) == 0
    return capsys.readouterr().out


def test_a_law_is_shown_with_its_constants(capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "law", "MODSINUSLINIE", "--at", "0.25", "--at", "0.5")
    for part in ("modified sine", "scca(1/4, 0, 3/4)", "5.527957071", "0.287299", "a, b, c"):
        assert part in text
    assert f"{catalogue['modified sine'].law.a(0.25):.10g}" in text


def test_a_law_as_json_can_be_read_back(capsys: pytest.CaptureFixture[str]) -> None:
    data = json.loads(output(capsys, "law", "0317(1,5)", "--at", "0.3", "--json"))
    law = MotionLaw.from_dict(data["law"])
    assert law == catalogue["0317(1,5)"].law
    assert data["constants"]["C"]["value"] == law.peak(2).value
    assert data["at"] == [
        {"k": 0.3, "a": law.a(0.3), "b": law.b(0.3), "c": law.c(0.3), "j": law.j(0.3), "d": law.d(0.3)}
    ]


def test_a_peak_without_bound_is_null(capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "law", "constant acceleration", "--json")
    assert json.loads(text, parse_constant=pytest.fail)["constants"]["J"] == {"value": None, "k": 0.5}


def test_members_of_families(capsys: pytest.CaptureFixture[str]) -> None:
    assert "6.760957066" in output(capsys, "law", "III", "--alpha", "7.2")
    assert "family II" in output(capsys, "law", "II", "--alpha=-5")
    data = json.loads(output(capsys, "law", "III", "--peak-velocity", "1.75", "--json"))
    assert data["alpha"] == pytest.approx(SavinFamily(2).alphas(B=1.75)[0])
    assert MotionLaw.from_dict(data["law"]) == savin("III", B=1.75)


def test_the_catalogue_is_listed_and_searched(capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "catalogue")
    assert all(name in text for name in catalogue)
    found = json.loads(output(capsys, "catalogue", "BESTEHORN", "--json"))
    assert [one["name"] for one in found] == ["cycloidal"]
    assert found[0]["aliases"]["CODESYS"] == ["InclinedSine"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["law", "modifed sine"], "did you mean 'modified sine'"),
        (["law", "0399"], "50 hundredths"),
        (["law", "III"], "family III needs --alpha from -6 to 12"),
        (["law", "III", "--alpha", "13"], "between -6 and 12"),
        (["law", "III", "--alpha", "1", "--peak-velocity", "2"], "got alpha and B"),
        (["law", "cubic", "--alpha", "1"], "choose a member of a family"),
        (["law", "cubic", "--at", "2"], "k must be in [0, 1]"),
        (["catalogue", "qwerty"], "no law is like 'qwerty'"),
    ],
)
def test_wrong_input_is_refused(capsys: pytest.CaptureFixture[str], arguments: list[str], message: str) -> None:
    assert exit_code(arguments) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.out == ""

"""`optlaws law` and `optlaws catalogue`."""

import json
from pathlib import Path

import numpy as np
import pytest

from optlaws import Cycle, Dwell, MotionLaw, Return, Rise, SavinFamily, catalogue, read_law, savin, smoothstep
from tests.internals.cli import exit_code


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


def test_members_of_families(capsys: pytest.CaptureFixture[str]) -> None:
    assert "6.760957066" in output(capsys, "law", "III", "--alpha", "7.2")
    assert "family II" in output(capsys, "law", "II", "--alpha=-5")
    data = json.loads(output(capsys, "law", "III", "--peak-velocity", "1.75", "--json"))
    assert data["alpha"] == pytest.approx(SavinFamily(2).alphas(B=1.75)[0])
    assert MotionLaw.from_dict(data["law"]) == savin("III", B=1.75)


def test_the_catalogue_is_listed_and_searched(capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "catalogue")
    assert all(name in text for name in catalogue)
    data = json.loads(output(capsys, "catalogue", "BESTEHORN", "--json"))
    assert [one["name"] for one in data] == ["cycloidal"]
    assert data[0]["aliases"]["CODESYS"] == ["InclinedSine"]


def test_a_member_is_named_in_one_text(capsys: pytest.CaptureFixture[str]) -> None:
    asked = json.loads(output(capsys, "law", "iii(7.2)", "--json"))
    assert asked == json.loads(output(capsys, "law", "III", "--alpha", "7.2", "--json"))
    assert json.loads(output(capsys, "law", "Family III (B = 1.75)", "--json"))["constants"]["B"]["value"] == 1.75
    assert json.loads(output(capsys, "follower", "III(7.2)", "--frequency", "20", "--json"))["frequency"] == 20


def test_what_solve_wrote_is_shown_as_any_law(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "law.json"
    output(capsys, "solve", "--order", "3", "--peak-velocity", "1.8", "--output", str(file))
    text = output(capsys, "law", str(file))
    assert f"the law in {file}" in text
    assert text.splitlines()[1].split(maxsplit=1) == ["continuous", "a, b, c"]
    law = MotionLaw.from_dict(json.loads(output(capsys, "law", str(file), "--json"))["law"])
    assert law == MotionLaw.from_dict(json.loads(file.read_text("utf-8"))["law"])


def test_rounding_is_shown_as_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    values = output(capsys, "law", "modified sine", "--at", "0.5").splitlines()[-1].split()
    assert values == ["0.5", "0.5", "1.759603386", "0", "-23.15545243", "0"]


def test_no_number_is_cut_and_no_blank_ends_a_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    wide = output(capsys, "law", "modified sine", "--at", "0.3")
    monkeypatch.setenv("COLUMNS", "20")
    assert output(capsys, "law", "modified sine", "--at", "0.3") == wide
    assert all(line == line.rstrip() for line in wide.splitlines())
    assert f"{catalogue['modified sine'].law.d(0.3):.10g}" in wide
    monkeypatch.setenv("FORCE_COLOR", "1")
    on_terminal = output(capsys, "law", "modified sine", "--at", "0.3")
    assert f"{catalogue['modified sine'].law.d(0.3):.10g}" in on_terminal


def test_a_law_is_written_as_a_table_and_drawn(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    table, picture = tmp_path / "table.csv", tmp_path / "law.svg"
    output(capsys, "law", "cubic", "--csv", str(table), "--samples", "5", "--plot", str(picture))
    lines = table.read_text("utf-8").splitlines()
    assert lines[1:4] == ["k,a,b,c,j,d", "0,0,0,6,-12,0", "0.25,0.15625,1.125,3,-12,3.375"]
    assert len(lines) == 7
    assert picture.read_text("utf-8").startswith("<?xml")


@pytest.mark.filterwarnings("default::optlaws.NoisyTable")
def test_a_measured_table_is_told_to_be_noisy_unless_its_tolerance_is_given(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file, k = tmp_path / "scan.txt", np.linspace(0.0, 1.0, 121)
    lift = 35.0 * smoothstep(3)(k) + np.random.default_rng(1).normal(0.0, 0.02, 121)
    file.write_text(
        "angle\tlift\ttemperature\n" + "".join(f"{x:.4f}\t{y:.2f}\t20\n" for x, y in zip(k, lift, strict=True))
    )
    assert exit_code(["law", str(file)]) == 2
    assert "line 2: 3 columns of numbers" in capsys.readouterr().err
    for arguments in (["law", str(file), "--columns", "angle,lift"], ["law", f"{file}(columns=1,2)"]):
        assert exit_code([*arguments, "--json"]) == 0
        answer = capsys.readouterr()
        assert answer.err.startswith("optlaws: the points scatter by 0.0")
        assert json.loads(answer.out)["constants"]["C"]["value"] == pytest.approx(5.7735, rel=0.1)
    choices = [["--columns", "1,2", "--tolerance", "0.1"], ["--columns", "1,2", "--tolerance", "0"]]
    peaks = []
    for options in choices:
        assert exit_code(["law", str(file), *options, "--json"]) == 0
        answer = capsys.readouterr()
        assert answer.err == ""
        peaks.append(json.loads(answer.out)["constants"]["C"]["value"])
    assert peaks[0] < 8.0
    assert peaks[1] > 30.0
    law = f"{file}(columns=1,2; tolerance=0.1)"
    rise = Rise("35 mm", "0.1 s", law=law)
    cycle = Cycle([rise, Dwell("0.1 s"), Return(duration="0.1 s", law=law)], period="0.3 s")
    assert cycle(0.025) == pytest.approx(0.035 * read_law(law)(0.25), rel=1e-12)

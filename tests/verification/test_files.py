"""Files and the command: what is read, what is printed, and what ends in an error."""

import json
from pathlib import Path
from typing import Any

import pytest
from cyclopts import App

from optlaws import Chebyshev, InputError, Problem, synthesize
from optlaws.verification import verify
from tests.internals.cli import NotProven
from tests.internals.cli import verify as command


@pytest.fixture(scope="module")
def text() -> str:
    return json.dumps(synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9))).to_dict())


def test_files_are_read(tmp_path: Path, text: str) -> None:
    file = tmp_path / "solution.json"
    file.write_text(text, "utf-8")
    assert verify(file) == verify(str(file)) == verify(json.loads(text))
    file.write_text("[]", "utf-8")
    with pytest.raises(InputError, match="not a JSON object"):
        verify(file)
    file.write_text("{", "utf-8")
    with pytest.raises(InputError, match="not JSON"):
        verify(file)


def test_the_command_says_what_is_not_proven(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    good.write_text(text, "utf-8")
    data: dict[str, Any] = json.loads(text)
    data["certificate"]["bound"] += 1e-7
    bad.write_text(json.dumps(data), "utf-8")
    command(good)
    assert "good.json: proven" in capsys.readouterr().out
    command(good, json=True)
    assert json.loads(capsys.readouterr().out)[str(good)]["proven"] is True
    with pytest.raises(NotProven, match=r"^1 claim is not proven$"):
        command(good, bad)
    said = capsys.readouterr().out.split(str(bad))[1]
    assert said.startswith(": not proven\n")
    assert said.count("the certificate's bound") == 1
    with pytest.raises(InputError, match="name at least one file"):
        command()


def test_the_command_line_takes_files_and_json(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "solution.json"
    file.write_text(text, "utf-8")
    app = App(result_action="return_none")
    app.command(command)
    app(["verify", str(file), str(file), "--json"])
    assert list(json.loads(capsys.readouterr().out)) == [str(file)]

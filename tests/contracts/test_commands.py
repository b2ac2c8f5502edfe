"""What every command keeps: strict JSON, whole numbers, refusals that name the option, a help that costs nothing."""

import inspect
import json
import subprocess
import sys
from pathlib import Path
from typing import NoReturn
from unittest.mock import patch

import pytest

import optlaws
from tests.contracts.frozen import Table, commands
from tests.documents import ROOT
from tests.internals.cli import BAD_INPUT, exit_code
from tests.internals.cli import app_of_cli as app

STUDY = "[problem]\norder = 2\nbasis = 'pieces'\nbreaks = 4\ncontinuity = 1\ndegree = 3\n[vary]\nB = [1.8]\n"
#: a call of each that has something infinite to tell where it can have it
CALLS = {
    "advise": "--stroke 35mm --duration 0.1s --degree 5 --points 0",
    "catalogue": "",
    "compare": "0050 cubic --frequency 20",
    "cycle": "cycle.toml",
    "export": "0050 --to csv --stroke 35mm --time 0.1s --points 9",
    "explore": "cycloidal --no-browser --port 0",
    "follower": "0050 --frequency 20",
    "front": "--order 2 --degree 3 --points 2",
    "law": "0050 --at 0.5",
    "new": "law law.toml --defaults",
    "run": "problem.toml",
    "solve": "--order 2 --degree 3 --basis pieces --breaks 4 --continuity 1 --peak-velocity 1.8",
    "study": "study.toml --workers 1",
    "verify": "solution.json",
}
COMMANDS: Table = commands()
NUMBERS = {"int": "2.5", "float": "fast", "list[float]": "fast", "tuple[float, float]": "1 fast", "bool": "maybe"}
FILES = {"--output": "answer.json", "--csv": "front.csv", "--plot": "picture.svg", "--out": "results"}
WRONG = [
    (command, option, NUMBERS[kind])
    for command, options in COMMANDS.items()
    for option, summary in options.items()
    if (kind := summary.partition(" = ")[0].removesuffix(" | None")) in NUMBERS
]
#: the many panels of the catalogue take as long as the pictures of all others
DRAWING = [
    pytest.param(one, marks=[pytest.mark.long] if one == "catalogue" else [])
    for one, options in COMMANDS.items()
    if "--plot" in options
]
WRITTEN = [(command, option) for command, options in COMMANDS.items() for option in FILES if option in options]

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files that the calls name, and one that holds a file in the place of a folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY, "utf-8")
    (tmp_path / "cam.toml").write_bytes((ROOT / "problems" / "cam_flat_face.toml").read_bytes())
    (tmp_path / "cycle.toml").write_bytes((ROOT / "problems" / "cycle_press.toml").read_bytes())
    (tmp_path / "problem.toml").write_bytes((ROOT / "problems" / "lever_nomogram.toml").read_bytes())
    (tmp_path / "file").write_text("", "utf-8")
    return tmp_path


def refuse(constant: str) -> NoReturn:
    raise AssertionError(f"{constant} is not JSON")


def call(command: str, **changed: str) -> list[str]:
    """The call of a command with options changed."""
    words = CALLS[command].split()
    for name, value in changed.items():
        option = f"--{name}"
        if option in words:
            at = words.index(option)
            del words[at : at + 2]
        words += [f"{option}={value}"] if " " not in value else [option, *value.split()]
    return [command, *words]


def refused(capsys: Capture, arguments: list[str]) -> str:
    before = sorted(Path.cwd().rglob("*"))
    assert exit_code(arguments) == BAD_INPUT
    assert sorted(Path.cwd().rglob("*")) == before
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("optlaws: ")
    assert "Traceback" not in err
    return err


def test_every_command_is_here() -> None:
    assert set(CALLS) == set(COMMANDS)


@pytest.mark.sample(3)
@pytest.mark.parametrize("command", [name for name, options in COMMANDS.items() if "--json" in options])
def test_json_is_strict_and_alone(command: str, capsys: Capture) -> None:
    if command == "verify":
        problem = optlaws.Problem(order=2, basis=optlaws.Pieces(degree=3, breaks=4, continuity=1), B=1.8)
        Path("solution.json").write_text(json.dumps(optlaws.synthesize(problem).to_dict()), "utf-8")
    assert exit_code([*call(command), "--json"]) == 0
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    assert json.loads(out, parse_constant=refuse)


@pytest.mark.sample(4)
@pytest.mark.parametrize("command", DRAWING)
def test_a_picture_is_drawn_of_what_was_found(command: str, capsys: Capture) -> None:
    assert exit_code([*call(command), "--plot", "picture.svg", "--json"]) == 0
    capsys.readouterr()
    assert "<svg" in Path("picture.svg").read_text("utf-8")
    assert "--plot" in refused(capsys, [*call(command), "--plot", "picture.pdf"])


@pytest.mark.sample(2)
@pytest.mark.parametrize(("command", "option", "value"), WRONG)
def test_a_wrong_value_is_refused_by_its_option(command: str, option: str, value: str, capsys: Capture) -> None:
    assert option in refused(capsys, call(command, **{option[2:]: value}))


@pytest.mark.parametrize("command", COMMANDS)
def test_an_unknown_option_is_refused_by_its_name(command: str, capsys: Capture) -> None:
    assert "--nonsense" in refused(capsys, [*call(command), "--nonsense"])


@pytest.mark.parametrize(("command", "option"), WRITTEN)
def test_a_file_that_cannot_be_written_is_refused(command: str, option: str, capsys: Capture) -> None:
    file = FILES[option]
    arguments = [*call(command), option, f"file/{file}"]
    # by the user's own name, and before anything is computed
    with (
        patch("optlaws.synthesize", side_effect=AssertionError),
        patch("optlaws.pareto_front", side_effect=AssertionError),
    ):
        assert f"file/{file}" in refused(capsys, arguments)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_has_a_sentence_in_the_help(command: str) -> None:
    arguments = app.app[command].assemble_argument_collection(parse_docstring=True)
    shown = {argument.name: argument.parameter.help or "" for argument in arguments if argument.show}
    assert shown
    assert [name for name, sentence in shown.items() if not sentence.rstrip().endswith(".")] == []
    headless = ("Of ", "By ", "Before ", "That ", "Which hold")
    assert [name for name, sentence in shown.items() if sentence.startswith(headless)] == []


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_says_what_a_command_does_and_shows_no_default_of_a_switch(command: str, capsys: Capture) -> None:
    arguments = app.app[command].assemble_argument_collection(parse_docstring=True)
    assert [argument.name for argument in arguments if "\n" in (argument.parameter.help or "")] == []
    does = inspect.getdoc(app.app[command].default_command)
    assert does is not None
    summary = does.partition("\n\nParameters")[0]
    for asked in (["--help"], [command, "--help"]):
        assert exit_code(asked) == 0
        out = capsys.readouterr().out
        assert "False" not in out
        assert summary.partition(".")[0][:40] in " ".join(out.replace("│", "").split())


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys\nfrom optlaws.cli import exit_code\n"
        f"codes = [exit_code([*name, '--help']) for name in ([], *([name] for name in {sorted(COMMANDS)}))]\n"
        "heavy = {'casadi', 'matplotlib', 'scipy'} & {*sys.modules}\n"
        "print('codes', {*codes}, 'heavy', heavy, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stderr == "codes {0} heavy set()\n"
    assert all(f"Usage: optlaws {name}" in done.stdout for name in COMMANDS)


def test_a_command_imports_what_it_needs_and_no_more() -> None:
    for command in ("catalogue", "law"):
        script = (
            f"import sys\nfrom optlaws.cli import exit_code\nassert exit_code({[*call(command), '--json']!r}) == 0\n"
            "print(*{'casadi', 'matplotlib', 'rich', 'scipy'} & {*sys.modules}, file=sys.stderr)"
        )
        done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
        assert done.stderr == "\n", command

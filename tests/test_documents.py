import re
import sys
from pathlib import Path

import pytest

from docs._ext.module_tree import PAGE, page_with_tree
from tests.documents import PROGRAMS, ROOT, Command, commands, failure

# What is executed or parsed (tests/documents.py), and what has nothing to execute.
LANGUAGES = {"python", "pycon", "console", "toml", "text", "csv", "bibtex"}
PAGES = sorted([*ROOT.glob("README.md"), *(ROOT / "docs").rglob("*.md")])
FENCE = re.compile(r"^[ \t>]*(`{3,}|~{3,})(?P<info>[^`\n]*)$", re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_fenced_block_has_a_language_that_is_executed_or_needs_no_execution(page: Path) -> None:
    openings = [match["info"].strip() for match in FENCE.finditer(page.read_text("utf-8"))][::2]
    assert not [info for info in openings if info not in LANGUAGES and not info.startswith("{")]


def test_the_architecture_shows_the_tree_as_it_is() -> None:
    page = PAGE.read_text("utf-8")
    assert page == page_with_tree(page), "run python docs/_ext/module_tree.py"


def test_a_console_block_is_split_into_commands_and_their_output() -> None:
    block = "$ optlaws run a.toml \\\n    --quiet\n$ optlaws list\none\n\ntwo\n"
    assert list(commands(block)) == [
        Command("optlaws run a.toml --quiet"),
        Command("optlaws list", ["one", "", "two"]),
    ]


def test_a_console_block_that_begins_with_output_is_refused() -> None:
    with pytest.raises(ValueError, match="begins with"):
        list(commands("one\n$ optlaws list\n"))


@pytest.fixture
def _speaker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stand-in for optlaws: prints its second argument, exits with its first."""
    script = tmp_path / "speaker.py"
    script.write_text("import sys\nprint(sys.argv[2])\nsys.exit(int(sys.argv[1]))\n", "utf-8")
    monkeypatch.setitem(PROGRAMS, "optlaws", [sys.executable, str(script)])


@pytest.mark.usefixtures("_speaker")
@pytest.mark.parametrize(
    ("line", "output"),
    [
        ("optlaws 0 anything", []),
        ("optlaws 0 'C = 5.7735'", ["C = 5.7735", ""]),
        ("optlaws 0 'C = 5.77350269'", ["C = 5.7735"]),
        ("optlaws 0 'C = 5.77 in 12 ms'", ["C = 5.77 in ... ms"]),
        ("optlaws 2 'no such law'", ["no such law", "[2]"]),
        ("optlaws 2 'no such law'", ["[2]"]),
        ("make table", ["any text"]),
    ],
)
def test_a_command_that_does_what_its_block_shows_passes(line: str, output: list[str]) -> None:
    assert failure(Command(line, output)) is None


@pytest.mark.usefixtures("_speaker")
@pytest.mark.parametrize(
    ("line", "output", "complaint"),
    [
        ("optlaws 1 anything", [], "exit status 1, not 0"),
        ("optlaws 0 anything", ["[2]"], "exit status 0, not 2"),
        ("optlaws 0 'C = 5.7735'", ["C = 5.7745"], "should print"),
        ("optlaws 0 law | head", [], "needs a shell"),
        ("rm -r results", [], "neither run"),
    ],
)
def test_a_command_that_does_otherwise_fails(line: str, output: list[str], complaint: str) -> None:
    assert complaint in (failure(Command(line, output)) or "")

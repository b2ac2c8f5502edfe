import pkgutil
import re
import sys
import tomllib
from pathlib import Path

import pytest

import optlaws
from docs._ext.docstrings import finish, prepare
from docs._ext.entry_tables import TABLES
from docs._ext.made_parts import PARTS, with_parts
from docs._ext.stub_names import with_names
from optlaws import catalogue
from tests.documents import PROGRAMS, ROOT, Command, commands, failure
from tests.internals.cli import COMMANDS
from tests.internals.jobs import JOBS

# What is executed or parsed (tests/documents.py), and what has nothing to execute.
LANGUAGES = {"python", "pycon", "console", "toml", "text", "csv", "bibtex"}
PAGES = sorted(
    [*(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")), *(ROOT / "docs").rglob("*.md")]
)
FOLDERS = sorted(path.name for path in (ROOT / "optlaws").iterdir() if (path / "__init__.py").is_file())
#: where users have files of their own under these names, pages name such as are not there
LAYERS = "|".join(name for name in FOLDERS if name not in {"problems", "results"})
#: files and folders of the repository, those of the package with or without its name, and dotted names
PATH = re.compile(rf"(?<![\w/.-])((?:optlaws|tests|docs|\.ci|{LAYERS})/[\w./-]*(?:\.\w+|/))(?![\w*<{{])")
DOTTED = re.compile(r"(?<![\w./-])((?:optlaws|tests)(?:\.[A-Za-z_]\w*)+)")
FENCE = re.compile(r"^[ \t>]*(`{3,}|~{3,})(?P<info>[^`\n]*)$", re.MULTILINE)


def missing(page: str) -> list[str]:
    """Paths and dotted names on a page that stand for nothing."""
    paths = [
        name for name in PATH.findall(page) if not any((root / name).exists() for root in (ROOT, ROOT / "optlaws"))
    ]
    return paths + [name for name in DOTTED.findall(page) if not is_there(name)]


def is_there(name: str) -> bool:
    """Whether a dotted name is a module, or what one has."""
    try:
        pkgutil.resolve_name(name)
    except (AttributeError, ImportError):
        return False
    return True


def test_every_fenced_block_has_a_language_that_is_executed_or_needs_no_execution() -> None:
    for page in PAGES:
        openings = [match["info"].strip() for match in FENCE.finditer(page.read_text("utf-8"))][::2]
        assert not [info for info in openings if info not in LANGUAGES and not info.startswith("{")], page


def test_parts_that_are_made_of_the_code_have_their_places() -> None:
    pages = {name: with_parts(name, (ROOT / f"docs/{name}.md").read_text("utf-8")) for name in PARTS}
    entries = pages["reference/problem-files"]
    assert entries.count("| entry |") == len(TABLES) + 1  # that of studies is written by hand
    assert all(f"`{name}`" in entries for name in ("follower.kind", "minimise", "rated_torque"))
    assert pages["reference/command-line"].count("| Argument |") >= len(COMMANDS)
    assert all(f"| {name} |" in pages["how-to/catalogue"] for name in catalogue)
    assert all(f"{folder}/" in pages["architecture"] for folder in FOLDERS)


def test_the_reference_shows_every_public_name() -> None:
    pages = [with_names(page.read_text("utf-8")) for page in (ROOT / "docs" / "reference" / "api").glob("*.md")]
    lists = [names.split(", ") for page in pages for names in re.findall(r":members: (.*)", page)]
    single = [re.findall(r"(?:autofunction|py:data):: (?:\S+\.)?(\w+)", page) for page in pages]
    assert set(vars(optlaws)["__all__"]) - {name for names in [*lists, *single] for name in names} == set()


def test_every_path_and_module_that_a_document_names_is_there() -> None:
    pages = [*PAGES, ROOT / "CHANGELOG.md"]
    assert [f"{page.name}: {name}" for page in pages for name in missing(page.read_text("utf-8"))] == []


@pytest.mark.parametrize(
    ("page", "names"),
    [
        ("`optlaws/laws/law.py`, `laws/law.py`, `tests/jobs/`, `optlaws.laws`, `python -m tests.contracts.frozen`", []),
        ("`optlaws.synthesize`, `optlaws.errors.InputError`, `optlaws.catalogue.search`, `out/law.json`", []),
        ("`optlaws/export/csv.py` and `synthesis/exchange.py`", ["optlaws/export/csv.py", "synthesis/exchange.py"]),
        ("from optlaws.studies.sweeps import sweep", ["optlaws.studies.sweeps"]),
        ("`python -m tests.frozen`, `studies/sweeps/`", ["tests.frozen", "studies/sweeps/"]),
    ],
)
def test_a_path_or_module_that_is_not_there_is_seen(page: str, names: list[str]) -> None:
    assert sorted(missing(page)) == sorted(names)


def sections(page: str) -> list[str]:
    """The jobs or commands that the headings of a page of the reference name."""
    headings = re.findall(r"^## (.*)", (ROOT / "docs" / "reference" / page).read_text("utf-8"), re.MULTILINE)
    return sorted(name for line in headings for name in re.findall(r'(?:"|^optlaws )(\w[\w ]*)(?:"|$)', line))


def test_every_job_and_every_command_has_a_section() -> None:
    assert sections("problem-files.md") == sorted(JOBS)
    assert sections("command-line.md") == sorted(COMMANDS)


def test_the_contents_list_every_how_to_once_and_the_page_on_installing_every_extra() -> None:
    contents = (ROOT / "docs" / "index.md").read_text("utf-8")
    for page in sorted((ROOT / "docs" / "how-to").glob("*.md")):
        assert len(re.findall(rf"^how-to/{page.stem}$", contents, re.MULTILINE)) == 1, page.stem
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
    installing = (ROOT / "docs" / "how-to" / "install.md").read_text("utf-8")
    assert [name for name in extras if f"`{name}`" not in installing] == []


def test_every_picture_of_a_script_is_stored_and_shown() -> None:
    pages = "".join(page.read_text("utf-8") for page in PAGES)
    drawn = {script.stem for script in (ROOT / "docs" / "pictures").glob("*.py") if script.stem != "__init__"}
    shown = set(re.findall(r"pictures/(\w+)\.svg", pages))
    assert drawn == shown
    assert all((ROOT / "docs" / "pictures" / f"{name}.svg").is_file() for name in drawn)


def test_the_first_page_is_included_from_mark_to_mark() -> None:
    page, included = (ROOT / "README.md").read_text("utf-8"), (ROOT / "docs" / "index.md").read_text("utf-8")
    marks = re.findall(r"^:(?:start-after|end-before): (.*)$", included, re.MULTILINE)
    assert [page.count(mark) for mark in marks] == [1, 1]


def test_no_module_has_two_places_in_the_reference() -> None:
    pages = (ROOT / "docs" / "reference" / "api").glob("*.md")
    placed = [name for page in pages for name in re.findall(r"automodule:: (\S+)", page.read_text("utf-8"))]
    assert sorted(placed) == sorted(set(placed))


def test_a_console_block_is_split_into_commands_and_their_output() -> None:
    block = "$ optlaws run a.toml \\\n    --quiet\n$ optlaws list\none\n\ntwo\n"
    assert list(commands(block)) == [Command("optlaws run a.toml --quiet"), Command("optlaws list", ["one", "", "two"])]


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


def test_no_half_of_a_sentence_is_taken_for_a_type_and_no_names_are_parted() -> None:
    from docutils import nodes
    from docutils.utils import new_document

    page = new_document("page")
    for what, lines in (
        ("property", ["The program: shared by |b| <= B.", "", "Of one: shape."]),
        ("class", ["Peaks.", "", "Attributes", "----------", "B, C, J", "    Peaks: of b, c, j.", "See B, C"]),
    ):
        prepare(None, what, "", None, None, lines)  # type: ignore[arg-type] # the application is not asked
        assert not any(text in line for line in lines[:1] for text in (": ", "|b| "))
        assert not any(line.startswith("B, C, J") for line in lines)
        page += [nodes.paragraph("", "", nodes.Text(line.replace("\\", ""))) for line in lines]
    finish(None, page)  # type: ignore[arg-type]
    shown = [paragraph.astext() for paragraph in page]
    assert shown[0] == "The program: shared by |b| <= B."
    assert {"B, C, J", "    Peaks: of b, c, j.", "See B, C", "Of one: shape."} <= set(shown)

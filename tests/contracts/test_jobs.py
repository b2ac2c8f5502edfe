"""What every job keeps: errors that name file and entry, nothing written then, marked files, the same bytes again."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from matplotlib import pyplot as plt

from optlaws import InputError
from tests.internals.files import tables, writing
from tests.internals.jobs import job
from tests.jobs.examples import EXAMPLES
from tests.sampling import sampled

#: those whose own tests do them each time, and make check-results at full size
SLOW = {"machine laws"}
WRONG = [(name, *change) for name, example in EXAMPLES.items() for change in example.wrong]
WRONG_BESIDE = [(name, *change) for name, example in EXAMPLES.items() for change in example.wrong_beside]


def done(folder: Path, name: str, change: Callable[[str], str] = str, beside: Callable[[str], str] = str) -> list[Path]:
    """Run a job's example, or what a change makes of it or of the data beside it."""
    for other, content in EXAMPLES[name].beside.items():
        (folder / other).write_text(beside(content), "utf-8")
    file = folder / "small.toml"
    file.write_text(change(EXAMPLES[name].text), "utf-8")
    return job.done(file).write(folder / "out")


def replaced(old: str, new: str) -> Callable[[str], str]:
    """The change of a text that must be there."""

    def change(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return change


def refuse(constant: str) -> None:
    """For numbers that JSON has not."""
    raise AssertionError(f"{constant} is not JSON")


def test_every_job_has_an_example() -> None:
    assert EXAMPLES.keys() == {*job.JOBS}


def test_a_job_is_imported_when_it_runs() -> None:
    seen = "[name for name in sys.modules if name.startswith(('optlaws.jobs.', 'matplotlib', 'numpy'))]"
    program = f"import sys; from optlaws.jobs import job; print('cycle' in job.JOBS, len(job.JOBS), {seen})"
    message = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert message == f"True {len(EXAMPLES)} ['optlaws.jobs.job']\n"


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.long] if name in SLOW else []) for name in EXAMPLES]
)
def test_a_job_writes_marked_files_and_the_same_again(tmp_path: Path, name: str) -> None:
    written = done(tmp_path, name)
    assert plt.get_fignums() == []  # which would keep the pictures of every job until its process ends
    first = {file: file.read_bytes() for file in (tmp_path / "out").iterdir()}
    assert sorted(written) == sorted(first)
    assert {file.suffix for file in written} >= {".md"}
    for file, content in first.items():
        assert writing.MARK.encode() in content
        if file.suffix == ".json":
            json.loads(content, parse_constant=refuse)
    # nothing is left as it is: every file is written again
    for file in first:
        file.write_text("changed\n", "utf-8")
    with pytest.raises(InputError, match="other contents"):
        done(tmp_path, name)
    assert all(file.read_text("utf-8") == "changed\n" for file in first)
    with writing.forced():
        assert sorted(done(tmp_path, name)) == sorted(first)
    assert {file: file.read_bytes() for file in (tmp_path / "out").iterdir()} == first


@pytest.mark.long
@pytest.mark.parametrize("name", sampled(["solutions", "cycle"]))
def test_what_another_machine_rounds_otherwise_changes_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    def noisy(noise: float) -> None:
        monkeypatch.setattr(
            tables,
            "_cell",
            lambda cell, digits: shown(cell * (1.0 + noise) if isinstance(cell, float) else cell, digits),
        )

    shown = tables._cell
    first = {file: file.read_bytes() for file in done(tmp_path, name)}
    # a unit in the tenth digit, which the page shows
    noisy(3e-11)
    assert {file: file.read_bytes() for file in done(tmp_path, name)} == first
    noisy(3e-6)
    page = next(file for file in first if file.suffix == ".md")
    with writing.forced():
        assert {file: file.read_bytes() for file in done(tmp_path, name)}[page] != first[page]
    assert sorted((tmp_path / "out").iterdir()) == sorted(first)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("name", "old", "new", "message"), WRONG)
def test_errors_name_the_file_and_the_entry(tmp_path: Path, name: str, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"(?s)small\.toml.*{message}"):
        done(tmp_path, name, replaced(old, new))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("name", "old", "new", "message"), WRONG_BESIDE)
def test_errors_of_data_name_the_place(tmp_path: Path, name: str, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"(?s)small\.toml.*{message}"):
        done(tmp_path, name, beside=replaced(old, new))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_entry_is_known_needed_and_of_its_type(tmp_path: Path, name: str) -> None:
    for change, message in (
        (lambda text: "titel = 1\n" + text, "titel.*did you mean 'title'"),
        (lambda text: re.sub("title = ", "titl = ", text, count=1), "titl.*did you mean 'title'"),
        (lambda text: re.sub("title = .*", "title = 5", text, count=1), "title"),
    ):
        with pytest.raises(InputError, match=rf"(?s)small\.toml.*{message}"):
            done(tmp_path, name, change)
        assert not (tmp_path / "out").exists()

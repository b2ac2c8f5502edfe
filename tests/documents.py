"""How the code blocks of README.md and docs/ are run.

- ```` ```python ```` is executed; the blocks of a document share one namespace.
- ```` ```pycon ```` is a doctest.
- ```` ```toml ```` must parse.
- ```` ```console ```` has lines `$ optlaws ...`: they are run, must succeed, and must print what the block
  shows below them, if it shows anything. `...` stands for any text, numbers agree to the digits shown, and a
  last line `[2]` says that exit status 2 is expected. The first page runs them as a reader does, each in a process
  of its own; the others in this one, which has imported what they need. Commands that set up a machine (make, pip,
  git, ...) are not run; nor is `optlaws run FILE` of a problem of the repository that shows nothing, for that the
  file is there is seen here, and `make check-results` runs every one.

A document runs in a temporary directory of its own that holds a copy of problems/.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE
from io import StringIO
from pathlib import Path
from unittest.mock import patch

from sybil import Document, Example, Region, Sybil
from sybil.evaluators.doctest import NUMBER, DocTestEvaluator, OutputChecker
from sybil.parsers.abstract.doctest import DocTestStringParser
from sybil.parsers.myst import CodeBlockParser, PythonCodeBlockParser, SkipParser

from optlaws.cli import exit_code

ROOT = Path(__file__).resolve().parents[1]
FLAGS = ELLIPSIS | NORMALIZE_WHITESPACE | NUMBER
PROGRAMS = {"optlaws": [sys.executable, "-m", "optlaws"], "cat": ["cat"]}
FIRST_PAGE = ROOT / "README.md"
ENVIRONMENT = {"COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb", "PYTHONUTF8": "1"}
NOT_RUN = {"cd", "git", "make", "pip", "python", "python3", "source", "uv"}
SHELL_SYNTAX = {"|", "||", "&", "&&", ";", ">", ">>", "<"}
WORKSPACE = "__workspace__"
SECONDS = 300


@dataclass
class Command:
    """One `$` line of a console block and the output shown below it."""

    line: str
    output: list[str] = field(default_factory=list)


def commands(block: str) -> Iterator[Command]:
    """Split a console block into its commands; a backslash at a line's end continues the command."""
    command: Command | None = None
    for line in block.splitlines():
        if command is not None and not command.output and command.line.endswith("\\"):
            command.line = command.line[:-1] + line.strip().removeprefix("> ")
        elif line.startswith("$ "):
            if command is not None:
                yield command
            command = Command(line[2:].strip())
        elif command is not None:
            command.output.append(line)
        elif line.strip():
            raise ValueError(f"a console block begins with a line '$ command', not with {line!r}")
    if command is not None:
        yield command


def failure(command: Command, *, alone: bool = True) -> str | None:
    """Run a command, in a process of its own or in this one; say what is wrong with it, if anything is."""
    words = shlex.split(command.line)
    if words[0] in NOT_RUN or _is_run_elsewhere(words, command.output):
        return None
    if words[0] not in PROGRAMS:
        known = ", ".join(sorted(NOT_RUN.union(PROGRAMS)))
        return f"$ {command.line}\nis neither run nor known to need no running; known are {known}"
    if SHELL_SYNTAX.intersection(words):
        return f"$ {command.line}\nneeds a shell; console blocks are run without one"
    shown, expected = "\n".join(command.output).strip("\n"), 0
    if stated := re.search(r"(?:\A|\n)\[(\d+)\]\Z", shown):
        shown, expected = shown[: stated.start()], int(stated[1])
    status, printed = _in_a_process(words) if alone or words[0] != "optlaws" else _in_this_process(words)
    # what a command says of its work on a slow machine is no part of its answer
    printed = re.sub(r"^optlaws.* s so far\n", "", printed, flags=re.MULTILINE)
    if status != expected:
        return f"$ {command.line}\nended with exit status {status}, not {expected}:\n{printed}"
    if shown and not OutputChecker().check_output(shown + "\n", printed.strip("\n") + "\n", FLAGS):
        return f"$ {command.line}\nshould print\n{shown}\nbut prints\n{printed}"
    return None


def _in_a_process(words: list[str]) -> tuple[int, str]:
    """Exit status and output of a program."""
    done = subprocess.run(
        [*PROGRAMS[words[0]], *words[1:]],
        check=False,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        timeout=SECONDS,
        env=os.environ | ENVIRONMENT,
    )
    return done.returncode, done.stdout


def _in_this_process(words: list[str]) -> tuple[int, str]:
    """Exit status and output of the command `optlaws`, whose warnings are shown as everywhere else."""
    printed = StringIO()
    with (
        patch.dict(os.environ, ENVIRONMENT),
        redirect_stdout(printed),
        redirect_stderr(printed),
        warnings.catch_warnings(),
    ):
        warnings.resetwarnings()
        status = exit_code(words[1:])
    return status, printed.getvalue()


def _is_run_elsewhere(words: list[str], output: list[str]) -> bool:
    """Whether a command does a problem of the repository and shows nothing."""
    if words[:2] != ["optlaws", "run"] or any(output):
        return False
    return (ROOT / "problems" / f"{Path(words[-1]).stem}.toml").exists()


def evaluate_console(example: Example) -> str | None:
    alone = Path(example.path) == FIRST_PAGE
    said = (failure(command, alone=alone) for command in commands(str(example.parsed)))
    failures = [text for text in said if text is not None]
    return "\n".join(failures) or None


def evaluate_toml(example: Example) -> str | None:
    try:
        tomllib.loads(str(example.parsed))
    except tomllib.TOMLDecodeError as error:
        return str(error)
    return None


class PyconParser:
    """Doctests in blocks of the language pycon."""

    def __init__(self) -> None:
        self.blocks = CodeBlockParser("pycon")
        self.doctests = DocTestStringParser(DocTestEvaluator(FLAGS))

    def __call__(self, document: Document) -> Iterable[Region]:
        for block in self.blocks(document):
            for region in self.doctests(block.parsed, document.path):
                region.adjust(block, block.parsed)
                yield region


def enter_workspace(namespace: dict[str, object]) -> None:
    with ExitStack() as stack:
        directory = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if (ROOT / "problems").is_dir():
            shutil.copytree(ROOT / "problems", directory / "problems")
        stack.enter_context(chdir(directory))
        namespace[WORKSPACE] = stack.pop_all()


def leave_workspace(namespace: dict[str, object]) -> None:
    stack = namespace.pop(WORKSPACE)
    assert isinstance(stack, ExitStack)
    stack.close()


documents = Sybil(
    parsers=[
        PythonCodeBlockParser(doctest_optionflags=FLAGS),
        PyconParser(),
        CodeBlockParser("console", evaluate_console),
        CodeBlockParser("toml", evaluate_toml),
        SkipParser(),
    ],
    path=str(ROOT),
    pattern="*.md",
    setup=enter_workspace,
    teardown=leave_workspace,
)

"""Starter problem files: their questions, and their text with the answers."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from textwrap import fill
from typing import Any

from optlaws.entries.declared import Declared
from optlaws.entries.reference import sentences
from optlaws.errors import InputError, located
from optlaws.motion.quantities import DIMENSIONS, either
from optlaws.numbers import finite
from optlaws.suggest import unknown_key

#: answers by the names of questions; None where an entry is left out
Answers = dict[str, str | None]

#: a place in a text: the name of its answer and, behind a bar, what stands there where the entry is left out
_PLACE = re.compile(r"\$\{([\w-]+)(?:\|([^}]*))?\}")
_FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Question:
    """A number, or a text, that a starter needs.

    Attributes
    ----------
    name
        The name of the option, and of the place in the text.
    default
        The answer unless another is given; None where the entry is then left out.
    dimensions
        What its unit may be; a number without unit, or a text, where there are none.
    choices
        What a text may be.
    whole
        Whether a number is a whole one.
    """

    name: str
    default: str | None = None
    dimensions: tuple[str, ...] = ()
    choices: tuple[str, ...] = ()
    whole: bool = False

    def read(self, text: str) -> str:
        """An answer as it was typed, checked.

        Raises
        ------
        InputError
            If it is no such number, has no unit or the wrong one, or is not above 0.

        Examples
        --------
        >>> Question("stroke", dimensions=("length",)).read(" 35 mm")
        '35 mm'
        """
        answer, name = text.strip(), f"--{self.name}"
        if self.choices:
            if answer not in self.choices:
                raise InputError(f"{name}: {unknown_key(answer, self.choices, 'value')}")
            return answer
        number = either(answer, self.dimensions, name)[1] if self.dimensions else _number(answer, name)
        if number < 0.0 or (number == 0.0 and self.name not in _MAY_BE_ZERO):
            raise InputError(f"{name} must be above 0, got {answer}")
        if self.whole and not answer.isdecimal():
            raise InputError(f"{name} must be a whole number, got {answer}")
        return answer


#: what may be 0
_MAY_BE_ZERO = ("damping", "offset", "spread")


def _number(text: str, name: str) -> float:
    try:
        return finite(float(text), name)
    except ValueError:
        raise InputError(f"{name} must be a number, got {text!r}") from None


@dataclass(frozen=True)
class Starter:
    """A kind of problem file to begin with.

    Attributes
    ----------
    kind
        The name of the kind, and of the file with its text.
    command
        What runs the file: `optlaws` and this.
    questions
        What the file needs.
    derived
        Further answers that follow from those given.
    check
        Refuses the entries of a file that could not be run.
    value
        What the file is read as: above an entry a # alone in the text stands for what the entry says.
    """

    kind: str
    command: str
    questions: tuple[Question, ...]
    derived: Callable[[Answers], Answers]
    check: Callable[[Mapping[str, Any], Path], object]
    value: type[Declared] | None = None

    def run(self, file: Path) -> str:
        """The command behind `optlaws` that runs a file."""
        return self.command.format(file=quote(file.as_posix()), folder=quote(file.stem))

    def text(self, given: Mapping[str, str], file: Path) -> str:
        """The text of the file: each place with its answer; the line of an entry that is left out as a comment.

        Raises
        ------
        InputError
            If an answer is wrong, or the file with it could not be run.
        """
        import tomllib

        answers: Answers = {question.name: question.default for question in self.questions}
        answers |= {
            question.name: question.read(given[question.name]) for question in self.questions if question.name in given
        }
        answers |= self.derived(answers) | {"run": self.run(file)}
        lines = [self._line(line, answers) for line in self._template()]
        text = "\n".join(lines) + "\n"
        with located(str(file)):
            self.check(tomllib.loads(text), file)
        return text

    def _template(self) -> list[str]:
        """The lines of the text, with what the entries say."""
        lines = (_FOLDER / f"{self.kind}.toml").read_text("utf-8").splitlines()
        texts = {} if self.value is None else sentences(self.value)
        below = [line.lstrip("# ").partition(" ")[0] for line in lines[1:]]
        return [
            fill(texts[name], 120, initial_indent="# ", subsequent_indent="# ") if line == "#" else line
            for line, name in zip(lines, [*below, ""], strict=True)
        ]

    def _line(self, line: str, answers: Answers) -> str:
        """A line of the text with its answers; as a comment, with examples, where one is left out."""
        left_out = any(answers[place[1]] is None for place in _PLACE.finditer(line))
        filled = _PLACE.sub(lambda place: answers[place[1]] or place[2] or self._example(place[1], answers), line)
        return f"# {filled}" if left_out and not line.startswith("#") else filled

    def _example(self, name: str, answers: Answers) -> str:
        """An example value for an optional entry, of the dimension of the stroke."""
        dimensions = next(question.dimensions for question in self.questions if question.name == name)
        turns = len(dimensions) > 1 and either(answers["stroke"], ("length", "angle"), "--stroke")[0] == "angle"
        return DIMENSIONS[dimensions[turns]][1]

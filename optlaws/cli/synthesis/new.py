"""The command `optlaws new`: a commented problem file with a person's own numbers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from optlaws.cli.options import Option, Options, given, takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError
from optlaws.jobs.starters.starter_numbers import ABOUT

Kind = Literal["cycle", "cam", "drive", "mechanism", "fastest", "interlock", "machine", "law", "study"]
_OPTIONS = Options(
    {
        name: Option(f"--{name}", str, about, signed=True, group="Numbers of the kinds of files")
        for name, about in ABOUT.items()
    }
)
_Hidden = Parameter(show=False)


@takes(json=False, numbers=_OPTIONS)
def new(
    kind: Kind,
    file: Path | None = None,
    /,
    *,
    defaults: Annotated[bool, _Hidden] = False,  # noqa: ARG001 - of earlier versions, which prompted
    numbers: Mapping[str, str | None],
    **others: Annotated[str, _Hidden],
) -> Answer:
    """Begin a problem file, commented and ready to run: what no option gives is an example, to be changed in the file.

    Each number is an option, with its unit. No file is ever written over.

    Parameters
    ----------
    kind
        What is to be solved: a cycle of an axis, a disc cam, a table with its motor and gear, a mechanism of links, the
        least time of a move, two axes that must not meet, a move with an elastic load, a single law, or a study.
    file
        The file to write, which must not be there yet; KIND.toml unless given.
    """
    from optlaws.files import writing
    from optlaws.jobs.starters.starter import STARTERS

    starter = STARTERS[kind]
    place = file or Path(f"{kind}.toml")
    if place.suffix != ".toml":
        raise InputError(f"a problem file's name ends in .toml, got {place}")
    if place.exists():
        raise InputError(f"{place} is there already, and nothing is written over it: name another file")
    writing.check_place(place)
    text = starter.text({**given(numbers), **others}, place)
    with place.open("x", encoding="utf-8", newline="\n") as out:
        out.write(text)
    lines = [f"{place}: look at it, change what you like, then run", f"optlaws {starter.run(place)}"]
    return Answer(lambda: lines, list)

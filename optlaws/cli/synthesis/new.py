"""The command `optlaws new`: a commented problem file with a person's own numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Literal, get_args

from cyclopts import App, Parameter

from optlaws.cli.options import Option, Options, given, takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError
from optlaws.jobs.starters.starter_numbers import ABOUT, numbers_of

Kind = Literal["cycle", "cam", "barrel", "drive", "mechanism", "fastest", "interlock", "machine", "law", "study"]
_ALL = Options(
    {
        name: Option(f"--{name}", str, about, signed=True, group=f"Numbers for {kinds}")
        for name, (kinds, about) in ABOUT.items()
    }
)
_Hidden = Parameter(show=False)


def _new(
    kind: Kind,
    file: Path | None = None,
    /,
    *,
    defaults: Annotated[bool, _Hidden] = False,  # noqa: ARG001 - of earlier versions, which prompted
    numbers: Mapping[str, str | None],
    **others: Annotated[str, _Hidden],
) -> Answer:
    """Begin a problem file, commented and ready to run: what no option gives is an example, to be changed in the file.

    Each number is an option, with its unit; `optlaws new cam --help` lists those of a cam. No file is ever replaced.

    Parameters
    ----------
    kind
        What is to be solved: a cycle of an axis, a disc cam, a barrel cam, a table with its motor and gear, a mechanism
        of links, the least time of a move, two axes that must not meet, a move with an elastic load, a single law, or a
        study.
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
        raise InputError(f"{place} exists already and is not overwritten: name another file")
    writing.check_place(place)
    text = starter.text({**given(numbers), **others}, place)
    with place.open("x", encoding="utf-8", newline="\n") as out:
        out.write(text)
    lines = [f"{place}: look at it, change what you like, then run", f"optlaws {starter.run(place)}"]
    return Answer(lambda: lines, list)


def _of_kind(kind: Kind) -> Callable[..., None]:
    """The command of a kind, whose help says what its numbers are."""
    options = {}
    for name, usual in numbers_of(kind).items():
        about = ABOUT[name][1]
        more = f"{about[:-1]}; {usual} unless given." if usual is not None else about
        options[name] = Option(f"--{name}", str, more, signed=True, group="Numbers of the file")

    def begin(
        file: Path | None = None,
        /,
        *,
        defaults: Annotated[bool, _Hidden] = False,
        numbers: Mapping[str, str | None],
        **others: Annotated[str, _Hidden],
    ) -> Answer:
        return _new(kind, file, defaults=defaults, numbers=numbers, **others)

    begin.__name__, begin.__doc__ = (
        "new",
        (_new.__doc__ or "").replace("; `optlaws new cam --help` lists those of a cam", ""),
    )
    return takes(json=False, numbers=Options(options))(begin)


new = App(name="new", help_format="plaintext")
new.default(takes(json=False, numbers=_ALL)(_new))
for _kind in get_args(Kind):
    new.command(_of_kind(_kind), name=_kind, show=False)

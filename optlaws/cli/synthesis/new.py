"""The command `optlaws new`: a commented problem file with a person's own numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from optlaws.cli.show import show
from optlaws.errors import InputError

Kind = Literal["cycle", "cam", "machine", "study", "law"]


def new(
    kind: Kind,
    file: Path | None = None,
    /,
    *,
    defaults: Annotated[bool, Parameter(show=False)] = False,  # noqa: ARG001 - of earlier versions, which prompted
    **answers: Annotated[str, Parameter(help="Any number of the file by its name, such as --stroke 35mm.")],
) -> None:
    """Begin a problem file, commented and ready to run: what no option gives is an example, to be changed in the file.

    The numbers, by kind; those in brackets may be left out:

    cycle: stroke, rise, dwell, return, speed, [velocity, acceleration, jerk, mass]
    cam: as cycle, roller, pressure-angle, curvature, [offset, prime-radius]
    machine: stroke, duration, frequency, damping, spread, sway
    law: stroke, duration, minimise, order, [velocity, acceleration, jerk]
    study: minimise, from, to, steps, degree

    Parameters
    ----------
    kind
        What is to be solved: a cycle of an axis, a disc cam, a move with an elastic load, a study, or a single law.
    file
        The file to write, which must not be there yet; KIND.toml unless given.
    answers
        Any of the numbers, with its unit.
    """
    from optlaws.files import writing
    from optlaws.jobs.starters.starter import STARTERS

    starter = STARTERS[kind]
    place = file or Path(f"{kind}.toml")
    if place.suffix != ".toml":
        raise InputError(f"a problem file's name ends in .toml, got {place}")
    there = InputError(f"{place} is there already, and nothing is written over it: name another file")
    if place.exists():
        raise there
    writing.check_place(place)
    text = starter.text(answers, place)
    try:
        with place.open("x", encoding="utf-8", newline="\n") as out:
            out.write(text)
    except FileExistsError:
        raise there from None
    show(f"{place}: look at it, change what you like, then run", f"optlaws {starter.run(place)}")

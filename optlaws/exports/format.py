"""Formats of exports and their registry: recipients, fields, limits, and the function that writes each."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from optlaws.echo import shortened, unknown_key
from optlaws.entries.declared import Declared, declared, entries_of, entry
from optlaws.entries.value_types import Choice, Either, Text, Whole
from optlaws.errors import InputError, located
from optlaws.files.reading import check_names
from optlaws.lazy import Registry
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

MOST_POINTS = 65_536
BEST = "best"


@declared
class Request(Declared, title="an export"):
    """The options of an export beside the motion; each format takes some of them."""

    name: str = entry(Text(), "Name of the variable, the table or the joint.", default="Cam")
    points: int | str | None = entry(
        Either(Whole(2, MOST_POINTS), Choice(BEST), which=lambda value: int(isinstance(value, str))),
        'How many points or segments, or "best", the fewest points whose run is as good as that of any number; what '
        "the format takes unless given.",
        default=None,
        example=361,
    )
    counts: int | None = entry(
        Whole(2), "Steps of the slave's encoder over the stroke, to which positions are rounded.", default=None
    )
    digits: int | None = entry(Whole(most=17), "Digits behind the decimal sign, of tables as text.", default=None)
    decimal: str = entry(Text(), 'The decimal sign of tables as text: "." or ",".', default=".")
    interpolation: str | None = entry(
        Text(), "Interpolation of the controller, where the format states it.", default=None
    )

    def _check(self) -> None:
        if self.decimal not in {".", ","}:
            raise InputError(f"decimal must be '.' or ',', got {shortened(self.decimal)}")

    def interpolation_among(self, known: Collection[str], default: str = "cubic") -> str:
        """The interpolation, which must be among the target's interpolations."""
        interpolation = self.interpolation or default
        if interpolation not in known:
            raise InputError(f"interpolation must be one of {', '.join(known)}, got {interpolation!r}")
        return interpolation


@dataclass(frozen=True)
class Written:
    """The file of an export, and the motion that a controller executes from it.

    Parameters
    ----------
    text
        The file.
    run
        What the controller makes of it, over the motion's whole master.
    model
        How it interpolates, in words.
    points
        How many points (or segments, where `counted` says so).
    counted
        "points" or "segments".
    resolution
        Step to which positions are rounded, in units of the slave; 0 for the rounding of double precision.
    bound
        What rounding adds at most to the peak of the acceleration, in units of the slave by the master's squared.
    notes
        What else there is to say.
    roundings
        Jumps of velocity, acceleration and jerk by the master up to which they are roundings of the numbers that the
        target holds, where these are not doubles.
    """

    text: str
    run: PiecewiseMotion
    model: str
    points: int
    counted: str = "points"
    resolution: float = 0.0
    bound: float = 0.0
    notes: tuple[str, ...] = ()
    roundings: tuple[float, ...] = ()


Writer = Callable[[Motion, Request], Written]


@dataclass(frozen=True)
class Format:
    """A format: its name, who takes it, its fields, its limits, the ending of its files, and what writes it.

    Parameters
    ----------
    name
        As `--to` takes it.
    target
        Controller and variable or file that takes it.
    contents
        Fields of a row.
    model
        How the target interpolates.
    limits
        What it cannot hold, in words.
    extension
        Of its files.
    write
        Makes the file of a motion and a request.
    takes
        The entries of `Request` that mean something to it, beside the name.
    write_joints
        Makes one file of several motions by their names; None of formats that hold one.
    """

    name: str
    target: str
    contents: str
    model: str
    limits: str
    extension: str
    write: Writer = field(repr=False)
    takes: tuple[str, ...] = ("points",)
    write_joints: Callable[[Mapping[str, Motion], Request], dict[str, Written]] | None = field(default=None, repr=False)

    def request(self, **options: Any) -> Request:
        """The options that are not None, checked against the format's options.

        Raises
        ------
        InputError
            If it is unknown, or means nothing to this format.
        """
        given = {name: value for name, value in options.items() if value is not None}
        with located("export"):
            check_names(given, entries_of(Request), "option")
        for name in given:
            if name not in {"name", *self.takes}:
                raise InputError(f"{self.name} takes no {name}; it takes {', '.join(('name', *self.takes))}")
        return Request(**given)


FORMATS: Registry[Format] = Registry("export format")


def format_of(name: Any) -> Format:
    """The format of a name, which is refused if there is none."""
    if not isinstance(name, str) or name not in FORMATS:
        raise InputError(f"to: {unknown_key(name, sorted(FORMATS), 'format')}")
    return FORMATS[name]


def file_format(name: str, **entries: Any) -> Callable[[Writer], Writer]:
    """A decorator that enters a format under its name, with the function that writes its files and its other fields."""

    def entered(write: Writer) -> Writer:
        FORMATS[name] = Format(name, write=write, **entries)
        return write

    return entered

"""What several commands read: laws by name or file, tables of points, frequencies, limits, axes of problem files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter, Token

from optlaws.cli.options import options
from optlaws.echo import shortened
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle


def _dimensionless(_: object, tokens: Sequence[Token]) -> float:
    """A frequency without dimension, which people give in Hz."""
    try:
        return float(tokens[0].value)
    except ValueError:
        raise ValueError(
            f"{shortened(tokens[0].value)} is no number without a unit: the frequency nu is in radians in the rise; "
            "one in Hz is --natural-frequency, with --duration or --speed"
        ) from None


FollowerFrequency = Annotated[float, Parameter(converter=_dimensionless)]


def numbers_in(text: str, expected: str) -> list[float]:
    """The numbers of a text, separated by blanks or commas."""
    try:
        return [float(number) for number in text.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"{expected}, got {shortened(text)}: {error}") from None


def one_or_two(values: list[Any]) -> Any:
    """A frequency that is given once, or the least and the greatest."""
    if len(values) > 2:
        raise InputError(f"--frequency is given once, or twice for the least and the greatest, got {len(values)} times")
    return values[0] if len(values) == 1 else tuple(values)


#: of the columns of a table, by headings or numbers, as 1,3
COLUMNS: dict[str, Any] = {"type": str, "read": lambda text: text.split(",")}
#: how a table of points is read
TABLE = options("optlaws.laws.catalogue.reading:read_law", "tolerance", columns=COLUMNS)


def _limits(texts: list[str]) -> dict[str, Any]:
    """Limits by name from texts such as "velocity=1 m/s"; a comma separates a least and a greatest value."""
    limits: dict[str, Any] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or name in limits:
            what = "is given twice" if name in limits else 'is a name = a quantity, such as "velocity=1 m/s"'
            raise InputError(f"--limit {shortened(text)}: a limit {what}")
        parts = [part.strip() for part in value.split(",")]
        limits[name] = parts[0] if len(parts) == 1 else parts
    return limits


#: of limits, each of which is an option of its own
LIMITS: dict[str, Any] = {
    "name": "--limit",
    "type": list[str],
    "read": _limits,
    "signed": True,
    "about": 'Limit of the velocity, acceleration, deceleration, jerk or snap, such as "velocity=1 m/s", or of the '
    'least and the greatest: "acceleration=-8 m/s^2, 12 m/s^2"; may be repeated.',
}


def named(text: str, alpha: float | None, B: float | None, by: str) -> str:
    """The name of a member, where a family I to IV has its alpha or its B beside it, by options; any other as it is.

    >>> named("iii", 7.2, None, "--alpha")
    'III(7.2)'
    """
    from optlaws.laws.catalogue import reading
    from optlaws.laws.savin import SavinFamily

    family = reading.family_of(text)
    if (family is None) != (alpha is None and B is None):
        if family is None:
            raise InputError(
                f"{by} choose a member of a family I, II, III or IV, and no other takes it, got {shortened(text)}"
            )
        low, high = map(float, SavinFamily.of(family).range)
        raise InputError(f"laws of family {family} need {by}: alpha is from {low:.9g} to {high:.9g}")
    if alpha is not None and B is not None:
        raise InputError(f"a member has one of {by}, got alpha and B")
    return text if family is None else f"{family}({f'B={B!r}' if alpha is None else repr(alpha)})"


def read_axes(file: Path, axis: str | None, *jobs: str) -> dict[str, Cycle]:
    """The axes of a problem file of the job "cycle" by their names, or one; with the job "cam" a cam's follower too."""
    from optlaws.echo import unknown_key
    from optlaws.jobs import cam, cycle_entries
    from optlaws.jobs.job import problem_of_job

    source, entries = problem_of_job(file, "cycle", *jobs)
    cycles = cam.motion_of(entries, source) if entries.get("job") == "cam" else cycle_entries.read(entries, source)[1]
    if axis is not None and axis not in cycles:
        raise InputError(f"--axis: {source}: {unknown_key(axis, list(cycles), 'axis')}")
    return dict(cycles) if axis is None else {axis: cycles[axis]}

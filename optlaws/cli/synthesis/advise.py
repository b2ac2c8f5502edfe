"""The command `optlaws advise`: the law to choose for a move or the axes of a cycle, with its gain and its cost."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Duration, Signed, Whole, check_files, save, save_picture
from optlaws.cli.show import busy, number, print_json, show, table
from optlaws.cli.timed_move import read_limits
from optlaws.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from optlaws.cycles.advising.advice import Advice

_INTERVAL = 2


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class SingleMoveOptions:
    """A single move from rest to rest, in place of a file.

    Parameters
    ----------
    stroke
        Such as 35mm or 45deg.
    duration
        Such as 0.1s.
    mass
        What the move accelerates, such as 2kg, or "0.05 kg m^2" of an angle: forces, power and energy are listed.
    """

    stroke: Signed = None
    duration: Duration = None
    mass: Signed = None


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class AdviceOptions:
    """The measures that laws are compared by, and the laws.

    Parameters
    ----------
    minimise
        What is to be least: acceleration, jerk, "rms acceleration", "rms torque", "residual acceleration"; what the
        file says unless given, of a single move the acceleration.
    limits
        Such as "velocity=616 mm/s" or "residual acceleration=2 m/s^2"; may be repeated.
    frequency
        Natural frequency of an elastic follower such as 30Hz, or twice for the least and the greatest.
    damping
        Its damping ratio.
    laws
        A law of the catalogue to compare, in place of the five usual ones; may be repeated. Others are compared with
        the first.
    degree
        Of the optimal laws' Z; that of the file unless given, of a single move 21.
    points
        Of the front between what is minimised and what decides between equally good laws; 0 for none.
    """

    minimise: str | None = None
    limits: Annotated[list[str] | None, Parameter(name="--limit", allow_leading_hyphen=True)] = None
    frequency: list[str] | None = None
    damping: float = 0.0
    laws: Annotated[list[str] | None, Parameter(name="--law")] = None
    degree: Whole | None = None
    points: Whole = 7


NO_MOVE, AS_USUAL = SingleMoveOptions(), AdviceOptions()


def advise(
    file: Path | None = None,
    /,
    *,
    axis: str | None = None,
    move: SingleMoveOptions = NO_MOVE,
    options: AdviceOptions = AS_USUAL,
    plot: Path | None = None,
    as_json: AsJson = False,
    output: Path | None = None,
) -> None:
    """Recommend a law: standard and optimal laws side by side, the cost of each, and the proven bounds.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press; in its
        place --stroke and --duration.
    axis
        The axis of the file; all of them unless given.
    move
        A single move.
    options
        What laws are compared by.
    plot
        Draw what is minimised over what decides, with the front, into this file, PNG or SVG; of one axis.
    as_json
        Print one JSON object on stdout and nothing else.
    output
        Write the proofs of all optimal laws to this JSON file, which `optlaws verify` checks.
    """
    check_files(output, plot=plot)
    with busy("laws are compared"):
        advice = _of_move(move, options) if file is None else _of_file(file, axis, move, options)
    if plot is not None:
        save_picture(plot, _only(advice))
    if output is not None:
        proofs = {name: each.proofs() for name, each in advice.items()}
        save(output, {"axes": proofs} if file is not None else {"move": proofs[""]})
    if as_json:
        brief = {name: _without_solutions(each.report()) for name, each in advice.items()}
        print_json(brief if file is not None else brief[""])
        return
    for name, each in advice.items():
        show(*([f"axis {name}"] if name and len(advice) > 1 else []), *_page(each))


def _of_move(move: SingleMoveOptions, options: AdviceOptions) -> dict[str, Advice]:
    if move.stroke is None or move.duration is None:
        raise InputError("give a problem file, or --stroke such as 35mm and --duration such as 0.1s")
    drive = None
    if move.mass is not None:
        from optlaws.motion.quantities import either

        dimension, _ = either(move.stroke, ("length", "angle"), "--stroke")
        drive = {"mass" if dimension == "length" else "inertia": move.mass}
    return {"": optlaws.advise(optlaws.Rise(move.stroke, move.duration), drive=drive, **_entries(options))}


def _of_file(file: Path, axis: str | None, move: SingleMoveOptions, options: AdviceOptions) -> dict[str, Advice]:
    from optlaws.errors import located
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs.cycle_entries import read
    from optlaws.suggest import unknown_key

    if move != NO_MOVE:
        raise InputError("--stroke, --duration and --mass are of a single move: a file has its own")
    source, _, entries = problem_of_job(file, "cycle")
    _, cycles = read(entries, source)
    if axis is not None and axis not in cycles:
        raise InputError(f"{source}: {unknown_key(axis, list(cycles), 'axis')}")
    advice = {}
    for name in cycles if axis is None else (axis,):
        with located(f"{source}: axis {name}"):
            advice[name] = optlaws.advise(cycles[name], **_entries(options))
    return advice


def _entries(options: AdviceOptions) -> dict[str, Any]:
    """The options as the library takes them."""
    if options.frequency is not None and len(options.frequency) > _INTERVAL:
        raise InputError("--frequency is given once, or twice for the least and the greatest")
    follower = None
    if options.frequency is not None:
        pair = options.frequency if len(options.frequency) == _INTERVAL else options.frequency * _INTERVAL
        follower = {"frequency": tuple(pair), "damping": options.damping}
    given = {} if options.laws is None else {"laws": options.laws}
    return {
        "minimise": options.minimise,
        "limits": read_limits(options.limits or []),
        "follower": follower,
        "degree": options.degree,
        "points": options.points,
        **given,
    }


def _only(advice: dict[str, Advice]) -> Advice:
    if len(advice) > 1:
        raise InputError(f"--plot draws one axis: choose it by --axis, of {', '.join(advice)}")
    return next(iter(advice.values()))


def _without_solutions(data: dict[str, Any]) -> dict[str, Any]:
    """The advice without whole solutions, which --output writes."""
    rows = {
        name: [{key: value for key, value in law.items() if key != "solutions"} for law in data[name]]
        for name in ("laws", "front")
    }
    return {**data, **rows}


def _page(advice: Advice) -> Iterable[Any]:
    """The table of the laws, the reasons for missing ones, and the recommendation."""
    sizes = {measure.name: max(abs(law.values[measure.name]) for law in advice) for measure in advice.measures}
    rows = []
    for law, row in zip(advice, advice.rows, strict=True):
        cells = [number(law.values[name], size, ".5g") for name, size in sizes.items()]
        mark = "> " if law.name == advice.recommendation.law.name else "  "
        rows.append([f"{mark}{law.name}", *cells, str(row[-2]), str(row[-1])])
    yield table("  law", *advice.headings[1:], rows=rows)
    yield from advice.remarks
    yield ""
    yield from advice.recommendation.sentences
    yield f"(Rule: {advice.recommendation.rule}.)"

"""The command `optlaws advise`: the law to choose for a move or the axes of a cycle, with its gain and its cost."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import optlaws
from optlaws.cli.law_options import LIMITS
from optlaws.cli.options import AsJson, Plot, Signed, Written, given, options, save, save_picture, takes
from optlaws.cli.show import busy, number, print_json, show, table
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.errors import InputError
from optlaws.motion.motion import motion_of_law

if TYPE_CHECKING:
    from collections.abc import Iterable

    from optlaws.cycles.advising.advice import Advice


def _interval(texts: list[str]) -> tuple[str, str]:
    """The least and the greatest of a frequency that is given once, or twice."""
    if len(texts) > 2:
        raise InputError("--frequency is given once, or twice for the least and the greatest")
    return texts[0], texts[-1]


_FOLLOWER: dict[str, Any] = {
    "name": "--frequency",
    "type": list[str],
    "read": _interval,
    "about": "Natural frequency of an elastic follower such as 30Hz, or twice for the least and the greatest.",
}


@takes(
    move=options(motion_of_law, "stroke", "duration", group="A single move in place of a file"),
    wishes=options(
        optlaws.advise,
        "minimise",
        "degree",
        "points",
        limits=LIMITS,
        laws={"name": "--law", "type": list[str], "default": None},
        follower=_FOLLOWER,
    ),
    damper=options(ElasticFollower, "damping"),
)
def advise(
    file: Path | None = None,
    /,
    *,
    axis: str | None = None,
    move: Mapping[str, str | None],
    mass: Signed = None,
    wishes: dict[str, Any],
    damper: Mapping[str, float],
    plot: Plot = None,
    as_json: AsJson = False,
    output: Written = None,
) -> None:
    """Recommend a law: standard and optimal laws side by side, the cost of each, and the proven bounds.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press; in its
        place --stroke and --duration.
    axis
        The axis of the file; all of them unless given.
    mass
        What a single move accelerates, such as 2kg, or "0.05 kg m^2" of an angle: forces, power and energy are listed.
    plot
        Draw what is minimised over what decides, with the front, into this file, PNG or SVG; of one axis.
    output
        Write the proofs of all optimal laws to this JSON file, which `optlaws verify` checks.
    """
    if wishes["follower"] is not None:
        wishes["follower"] = {"frequency": wishes["follower"], **damper}
    if file is not None and given({**move, "mass": mass}):
        raise InputError("--stroke, --duration and --mass are of a single move: a file has its own")
    wishes = given(wishes)
    with busy("laws are compared"):
        advice = _of_move(**move, mass=mass, wishes=wishes) if file is None else _of_file(file, axis, wishes)
    if len(advice) > 1 and plot is not None:
        raise InputError(f"--plot draws one axis: choose it by --axis, of {', '.join(advice)}")
    save_picture(plot, next(iter(advice.values())))
    if output is not None:
        proofs = {name: each.proofs() for name, each in advice.items()}
        save(output, {"axes": proofs} if file is not None else {"move": proofs[""]})
    if as_json:
        brief = {name: each.report() for name, each in advice.items()}
        for law in (law for data in brief.values() for law in (*data["laws"], *data["front"])):
            law.pop("solutions", None)  # which --output writes
        print_json(brief if file is not None else brief[""])
        return
    for name, each in advice.items():
        show(*([f"axis {name}"] if name and len(advice) > 1 else []), *_page(each))


def _of_move(
    stroke: str | None, duration: str | None, mass: str | None, wishes: Mapping[str, Any]
) -> dict[str, Advice]:
    if stroke is None or duration is None:
        raise InputError("give a problem file, or --stroke such as 35mm and --duration such as 0.1s")
    from optlaws.motion.quantities import either, quantity

    dimension, _ = either(stroke, ("length", "angle"), "--stroke")
    quantity(duration, "time", "--duration")
    drive = None if mass is None else {"mass" if dimension == "length" else "inertia": mass}
    return {"": optlaws.advise(optlaws.Rise(stroke, duration), drive=drive, **wishes)}


def _of_file(file: Path, axis: str | None, wishes: Mapping[str, Any]) -> dict[str, Advice]:
    from optlaws.errors import located
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs.cycle_entries import read
    from optlaws.suggest import unknown_key

    source, _, entries = problem_of_job(file, "cycle")
    _, cycles = read(entries, source)
    if axis is not None and axis not in cycles:
        raise InputError(f"{source}: {unknown_key(axis, list(cycles), 'axis')}")
    advice = {}
    for name in cycles if axis is None else (axis,):
        with located(f"{source}: axis {name}"):
            advice[name] = optlaws.advise(cycles[name], **wishes)
    return advice


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

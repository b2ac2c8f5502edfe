"""The command `optlaws cycle`: whole cycles of a machine from problem files, and from the tables of old cams."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.app import NotProven
from optlaws.cli.law_options import COLUMNS
from optlaws.cli.options import Signed, Written, given, options, takes
from optlaws.cli.show import Answer, busy
from optlaws.cli.synthesis.run import check_folder, written
from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.sentences import joined, sentence
from optlaws.synthesis.status import Status

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.cycles.old_tables.table import OldTable
    from optlaws.results import Results

_GROUP = "The table of an old cam"
_SEGMENTS = "the cycle, whose segments are the stretches of the table"
_HOW = options(
    "optlaws.cycles.old_tables.splitting:read_cycle_table",
    *("unit", "master", "cam", "turn", "advance", "rows", "lobes", "begin", "tolerance"),
    group=_GROUP,
    columns=COLUMNS,
)


@takes(
    "Draw all axes, the points and laws of an old cam, or with `--fastest` the motion at that speed, into this file, "
    "PNG or SVG.",
    how=_HOW,
)
def cycle(
    file: Path,
    /,
    *,
    out: Path | None = None,
    fastest: bool = False,
    how: Mapping[str, Any],
    speed: Annotated[Signed, Parameter(group=_GROUP)] = None,
    modernise: Annotated[Signed, Parameter(group=_GROUP)] = None,
    export: Annotated[str | None, Parameter(group=_GROUP)] = None,
    save: Annotated[Written, Parameter(group=_GROUP)] = None,
    plot: Path | None,
) -> Answer:
    """Whole cycles of a machine in physical units, optimal as a whole; or the table of an old cam, and a better one.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press; or the
        table of an old cam: columns of text, or a file of a controller.
    out
        Folder for the table, the pictures and the laws; results/NAME where you are unless given. Of an old cam for the
        file of --export; otherwise where you are.
    fastest
        The greatest speed of the master at which every axis keeps its limits, what binds there, and the proof: a table,
        and with `--out` all results at that speed with fastest.json for `optlaws verify`. The exit code is 1 where a
        greater speed is not proven to be impossible.
    speed
        Speed of the master, such as "200 rpm"; what the file says unless given. --save and --export need it where the
        master is an angle.
    modernise
        How far better laws may be off the old ones, such as 0.05mm: the laws of least acceleration within it.
    export
        A format of `optlaws export --list`: the cycle is written in it, modernised where --modernise is given.
    save
        Write the cycle as a problem file (.toml), which contains its laws, and beside it the proofs of better ones
        (.json), which `optlaws verify` takes.
    """
    cam: dict[str, Any] = {"speed": speed, "modernise": modernise, "export": export, "save": save}
    if file.suffix and file.suffix.lower() != ".toml":
        if fastest:
            raise InputError(
                "--fastest needs a problem file: --save writes one from the table, in which you enter the limits"
            )
        return _old_cam(file, how, cam, out=out, plot=plot)
    typed = {name: value for name, value in how.items() if value != _HOW[name].default}
    for name, value in given({**typed, **cam}).items():
        raise InputError(f"--{name} is of the table of an old cam, got {shortened(value)} with a problem file")
    if fastest:
        return _greatest_speed(file, out)
    return _job(file, out)


def _greatest_speed(file: Path, out: Path | None) -> Answer:
    """The greatest speed of each axis of a problem file."""
    from optlaws.jobs import cycle as job
    from optlaws.jobs.cycle_entries import read
    from optlaws.jobs.job import problem_of_job
    from optlaws.plots.cycle import draw_axes, draw_cycle
    from optlaws.plots.style import figure_of
    from optlaws.results import Results

    source, entries = problem_of_job(file, "cycle")
    spec, cycles = read(entries, source)
    speeds = job.fastest_of(cycles, source)
    if out is not None:
        results = Results(source)
        results.entries["fastest"] = True
        job.run(results)
        results.write(out)
    at_best = {name: speed.cycle for name, speed in speeds.items()}
    unproven = [name for name, speed in speeds.items() if speed.status != Status.OPTIMAL]
    return Answer(
        lambda: (
            [part for name, each in speeds.items() for part in (f"axis {name}", each.summary())] + job.slowest(speeds)
        ),
        lambda: {name: speed.report().data for name, speed in speeds.items()},
        lambda: figure_of(draw_axes(at_best) if len(at_best) > 1 else draw_cycle(*at_best.values()), spec.title),
        NotProven(f"axis {', '.join(unproven)}: no proof that no law is faster was found") if unproven else None,
    )


def _job(file: Path, out: Path | None) -> Answer:
    """The job of a problem file, with its main picture in the file of --plot too; or its data for programs."""
    from optlaws.jobs import job
    from optlaws.jobs.cycle import TOGETHER, answer
    from optlaws.jobs.job import problem_of_job
    from optlaws.jobs.job_entries import plain_name

    source, entries = problem_of_job(file, "cycle")

    @cache
    def results() -> Results:
        with busy(f"optlaws: {file}"):
            return job.done(source)

    def drawn() -> Figure:
        """The most informative picture: of the single axis, or of all axes."""
        names = [plain_name(axis["name"]) for axis in entries["axis"]]
        return results().figure(names[0] if len(names) == 1 else TOGETHER)

    def shown() -> Iterator[str]:
        check_folder(source, out)
        yield from written(results(), out)

    return Answer(shown, partial(answer, entries, source), drawn)


def _old_cam(
    file: Path, how: Mapping[str, Any], cam: Mapping[str, Any], *, out: Path | None, plot: Path | None
) -> Answer:
    """Answer for the table of an old cam, read `how` the options say, with a better one and files as `cam` says."""
    from optlaws.cycles.old_tables.report import OldTableReport
    from optlaws.exports.format import format_of
    from optlaws.motion.quantities import quantity

    speed, export, save = cam["speed"], cam["export"], cam["save"]
    if speed is not None:
        quantity(speed, ("angular velocity", "velocity"), "--speed", above=0.0)
    if save is not None and save.suffix != ".toml":
        raise InputError(f"--save takes a problem file, whose name ends in .toml, got {save}")
    chosen = None if export is None else format_of(export)
    old = optlaws.read_cycle_table(file, **how)
    new = None if cam["modernise"] is None else old.bettered(_tolerance(cam["modernise"], old))
    latest, report = new or old, OldTableReport(old, new)
    as_before = new is not None and all(part.solution is None and part.corner is None for part in new.moves)
    if as_before and (save or chosen):
        reasons = joined("; ", report.unchanged)
        raise InfeasibleProblem(sentence("no file is written, because no move has a better law: {}", reasons))
    files, lines = dict[str, str](), list[str]()
    if save is not None:
        files |= _saved(latest, save, file, speed)
    if chosen is not None:
        with located(_SEGMENTS):
            exported = latest.cycle(speed=speed).export(chosen.name)
        place = (out or Path()) / f"{file.stem}_{chosen.name}{chosen.extension}"
        files["exported"] = str(exported.write(place))
        lines.append(str(exported))
    if plot is not None:
        files["picture"] = str(plot)
    lines += [f"{what}: {place}" for what, place in files.items()]
    return Answer(
        lambda: [report, *lines], lambda: {"file": str(file), **report.data, **files}, lambda: old.plot(new=new)
    )


def _tolerance(text: str, old: OldTable) -> float:
    """A tolerance in units of the table."""
    from optlaws.motion.quantities import either, quantity

    dimension, size = either(f"1 {old.unit}", ("length", "angle"), "unit")
    off = quantity(text, dimension, "--modernise")
    if off <= 0.0:
        such = "0.05mm" if dimension == "length" else "0.05deg"
        raise InputError(
            f"--modernise must be above 0, got {shortened(text)}: give how far better laws may be off the old ones, to "
            f"either side, such as {such}"
        )
    return off / size


def _saved(latest: OldTable, place: Path, source: Path, speed: str | None) -> dict[str, str]:
    """The problem file of a cycle, with the text of laws that have no name; and the proofs of better ones."""
    from optlaws.files.writing import MARK, write
    from optlaws.studies.problem_entries import steady

    with located(_SEGMENTS):
        cycle = latest.cycle(speed=speed)
        cycle.solve()  # as a whole, before a file is written
        text = cycle.to_toml(f"The cam of {source.name}", axis="cam")
    files = {"saved": str(write(place, f"# from {source.name}; {MARK}\n{text}"))}
    solutions = [part.solution.to_dict() for part in latest.moves if part.solution is not None]
    if solutions:
        proofs = json.dumps(steady({"about": f"{MARK}, of the laws in {place.name}", "solutions": solutions}), indent=1)
        files["proofs"] = str(write(place.with_suffix(".json"), f"{proofs}\n"))
    return files

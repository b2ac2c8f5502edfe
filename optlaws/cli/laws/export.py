"""The command `optlaws export`: a law or a cycle in a controller's format, and the executed motion."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from optlaws.cli.law_options import TABLE, read_axes
from optlaws.cli.options import Written, given, options, takes
from optlaws.cli.show import Answer, exported
from optlaws.errors import InputError
from optlaws.exports.format import BEST, Request

if TYPE_CHECKING:
    from optlaws.motion.motion import Motion


def _points(text: str) -> int | str:
    try:
        return text if text == BEST else int(text)
    except ValueError:
        raise InputError(f"--points takes a whole number or {BEST}, got {text}") from None


@takes(
    "Draw the motion and what the controller runs into this file, PNG or SVG.",
    move=options(
        "optlaws.motion.motion:motion_of_law",
        *("stroke", "duration", "master", "start"),
        group="The motion of a law",
    ),
    form=options(
        Request,
        *("counts", "digits", "interpolation"),
        name={"default": None},
        points={"type": str, "read": _points},
        decimal={"default": None},
    ),
    points=TABLE,
)
def export(
    law: str | None = None,
    /,
    *,
    to: str | None = None,
    listed: Annotated[bool, Parameter(name="--list")] = False,
    move: Mapping[str, Any],
    axis: str | None = None,
    form: Mapping[str, Any],
    task: str | None = None,
    points: Mapping[str, Any],
    output: Written = None,
) -> Answer:
    """Write a law or a cycle in the format of a controller, and report the motion that the controller executes.

    The file goes to --output or, without it, to stdout and the report to stderr.

    Parameters
    ----------
    law
        A law by its name or file, or a problem file of the job "cycle" (.toml).
    to
        The format; --list shows all formats, and with --to what one of them holds.
    listed
        List the formats with their controllers, interpolations and restrictions.
    axis
        Which axis of a problem file with several.
    task
        Time of the drive's task, such as "1 ms": the report gives what the drive reads in each.
    output
        The file to write.
    """
    if listed:
        return _formats(to)
    if law is None or to is None:
        raise InputError("say what is exported and to which format: optlaws export LAW --to FORMAT; --list lists them")
    from optlaws.exports.export import export_motion
    from optlaws.exports.format import format_of

    format_of(to).request(**form)
    written = export_motion(_motion(law, axis, move, points), to, task=task, **form)
    return exported(written, output, written.plot)


def _motion(law: str, axis: str | None, move: Mapping[str, Any], points: Mapping[str, Any]) -> Motion:
    from optlaws.files.packaged import is_problem
    from optlaws.laws.catalogue.reading import read_law
    from optlaws.motion.motion import motion_of_law

    if not is_problem(law):
        if axis is not None:
            raise InputError("--axis is one of a problem file with several; a law has none")
        return motion_of_law(read_law(law, **points), **move)
    for option in given({**move, **points, "master": None}):
        raise InputError(f"--{option} applies to a single law: a cycle has its own")
    cycles = read_axes(Path(law), axis)
    if len(cycles) > 1:
        raise InputError(f"{law} has several axes, say which by --axis: {', '.join(cycles)}")
    (cycle,) = cycles.values()
    return cycle.motion(**given({"master": move["master"]}))


def _formats(to: str | None) -> Answer:
    from optlaws.exports.format import FORMATS, format_of
    from optlaws.shown.report import ReportTable
    from optlaws.shown.summary import Row, Summary

    formats = [FORMATS[name] for name in sorted(FORMATS)] if to is None else [format_of(to)]
    keys = ("name", "target", "contents", "model", "limits", "extension", "takes")
    facts = (("target", "target"), ("holds", "contents"), ("runs", "model"), ("limits", "limits"))
    return Answer(
        lambda: [
            ReportTable(["format", "target"], [[form.name, form.target] for form in formats])
            if to is None
            else Summary([Row(name, getattr(formats[0], key)) for name, key in facts])
        ],
        lambda: [{key: getattr(form, key) for key in keys} for form in formats],
    )

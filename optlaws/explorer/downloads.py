"""Files that the page offers of what it shows: as Python, as a problem file, as laws and tables, for a controller."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from mimetypes import guess_type
from pathlib import Path
from pprint import pformat
from typing import Annotated, Any

import msgspec

import optlaws
from optlaws import MotionLaw, Solution
from optlaws.cams.curves import cam_files
from optlaws.cams.curves.cam_files import Cutting
from optlaws.cycles.answers import Answers
from optlaws.cycles.report import CycleReport
from optlaws.errors import InputError
from optlaws.explorer.views import advice_view, axes_view, cam_view, cycle_view, fastest_view, old_cam_view
from optlaws.explorer.views.cycle_view import CycleRequest
from optlaws.explorer.views.law_view import digits, title, titled
from optlaws.explorer.views.requests import LawRequest, LawsRequest, Text, law_of, problem_of, read, result_of
from optlaws.files.reading import check_names
from optlaws.files.tables import to_csv, to_toml
from optlaws.files.writing import MARK
from optlaws.jobs.cycle_entries import cycle_of
from optlaws.laws.report import table_of_values

_ROWS = 361
_WIDTH = 116
_MOST_POINTS = 10_000
_PUBLIC = frozenset(vars(optlaws)["__all__"])

File = tuple[str, str]  #: its name and its text
#: of a view its files by their kinds, and the result of which they are
ViewFiles = tuple[Mapping[str, Callable[[Any], File]], Callable[[Any], Any]]


class FileRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A file of a kind, of the request of a view; of a report the name and the notes of the document.

    For a controller, a law has the machine that it moves.
    """

    kind: Text
    view: Text
    request: msgspec.Raw
    name: Annotated[str, msgspec.Meta(max_length=80)] = ""
    notes: Annotated[str, msgspec.Meta(max_length=20_000)] = ""
    stroke: Text = "35 mm"
    time: Text = "0.1 s"
    master: Text = "120 deg"
    points: Annotated[int, msgspec.Meta(ge=2, le=_MOST_POINTS)] | None = None
    counts: Annotated[int, msgspec.Meta(ge=2, le=2**53)] | None = None


def answer(question: FileRequest) -> dict[str, str]:
    """A file: its name, its type, its text."""
    (kinds, result), request = _read(question)
    check_names([question.kind], {*kinds, "report"}, f"file of the view {question.view}")
    if question.kind == "report":
        from optlaws.plots.report import printable_page  # matplotlib costs a start that other questions do without

        of = titled(request.law) if isinstance(request, LawsRequest) else request.study.get("title", "A motion")
        name = f"{_stem(question.name or of)}.html"
        text = printable_page(
            question.name or of, result(request).report(), f"optlaws {optlaws.__version__}\n{question.notes}"
        )
    else:
        name, text = kinds[question.kind](request)
    return {"name": name, "type": guess_type(name)[0] or "text/plain", "text": text}


def _read(question: FileRequest) -> tuple[ViewFiles, Any]:
    check_names([question.view], VIEWS, "view")
    return VIEWS[question.view], read(bytes(question.request), LawsRequest if question.view == "laws" else CycleRequest)


def _stem(name: str) -> str:
    """A file's name of a title: no folder, no line break."""
    return "_".join(re.findall(r"[^\W_]+[\w.]*", name))[:60].strip("._") or "law"


def _json(name: str, **entries: Any) -> File:
    return f"{_stem(name)}.json", json.dumps({"about": MARK, **entries}, indent=1) + "\n"


def _study(name: str) -> Callable[[Any], File]:
    """The request of a view as a problem file."""
    return lambda request: (name, to_toml(request.study))


def _laws_python(request: LawsRequest) -> File:
    """Python lines that compute the same laws with the same digits, and draw them."""
    named = {name: law for name, law in zip("abcd", request.laws, strict=False) if law.problem or law.law}
    given = [name if name in named else repr(law.name) for name, law in zip("abcd", request.laws, strict=False)]
    lines = [
        *(f"{name} = {_law_source(law)}" for name, law in named.items()),
        f"comparison = compare_laws({', '.join(given)})",
        "for row in comparison.rows:",
        "    print(row)",
        'comparison.plot()[0].figure.savefig("laws.png")',
    ]
    return _python("study", lines)


def _law_source(law: LawRequest) -> str:
    """A law as Python; a problem as it shows itself where that is made of public names, else from its entries."""
    if law.problem is None:
        return _source(law_of(law))
    problem = problem_of(law)
    try:
        known = _names(repr(problem)) <= _PUBLIC
    except SyntaxError:
        known = False
    return f"synthesize({problem!r})" if known else f"synthesize(Problem.from_dict({problem.to_dict()!r}))"


def _names(text: str) -> set[str]:
    return {node.id for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name)}


def _python(name: str, lines: list[str]) -> File:
    """Lines below the import of the public names in them."""
    body = "\n".join(lines)
    return f"{name}.py", f"from optlaws import {', '.join(sorted(_names(body) & _PUBLIC))}\n\n{body}\n"


def _source(value: Any) -> str:
    """A value as Python that reads it from its plain data."""
    kind = "MotionLaw" if isinstance(value, MotionLaw) else type(value).__name__
    return f"{kind}.from_dict({pformat(value.to_dict(), width=_WIDTH, sort_dicts=False)})"


def _law_problem(request: LawsRequest) -> File:
    """The problem as a file for `optlaws run` and `optlaws explore`."""
    if request.law.problem is None:
        raise InputError("a given law belongs to no problem: save it as a law, or request an optimal law in its place")
    problem = problem_of(request.law)
    entries = problem.to_dict()
    swept = "B" if isinstance(entries.get("B"), float) else "order"
    sweep = [{swept: [entries.pop(swept)]}]
    study = {"job": "solutions", "title": title(problem), "problem": _with_ends(entries), "sweep": sweep}
    return "problem.toml", to_toml(study)


def _with_ends(value: Any) -> Any:
    """A range without an upper end: JSON has no number for it, a file has infinity."""
    if isinstance(value, dict):
        return {name: _with_ends(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [value[0], float("inf")] if len(value) == 2 and value[1] is None else list(map(_with_ends, value))
    return value


def _law_file(request: LawsRequest) -> File:
    """The law as JSON; a solution with its problem and its proof, for `optlaws verify`."""
    name, result = titled(request.law), result_of(request.law)
    if isinstance(result, Solution):
        return _json(name, **result.to_dict())
    return f"{_stem(name)}.json", json.dumps(result.to_dict(), indent=1) + "\n"


def _law_table(request: LawsRequest) -> File:
    name = titled(request.law)
    return f"{_stem(name)}.csv", table_of_values(law_of(request.law), name)


def _cycle_table(request: CycleRequest) -> File:
    spec, axis = cycle_view.read(request)
    about = " ".join(f"{spec.title}: {axis.name}".split())
    return _motion_table(_stem(axis.name), about, cycle_view.cycle(request))


def _motion_table(name: str, about: str, cycle: Answers) -> File:
    text = to_csv(*CycleReport(cycle).motion(_ROWS), about=f"{about}; SI units but for mm and deg")
    return f"{name}.csv", text


def _proofs(*cycles: Answers) -> File:
    return _json("motion", solutions=[solution.to_dict() for cycle in cycles for solution in cycle.solutions])


def _cycle_python(request: CycleRequest) -> File:
    """Python lines that compute the same cycle, or the cycle of the cam whose follower moves so."""
    spec, axis = cycle_view.read(request)
    cycle, follower = cycle_of(replace(axis, follower=None), spec.speed, spec.period), axis.follower
    cam = "" if follower is None else f".cam({follower.period!r}, damping={follower.damping!r})"
    shown = "print(cycle.status.value, cycle.objective, cycle.lower_bound)"
    return _python("cycle", [f"cycle = {_source(cycle)}{cam}", shown, 'cycle.plot()[0].figure.savefig("cycle.png")'])


def _axes_python(request: CycleRequest) -> File:
    """Python lines that make the same axes with their interlocks, and say what is clear."""
    lines = [
        f"axes = {_source(axes_view.axes_of(request.study))}",
        "for least in axes.clearances:",
        "    print(least.interlock.label, least.status, least.clearance)",
        'axes.plot(what="timing")[0].figure.savefig("axes.png")',
    ]
    return _python("axes", lines)


def _cut(form: str, request: CycleRequest) -> File:
    result = cam_view.result_of(request)
    kind = form.partition(" ")[0]
    ending = next(end for end, name in cam_files.ENDINGS.items() if name.partition(" ")[0] == kind)
    return f"cam{ending}", cam_files.FORMATS[form](result.cam.profile, Cutting(about=result.spec.title))


def _cam_table(request: CycleRequest) -> File:
    table = cam_view.values_of(request)
    return "cam.csv", to_csv(table.headings, table.rows, about=cam_view.result_of(request).spec.title)


def _advice_table(request: CycleRequest) -> File:
    table = advice_view.advice_of(request).report().tables[0]
    return "advice.csv", to_csv(table.headings, table.rows, about="Laws for the motion side by side")


def _old_problem(request: CycleRequest) -> File:
    if any(isinstance(part.law, MotionLaw) for part in old_cam_view.with_laws(request).moves):
        raise InputError("a problem file names laws, and some of these have no name: save the cycle with its laws")
    about = f"The cam of {_stem(str(request.study.get('file', 'table')))}"
    return f"{_old_name(request)}.toml", old_cam_view.cycle(request).to_toml(about, axis="cam")


def _old_name(request: CycleRequest) -> str:
    return _stem(Path(str(request.study.get("file", "table"))).stem)


_CYCLE: dict[str, Callable[[Any], File]] = {
    "python": _cycle_python,
    "problem": _study("cycle.toml"),
    "table": _cycle_table,
    "proof": lambda request: _proofs(cycle_view.cycle(request)),
}
_FASTEST: dict[str, Callable[[Any], File]] = {
    "problem": _study("fastest.toml"),
    "proof": lambda request: _json("fastest", **fastest_view.proof_of(request)),
}
_OLD: dict[str, Callable[[Any], File]] = {
    "problem": _old_problem,
    "cycle": lambda request: (f"{_old_name(request)}.json", old_cam_view.cycle(request).to_json()),
    "table": lambda request: _motion_table(
        f"{_old_name(request)}_motion", _old_name(request), old_cam_view.cycle(request)
    ),
    "proof": lambda request: _json("old_cam", solutions=[law for law in old_cam_view.laws_of(request) if law]),
}
#: by the name of a view
VIEWS: dict[str, ViewFiles] = {
    "laws": (
        {"python": _laws_python, "problem": _law_problem, "law": _law_file, "table": _law_table, "proof": _law_file},
        lambda request: result_of(request.law),
    ),
    "cycle": (_CYCLE, cycle_view.cycle),
    "machine": (_CYCLE, cycle_view.cycle),
    "axes": (
        {
            **_CYCLE,
            "python": _axes_python,
            "proof": lambda request: _proofs(*axes_view.axes_of(request.study).values()),
        },
        lambda request: axes_view.axes_of(request.study),
    ),
    "cam": (
        {
            "problem": _study("cam.toml"),
            "table": _cam_table,
            **{form: partial(_cut, form) for form in cam_files.FORMATS},
        },
        lambda request: cam_view.result_of(request).cam,
    ),
    "advice": ({"table": _advice_table}, advice_view.advice_of),
    "fastest": (_FASTEST, fastest_view.fastest_of),
    "old": (_OLD, old_cam_view.cycle),
}
#: by the name of a view what a controller may run: of axes the one on display
MOTIONS: dict[str, Callable[[Any], Callable[..., Any]]] = {
    "laws": lambda request: law_of(request.law).export,
    **dict.fromkeys(("cycle", "machine", "axes"), lambda request: cycle_view.cycle(request).export),
    "fastest": fastest_view.export_of,
    "old": lambda request: old_cam_view.cycle(request).export,
}


def exported(question: FileRequest) -> dict[str, Any]:
    """The file, and the peaks of the motion as the controller interpolates it beside the law's peaks."""
    _, request = _read(question)
    if question.view not in MOTIONS:
        raise InputError(f"the view {question.view} has no motion for a controller")
    given: dict[str, Any] = {"points": question.points, "counts": question.counts}
    if isinstance(request, LawsRequest):
        given |= {"stroke": question.stroke, "duration": question.time, "master": question.master or None}
    export = MOTIONS[question.view](request)(question.kind, **given)
    written = export.written
    return {
        "name": f"Cam{export.format.extension}",
        "type": "text/plain",
        "text": export.text,
        "words": f"{export.format.target}: {written.points} {written.counted}, {written.model}",
        "notes": list(written.notes),
        "rows": [
            [name, *("—" if number is None else digits(number, 6) for number in numbers)]
            for name, *numbers in export.rows()
        ],
    }

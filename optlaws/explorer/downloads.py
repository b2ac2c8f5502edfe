"""Files that the page offers: its state as Python, as a problem file, as laws and tables, for a controller."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from pprint import pformat
from textwrap import indent
from typing import Annotated, Any, Literal

import msgspec

import optlaws
from optlaws import Axes, Cycle, Drive, Mechanism, MotionLaw, Problem, Solution
from optlaws.cams.curves import cam_files
from optlaws.cams.curves.file_options import Cutting
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.errors import InputError
from optlaws.explorer.views import axes_view, cam_view, cycle_view, old_cam_view
from optlaws.explorer.views.law_view import digits, title
from optlaws.explorer.views.machines import fastest_view
from optlaws.explorer.views.requests import MOST_LAWS, LawRequest, Question, law_of, problem_of, solved
from optlaws.exports.format import FORMATS
from optlaws.files.tables import to_toml
from optlaws.files.writing import MARK
from optlaws.jobs.cycle import table_of_motion
from optlaws.jobs.cycle_entries import cycle_of
from optlaws.laws.values import table_of_values
from optlaws.suggest import unknown_key

_NAMES = "abcd"
_ROWS = 361
_WIDTH = 116
_CALLED = re.compile(r"\b([A-Za-z_]\w*)\(")
_PUBLIC = frozenset(vars(optlaws)["__all__"])

#: what the text of a problem is made of, where it is Python
_PLAIN = (
    ast.Expression, ast.Call, ast.keyword, ast.Name, ast.Load, ast.Constant, ast.Tuple, ast.List, ast.Dict,
    ast.UnaryOp, ast.USub,
)  # fmt: skip

File = dict[str, str]


class SeenRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Content of the page: laws, of which one is active, and a cycle."""

    laws: Annotated[list[LawRequest], msgspec.Meta(min_length=1, max_length=MOST_LAWS)]
    active: Annotated[int, msgspec.Meta(ge=0, lt=MOST_LAWS)] = 0
    cycle: cycle_view.CycleRequest | None = None

    @property
    def law(self) -> LawRequest:
        """The law that is active."""
        return self.laws[min(self.active, len(self.laws) - 1)]


class FileRequest(SeenRequest, kw_only=True, forbid_unknown_fields=True):
    """A file of the page's state."""

    kind: Literal["python", "problem", "law", "table", "cut", "proof"]
    view: Literal["laws", "cycle", "axes", "cam", "machine", "fastest", "old"] = "laws"
    axes: cycle_view.CycleRequest | None = None
    old: old_cam_view.OldCycleRequest | None = None
    cam: cam_view.CamRequest | None = None
    machine: cycle_view.CycleRequest | None = None
    fastest: fastest_view.FastestRequest | None = None
    format: Annotated[str, msgspec.Meta(max_length=40)] = "dxf spline"


def answer(request: FileRequest) -> File:
    """A file: its name, its type, its text."""
    if request.kind == "proof":
        return _proof(request)
    if request.view in ("cycle", "axes", "machine"):
        return _of_cycle(request, getattr(request, request.view))
    of_view: Mapping[str, Callable[[FileRequest], File]] = {
        "fastest": _of_fastest, "cam": _of_cam, "old": _of_old_cam,
    }  # fmt: skip
    if request.view in of_view:
        return of_view[request.view](request)
    law = request.law
    makers: Mapping[str, Callable[[], File]] = {
        "python": lambda: _file("study.py", "text/x-python", python(request.laws)),
        "problem": lambda: _file("problem.toml", "application/toml", problem_file(law)),
        "law": lambda: _file(f"{_stem(_title(law))}.json", "application/json", stored(law)),
        "table": lambda: _file(f"{_stem(_title(law))}.csv", "text/csv", table_of_values(law_of(law), _title(law))),
    }
    if request.kind not in makers:
        raise InputError("a law is cut by no tool: make a cam of it")
    return makers[request.kind]()


def _proof(request: FileRequest) -> File:
    """The stored proof of a result: a solution, or the solutions of all segments of a motion.

    Examples
    --------
    >>> law = LawRequest(problem={"order": 3, "degree": 5, "B": 1.8}, weights={"C": 1.0})
    >>> sorted(json.loads(answer(FileRequest(kind="proof", laws=[law]))["text"]))[:3]
    ['about', 'certificate', 'constants']
    """
    if request.fastest is not None and request.view == "fastest":
        stated = {"about": MARK, **fastest_view.proof_of(request.fastest)}
        return _file("fastest.json", "application/json", json.dumps(stated) + "\n")
    if request.old is not None and request.view == "old":
        solutions = [law for law in request.old.laws if law is not None]
        return _file("old_cam.json", "application/json", json.dumps({"about": MARK, "solutions": solutions}) + "\n")
    if request.view not in ("cycle", "axes", "machine"):
        return _file(f"{_stem(_title(request.law))}.json", "application/json", stored(request.law))
    shown: cycle_view.CycleRequest | None = getattr(request, request.view)
    if shown is None:
        raise InputError("there is no motion whose laws could be checked")
    motions = axes_view.axes_of(shown.study).values() if request.view == "axes" else [cycle_view.cycle(shown)]
    solutions = [solution.to_dict() for motion in motions for solution in motion.solutions]
    return _file("motion.json", "application/json", json.dumps({"about": MARK, "solutions": solutions}) + "\n")


def _file(name: str, kind: str, text: str) -> File:
    return {"name": name, "type": kind, "text": text}


def _title(law: LawRequest) -> str:
    if law.problem is None:
        return law.title or law.name or "a stored law"
    return law.title or title(problem_of(law))


def _stem(name: str) -> str:
    """A file's name of a title: no folder, no line break."""
    return "_".join(re.findall(r"[A-Za-z0-9.]+", name))[:60].strip("._") or "law"


def python(laws: list[LawRequest]) -> str:
    """Python lines that compute the same laws with the same digits, and draw them.

    Examples
    --------
    >>> print(python([LawRequest(name="cycloidal")]), end="")
    from optlaws import compare_laws
    <BLANKLINE>
    comparison = compare_laws('cycloidal')
    for row in comparison.rows:
        print(row)
    comparison.plot()[0].figure.savefig("laws.png")
    """
    lines, given = [], []
    for name, law in zip(_NAMES, laws, strict=False):
        text = _expression(law)
        given.append(text if law.name is not None and law.problem is None else name)
        if given[-1] == name:
            lines.append(f"{name} = {text}")
    lines = [
        *lines,
        f"comparison = compare_laws({', '.join(given)})",
        "for row in comparison.rows:",
        "    print(row)",
        'comparison.plot()[0].figure.savefig("laws.png")',
    ]
    return _with_imports(lines)


def _expression(law: LawRequest) -> str:
    if law.problem is not None:
        return f"synthesize({_problem_text(problem_of(law))})"
    if law.law is not None:
        return f"MotionLaw.from_dict({pformat(law.law, width=_WIDTH, sort_dicts=False)})"
    return repr(law.name)


def _problem_text(problem: Problem) -> str:
    """A problem as Python: as it shows itself where that is plain calls and values, else from its entries."""
    text = repr(problem)
    try:
        plain = all(isinstance(node, _PLAIN) for node in ast.walk(ast.parse(text, mode="eval")))
    except SyntaxError:
        plain = False
    known = plain and set(_CALLED.findall(text)) <= _PUBLIC
    return text if known else f"Problem.from_dict({problem.to_dict()!r})"


def _with_imports(lines: list[str]) -> str:
    body = "\n".join(lines)
    names = {name for name in _CALLED.findall(body) if name in _PUBLIC}
    names |= {name for name in ("Drive", "Mechanism", "MotionLaw", "Problem") if f"{name}." in body}
    return f"from optlaws import {', '.join(sorted(names))}\n\n{body}\n"


def problem_file(law: LawRequest) -> str:
    """The problem as a file for `optlaws run` and `optlaws explore`.

    Examples
    --------
    >>> print(problem_file(LawRequest(problem={"order": 4, "B": 1.7, "J": [0, 60]})), end="")
    job = "solutions"
    title = "least C, J ≤ 60, B = 1.7, order 4, degree 9"
    <BLANKLINE>
    [problem]
    minimise = "C"
    order = 4
    basis = "chebyshev"
    degree = 9
    monotone = false
    symmetric = true
    J = [0, 60]
    <BLANKLINE>
    [[sweep]]
    B = [1.7]
    """
    if law.problem is None:
        raise InputError("a given law belongs to no problem: save it as a law, or request an optimal law in its place")
    problem = problem_of(law)
    entries = problem.to_dict()
    swept = "B" if isinstance(entries.get("B"), float) else "order"
    value = entries.pop(swept)
    entries = {name: _bounds(entry) for name, entry in entries.items()}
    return to_toml({"job": "solutions", "title": title(problem), "problem": entries, "sweep": [{swept: [value]}]})


def _bounds(value: Any) -> Any:
    """A range without an upper end: JSON has no number for it, a file has infinity."""
    if isinstance(value, list) and len(value) == 2 and value[1] is None:
        return [value[0], float("inf")]
    if isinstance(value, list):
        return [_bounds(entry) for entry in value]
    return {name: _bounds(entry) for name, entry in value.items()} if isinstance(value, dict) else value


def stored(law: LawRequest) -> str:
    """The law as JSON; a solution with its problem and its proof, for `optlaws verify`."""
    solution = solved(problem_of(law)) if law.problem is not None else None
    data = solution.to_dict() if isinstance(solution, Solution) else law_of(law).to_dict()
    return json.dumps({"about": MARK, **data} if isinstance(solution, Solution) else data, indent=1) + "\n"


def _of_cycle(request: FileRequest, shown: cycle_view.CycleRequest | None) -> File:
    if shown is None:
        raise InputError("there is no cycle to save")
    if request.kind == "problem":
        return _file("cycle.toml", "application/toml", to_toml(shown.study))
    if request.view == "axes" and request.kind == "python":
        return _file("axes.py", "text/x-python", axes_python(axes_view.axes_of(shown.study)))
    spec, axis = cycle_view.read(shown)
    cycle = cycle_view.cycle(shown)
    if request.kind == "table":
        about = " ".join(f"{spec.title}: {axis.name}; SI units but for mm and deg".split())
        return _file(f"{_stem(axis.name)}.csv", "text/csv", table_of_motion(cycle, _ROWS, about))
    if request.kind == "python":
        free = replace(axis, follower=None)
        return _file("cycle.py", "text/x-python", cycle_python(cycle_of(free, spec.speed, spec.period), axis.follower))
    raise InputError("a cycle has several laws: save it as a problem file or a table")


def _of_fastest(request: FileRequest) -> File:
    if request.fastest is None:
        raise InputError("there is no move to save")
    if request.kind == "problem":
        return _file("fastest.toml", "application/toml", to_toml(request.fastest.study))
    if request.kind == "law":
        move = fastest_view.fastest_of(request.fastest)
        return _file("fastest.json", "application/json", json.dumps({"about": MARK, **move.to_dict()}, indent=1) + "\n")
    raise InputError("a least time is saved as a problem file, or as a law with its proof")


def _of_old_cam(request: FileRequest) -> File:
    """The cycle of a table: as a problem file where all its laws have names, as JSON with its laws, or as a table."""
    if request.old is None:
        raise InputError("there is no table to save")
    cycle, name = old_cam_view.cycle(request.old), request.old.study.file
    stem = _stem(name.rpartition(".")[0] or name)
    if request.kind == "problem":
        if any(isinstance(part.law, MotionLaw) for part in old_cam_view.with_laws(request.old).moves):
            raise InputError("a problem file names laws, and some of these have no name: save the cycle with its laws")
        return _file(f"{stem}.toml", "application/toml", cycle.to_toml(f"The cam of {_stem(name)}", axis="cam"))
    if request.kind == "law":
        return _file(f"{stem}.json", "application/json", cycle.to_json())
    if request.kind == "table":
        return _file(
            f"{stem}_motion.csv", "text/csv", table_of_motion(cycle, _ROWS, f"{stem}; SI units but for mm and deg")
        )
    raise InputError("an old cam is saved as a problem file, a cycle or a table")


def _of_cam(request: FileRequest) -> File:
    if request.cam is None:
        raise InputError("there is no cam to save")
    if request.kind == "problem":
        return _file("cam.toml", "application/toml", to_toml(request.cam.study))
    findings = cam_view.findings_of(request.cam)
    if request.kind != "cut":
        raise InputError("a cam is saved as a problem file or as a file that cuts it")
    if request.format not in cam_files.FORMATS:
        raise InputError(f"format: {unknown_key(request.format, cam_files.FORMATS, 'format')}")
    ending = next(end for end, name in cam_files.ENDINGS.items() if name.split()[0] == request.format.split()[0])
    return _file(
        f"cam{ending}",
        "text/plain",
        cam_files.text(findings.cam.profile, request.format, Cutting(about=findings.spec.title)),
    )


def cycle_python(cycle: Cycle, follower: ElasticFollower | None = None) -> str:
    """Python lines that compute the same cycle, or the cycle of the cam whose follower moves so."""
    lines = [
        f"cycle = {_cycle_text(cycle)}"
        + ("" if follower is None else f".cam({follower.period!r}, damping={follower.damping!r})"),
        "print(cycle.status.value, cycle.objective, cycle.lower_bound)",
        'cycle.plot()[0].figure.savefig("cycle.png")',
    ]
    return _with_imports(lines)


def axes_python(axes: Axes) -> str:
    """Lines that make the same axes with their interlocks, and say what is clear.

    Examples
    --------
    >>> from optlaws import Axes, Dwell, Rise
    >>> table = {"segments": [Rise("90 deg", "1 s"), Dwell()], "advance": "90 deg"}
    >>> print(axes_python(Axes({"table": table}, period="2 s")), end="")
    from optlaws import Axes, Cycle, Dwell, Rise
    <BLANKLINE>
    axes = Axes({
        'table': Cycle([
            Rise(by='90 deg', duration='1 s'),
            Dwell(),
        ], period='2 s', minimise='acceleration', advance='90 deg', order=3, degree=9),
    })
    for least in axes.clearances:
        print(least.interlock.label, least.status, least.clearance)
    axes.plot(what="timing")[0].figure.savefig("axes.png")
    """
    cycles = "".join(f"    {name!r}: {indent(_cycle_text(cycle), '    ').lstrip()},\n" for name, cycle in axes.items())
    rules = "".join(f"    {_plainly(rule)},\n" for rule in axes.rules)
    lines = [
        f"axes = Axes({{\n{cycles}}}" + (f", interlocks=[\n{rules}])" if rules else ")"),
        "for least in axes.clearances:",
        "    print(least.interlock.label, least.status, least.clearance)",
        'axes.plot(what="timing")[0].figure.savefig("axes.png")',
    ]
    return _with_imports(lines)


def _cycle_text(cycle: Cycle) -> str:
    """A cycle as Python."""
    entries = {name: getattr(cycle, name) for name in ("speed", "period", "minimise", "limits", "start", "advance")}
    entries |= {"load": cycle.load, "order": cycle.order, "degree": cycle.degree}
    given = "".join(f", {name}={value!r}" for name, value in entries.items() if value not in (None, {}))
    given += "" if cycle.drive is None else f", drive={_drive_text(cycle.drive)}"
    segments = "\n".join(f"    {_plainly(segment)}," for segment in cycle.segments)
    return f"Cycle([\n{segments}\n]{given})"


def _plainly(value: Any) -> str:
    """A segment or an interlock as Python, without what is as it is by default."""
    usual = {each.name: each.default for each in fields(value) if each.init}
    given = {name: getattr(value, name) for name in usual}
    entries = [f"{name}={entry!r}" for name, entry in given.items() if entry != usual[name] and entry not in ({}, None)]
    return f"{type(value).__name__}({', '.join(entries)})"


def _drive_text(drive: Mapping[str, Any] | Mechanism | Drive) -> str:
    """The drive of a cycle as Python text."""
    if isinstance(drive, Mapping):
        return repr(drive)
    return f"{type(drive).__name__}.from_dict({drive.to_dict()!r})"


Text = Annotated[str, msgspec.Meta(max_length=60)]
_MOST_POINTS = 10_000


class ExportRequest(SeenRequest, kw_only=True, forbid_unknown_fields=True):
    """A law or a cycle in a format, with the machine it moves."""

    format: Text
    view: Literal["laws", "cycle", "old"] = "laws"
    old: old_cam_view.OldCycleRequest | None = None
    stroke: Text = "35 mm"
    time: Text = "0.1 s"
    master: Text = "120 deg"
    points: Annotated[int, msgspec.Meta(ge=2, le=_MOST_POINTS)] | None = None
    counts: Annotated[int, msgspec.Meta(ge=2, le=2**53)] | None = None


def formats() -> list[dict[str, Any]]:
    """The export formats, with their controllers and their options."""
    return [
        {"name": name, "target": FORMATS[name].target, "takes": list(FORMATS[name].takes)} for name in sorted(FORMATS)
    ]


def exported(request: ExportRequest) -> dict[str, Any]:
    """The file, and the peaks of the motion as the controller interpolates it beside the law's peaks.

    Examples
    --------
    >>> file = exported(ExportRequest(format="codesys-xyva", laws=[LawRequest(name="cycloidal")], points=9))
    >>> file["name"], file["rows"][1][0]
    ('Cam.st', 'peak of acceleration, mm/s²')
    """
    export = _export(request)
    written = export.written
    return {
        "name": f"Cam{export.format.extension}",
        "type": "text/plain",
        "text": export.text,
        "words": f"{export.format.target}: {written.points} {written.counted}, {written.model}",
        "notes": list(written.notes),
        "rows": [[name, *map(_cell, numbers)] for name, *numbers in export.rows()],
    }


def _export(request: ExportRequest) -> Any:
    given: dict[str, Any] = {"points": request.points, "counts": request.counts}
    if request.view == "cycle":
        if request.cycle is None:
            raise InputError("there is no cycle to export")
        return cycle_view.cycle(request.cycle).export(request.format, **given)
    if request.view == "old":
        if request.old is None:
            raise InputError("there is no table to export")
        return old_cam_view.cycle(request.old).export(request.format, **given)
    given |= {"stroke": request.stroke, "duration": request.time, "master": request.master or None}
    return law_of(request.law).export(request.format, **given)


def _cell(number: float | None) -> str:
    return "—" if number is None else digits(number, 6)


QUESTIONS: dict[str, Question] = {"export": (ExportRequest, exported), "save": (FileRequest, answer)}

"""The explorer's initial state: the given file or problem, in the form in which the page keeps its state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Annotated, Any

import msgspec

from optlaws import Axes, MotionLaw
from optlaws.errors import InputError, located
from optlaws.explorer.views import old_cam_view
from optlaws.explorer.views.requests import MOST_LAWS, LawRequest, problem_of
from optlaws.files import reading
from optlaws.files.packaged import is_problem, problem_file
from optlaws.jobs.cycle_entries import CycleProblemFile, motor_of
from optlaws.jobs.solutions import SolutionsProblemFile, swept_entries
from optlaws.laws.catalogue.reading import is_file, is_table, law_of_points, read_law, with_files
from optlaws.studies.problem_entries import problem

_FIRST = {"order": 4, "degree": 9, "B": 1.7}
#: jobs with a view of their own name
_SHOWN = frozenset({"cam", "fastest"})
#: views of a cycle's file that has an entry
_CYCLES = {"fastest": "fastest", "interlocks": "axes"}


def start(given: str | None, results: str = "") -> dict[str, Any]:
    """The page's first state for a law's name or file, a problem file or a solution; an optimal law unless given.

    `results` is the text of a file that was read already, as `results_of` gives it.
    """
    if given is None:
        return _law({"problem": dict(_FIRST)})
    if is_problem(given):
        file = problem_file(Path(given))
        with located(str(file)):
            data = _with_motors(with_files(reading.toml(file), file.parent))
        return _of_problem_file(data, str(file))
    if not is_file(given):
        read_law(given)
        return _law({"name": given})
    return _of_text(given, results or reading.text(Path(given), legacy=not given.lower().endswith(".json")))


def results_of(given: str | None, text: str | None = None) -> str:
    """The text of a file of results, read unless it is given; empty where what is given is none."""
    if given is None or not given.lower().endswith(".json"):
        return ""
    if text is None:
        return reading.text(Path(given)) if is_file(given) else ""
    return text


def _law(law: dict[str, Any]) -> dict[str, Any]:
    return {"view": "laws", "laws": [law]}


def _of_stored(data: Any, name: str) -> dict[str, Any]:
    """The machine or the cam of results; the problems of solutions, so that they can be changed; else the law."""
    if isinstance(data, dict) and isinstance(data.get("cam"), dict):
        return _of_problem_file({**data["cam"], "job": "cam"}, name)
    if isinstance(data, dict) and {"axes", "cycle", "segments"} & data.keys():
        return _of_problem_file(_machine(data, name), name)
    with located(name):
        problems = list(islice(_problems(data), MOST_LAWS))
        if problems:
            laws = [{"problem": problem_of(LawRequest(problem=each)).to_dict()} for each in problems]
            return {"view": "laws", "laws": laws}
        if isinstance(data, dict) and "kind" not in data and "law" in data:
            data = data["law"]
        return _law({"law": MotionLaw.from_dict(data).to_dict(), "title": _stem(name)})


def _problems(data: Any) -> Iterator[dict[str, Any]]:
    """The problems of the solutions in a file, in order, however deep."""
    if isinstance(data, dict) and isinstance(data.get("problem"), dict):
        yield data["problem"]
    elif isinstance(data, dict | list):
        for part in data.values() if isinstance(data, dict) else data:
            yield from _problems(part)


def _machine(data: dict[str, Any], name: str) -> dict[str, Any]:
    """The problem file of a stored cycle, plan or machine, or of the axes that `cycle.json` holds."""
    with located(name):
        axes = {"axis": data} if {"cycle", "segments"} & data.keys() else data["axes"]
        if not isinstance(axes, dict) or not all(isinstance(axis, dict) for axis in axes.values()):
            raise InputError("axes must be a table of cycles by their names")
        cycles = {axis: entries.get("cycle", entries) for axis, entries in axes.items()}
        rules = [row.get("rule", row) for row in data.get("interlocks") or () if isinstance(row, dict)]
        title = str(data.get("about", "Machine")).partition("; ")[0]
        machine = Axes.from_dict({"axes": cycles, "interlocks": rules})
        return reading.toml_text(machine.to_toml(title), name)


def _of_table(name: str, text: str) -> dict[str, Any]:
    """The law of a table of points; where these are of a whole cycle, or of a controller, the old cam."""
    refused: InputError | None = None
    if is_table(name):
        try:
            return _law({"law": law_of_points(Path(name), content=text).to_dict(), "title": _stem(name)})
        except InputError as error:
            refused = error
    try:
        old_cam_view.table(old_cam_view.OldCamEntries(file=Path(name).name, text=text))
    except InputError as error:
        raise refused or InputError(
            f"the page opens problem files (.toml), laws and solutions (.json), tables of points (.csv) and of "
            f"controllers: {error}"
        ) from None
    return {"view": "old", "old": {"file": Path(name).name, "text": text}}


def _stem(name: str) -> str:
    return Path(name).stem[:60]


def _of_problem_file(data: dict[str, Any], name: str) -> dict[str, Any]:
    """The view of a job, or a single law where the file has one problem."""
    job: Any = data["job"] if isinstance(data.get("job"), str) else None
    if job == "cycle":
        with located(name):
            axes = CycleProblemFile.from_dict(data).axis
        driven = [i for i, axis in enumerate(axes) if axis.mechanism is not None]
        view = next((view for entry, view in _CYCLES.items() if data.get(entry)), "machine" if driven else "cycle")
        return {"view": view, "machine": data} | ({"axis": driven[0]} if view == "machine" else {})
    if job in _SHOWN:
        return {"view": job, job: data}
    with located(name):
        given, swept = data.get("problem"), [dict[str, Any]()]
        if job == "solutions":
            spec = SolutionsProblemFile.from_dict(data)
            given, swept = spec.problem, [*swept_entries(spec)]
        if isinstance(given, Mapping) and len(swept) == 1 and (job == "solutions" or not {"job", "vary"} & data.keys()):
            return _law({"problem": problem("problem", given, swept[0]).to_dict()})
        raise InputError("the page shows a law, a cycle, a cam or a move; `optlaws run` does what this file says")


def _with_motors(data: dict[str, Any]) -> dict[str, Any]:
    """The entries of a file with its motors as tables: the page reads no catalogue."""
    for entry in (entry for part in ("axis", "move") if isinstance(data.get(part), list) for entry in data[part]):
        drive = entry.get("drive") if isinstance(entry, dict) else None
        if isinstance(drive, dict) and isinstance(drive.get("motors"), str) and isinstance(drive.get("motor"), str):
            motor_of(drive["motor"], drive["motors"])  # refuses what is no motor of it
            motors = reading.toml(Path(drive.pop("motors")))
            drive["motor"] = {"name": drive["motor"], **motors[drive["motor"]]}
    return data


class OpenRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A file that the reader opened: its name and its text."""

    name: Annotated[str, msgspec.Meta(max_length=255)]
    text: str


def opened(request: OpenRequest) -> dict[str, Any]:
    """The state that shows a file; no file of this machine is read for it."""
    return {"state": _of_text(Path(request.name).name, request.text)}


def _of_text(name: str, text: str) -> dict[str, Any]:
    ending = Path(name).suffix.lower()
    if ending == ".toml":
        return _of_problem_file(reading.toml_text(text, name), name)
    return _of_stored(reading.json_text(text, name), name) if ending == ".json" else _of_table(name, text)

"""What the explorer shows first: what the command was given, as the page keeps its state."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from optlaws.errors import InputError, located
from optlaws.explorer.answering import EXAMPLES
from optlaws.explorer.views.requests import MOST_LAWS, LawRequest, problem_of
from optlaws.files import reading
from optlaws.files.packaged import is_problem, problem_file
from optlaws.laws.catalogue.reading import is_file, is_table, read_law

_FIRST = {"order": 4, "degree": 9, "B": 1.7}


def start(given: str | None) -> dict[str, Any]:
    """The page's first state for a law's name or file, a problem file or a solution; an optimal law unless given.

    Examples
    --------
    >>> start("cycloidal")
    {'view': 'laws', 'laws': [{'name': 'cycloidal'}]}
    """
    if given is None:
        return _laws({"problem": dict(_FIRST), "weights": {"C": 1.0}})
    if is_problem(given):
        return _of_problem_file(problem_file(Path(given))[0])
    if is_file(given):
        return _of_law_file(given)
    read_law(given)
    return _laws({"name": given})


def _laws(*laws: dict[str, Any]) -> dict[str, Any]:
    return {"view": "laws", "laws": list(laws)[:MOST_LAWS]}


def _of_law_file(given: str) -> dict[str, Any]:
    """The problem of a solution, so that it can be changed; else the law."""
    file = Path(given)
    data = None if is_table(given) else reading.json_file(file)
    if isinstance(data, dict) and isinstance(data.get("problem"), dict):
        return _laws(_problem(data["problem"], file))
    return _laws({"law": read_law(given).to_dict(), "title": file.stem[:60]})


def _of_problem_file(file: Path) -> dict[str, Any]:
    data = reading.toml(file)
    job = data.get("job")
    if job in EXAMPLES:
        return {"view": job, job: data}
    entries = data.get("problem")
    if not isinstance(entries, dict):
        raise InputError(
            f"{file} has neither a [problem] nor a job of {', '.join(EXAMPLES)}: the explorer shows these and laws"
        )
    swept: Any = data.get("sweep")
    first = {name: values[0] for entry in swept for name, values in entry.items()} if _is_sweep(swept) else {}
    return _laws(_problem({name: value for name, value in (entries | first).items() if value != "free"}, file))


def _is_sweep(swept: Any) -> bool:  # noqa: ANN401 - of a file
    return isinstance(swept, list) and all(
        isinstance(entry, dict) and all(isinstance(values, list) and values for values in entry.values())
        for entry in swept
    )


def _problem(entries: dict[str, Any], file: Path) -> dict[str, Any]:
    """A problem as the page keeps it: with weights where one constant is minimised."""
    with located(str(file)):
        plain = problem_of(LawRequest(problem=entries)).to_dict()
    if plain.get("minimise") in {"C", "D", "J", "rms_c"}:
        return {"weights": {plain.pop("minimise"): 1.0}, "problem": plain}
    return {"problem": plain}

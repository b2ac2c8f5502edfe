"""The jobs that a problem file can name, and the one door to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.jobs.dwell import drawing as dwell_drawing
from optlaws.jobs.dwell import types as dwell_types
from optlaws.jobs.follower import follower, optimal_polydyne
from optlaws.jobs.laws import atlas, fronts, optimal_table, savin_families, solutions
from optlaws.jobs.lever import drawing as lever_drawing
from optlaws.jobs.lever import nomogram as lever_nomogram
from optlaws.jobs.lever import parametric as lever_parametric
from optlaws.jobs.lever import tables as lever_tables
from optlaws.jobs.loader import drawing as loader_drawing
from optlaws.jobs.loader import nomogram as loader_nomogram
from optlaws.jobs.loader import optimal as loader_optimal
from optlaws.jobs.loader import table as loader_table
from optlaws.suggest import unknown_key

Job = Callable[[Mapping[str, Any], Path, Path], list[Path]]

JOBS: dict[str, Job] = {
    "atlas": atlas.run,
    "dwell drawing": dwell_drawing.run,
    "dwell types": dwell_types.run,
    "follower": follower.run,
    "fronts": fronts.run,
    "lever drawing": lever_drawing.run,
    "lever nomogram": lever_nomogram.run,
    "lever parametric": lever_parametric.run,
    "lever tables": lever_tables.run,
    "loader drawing": loader_drawing.run,
    "loader nomogram": loader_nomogram.run,
    "loader optimal": loader_optimal.run,
    "loader table": loader_table.run,
    "optimal polydyne": optimal_polydyne.run,
    "optimal table": optimal_table.run,
    "savin families": savin_families.run,
    "solutions": solutions.run,
}


def run(file: Path, out: Path | None = None) -> list[Path]:
    """Do the job of a problem file and return the files written.

    Parameters
    ----------
    file
        The problem file.
    out
        Folder for the results; `results/<name of the file>` beside the problem file's folder unless given.

    Raises
    ------
    InputError
        If the file cannot be read, is not TOML, or holds an unknown or wrong entry.
    """
    data = reading.toml(file)
    name = data.get("job")
    if name is None:
        raise InputError(f"{file}: the entry job is missing; known jobs are {', '.join(JOBS)}")
    if not isinstance(name, str) or name not in JOBS:
        raise InputError(f"{file}: {unknown_key(name, JOBS, 'job')}")
    target = out if out is not None else file.resolve().parent.parent / "results" / file.stem
    try:
        return JOBS[name](data, file, target)
    except InputError as error:
        text = str(error)
        raise InputError(text if str(file) in text else f"{file}: {text}") from None

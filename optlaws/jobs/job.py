"""The jobs that a problem file can name, and the one door to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.suggest import unknown_key

Job = Callable[[Mapping[str, Any], Path, Path], list[Path]]

_MODULES = {
    "atlas": "laws.atlas",
    "cam": "cam.cam",
    "cycle": "cycle.cycle",
    "dwell drawing": "dwell.drawing",
    "dwell types": "dwell.types",
    "follower": "follower.follower",
    "force loaded": "laws.force_loaded",
    "fronts": "laws.fronts",
    "ledger": "ledger.ledger",
    "lever drawing": "lever.drawing",
    "lever moments": "lever.moments",
    "lever nomogram": "lever.nomogram",
    "lever parametric": "lever.parametric",
    "lever tables": "lever.tables",
    "loader drawing": "loader.drawing",
    "loader nomogram": "loader.nomogram",
    "loader optimal": "loader.optimal",
    "loader table": "loader.table",
    "machine laws": "machine.laws_for_machine",
    "optimal polydyne": "follower.optimal_polydyne",
    "optimal table": "laws.optimal_table",
    "own search": "laws.own_search",
    "savin families": "laws.savin_families",
    "solutions": "laws.solutions",
}


class _Jobs(Mapping[str, Job]):
    """The function `run` of each job's module, which is imported, and matplotlib with it, when it is asked for."""

    def __getitem__(self, name: str) -> Job:
        job: Job = import_module(f"optlaws.jobs.{_MODULES[name]}").run
        return job

    def __contains__(self, name: object) -> bool:
        return name in _MODULES

    def __iter__(self) -> Iterator[str]:
        return iter(_MODULES)

    def __len__(self) -> int:
        return len(_MODULES)


JOBS = _Jobs()


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

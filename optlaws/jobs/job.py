"""The jobs that a problem file can name, and the function that runs them."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.packaged import packaged, problem_file
from optlaws.plots.style import figures_for_files
from optlaws.results import Results

#: the job of a problem file is the function `run` of the module of its name
JOBS = ("cam", "cycle", "fastest", "machine laws", "solutions")
#: jobs of earlier versions, and what does their work now
RETIRED = {
    "atlas": "leave the job out and take `optlaws study`; `optlaws run atlas` solves the one that comes with optlaws",
    "force loaded": "minimise peak(drive_torque(...)) or rms(drive_torque(...)) by Python, as problems/force_loaded.py "
    "does; `optlaws run force_loaded` computes its results",
    "fronts": "take `optlaws front`, or pareto_front(...) by Python, as problems/fronts.py does; `optlaws run fronts` "
    "computes its results",
}
#: the job of the problem files that come with optlaws and have a script beside them
SCRIPT = "script"


def do(name: str, results: Results) -> None:
    """Run the job of a problem file and collect its results; the job's module, and matplotlib, are imported here."""
    import_module(f"optlaws.jobs.{name.replace(' ', '_')}").run(results)


def done(file: Path) -> Results:
    """The results of the job of a problem file, not yet written."""
    if file.suffix == ".py":
        raise InputError(
            f"{file}: optlaws runs no code but its own scripts, by name (`optlaws run {file.stem}`); "
            f"run yours by Python: `python {file}`"
        )
    results = Results(file)
    name = _job_of(results.entries, file)
    if name == SCRIPT:
        return _scripted(file)
    try:
        with figures_for_files():
            do(name, results)
    except InputError as error:
        text = str(error)
        raise InputError(text if str(file) in text else f"{file}: {text}") from None
    return results


def _job_of(entries: Mapping[str, Any], file: Path) -> str:
    """The job that a file names."""
    name = entries.get("job")
    if name is None:
        raise InputError(f"{file}: the entry job is missing; known jobs are {', '.join(JOBS)}")
    if isinstance(name, str) and name in RETIRED:
        raise InputError(f"{file}: there is no job {name!r} any more: {RETIRED[name]}")
    if not isinstance(name, str) or name not in (*JOBS, SCRIPT):
        raise InputError(f"{file}: {unknown_key(name, JOBS, 'job')}")
    return name


def problem_of_job(given: Path, job: str, *others: str) -> tuple[Path, dict[str, Any]]:
    """A problem file of a job, which it need not name, or of others, and its entries.

    >>> problem_of_job(Path("cam_press"), "cycle")
    Traceback (most recent call last):
    optlaws.errors.InputError: cam_press is of the job 'cam', not 'cycle': `optlaws run cam_press` does it
    """
    file = problem_file(given)
    entries = reading.toml(file)
    named = _job_of({"job": job, **entries}, given)
    if named not in (job, *others):
        raise InputError(f"{given} is of the job {named!r}, not {job!r}: `optlaws run {given}` does it")
    return file, entries


def _scripted(file: Path) -> Results:
    """The results of a script that comes with optlaws, whose own problem file this must be."""
    from optlaws import problems

    if file.stem in problems.names() and packaged(f"problems/{file.stem}.toml").samefile(file):
        return problems.results_of(file.stem)
    raise InputError(
        f"{file}: scripts are run for the problems that come with optlaws alone, by name: "
        f"`optlaws run {file.stem if file.stem in problems.names() else 'optimal_table'}`; "
        "a script of your own takes this file by optlaws.results.Results"
    )

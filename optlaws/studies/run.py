"""Running a study: chunks out, their rows into files, the table at the end."""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError, SolverFailure
from optlaws.numbers import whole
from optlaws.studies.executor import WorkerPool
from optlaws.studies.points import StudyPoints
from optlaws.studies.progress import Watch, watching
from optlaws.studies.specification import StudyFile, entries, read_study
from optlaws.studies.store import Chunks, StudyDirectory
from optlaws.studies.study import Study
from optlaws.synthesis import Problem

_TRIES = 3
_TICK = 1.0


def run_study(
    source: Path | str | Mapping[str, Any],
    out: Path | str,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    watch: Watch | None = None,
) -> Study:
    """Solve every point of a study into a directory, or continue an interrupted study.

    Parameters
    ----------
    source
        The study file, or the same as a dict.
    out
        The directory. The same call continues an interrupted run.
    executor
        Anything that speaks `concurrent.futures.Executor`; watched processes of this machine unless given.
    workers
        How many points are solved at a time; all cores, or what the executor has, unless given.
    watch
        The display of the progress; by default, a bar on a terminal or in a notebook.

    Returns
    -------
    Study
        The finished study.

    Raises
    ------
    InputError
        If the study file or the number of workers is wrong, or the directory holds another study or is in use.
    StoreFailure
        If the directory cannot be written, for example on a full disk; what was written stands.
    SolverFailure
        If the workers cannot work at all. A point that fails is a row with its error.

    Examples
    --------
    >>> import tempfile
    >>> from optlaws.studies.executor import Serial
    >>> source = {"problem": {"order": 4}, "vary": {"B": [1.6, 1.7], "degree": [3, 9]}}
    >>> with tempfile.TemporaryDirectory() as out:
    ...     study = run_study(source, out, executor=Serial())
    ...     print(study.counts, round(study.best("C").constants["C"], 6))
    {'optimal': 4} 4.819774
    """
    if workers is not None:
        workers = whole(workers, "workers", least=1)
    study = read_study(source)
    points = StudyPoints.of(study)
    check(study, points)
    directory, seen = StudyDirectory(Path(out)), watch or watching()
    with directory.locked():
        points = StudyPoints.of(study, directory.claim(study, points))
        if not directory.finished(len(points)):
            chunks = Chunks(directory.chunks)
            seen.begin(len(points), chunks.counts)
            try:
                _solve(study, points, chunks, WorkerPool(executor, workers), seen)
            finally:
                seen.end(chunks.counts)
            directory.write_table(points, chunks)
        directory.remove_chunks()
    return Study(directory.path)


def task(study: StudyFile, points: StudyPoints, number: int) -> dict[str, Any]:
    """A chunk as plain data."""
    return {
        "chunk": number,
        "problem": study.problem,
        "points": list(points.of_chunk(number).items()),
        "bound": study.bound,
        "time_limit": study.time_limit,
        "imports": list(study.imports),
    }


def check(study: StudyFile, points: StudyPoints) -> None:
    """Refuse a study whose modules are missing or whose first point is no problem."""
    for module in study.imports:
        try:
            importlib.import_module(module)
        except (ImportError, SyntaxError, TypeError, ValueError) as error:
            raise InputError(f"imports: {module}: {error}") from None
    first = points.inputs(0)
    try:
        Problem.from_dict(entries(study.problem, first))
    except InputError as error:
        shown = ", ".join(f"{name} = {shortened(value)}" for name, value in first.items())
        raise InputError(f"the first point, {shown}, is no problem: {error}") from None


def _solve(study: StudyFile, points: StudyPoints, chunks: Chunks, pool: WorkerPool, watch: Watch) -> None:
    waiting = (number for number in range(points.chunks) if number not in chunks.done)
    under_way: dict[Future[list[bytes]], int] = {}
    tries: Counter[int] = Counter()

    def submit(number: int) -> None:
        under_way[pool.submit(task(study, points, number))] = number

    try:
        while True:
            while len(under_way) < pool.most and (number := next(waiting, None)) is not None:
                submit(number)
            if not under_way:
                return
            done, _ = wait(under_way, timeout=_TICK, return_when=FIRST_COMPLETED)
            if not done:
                pool.check()
            lost = {under_way[future]: error for future in done if (error := _failure(future)) is not None}
            solved = {number: future.result() for future in done if (number := under_way.pop(future)) not in lost}
            chunks.write_all(solved)
            watch.advance(chunks.counts)
            for number, error in lost.items():
                tries[number] += 1
                if isinstance(error, SolverFailure | BrokenExecutor) or tries[number] == _TRIES:
                    raise SolverFailure(
                        f"chunk {number} cannot be solved: {str(error) or type(error).__name__}"
                    ) from error
                submit(number)
    finally:
        for future in under_way:
            future.cancel()
        pool.close()


def _failure(future: Future[list[bytes]]) -> BaseException | None:
    """The failure of a chunk; an executor that is closed during a study cancels its chunks."""
    if future.cancelled():
        return SolverFailure("the executor gave it up: it was closed, or its scheduler is gone")
    return future.exception()

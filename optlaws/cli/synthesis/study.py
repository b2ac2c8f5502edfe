"""The command `optlaws study`: many problems, on all cores or on a cluster."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import optlaws
from optlaws.cli.options import Whole, takes
from optlaws.cli.show import Answer, progress
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.studies.study import Study


@takes(
    "Draw objective and peaks of the finished points over the entry of most values into this file, PNG or SVG.",
    watched=False,
)
def study(
    file: Path | None = None,
    *,
    out: Path | None = None,
    workers: Whole | None = None,
    dask: str | None = None,
    status: Path | None = None,
) -> Answer:
    """Solve every point of a study; the same command continues an interrupted study.

    Parameters
    ----------
    file
        Study file (TOML).
    out
        Directory of the study; studies/NAME where you are unless given.
    workers
        The number of points solved at a time; by default, all cores, or all threads of the cluster.
    dask
        Address of a Dask scheduler, such as tcp://10.0.0.1:8786.
    status
        Report the progress of the study in this directory, and solve nothing.
    """
    if status is not None:
        if file is not None or out is not None or dask is not None:
            raise InputError("--status takes a directory and neither a study file nor --out nor --dask")
        return _answer(optlaws.open_study(status))
    if file is None:
        raise InputError("name a study file, or a directory by --status DIR")
    from optlaws.files import writing
    from optlaws.studies.progress import Bar, Lines

    target = out if out is not None else Path("studies", file.stem)
    if not target.exists():
        writing.check_place(target / "rows.parquet")
    console = progress()
    watch = Bar(console) if console.is_terminal else Lines(console)
    with _cluster(dask) as (executor, threads):
        study = optlaws.run_study(file, target, executor=executor, workers=workers or threads, watch=watch)
    return _answer(study)


@contextmanager
def _cluster(address: str | None) -> Iterator[tuple[Executor | None, int | None]]:
    if address is None:
        yield None, None
        return
    from optlaws.errors import not_installed

    try:
        from distributed import Client
    except ImportError:
        raise not_installed("--dask needs distributed", "'optlaws[cluster]'") from None
    try:
        client = Client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise InputError(f"--dask {address}: no scheduler answers there: {error}") from None
    with client:
        yield client.get_executor(), max(1, sum(client.nthreads().values()))


def _answer(study: Study) -> Answer:
    from optlaws.plots.sweep import points_figure

    return Answer.of(study.report(), lambda: points_figure(study, str(study.path), study.about["title"]))

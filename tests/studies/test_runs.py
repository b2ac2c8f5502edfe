"""Running studies: the same rows everywhere, failures that stay single, a store that is refused or gone on with."""

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import pytest

import optlaws
from optlaws import FUNCTIONALS, InputError, MotionLaw, Problem, SolverFailure, open_study, run_study, synthesize
from tests.internals.files import writing
from tests.internals.studies import Study, digest, read_study, with_digest
from tests.studies.sweeping import SMALL, rows, serially, troubled

P = ParamSpec("P")
T = TypeVar("T")


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return serially(SMALL, tmp_path_factory.mktemp("studies") / "small")


def test_a_notebook_shows_what_is_done(small: Study) -> None:
    html = small._repr_html_()
    assert "28 of 28" in html
    assert html.count("<tr>") > 12
    assert "<script" not in html


def test_rows_are_what_synthesize_gives(small: Study) -> None:
    assert len(small) == 28
    assert [point.index for point in small] == list(range(28))
    for point in small:
        try:
            solution = synthesize(point.problem)
        except optlaws.InfeasibleProblem:
            assert (point.status, point.law, point.objective) == ("infeasible", None, None)
            assert point.error
            continue
        assert point.status == solution.status.value
        assert point.objective == pytest.approx(solution.objective, rel=1e-11)
        assert point.best_possible == solution.best_possible
        assert isinstance(point.law, MotionLaw)
        # laws of an array have their constants together, which sums in another order
        assert point.law.constants.C.value == pytest.approx(point.constants["C"], rel=1e-15)
        assert point.objective == point.constants[point.inputs["minimise"]]
    assert {point.status for point in small} == {"optimal", "infeasible"}


def test_one_point_is_found_by_its_index_with_its_law_and_problem(small: Study) -> None:
    point = small[9]
    assert point.problem == Problem(B=point.inputs["B"], order=4, basis=optlaws.Chebyshev(5), minimise="C")
    assert small.law(9).constants.B.value == pytest.approx(point.inputs["B"], rel=1e-12)
    with pytest.raises(InputError, match=r"point 0 of .* has no law: infeasible"):
        small.law(0)
    with pytest.raises(IndexError, match="0 to 27"):
        small[28]


def test_the_best_point_is_the_least_of_all_or_of_some(small: Study) -> None:
    solved = [point for point in small if point.law is not None]
    assert small.best("C").constants["C"] == min(point.constants["C"] or 9e9 for point in solved)
    some = small.best("D", {"minimise": "rms_c"})
    assert some.inputs["minimise"] == "rms_c"
    assert some.constants["D"] == min(p.constants["D"] or 9e9 for p in solved if p.inputs["minimise"] == "rms_c")
    with pytest.raises(InputError, match="did you mean 'rms_c'"):
        small.best("rms")
    with pytest.raises(InputError, match="did you mean 'minimise'"):
        small.best("C", {"minimize": "C"})
    with pytest.raises(InputError, match="has no law with"):
        small.best("C", {"B": 1.1})


def test_tables_hold_every_row(small: Study) -> None:
    frame = small.to_pandas()
    assert list(frame["index"]) == list(range(28))
    assert list(frame["C"].dropna()) == [p.constants["C"] for p in small if p.law is not None]
    assert MotionLaw.from_json(frame["law"][9]) == small.law(9)
    grid = small.to_xarray()
    assert dict(grid.sizes) == {"minimise": 2, "B asked": 14}
    assert float(grid["C"].sel(minimise="rms_c").isel({"B asked": 9})) == small[23].constants["C"]
    assert str(grid["status"].values[0, 0]) == "infeasible"


@pytest.mark.long
def test_watched_processes_give_the_rows_of_a_serial_run(small: Study, tmp_path: Path) -> None:
    assert rows(run_study(SMALL, tmp_path, workers=2)) == rows(small)


@pytest.mark.long
def test_any_executor_gives_the_rows_of_a_serial_run(small: Study, tmp_path: Path) -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert rows(run_study(SMALL, tmp_path, executor=pool)) == rows(small)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_a_cluster_gives_the_rows_of_a_serial_run(small: Study, tmp_path: Path) -> None:
    from distributed import Client, LocalCluster

    # a free port: the dashboard's own may be taken by another run
    shape: dict[str, Any] = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(**shape) as cluster, Client(cluster) as client:
        assert rows(run_study(SMALL, tmp_path, executor=client.get_executor(), workers=2)) == rows(small)


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_a_cluster_without_workers_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from distributed import Client, LocalCluster

    monkeypatch.setattr("optlaws.studies.executor._LOST_SECONDS", 1.0)
    with (
        LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster,
        Client(cluster) as client,
        pytest.raises(SolverFailure, match="the cluster has had no worker for 1 s; what is solved is safe"),
    ):
        run_study(SMALL, tmp_path, executor=client.get_executor(), workers=1)


def test_tight_bounds_are_searched_and_power_is_never_continued(tmp_path: Path) -> None:
    asked = {"problem": {"order": 4, "degree": 5, "minimise": "D"}, "vary": {"B": [1.6, 1.65]}, "bound": "tight"}
    for point in serially(asked, tmp_path):
        assert point.status == "optimal"
        assert point.objective == synthesize(point.problem, bound="tight").objective


def test_a_law_with_a_jump_of_acceleration_has_no_finite_jerk(tmp_path: Path) -> None:
    asked = {
        "problem": {"order": 2, "basis": "pieces", "breaks": 4, "degree": 3, "continuity": 1},
        "vary": {"B": [1.8]},
    }
    (point,) = serially(asked, tmp_path)
    assert point.law is not None
    assert point.constants["J"] is None
    assert point.constants["C"] == point.law.constants.C.value


@pytest.fixture
def registered() -> Iterator[None]:
    """Takes away again what the study's import registers."""
    known = set(FUNCTIONALS)
    yield
    for name in set(FUNCTIONALS) - known:
        del FUNCTIONALS[name]
    sys.modules.pop("tests.studies.troubles", None)


@pytest.mark.sample(2)
@pytest.mark.usefixtures("registered")
@pytest.mark.parametrize(
    ("trouble", "status", "error"),
    [
        ("errs", "error", "ZeroDivisionError: a mistake in a constant"),
        ("dies", "worker died", "its process died 3 times: signal 9"),
        pytest.param("hangs", "time limit", "no answer within 2 s", marks=pytest.mark.long),
        pytest.param("dies_forked", "worker died", "its process died 3 times: signal 9", marks=pytest.mark.long),
        pytest.param("hangs_forked", "time limit", "no answer within 2 s", marks=pytest.mark.long),
    ],
)
def test_a_point_in_trouble_is_one_row(tmp_path: Path, trouble: str, status: str, error: str) -> None:
    study = run_study(troubled(trouble, time_limit=2.0 if "hangs" in trouble else 60.0), tmp_path, workers=1)
    assert [point.status for point in study] == ["optimal", "optimal", status, "optimal"]
    assert study[2].error == error
    assert study[2].law is None
    # the point after it begins cold, as the head of a chunk does
    assert study[3].objective == synthesize(study[3].problem).objective


def test_a_value_that_makes_no_problem_is_one_row(tmp_path: Path) -> None:
    study = serially({"problem": {"order": 4}, "vary": {"B": [1.6, 0.9]}}, tmp_path)
    assert [point.status for point in study] == ["optimal", "invalid"]
    assert "B must be" in str(study[1].error)


def test_a_first_point_that_makes_no_problem_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"the first point, B = 0\.9, is no problem: B must be"):
        serially({"problem": {"order": 4}, "vary": {"B": [0.9, 1.6]}}, tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("workers", [0.5, 2.0, 0, -1, True, "2"])
def test_workers_are_whole(tmp_path: Path, workers: Any) -> None:
    with pytest.raises(InputError, match="workers must be an integer of at least 1, got"):
        run_study(SMALL, tmp_path / "out", workers=workers)
    assert not (tmp_path / "out").exists()


def test_a_missing_module_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="imports: nowhere"):
        serially({**SMALL, "imports": ["nowhere"]}, tmp_path)


def test_a_changed_study_is_refused_and_the_same_one_is_not_solved_again(tmp_path: Path) -> None:
    first = serially(SMALL, tmp_path)
    written = (tmp_path / "rows.parquet").stat().st_mtime_ns
    assert rows(serially(SMALL, tmp_path)) == rows(first)
    assert (tmp_path / "rows.parquet").stat().st_mtime_ns == written
    with pytest.raises(InputError, match="before its file was changed"):
        serially({**SMALL, "problem": {"order": 4, "degree": 7}}, tmp_path)


def test_other_versions_may_not_finish_a_study(tmp_path: Path) -> None:
    serially(SMALL, tmp_path)
    (tmp_path / "rows.parquet").unlink()
    about = json.loads((tmp_path / "study.json").read_text())
    about["versions"]["casadi"] = "3.0"
    (tmp_path / "study.json").unlink()
    about["about"] = writing.MARK
    (tmp_path / "study.json").write_text(with_digest(json.dumps(about, indent=1) + "\n"), "utf-8")
    with pytest.raises(InputError, match=r"was begun with .*casadi 3\.0"):
        serially(SMALL, tmp_path)


@pytest.mark.parametrize(
    "change", [('"degree": 5', '"degree": 7'), ('"order": 4', '"order": 3'), ('"hash": "', '"hash": "0')]
)
def test_a_study_whose_file_was_changed_is_neither_read_nor_gone_on_with(
    small: Study, tmp_path: Path, change: tuple[str, str]
) -> None:
    out = tmp_path / "out"
    shutil.copytree(small.path, out)
    about = out / "study.json"
    text = about.read_text("utf-8")
    assert change[0] in text
    about.write_text(text.replace(*change, 1), "utf-8")
    uses: tuple[Callable[[], Study], ...] = (lambda: open_study(out), lambda: serially(SMALL, out))
    for use in uses:
        with pytest.raises(InputError, match=r"study\.json is damaged: .*put a whole copy in its place"):
            use()
    # line ends count for nothing: some systems change them on their own
    about.write_bytes(text.replace("\n", "\r\n").encode())
    assert rows(open_study(out)) == rows(small)


def test_directories_of_earlier_versions_are_known_by_the_hash_of_their_study() -> None:
    study = {
        "problem": {"order": 4, "degree": 5, "bounds": {"rms_c": [0, 9.0]}},
        "vary": {
            "minimise": ["C", "rms_c"],
            "B": {"from": 1.1, "to": 2.4, "steps": 14},
            "at_most.J": {"from": 60, "to": 6000, "steps": 2, "scale": "log"},
        },
        "together": [{"order": [3, 4], "monotone": [True, False]}],
        "sample": [
            {
                "kind": "sobol",
                "points": 2,
                "seed": 1,
                "over": {"at_most.jounce": {"from": 900, "to": 9e5, "scale": "log"}},
            }
        ],
        "chunk": 9,
    }
    assert digest(read_study(study)) == "ecc4bba0553eab6c090e45360a3b84aac4d616c7f282ef573479653304acafe6"


def test_a_study_knows_every_library_that_finds_laws(small: Study) -> None:
    assert {"optlaws", "casadi", "clarabel", "numpy", "scipy"} == small.about["versions"].keys()


def test_a_directory_with_other_files_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="contains other files and no study"):
        serially(SMALL, tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.tex"]
    with pytest.raises(InputError, match="contains no study; optlaws study FILE --out"):
        open_study(tmp_path)


def test_an_executor_that_fails_stops_the_study_and_what_is_done_stands(small: Study, tmp_path: Path) -> None:
    class Failing(ThreadPoolExecutor):
        count = 0

        def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
            self.count += 1
            if self.count <= 2:
                return super().submit(fn, *args, **kwargs)
            failed: Future[T] = Future()
            failed.set_exception(ZeroDivisionError("division by zero"))
            return failed

    with Failing(1) as pool, pytest.raises(SolverFailure, match="chunk 2 cannot be solved: division by zero"):
        run_study(SMALL, tmp_path, executor=pool)
    assert 0 < sum(open_study(tmp_path).counts.values()) < 28
    assert rows(serially(SMALL, tmp_path)) == rows(small)


def test_work_is_handed_out_as_it_is_done(tmp_path: Path) -> None:
    class Counting(ThreadPoolExecutor):
        waiting = most = 0

        def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
            self.waiting += 1
            self.most = max(self.most, self.waiting)
            future = super().submit(fn, *args, **kwargs)
            future.add_done_callback(self._one_less)
            return future

        def _one_less(self, _: object) -> None:
            self.waiting -= 1

    asked = {"problem": {"order": 4}, "vary": {"B": {"from": 1.5, "to": 1.6, "steps": 100}}, "chunk": 5}
    with Counting(2) as pool:
        run_study(asked, tmp_path, executor=pool, workers=2)
    assert pool.most == 4

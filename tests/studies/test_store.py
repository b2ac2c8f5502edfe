"""The store of a study: what is torn, damaged or cut short is solved again, and nothing else."""

import errno
import fcntl
import os
import resource
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from optlaws import InputError, Status, open_study, run_study
from tests.documents import ROOT
from tests.internals.studies import Chunks, DamagedTable, StoreFailure, Study, StudyDirectory
from tests.sampling import examples
from tests.studies.sweeping import SMALL, rows, serially


def written(folder: Path, count: int = 4) -> Chunks:
    chunks = Chunks(folder)
    for number in range(count):
        rows = [
            b'{"index":%d,"key":"","inputs":{},"status":"optimal","error":"%s"}' % (i, b"x" * i)
            for i in range(3 * number, 3 * number + 3)
        ]
        chunks.write(number, rows)
    return chunks


DAMAGES: dict[str, Callable[[bytes, int, int], bytes]] = {
    "cut": lambda data, place, _: data[:place],
    "changed": lambda data, place, bits: data[:place] + bytes([data[place] ^ bits]) + data[place + 1 :],
    "longer": lambda data, place, _: data + data[place:],
}


@settings(examples(60), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(damage=st.sampled_from(sorted(DAMAGES)), share=st.floats(0.0, 1.0, exclude_max=True), bits=st.integers(1, 255))
def test_damage_anywhere_costs_its_chunk_alone(tmp_path: Path, damage: str, share: float, bits: int) -> None:
    written(tmp_path / "chunks")
    file = tmp_path / "chunks" / "2"
    data = file.read_bytes()
    file.write_bytes(DAMAGES[damage](data, int(share * len(data)), bits))
    chunks = Chunks(tmp_path / "chunks")
    assert chunks.done == {0, 1, 3}
    assert chunks.counts == {"optimal": 9}
    chunks.write(2, [b'{"index":99,"key":"","inputs":{},"status":"local"}'])
    again = Chunks(tmp_path / "chunks")
    assert again.done == {0, 1, 2, 3}
    assert again.counts == chunks.counts == {"optimal": 9, "local": 1}
    assert list(again.rows(2)) == [99]


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return serially(SMALL, tmp_path_factory.mktemp("studies") / "small")


class Enough(Exception):  # noqa: N818 - it stops a run at a chosen place
    pass


class After:
    """Watches a run and ends it after some chunks."""

    def __init__(self, chunks: int) -> None:
        self.chunks = chunks

    def begin(self, total: int, counts: object) -> None:
        assert total == 28
        assert counts is not None

    def advance(self, counts: object) -> None:
        assert counts is not None
        self.chunks -= 1
        if self.chunks == 0:
            raise Enough

    def end(self, counts: object) -> None:
        pass


def interrupted(out: Path, chunks: int) -> None:
    from tests.internals.studies import Serial

    with pytest.raises(Enough):
        run_study(SMALL, out, executor=Serial(), watch=After(chunks))


def test_a_torn_record_is_solved_again(small: Study, tmp_path: Path) -> None:
    interrupted(tmp_path, 3)
    assert sum(open_study(tmp_path).counts.values()) == 15
    last = tmp_path / "chunks" / "2"
    os.truncate(last, last.stat().st_size - 7)
    study = open_study(tmp_path)
    assert sum(study.counts.values()) == 10
    assert not study.finished
    assert len(study.to_pandas()) == 10
    with pytest.raises(InputError, match="is not solved yet"):
        study[20]
    assert rows(serially(SMALL, tmp_path)) == rows(small)
    assert not (tmp_path / "chunks").exists()


@pytest.mark.parametrize("damaged", [False, True])
def test_a_run_killed_between_table_and_chunks_is_finished(small: Study, tmp_path: Path, *, damaged: bool) -> None:
    interrupted(tmp_path, 2)
    shutil.copytree(tmp_path / "chunks", tmp_path / "before")
    serially(SMALL, tmp_path)
    (tmp_path / "before").rename(tmp_path / "chunks")
    if damaged:
        (tmp_path / "rows.parquet").write_bytes(b"PAR1")
    assert rows(serially(SMALL, tmp_path)) == rows(small)
    assert not (tmp_path / "chunks").exists()


def test_without_pyarrow_the_chunks_are_the_store(
    small: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    study = serially(SMALL, tmp_path)
    assert not (tmp_path / "rows.parquet").exists()
    table = rows(study)
    with pytest.raises(ImportError, match=r"pip install 'optlaws\[studies\]'"):
        study.to_pandas()
    monkeypatch.undo()
    assert table == rows(small)
    assert rows(serially(SMALL, tmp_path)) == rows(small)
    assert (tmp_path / "rows.parquet").exists()


def test_two_runs_in_one_directory_are_refused(tmp_path: Path) -> None:
    with (
        StudyDirectory(tmp_path).locked(),
        pytest.raises(InputError, match=f"in use by another run, process {os.getpid()}"),
    ):
        serially(SMALL, tmp_path)


def test_the_lock_of_a_killed_run_is_no_hindrance(tmp_path: Path) -> None:
    script = (
        "import sys, time\nfrom pathlib import Path\nfrom optlaws.studies.store import StudyDirectory\n"
        f"with StudyDirectory(Path({str(tmp_path)!r})).locked():\n    print('locked', flush=True)\n    time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, cwd=ROOT) as owner:
        assert owner.stdout is not None
        assert owner.stdout.readline() == b"locked\n"
        assert StudyDirectory(tmp_path).in_use()
        owner.send_signal(signal.SIGKILL)
        owner.wait()
    assert not StudyDirectory(tmp_path).in_use()
    with StudyDirectory(tmp_path).locked():
        assert (tmp_path / "lock").read_text() == str(os.getpid())


def test_a_file_system_without_locks_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    with pytest.raises(InputError, match=r"lock cannot be locked: No locks available; put the study"):
        serially(SMALL, tmp_path)
    assert not StudyDirectory(tmp_path).in_use()


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")
def test_another_user_who_may_only_read_sees_that_a_run_is_under_way() -> None:
    script = (
        "import os, sys\nfrom pathlib import Path\nfrom optlaws.studies.store import StudyDirectory\n"
        "from filelock import lock_descriptor\nos.setuid(65534)\nprint(StudyDirectory(Path(sys.argv[1])).in_use())"
    )
    with TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)
        with StudyDirectory(folder).locked():
            (folder / "lock").chmod(0o444)
            done = subprocess.run(
                [sys.executable, "-c", script, name], cwd=ROOT, capture_output=True, text=True, check=False
            )
    assert done.stdout == "True\n", done.stderr


def test_chunks_are_read_once_and_new_ones_are_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path, 3)
    study = open_study(tmp_path)
    added: list[int] = []
    add = Chunks._add

    def counted(chunks: Chunks, number: int, rows: list[bytes]) -> None:
        added.append(number)
        add(chunks, number, rows)

    with monkeypatch.context() as patch:
        patch.setattr(Chunks, "_add", counted)
        for index in range(10):
            assert study[index].index == index
        assert sum(study.counts.values()) == 15
    assert added == [0, 1, 2]
    Chunks(tmp_path / "chunks").write(4, [b'{"index":27,"key":"","inputs":{},"status":"local"}'])
    assert study.counts[Status.LOCAL] == 1


@pytest.fixture(params=[2600, 6000], ids=["at a chunk", "at the table"])
def small_disk(request: pytest.FixtureRequest) -> Iterator[int]:
    """No file may grow beyond so many bytes: a full disk, as far as a write can tell."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (request.param, before[1]))
    yield request.param
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, handler)


def test_a_full_disk_is_said_and_nothing_is_lost(small: Study, tmp_path: Path, small_disk: int) -> None:
    with pytest.raises(StoreFailure, match=r"File too large.*make room and run the same command again"):
        serially(SMALL, tmp_path)
    sizes = [file.stat().st_size for file in (tmp_path / "chunks").iterdir()]
    assert 0 < max(sizes) <= small_disk
    done = sum(open_study(tmp_path).counts.values())
    assert done == (5 if len(sizes) == 1 else 28)
    assert not (tmp_path / "rows.parquet").exists()
    resource.setrlimit(resource.RLIMIT_FSIZE, resource.getrlimit(resource.RLIMIT_FSIZE)[1:] * 2)
    assert rows(serially(SMALL, tmp_path)) == rows(small)


def _emptied(data: bytes) -> bytes:
    return data[:0]


def _cut(data: bytes) -> bytes:
    return data[: len(data) // 2]


def _flipped(data: bytes) -> bytes:
    # a bit of what the first page holds: of some bits of its header nothing depends
    import pyarrow.parquet as pq

    column = pq.ParquetFile(BytesIO(data)).metadata.row_group(0).column(0)
    place = column.data_page_offset + column.total_compressed_size - 1
    return data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :]


@pytest.mark.sample(2)
@pytest.mark.parametrize("damage", [_emptied, _cut, _flipped])
@pytest.mark.parametrize("checksum", [True, False])
def test_a_damaged_table_is_refused_by_name(
    small: Study, tmp_path: Path, damage: Callable[[bytes], bytes], *, checksum: bool
) -> None:
    out = tmp_path / "out"
    shutil.copytree(small.path, out)
    table = out / "rows.parquet"
    table.write_bytes(damage(table.read_bytes()))
    if not checksum:
        (out / "rows.sha256").unlink()
    for use in (lambda: serially(SMALL, out), lambda: open_study(out).counts, lambda: list(open_study(out))):
        with pytest.raises(DamagedTable, match=r"rows\.parquet is damaged: .* run the same study again"):
            use()
    table.unlink()
    (out / "rows.sha256").unlink(missing_ok=True)
    assert rows(serially(SMALL, out)) == rows(small)


@pytest.mark.parametrize(
    "about", ["[]", "7", '{"format": 1}', "{", "[" * 100_000, '{"format": 1, "title": 3}', '{"format": 2}']
)
def test_what_is_no_study_is_said(small: Study, tmp_path: Path, about: str) -> None:
    assert small.finished
    (tmp_path / "study.json").write_text(about)
    with pytest.raises(InputError, match=r"study\.json(: the format is 2| is damaged)"):
        open_study(tmp_path)


def test_whoever_may_only_read_sees_rows_and_status(small: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    shutil.copytree(small.path, out)
    with reading_only(out):
        study = open_study(out)
        assert rows(study) == rows(small)
        assert study.finished
        assert not study.running
        with pytest.raises(InputError, match=r"out cannot be written: .*; a study there can be read"):
            serially(SMALL, out)


@contextmanager
def reading_only(folder: Path) -> Iterator[None]:
    """Refuses to open files of the folder for writing: permissions do not bind every user."""

    def opened(file: Path, mode: str = "r", **kwargs: Any) -> Any:
        if file.is_relative_to(folder) and set(mode) & set("wax+"):
            raise PermissionError(13, "Permission denied", str(file))
        return before(file, mode, **kwargs)

    before = Path.open
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "open", opened)
        yield

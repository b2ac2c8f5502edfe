"""Processes that write results into the same file at the same moment, round after round.

`python -m tests.files.concurrent_writing 20000` runs so many rounds and prints what came of them.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import BrokenBarrierError
from typing import Any

from optlaws import InputError
from tests.internals.files import writing

MINE = "mine, by hand\n"
PROCESSES = 2
_PATIENCE = 60.0


def _result(number: int, turn: int) -> str:
    return f"result {number} of round {turn} {writing.MARK}\n"


def _writer(number: int, rounds: int, folder: str, barrier: Any, errors: Any) -> None:
    for turn in range(rounds):
        try:
            barrier.wait(_PATIENCE)
            writing.write(Path(folder) / f"{turn}.txt", _result(number, turn), exact=True)
        except BrokenBarrierError:
            return
        except InputError:
            continue
        except BaseException as error:  # noqa: BLE001 - whatever it is, it is told
            errors.put(f"round {turn}: {error!r}")


def outcomes(rounds: int, folder: Path) -> Iterator[str]:
    """What is wrong of each round, and what every process said; nothing where all went as it should."""
    context = get_context("spawn")
    barrier, errors = context.Barrier(PROCESSES), context.Queue()
    for turn in range(rounds):
        # of every other file nothing is there before
        if turn % 2:
            (folder / f"{turn}.txt").write_text(MINE, "utf-8")
    writers = [
        context.Process(target=_writer, args=(number, rounds, str(folder), barrier, errors))
        for number in range(PROCESSES)
    ]
    for process in writers:
        process.start()
    for process in writers:
        process.join()
    while not errors.empty():
        yield errors.get()
    left: dict[str, dict[str, str]] = {}
    for file in folder.iterdir():
        left.setdefault(file.name.lstrip(".").partition(".")[0], {})[file.name] = file.read_text("utf-8")
    for turn in range(rounds):
        files = left.get(str(turn), {})
        results = {MINE} if turn % 2 else {_result(number, turn) for number in range(PROCESSES)}
        if files.pop(f"{turn}.txt", None) not in results or files:
            yield f"round {turn}: {files}"


if __name__ == "__main__":
    with TemporaryDirectory() as place:
        total = int(sys.argv[1])
        wrong = list(outcomes(total, Path(place)))
        print(f"{total} rounds of {PROCESSES} processes, {len(wrong)} wrong", Counter(wrong).most_common(3))  # noqa: T201

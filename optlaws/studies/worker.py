"""A process that solves chunks: tasks as lines of JSON come in, blocks of rows go out, until its input ends."""

from __future__ import annotations

import os
import signal
import sys
import threading
from queue import SimpleQueue

READY, DONE, ERROR = b"ready", b"done", b"error "


def main() -> None:
    """Serve until the input ends, which it does with the process that started this one, however that ended."""
    # what libraries print must not run into the rows
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    tasks: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read, args=(tasks,), daemon=True).start()

    import msgspec

    from optlaws.studies.chunk import Task, blocks

    decode = msgspec.json.Decoder(tuple[int, Task]).decode
    output.write(READY + b"\n")
    output.flush()
    while True:
        begin, task = decode(tasks.get())
        last = DONE
        try:
            for block in blocks(task, begin):
                output.write(b"[" + b",".join(block) + b"]\n")
                output.flush()
        except Exception as error:  # noqa: BLE001 - whoever asked must hear of it
            last = ERROR + " ".join(f"{type(error).__name__}: {error}".split()).encode()
        output.write(last + b"\n")
        output.flush()


def _read(tasks: SimpleQueue[bytes]) -> None:
    for line in sys.stdin.buffer:
        tasks.put(line)
    if sys.platform != "win32" and os.getpgrp() == os.getpid():
        # what libraries started ends with it
        os.killpg(os.getpid(), signal.SIGKILL)
    os._exit(0)


if __name__ == "__main__":
    main()

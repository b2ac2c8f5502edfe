"""Watching a study: a progress bar on a terminal, lines of text elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from time import monotonic
from typing import Any, Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from optlaws.shown.steps import watched

_SECONDS = 10.0


class Watch(Protocol):
    """Reports of a study's progress: points done by status, at the beginning, now and then, and at the end."""

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """Begin a run with a number of finished points."""

    def advance(self, counts: Mapping[str, int]) -> None:
        """Set the number of points that are done and stored."""

    def end(self, counts: Mapping[str, int]) -> None:
        """The run ends, finished or not."""


class Silent:
    """Progress that is not shown."""

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """Show nothing at the start."""

    def advance(self, counts: Mapping[str, int]) -> None:
        """Show nothing at a step."""

    def end(self, counts: Mapping[str, int]) -> None:
        """Show nothing at the end."""


class Bar(Watch):
    """A progress bar with rate, time left and counts by status."""

    def __init__(self, console: Console) -> None:
        self._progress = Progress(
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[rate]}"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[counts]}", markup=False),
            console=console,
        )

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        self._rate = _Rate(total, counts)
        done = sum(counts.values())
        self._task = self._progress.add_task("", total=total, completed=done, rate="", counts=listed(counts))
        self._progress.start()

    def advance(self, counts: Mapping[str, int]) -> None:
        rate, _ = self._rate.texts(counts)
        self._progress.update(self._task, completed=sum(counts.values()), rate=rate, counts=listed(counts))

    def end(self, counts: Mapping[str, int]) -> None:
        self.advance(counts)
        self._progress.stop()


class Lines(Watch):
    """A line of text at the beginning, every ten seconds and at the end."""

    def __init__(self, console: Console) -> None:
        self._console = console

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        self._rate, self._total, self._last = _Rate(total, counts), total, monotonic()
        self._print(f"{sum(counts.values())} of {total} points done before")

    def advance(self, counts: Mapping[str, int]) -> None:
        """Print a line where enough has been done since the last."""
        if monotonic() - self._last >= _SECONDS:
            self._last = monotonic()
            self.end(counts)

    def end(self, counts: Mapping[str, int]) -> None:
        parts = (f"{sum(counts.values())} of {self._total}", *self._rate.texts(counts), listed(counts))
        self._print(", ".join(part for part in parts if part))

    def _print(self, text: str) -> None:
        self._console.print(text, markup=False, highlight=False, soft_wrap=True)


def watching() -> Watch:
    """A bar for whoever watches, on a terminal or in a notebook; nothing elsewhere."""
    return Bar(Console(stderr=True)) if watched() else Silent()


class _Rate:
    """Points a second since the run began."""

    def __init__(self, total: int, counts: Mapping[str, int]) -> None:
        self._total, self._before, self._began = total, sum(counts.values()), monotonic()

    def texts(self, counts: Mapping[str, int]) -> tuple[str, str]:
        """The rate, and the time that the points left take at it; nothing before the first point and after the last."""
        done = sum(counts.values())
        rate = (done - self._before) / max(monotonic() - self._began, 1e-9)
        if not rate:
            return "", ""
        minutes, seconds = divmod(round((self._total - done) / rate), 60)
        left = f"{minutes // 60}:{minutes % 60:02}:{seconds:02} left" if done < self._total else ""
        return f"{rate:.3g}/s", left


def listed(counts: Mapping[Any, int]) -> str:
    """Counts by status in words."""
    return ", ".join(f"{number} {status}" for status, number in counts.items() if number)

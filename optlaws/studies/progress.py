"""Watching a study: a progress bar on a terminal, lines of text elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from time import monotonic
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from optlaws.shown.steps import watched

_SECONDS = 10.0


class Watch(Protocol):
    """What is told of a study's progress: points done by status, at the beginning, now and then, and at the end."""

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """A run begins; so many points are done already."""

    def advance(self, counts: Mapping[str, int]) -> None:
        """So many points are done, and safe."""

    def end(self, counts: Mapping[str, int]) -> None:
        """The run ends, finished or not."""


class Silent:
    """Nobody watches."""

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """Say nothing."""

    def advance(self, counts: Mapping[str, int]) -> None:
        """Say nothing."""

    def end(self, counts: Mapping[str, int]) -> None:
        """Say nothing."""


class Bar:
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
        self._rate = Rate()

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """Show the bar."""
        done = sum(counts.values())
        self._rate.begin(done)
        self._task = self._progress.add_task("", total=total, completed=done, rate="", counts=listed(counts))
        self._progress.start()

    def advance(self, counts: Mapping[str, int]) -> None:
        """Move it."""
        done = sum(counts.values())
        self._progress.update(self._task, completed=done, rate=self._rate.text(done), counts=listed(counts))

    def end(self, counts: Mapping[str, int]) -> None:
        """Leave it as it is."""
        self.advance(counts)
        self._progress.stop()


def watching() -> Watch:
    """A bar for whoever watches, on a terminal or in a notebook; nothing elsewhere."""
    return Bar(Console(stderr=True)) if watched() else Silent()


class Lines:
    """A line of text at the beginning, every ten seconds and at the end."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._rate = Rate()
        self._last = 0.0
        self._total = 0

    def begin(self, total: int, counts: Mapping[str, int]) -> None:
        """The first line."""
        self._total, self._last = total, monotonic()
        self._rate.begin(sum(counts.values()))
        self._say(f"{sum(counts.values())} of {total} points done before")

    def advance(self, counts: Mapping[str, int]) -> None:
        """Perhaps a line."""
        if monotonic() - self._last >= _SECONDS:
            self._last = monotonic()
            self._say(self._state(counts))

    def end(self, counts: Mapping[str, int]) -> None:
        """The last line."""
        self._say(self._state(counts))

    def _state(self, counts: Mapping[str, int]) -> str:
        done = sum(counts.values())
        left = self._rate.left(self._total - done)
        parts = (f"{done} of {self._total}", self._rate.text(done), left, listed(counts))
        return ", ".join(part for part in parts if part)

    def _say(self, text: str) -> None:
        self._console.print(text, markup=False, highlight=False, soft_wrap=True)


class Rate:
    """Points a second since the run began."""

    def __init__(self) -> None:
        self._before, self._began, self._rate = 0, 0.0, 0.0

    def begin(self, done: int) -> None:
        """Begin to count."""
        self._before, self._began = done, monotonic()

    def text(self, done: int) -> str:
        """The rate; nothing before the first point."""
        self._rate = (done - self._before) / max(monotonic() - self._began, 1e-9)
        return f"{self._rate:.3g}/s" if done > self._before else ""

    def left(self, points: int) -> str:
        """The time that so many points take at this rate."""
        if not points or not self._rate:
            return ""
        minutes, seconds = divmod(round(points / self._rate), 60)
        return f"{minutes // 60}:{minutes % 60:02}:{seconds:02} left"


def listed(counts: Mapping[str, int]) -> str:
    """Counts by status in words.

    Examples
    --------
    >>> listed({"optimal": 12, "infeasible": 3})
    '12 optimal, 3 infeasible'
    """
    return ", ".join(f"{number} {status}" for status, number in counts.items() if number)

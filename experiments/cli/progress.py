"""A progress bar on stderr, for what takes longer than a second."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from itertools import count
from math import inf
from threading import Timer
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import ProgressColumn

PATIENCE = 1.0  # seconds before there is a bar
AT_ONCE = 0.5  # what is done within the first so many seconds was done before, and says nothing about the time left


@contextmanager
def progress(what: str, total: int) -> Generator[Callable[[int], None]]:
    """Yields a function that takes how much of `total` is done. Without a terminal nothing is shown.

    The time left is reckoned from all that is done from now on."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda done: None
        return
    bar = Progress(*_columns(), console=console, transient=True, speed_estimate_period=inf)
    task, begin = bar.add_task(what, total=total), monotonic()

    def report(done: int) -> None:
        if monotonic() - begin < AT_ONCE:
            bar.reset(task, completed=done)
        else:
            bar.update(task, completed=done)

    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield report
    finally:
        timer.cancel()
        timer.join()  # or the bar could start after it was stopped
        if bar.live.is_started:
            bar.stop()


@contextmanager
def counting(what: str, total: int) -> Generator[Callable[[], None]]:
    """`progress` that yields a function to call after each of `total` parts."""
    with progress(what, total) as report:
        done = count(1)
        yield lambda: report(next(done))


def _columns() -> list[ProgressColumn]:
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    return [
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    ]

"""A progress bar on stderr, for what takes longer than a second."""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from itertools import count
from math import inf
from threading import Timer
from time import monotonic

PATIENCE = 1.0  # seconds before there is a bar
AT_ONCE = 0.5  # what is done within the first so many seconds was done before, and says nothing about the time left


@contextmanager
def progress(what: str, total: int) -> Generator[Callable[[int], None]]:
    """Yields a function that takes how much of `total` is done. Without a terminal nothing is shown."""
    from rich import progress as rich

    from ..text import Screen

    console = Screen(stderr=True)
    if not console.is_terminal:
        yield lambda done: None
        return
    name, left = rich.TextColumn("{task.description}", markup=False), rich.TextColumn("left")
    clock = (rich.TimeElapsedColumn(), left, rich.TimeRemainingColumn())
    columns = (name, rich.BarColumn(), rich.MofNCompleteColumn(), *clock)
    bar = rich.Progress(*columns, console=console, transient=True, speed_estimate_period=inf)
    task, begin = bar.add_task(what, total=total), monotonic()
    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda done: (bar.reset if monotonic() - begin < AT_ONCE else bar.update)(task, completed=done)
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

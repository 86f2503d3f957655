"""A progress bar on stderr, for what takes longer than a second."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from itertools import count
from threading import Timer

PATIENCE = 1.0  # seconds before there is a bar


@contextmanager
def progress(what: str, total: int) -> Generator[Callable[[int], None]]:
    """Yields a function that takes how much of `total` is done. Without a terminal nothing is shown."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda done: None
        return
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=console, transient=True)
    task = bar.add_task(what, total=total)
    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda done: bar.update(task, completed=done)
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

"""The same function on many tasks, wherever they are run."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, as_completed
from typing import Any, TypeVar

from ..model import CogmapError

Task = TypeVar("Task")
Result = TypeVar("Result")


class WorkerLostError(CogmapError):
    """A worker ended before its task did."""


def completed(
    function: Callable[[Task], Result], tasks: Sequence[Task], *, executor: Executor | None = None
) -> Iterator[tuple[int, Result]]:
    """(index of the task, result) as they finish; at the first error those that are there, then the error.

    Closing the iterator, or an error of any task, cancels what has not begun.

    Args:
        function: must be importable unless it runs in this process, and its tasks and results must pickle.
        tasks: one argument each.
        executor: any of `concurrent.futures`; None: in this process, one after another, each when it is asked for.

    Raises:
        WorkerLostError: a worker was killed, or its cluster is gone.
    """
    if executor is None:
        yield from ((index, function(task)) for index, task in enumerate(tasks))
        return
    left: dict[Future[Result], int] = {}
    try:
        for index, task in enumerate(tasks):
            left[executor.submit(function, task)] = index
        yield from _results(left)
    except BrokenExecutor as error:
        raise WorkerLostError("a worker process was killed, perhaps out of memory; use fewer jobs") from error
    except _dask_errors() as error:
        raise WorkerLostError("the Dask cluster lost its scheduler, or workers again and again") from error
    finally:
        for future in left:
            future.cancel()


def map_tasks(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    *,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> list[Result]:
    """Results in the order of the tasks, whatever the executor; see `completed`. `on_done` is called after each."""
    results: dict[int, Result] = {}
    for index, result in completed(function, tasks, executor=executor):
        results[index] = result
        if on_done is not None:
            on_done()
    return [results[index] for index in range(len(tasks))]


def map_seeds(function: Callable[[int], Result], *, runs: int, seed: int = 0, **how: Any) -> list[Result]:
    """Results of the seeds `seed`, `seed + 1`, ..., so that each run can be repeated alone; `how` as for `map_tasks`.

    Raises:
        CogmapError: `runs` is below 1, or what `map_tasks` raises.
    """
    if runs < 1:
        raise CogmapError(f"runs is {runs}; use 1 or more")
    return map_tasks(function, range(seed, seed + runs), **how)


def _results(left: dict[Future[Result], int]) -> Iterator[tuple[int, Result]]:
    for future in as_completed(list(left)):
        if not _succeeded(future):
            yield from ((i, done.result()) for done, i in left.items() if done.done() and _succeeded(done))
            future.result()  # raises
        yield left.pop(future), future.result()


def _succeeded(future: Future[Any]) -> bool:
    return not future.cancelled() and future.exception() is None


def _dask_errors() -> tuple[type[BaseException], ...]:
    """What a future of Dask raises where workers or scheduler have gone, if Dask is in use."""
    dask: Any = sys.modules.get("distributed")
    return () if dask is None else (CancelledError, dask.KilledWorker)

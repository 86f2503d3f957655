"""The same function on many tasks, wherever they are run."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, as_completed
from typing import Any, TypeVar

from ..model.errors import CogmapError

Task = TypeVar("Task")
Result = TypeVar("Result")


class WorkerLostError(CogmapError):
    """A worker ended before its task did."""


def completed(
    function: Callable[[Task], Result], tasks: Sequence[Task], *, executor: Executor | None = None
) -> Iterator[tuple[int, Result]]:
    """(index of the task, result) as they finish.

    Closing the iterator, or an error of any task, cancels what has not begun.

    Args:
        function: must be importable unless it runs in this process, and its tasks and results must pickle.
        tasks: one argument each.
        executor: any of `concurrent.futures`; None: in this process, one after another, each when it is asked for.

    Raises:
        WorkerLostError: a worker was killed, or its cluster is gone.
    """
    if executor is None:
        for index, task in enumerate(tasks):
            yield index, function(task)
        return
    indices: dict[Future[Result], int] = {}
    try:
        for index, task in enumerate(tasks):
            indices[executor.submit(function, task)] = index
        yield from _results(indices)
    except BrokenExecutor as error:
        raise WorkerLostError("a worker process was killed, perhaps out of memory; use fewer jobs") from error
    except _dask_errors() as error:
        raise WorkerLostError("the Dask cluster lost its scheduler, or workers again and again") from error
    finally:
        for future in indices:
            future.cancel()


def map_tasks(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    *,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> list[Result]:
    """Results in the order of the tasks, whatever the executor; see `completed`.

    Args:
        function: as there.
        tasks: as there.
        executor: as there.
        on_done: called after each task.
    """
    results: dict[int, Result] = {}
    for index, result in completed(function, tasks, executor=executor):
        results[index] = result
        if on_done is not None:
            on_done()
    return [results[index] for index in range(len(tasks))]


def map_seeds(
    function: Callable[[int], Result],
    *,
    runs: int,
    seed: int = 0,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> list[Result]:
    """Results of the seeds `seed`, `seed + 1`, ..., so that each run can be repeated alone; see `map_tasks`.

    Raises:
        CogmapError: `runs` is below 1, or what `map_tasks` raises.
    """
    if runs < 1:
        raise CogmapError(f"runs is {runs}; use 1 or more")
    return map_tasks(function, range(seed, seed + runs), executor=executor, on_done=on_done)


def _results(indices: Mapping[Future[Result], int]) -> Iterator[tuple[int, Result]]:
    """As they finish; at the first error those that are there, then the error."""
    left, failure = dict(indices), None
    for future in as_completed(indices):
        failure = _failure(future)
        if failure is not None:
            break
        yield left.pop(future), future.result()
    for future, index in left.items():
        if future.done() and _failure(future) is None:
            yield index, future.result()
    if failure is not None:
        raise failure


def _failure(future: Future[Any]) -> BaseException | None:
    try:
        return future.exception()
    except CancelledError as error:
        return error


def _dask_errors() -> tuple[type[BaseException], ...]:
    """What a future of Dask raises where workers or scheduler have gone, if Dask is in use."""
    dask: Any = sys.modules.get("distributed")
    return () if dask is None else (CancelledError, dask.KilledWorker)

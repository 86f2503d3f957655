"""The same function on many tasks, on one or several processes."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import TypeVar

from ..model.errors import CogmapError

Task = TypeVar("Task")
Result = TypeVar("Result")


def map_tasks(
    function: Callable[[Task], Result],
    tasks: Sequence[Task],
    *,
    jobs: int = 1,
    on_done: Callable[[], None] | None = None,
) -> list[Result]:
    """Results in the order of the tasks, whatever the number of processes.

    Args:
        function: must be importable if `jobs` is above 1, and its tasks and results must pickle.
        tasks: one argument each.
        jobs: processes at most. Above 1 they are spawned, so a script needs `if __name__ == "__main__":`.
        on_done: called after each task.

    Raises:
        CogmapError: `jobs` is below 1, or a process was killed.
    """
    if jobs < 1:
        raise CogmapError(f"jobs is {jobs}; use 1 or more")
    done = on_done or _nothing
    if jobs == 1 or len(tasks) < 2:
        results: list[Result] = []
        for task in tasks:
            results.append(function(task))
            done()
        return results
    with _workers(min(jobs, len(tasks))) as pool:
        with _interrupts_blocked():
            futures = [pool.submit(function, task) for task in tasks]
        left: set[Future[Result]] = set(futures)
        while left:
            finished, left = wait(left, return_when=FIRST_COMPLETED)
            for future in finished:
                future.result()  # raises here and now what the task raised
                done()
        return [future.result() for future in futures]


def map_seeds(
    function: Callable[[int], Result],
    *,
    runs: int,
    seed: int = 0,
    jobs: int = 1,
    on_done: Callable[[], None] | None = None,
) -> list[Result]:
    """Results of the seeds `seed`, `seed + 1`, ..., so that each run can be repeated alone; see `map_tasks`.

    Raises:
        CogmapError: `runs` is below 1, or what `map_tasks` raises.
    """
    if runs < 1:
        raise CogmapError(f"runs is {runs}; use 1 or more")
    return map_tasks(function, range(seed, seed + runs), jobs=jobs, on_done=on_done)


@contextmanager
def _workers(count: int) -> Generator[ProcessPoolExecutor]:
    """A pool that is ended at once, not after its last task, when something goes wrong."""
    others = set(multiprocessing.active_children())
    # spawned, since a progress bar has a thread and threads do not survive a fork
    pool = ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn"))
    try:
        yield pool
    except BaseException as error:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in set(multiprocessing.active_children()) - others:
            worker.terminate()
        if isinstance(error, BrokenProcessPool):
            raise CogmapError("a worker process was killed, perhaps out of memory; use fewer jobs") from error
        raise
    finally:
        pool.shutdown()


@contextmanager
def _interrupts_blocked() -> Generator[None]:
    """Processes started here never see Ctrl-C: this one does, and ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _nothing() -> None:
    pass

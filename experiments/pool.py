"""The same function on many tasks: in this process, on several processes, or on a Dask cluster."""

import logging
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.context import SpawnContext, SpawnProcess
from queue import Empty, SimpleQueue
from threading import Thread, current_thread, main_thread
from types import FrameType
from typing import Any, ParamSpec, TypeVar

from ..model import CogmapError

Parameters = ParamSpec("Parameters")
Task = TypeVar("Task")
Result = TypeVar("Result")

PATIENCE = 5.0  # seconds that a process may take to end
SILENCE = 10.0  # seconds without a result after which is said what is waited for, if that is not the work itself

MOST_JOBS = 1024

_log = logging.getLogger("cogmap")


class WorkerLostError(CogmapError):
    """A worker process ended before its task did."""


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
        yield from _results(left, getattr(executor, "waiting", lambda: None))
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


@contextmanager
def workers(*, jobs: int = 1, dask: str | None = None) -> Generator[Executor | None]:
    """Where to run tasks, for as long as the `with` lasts; an error in it ends what still runs.

    Args:
        jobs: processes at most. Above 1 they are spawned, so a script needs `if __name__ == "__main__":`. They do not
            see Ctrl-C: this process does, and ends them.
        dask: address of a Dask scheduler, `host:port` or `tcp://host:port`. Its workers must have cogmap in the same
            version.

    Yields:
        An executor, or None: in this process.

    Raises:
        CogmapError: `jobs` below 1 or above `MOST_JOBS`, processes that cannot be started, both given, the package
            `distributed` is missing, or there is no such cluster.
    """
    if not 1 <= jobs <= MOST_JOBS:
        raise CogmapError(f"jobs is {jobs}; use 1 to {MOST_JOBS}")
    if dask is not None and jobs > 1:
        raise CogmapError(f"jobs is {jobs} and dask is {dask}; give one of them, a Dask cluster has its own workers")
    if dask is not None:
        from .dask_cluster import cluster

        with cluster(dask) as executor:
            yield executor
    elif jobs > 1:
        with _processes(jobs) as executor:
            yield executor
    else:
        yield None


def _results(left: dict[Future[Result], int], waiting: Callable[[], str | None]) -> Iterator[tuple[int, Result]]:
    finished, said = SimpleQueue[Future[Result]](), None
    for future in left:
        future.add_done_callback(finished.put)
    while left:
        try:
            future = finished.get(timeout=SILENCE)
        except Empty:
            if (why := waiting()) != said:
                said = why
                if why is not None:
                    _log.warning("cogmap: waiting: %s", why)
            continue
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


@contextmanager
def _processes(jobs: int) -> Generator[Executor]:
    """A pool that is ended at once, not after its last task, when something goes wrong."""
    context = _Spawning()
    try:
        pool = _Processes(jobs, context, initializer=_end_with_parent)
    except OSError as error:
        raise _no_process(error, jobs) from error
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        _end(context.started)
        raise
    finally:
        pool.shutdown()


def _end(processes: Sequence[SpawnProcess]) -> None:
    """Terminate them and wait until each is known to have ended, at most `PATIENCE` seconds."""
    for process in processes:
        process.terminate()
    deadline = time.monotonic() + PATIENCE
    while any(process.exitcode is None for process in processes) and time.monotonic() < deadline:
        time.sleep(0.01)  # a join is no help: the thread of a broken pool may take the exit status before it
    for process in processes:
        process.join(0)


class _Spawning(SpawnContext):
    """Remembers the processes that it starts; spawned, since a progress bar has a thread, which survives no fork."""

    def __init__(self) -> None:
        super().__init__()
        self.everyone: list[SpawnProcess] = []

    def Process(self, *args: Any, **options: Any) -> SpawnProcess:  # type: ignore[override]
        self.everyone.append(SpawnProcess(*args, **options))
        return self.everyone[-1]

    @property
    def started(self) -> list[SpawnProcess]:
        """Those that were started."""
        return [process for process in self.everyone if process.pid is not None]


class _Processes(ProcessPoolExecutor):
    """Processes that never see Ctrl-C."""

    def submit(
        self, fn: Callable[Parameters, Result], /, *args: Parameters.args, **kwargs: Parameters.kwargs
    ) -> Future[Result]:
        try:
            with _ctrl_c_waits():  # processes start here
                return super().submit(fn, *args, **kwargs)
        except OSError as error:
            raise _no_process(error, self._max_workers) from error  # type: ignore[attr-defined]


@contextmanager
def _ctrl_c_waits() -> Generator[None]:
    """Processes that start within never see it; here it is heard afterwards, or one would be told half of its work."""
    if current_thread() is not main_thread() or not hasattr(signal, "pthread_sigmask"):
        yield
        return
    heard: list[tuple[int, FrameType | None]] = []

    def hear(number: int, frame: FrameType | None) -> None:
        heard.append((number, frame))

    before = signal.signal(signal.SIGINT, hear)
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # is inherited
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, before)
        if heard and callable(before):
            before(*heard[0])


def _no_process(error: OSError, jobs: int) -> CogmapError:
    why = f"cannot start {jobs} processes ({error.strerror or error})"
    return CogmapError(f"{why}; use fewer jobs, or raise the limit (ulimit -n for open files, -u for processes)")


def _end_with_parent() -> None:
    """In a process of the pool: end with the one that started it, however that ends."""
    parent: Any = multiprocessing.parent_process()
    Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()

"""Where runs are made: in this process, on several processes, or on a Dask cluster."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.context import SpawnContext, SpawnProcess
from threading import Thread
from typing import Any, ParamSpec, TypeVar

from ..model import CogmapError

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")

PATIENCE = 5.0
"""Seconds that a process may take to end."""


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
        CogmapError: `jobs` below 1, both given, the package `distributed` is missing, or there is no such cluster.
    """
    if jobs < 1:
        raise CogmapError(f"jobs is {jobs}; use 1 or more")
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


@contextmanager
def _processes(jobs: int) -> Generator[Executor]:
    """A pool that is ended at once, not after its last task, when something goes wrong."""
    context = _Spawning()
    pool = _Processes(jobs, context, initializer=_end_with_parent)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in context.started:
            process.terminate()
        for process in context.started:
            process.join(PATIENCE)
        raise
    finally:
        pool.shutdown()


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
        if not hasattr(signal, "pthread_sigmask"):
            return super().submit(fn, *args, **kwargs)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # processes start here, and inherit it
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with_parent() -> None:
    """In a process of the pool: end with the one that started it, however that ends."""
    parent: Any = multiprocessing.parent_process()
    Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()

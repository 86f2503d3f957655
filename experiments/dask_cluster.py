"""The workers of a Dask cluster."""

import asyncio
import logging
import warnings
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from importlib.metadata import version
from typing import Any, ParamSpec, TypeVar

from ..model import CogmapError

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")

_LOUD = ("distributed", "tornado", "asyncio")
PATIENCE = 5.0  # seconds in which a scheduler must answer, and again in which a worker must be there


@contextmanager
def cluster(address: str) -> Generator[Executor]:
    """The workers of the scheduler at that address, `host:port` or `tcp://host:port`.

    Raises:
        CogmapError: the package `distributed` is missing, no scheduler answers there, or its workers lack this cogmap.
    """
    client = _connected(address)
    with _quiet():
        try:
            yield _ClusterExecutor(client, address)
        finally:
            _close(client)


class _ClusterExecutor(Executor):
    """Tasks of a client as futures of `concurrent.futures`.

    The executor that `distributed` has asks the scheduler at each cancelled future and waits for its answer, which is
    slow, and fails at every single one where the scheduler has gone.
    """

    def __init__(self, client: Any, address: str) -> None:
        self._client, self._address, self._version = client, address, version("cogmap")

    def waiting(self) -> str | None:
        """What keeps results from coming, if it is not the work itself."""
        try:
            known = self._client.sync(self._client.scheduler.identity, callback_timeout=PATIENCE)
        except Exception:  # whatever it is, it does not answer
            return f"the Dask scheduler at {self._address} does not answer"
        if known["workers"]:
            return None
        return f"the Dask cluster at {self._address} has no workers left; start one: dask worker {self._address}"

    def submit(
        self, fn: Callable[Parameters, Result], /, *args: Parameters.args, **kwargs: Parameters.kwargs
    ) -> Future[Result]:
        there = self._client.submit(_with_same_version, self._version, fn, *args, pure=False, **kwargs)
        here = Future[Result]()
        there.add_done_callback(partial(_hand_over, here))
        here.add_done_callback(partial(self._cancel, there))
        return here

    def _cancel(self, there: Any, here: Future[Any]) -> None:
        async def cancel() -> None:
            with suppress(Exception):  # the scheduler has gone
                await self._client.cancel([there], asynchronous=True)

        if here.cancelled():
            self._client.loop.add_callback(cancel)


def _with_same_version(own: str, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Result:
    """Call it, in a worker that may have joined after the others were looked at."""
    if (other := version("cogmap")) != own:
        raise CogmapError(f"a Dask worker has cogmap {other}, this is {own}; install the same version there")
    return fn(*args, **kwargs)


def _hand_over(here: Future[Any], there: Any) -> None:
    if here.set_running_or_notify_cancel():
        try:
            here.set_result(there.result())
        except ModuleNotFoundError as error:
            lacks = f"a Dask worker has no {error.name}"
            here.set_exception(CogmapError(f"{lacks}; install cogmap {version('cogmap')} there, and what it needs"))
        except BaseException as error:
            here.set_exception(error)


def _close(client: Any) -> None:
    try:
        client.close(timeout=PATIENCE)  # the scheduler drops what has not finished
    except Exception:  # it has gone; what went wrong is known by then
        client.status = "closed"  # or the client tries again when it is collected, and complains


def _connected(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError as error:
        missing = f"dask is {address}, but the package distributed is missing"
        raise CogmapError(f"{missing}; run: pip install 'cogmap[dask]'") from error
    with _quiet():
        try:
            # a client by itself would wait for ever where something else listens
            with ThreadPoolExecutor(1) as thread:  # in a notebook this one has a loop already
                thread.submit(asyncio.run, _probe(address)).result()
            client = Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, MemoryError, ValueError, TypeError, EOFError) as error:
            why = (str(error) or "something else listens there").splitlines()[0]
            remedy = "give the address that `dask scheduler` prints, like tcp://127.0.0.1:8786"
            raise CogmapError(f"no Dask scheduler answers at {address!r} ({why}); {remedy}") from error
        try:
            _check_workers(client, address)
        except BaseException:
            _close(client)
            raise
    return client


async def _probe(address: str) -> None:
    from distributed.comm.core import connect

    async with asyncio.timeout(PATIENCE):
        comm = await connect(address if "://" in address else f"tcp://{address}", timeout=PATIENCE - 1)
    comm.abort()


def _check_workers(client: Any, address: str) -> None:
    """Refuse a cluster whose results could be others than those of this process."""
    own = version("cogmap")
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
        found: dict[str, str] = client.run(version, "cogmap")
    except TimeoutError as error:
        none = f"the Dask scheduler at {address} has no workers"
        raise CogmapError(f"{none}; start one: dask worker {address}") from error
    except ImportError as error:
        raise CogmapError(f"a Dask worker of {address} has no cogmap; install cogmap {own} there") from error
    for worker, other in found.items():
        if other != own:
            raise CogmapError(f"Dask worker {worker} has cogmap {other}, this is {own}; install the same version there")


@contextmanager
def _quiet() -> Generator[None]:
    """What goes wrong is said in one line by us, not in many by `distributed`."""
    known = [logging.getLogger(name) for name in logging.root.manager.loggerDict]
    levels = {logger: logger.level for logger in known if logger.name.split(".")[0] in _LOUD}
    try:
        for logger in levels:
            logger.setLevel(logging.CRITICAL + 1)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", module="distributed")
            yield
    finally:
        for logger, level in levels.items():
            logger.setLevel(level)

"""Steps that are taken whole or not at all."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from ..model import CogmapError, CognitiveMap, Savepoint, go_back, release, savepoint
from ..planning import LocalCache, Plan
from .forgetting import forget_unused
from .recognition import Recognition
from .state import State
from .wiring import Wired

T = TypeVar("T")

IN_STEP = "in the middle of a step"  # what is said of an agent while it takes one


@dataclass(frozen=True, slots=True)
class Before:
    """All that a step may change, as it was before it.

    Attributes:
        model: of the map.
        recognition: of the hypotheses, and of which place is which.
        state: of the agent.
        plan: the last one.
        rng, drawn: the generator, and where it was.
        records: how many the trace had.
        kept: what else the agent has.
    """

    model: Savepoint
    recognition: Any
    state: State
    plan: Plan | None
    rng: np.random.Generator
    drawn: Any
    records: int
    kept: Any


def before_step(
    map_: CognitiveMap,
    recognition: Recognition,
    state: State,
    plan: Plan | None,
    rng: np.random.Generator,
    records: int,
    kept: Any,
) -> Before:
    """How an agent is now; nothing of it is changed."""
    window = deque(state.window, maxlen=state.window.maxlen)
    then = replace(state, window=window)
    return Before(savepoint(map_), recognition.savepoint(), then, plan, rng, rng.bit_generator.state, records, kept)


def undo_step(before: Before, map_: CognitiveMap, recognition: Recognition) -> None:
    """Have map, hypotheses and generator as they were, wherever the step was broken off; may be called again.

    Raises:
        CogmapError: a part is not of this library, and cannot be copied.
    """
    go_back(map_, before.model)
    recognition.go_back(before.recognition)
    before.rng.bit_generator.state = before.drawn


class Whole(Wired):
    """An agent whose steps happen whole or not at all."""

    def _check_whole(self) -> None:
        if self._torn is not None:
            raise CogmapError(f"agent: it is torn, {self._torn}; load it from a file, or make another")

    def _whole(self, work: Callable[[], T]) -> T:
        """Do it, or leave everything as it was; what is done within it is part of it."""
        if self._torn is IN_STEP:
            return work()
        self._check_whole()
        map_, state = self.map, self._state
        before = before_step(map_, self._recognition, state, self._plan, self.rng, len(self.trace), self._kept())
        try:
            self._torn = IN_STEP
            result = work()
            self._torn = None
            release(map_)
            forget_unused(map_, self._recognition.tracker, self._state)
            if self._keep is not None and len(self.trace) >= 2 * self._keep:
                del self.trace[: -self._keep]
            return result
        except BaseException as error:
            if self._torn is not None:
                self._go_back(before, error)
            raise

    def _kept(self) -> Any:
        """What a kind of agent has besides, and steps may replace."""
        return None

    def _put_back(self, kept: Any) -> None:
        """Have it as it was."""

    def _go_back(self, before: Before, error: BaseException) -> None:
        """As it was before; a second interrupt in the middle is waited out."""
        self._torn = f"left in the middle of a step by a {type(error).__name__}"
        for _ in range(3):
            try:
                undo_step(before, self.map, self._recognition)
                self._state, self._plan, self.rng = before.state, before.plan, before.rng
                self._cache = LocalCache(self.map, self.settings.look_ahead)
                del self.trace[before.records :]
                self._put_back(before.kept)
                self._torn = None
                return
            except CogmapError as why:
                self._torn = f"{self._torn}, and cannot go back ({why})"
                return
            except KeyboardInterrupt:  # it is raised in the end
                continue

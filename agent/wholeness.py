"""Steps that are taken whole or not at all."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..model import CognitiveMap, Savepoint, go_back, savepoint
from ..planning import Plan
from .recognition import Recognition
from .state import State

IN_STEP = "in the middle of a step"
"""What is said of an agent while it takes one."""


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
    """

    model: Savepoint
    recognition: Any
    state: State
    plan: Plan | None
    rng: np.random.Generator
    drawn: Any
    records: int


def before_step(
    map_: CognitiveMap,
    recognition: Recognition,
    state: State,
    plan: Plan | None,
    rng: np.random.Generator,
    records: int,
) -> Before:
    """How an agent is now; nothing of it is changed."""
    window = deque(state.window, maxlen=state.window.maxlen)
    kept = replace(state, window=window)
    return Before(savepoint(map_), recognition.savepoint(), kept, plan, rng, rng.bit_generator.state, records)


def undo_step(before: Before, map_: CognitiveMap, recognition: Recognition) -> None:
    """Have map, hypotheses and generator as they were, wherever the step was broken off; may be called again.

    Raises:
        CogmapError: a part is not of this library, and cannot be copied.
    """
    go_back(map_, before.model)
    recognition.go_back(before.recognition)
    before.rng.bit_generator.state = before.drawn

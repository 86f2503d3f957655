"""Along a walk that somebody else made: what the agent would believe, consider and do at each step of it."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief
from ..model import CogmapError, CognitiveMap, Slice
from ..planning import Plan


@dataclass(frozen=True, slots=True)
class Followed:
    """One step of a recorded walk that the agent followed."""

    step: int  # the time step, from 0
    belief: Belief  # where the agent believes to be
    plan: Plan  # the policies that it considers, what each is worth, and P(policy)
    ways: tuple[int, ...]  # the actions whose way was open, ascending; `stay` is none
    # `[K]` P(action): the policy posterior summed by first action, over the open ways; zero of others
    probability: NDArray[np.float64]


class Perceiver(Protocol):
    """What can be taken along: an `Agent`."""

    map: CognitiveMap

    @property
    def steps(self) -> int:
        """Observations taken in so far."""
        ...

    @property
    def plan(self) -> Plan:
        """What it considers."""
        ...

    @property
    def window(self) -> Sequence[Slice]:
        """The last steps."""
        ...

    def perceive(self, observation: Mapping[str, Any]) -> Belief:
        """Take in one observation."""
        ...


def follow(agent: Perceiver, walk: Iterable[Mapping[str, Any]]) -> Iterator[Followed]:
    """Lead the agent along a recorded walk; at each step give the probability that it assigns to each action.

    The agent learns as if it walked itself; what it would have done is never carried out.

    Args:
        agent: one that has seen nothing yet, or that is to be led on from where it is.
        walk: what was sensed at each step; from the second on `taken` says which action led there.

    Raises:
        CogmapError: no walk, or an observation that `Agent.perceive` refuses, such as one that does not say what was
            `taken`.
    """
    if not isinstance(walk, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise CogmapError(f"follow: the walk is a {type(walk).__name__}; give observations, one a step")
    for observation in walk:
        belief = agent.perceive(observation)
        plan, stay = agent.plan, agent.map.motions.stay
        open_ = agent.window[-1].percept.passable or (True,) * len(agent.map.motions)
        ways = tuple(action for action, is_open in enumerate(open_) if is_open and action != stay)
        probability = np.zeros(len(open_))
        probability[list(ways)] = plan.action_probability[list(ways)]
        if ways and not probability.any():  # it means to stay
            probability[list(ways)] = 1.0
        yield Followed(agent.steps - 1, belief, plan, ways, probability / (probability.sum() or 1.0))

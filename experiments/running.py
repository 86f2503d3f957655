"""Any agent in any world: the loop that every experiment is built on."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import gymnasium as gym

from ..agent import Agent, StepRecord
from ..model import CogmapError
from ..worlds import World, offered

Seen = tuple[Any, Mapping[str, Any]]
"""What a world shows: an observation, for the agent, and an info, which no agent sees."""


class Walker(Protocol):
    """Whatever answers an observation with an action."""

    def step(self, observation: Any, /) -> int:
        """The next action."""
        ...


@dataclass(frozen=True, slots=True)
class Moment:
    """A choice that was made and is not yet carried out."""

    step: int  # its number, 0 at the first observation
    agent: Walker  # who chose
    world: gym.Env[Any, Any]  # where
    observation: Any  # what the agent chose after
    info: Mapping[str, Any]  # what the world tells of the truth
    action: int  # the choice


Watch = Callable[[Moment], object]
"""Called after every choice, before it is carried out; an answer of True ends the run after this action."""


@dataclass(frozen=True, slots=True)
class Run:
    """The result of a run."""

    agent: Any  # after its last observation
    actions: tuple[int, ...]  # what it chose, one action an observation; all were carried out
    # where it truly was at each observation, `info["place"]` or `info["position"]`; empty where the world does
    # not say
    truth: tuple[Any, ...]
    records: tuple[StepRecord, ...]  # the agent's own records of these steps; empty for an agent that keeps no `trace`
    end: Seen  # observation and info after the last action, which the agent has not seen; `run(..., begin=end)` goes on
    ended: bool  # whether the world ended the episode

    @property
    def observations(self) -> int:
        """How many observations the agent took in."""
        return len(self.actions)


def run(
    world: gym.Env[Any, Any],
    agent: Walker | None = None,
    *,
    steps: int,
    seed: int | None = None,
    options: dict[str, Any] | None = None,
    begin: Seen | None = None,
    watch: Watch | None = None,
) -> Run:
    """Let an agent live in a world: it receives observations, and its actions are carried out.

    Args:
        world: a Gymnasium environment.
        agent: has `step(observation)`, which answers with an action; one that says `positions = True` is given the true
            position as well. Unless given, a new `Agent` with the world's `motions`.
        steps: observations that it takes in at most; fewer where the world ends the episode, or `watch` the run.
        seed: of the world's reset, and of the new agent.
        options: of the world's reset.
        begin: what the world shows now, if it is not to be reset: the `end` of a run before.
        watch: looks on.

    Raises:
        CogmapError: `steps` below 1.
        WorldError: no agent for a world without motions.
    """
    if steps < 1:
        raise CogmapError(f"run: steps is {steps}; use 1 or more")
    agent = agent or Agent(offered(world, World, "run without an agent").motions, seed=seed)
    observation, info = world.reset(seed=seed, options=options) if begin is None else begin
    kept = len(getattr(agent, "trace", ()))
    actions, truth, ended, stop = list[int](), list[Any](), False, False
    while len(actions) < steps and not (ended or stop):
        truth.append(info.get("place", info.get("position")))
        told = {**observation, "position": truth[-1]} if getattr(agent, "positions", False) else observation
        actions.append(agent.step(told))
        if watch is not None:
            stop = watch(Moment(len(actions) - 1, agent, world, observation, info, actions[-1])) is True
        observation, _, terminated, truncated, info = world.step(actions[-1])
        ended = terminated or truncated
    where, records = () if None in truth else tuple(truth), tuple(getattr(agent, "trace", ())[kept:])
    return Run(agent, tuple(actions), where, records, (observation, info), ended)

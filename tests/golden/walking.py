"""Carries a golden walk out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from .adapters import Facts, agent_of, facts_of, map_of, prefer, reloaded
from .worlds import Room, World, rooms_of, world_named

Event = tuple[Any, ...]


@dataclass(frozen=True, kw_only=True)
class Walk:
    """What a walk is.

    Attributes:
        world: its name, see `worlds`.
        steps: how many observations the agent takes in.
        seed: of the agent, of the start, and of the rooms that the agent is moved to.
        start: a room, or None for one at random.
        settings: of the agent, in names and numbers; see `adapters.agent_of`.
        events: what happens before a step's observation, each `(step, what, ...)`:
            `(5, "displace", room)`, where "known" and "unknown" stand for some room it was in or was never in;
            `(5, "close_room", room)`, `(5, "close_door", room, room)`, and `open_room`, `open_door`;
            `(5, "prefer", {...})` with `sights`, `positions` (relative to the start) and `imagined`;
            `(5, "see", label)`: this once it sees what is not there;
            `(5, "reload")`: it is saved, and another is loaded and walks on.
    """

    world: str
    steps: int
    seed: int = 0
    start: Room | None = None
    settings: dict[str, Any] = field(default_factory=dict[str, Any])
    events: Sequence[Event] = ()


def walked(walk: Walk) -> Iterator[Facts]:
    """The facts of every step, and last of all those of the map."""
    world = world_named(walk.world)
    world.reset(seed=walk.seed, options=None if walk.start is None else {"start": walk.start})
    agent, seen = agent_of(world.motions, walk.settings, seed=walk.seed), set[Room]()
    for step in range(walk.steps):
        lie: dict[str, Any] = {}
        for _, what, *args in (event for event in walk.events if event[0] == step):
            if what == "see":
                lie = {"sight": args[0]}
            elif what == "reload":
                agent = reloaded(agent)
            elif what == "prefer":
                prefer(agent, **args[0])
            else:
                _change(world, what, args, seen, seed=(walk.seed, step))
        room = world.position
        seen.add(room)
        action = agent.step({**world.observe(), **lie})
        assert action == agent.plan.action
        yield {"room": list(room), **facts_of(agent)}
        world.step(action)
    yield map_of(agent)


def _change(world: World, what: str, args: Sequence[Any], seen: set[Room], *, seed: tuple[int, int]) -> None:
    """Something happens in the world that the agent is not told."""
    if what == "displace":
        room = args[0] if isinstance(args[0], tuple) else _some_room(world, seen, known=args[0] == "known", seed=seed)
        world.displace(cast(Any, room))
    else:
        getattr(world, what)(*args)


def _some_room(world: World, seen: set[Room], *, known: bool, seed: tuple[int, int]) -> Room:
    """Another open room, one where the agent was or one where it never was."""
    not_these = {world.position, *world.closed_rooms}
    rooms = [room for room in rooms_of(world) if (room in seen) == known and room not in not_these]
    return rooms[int(np.random.default_rng(seed).integers(len(rooms)))]

"""The paper's study of remapping: on its way round the donut the agent meets a room that has been closed."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...agent import Agent, Settings
from ...worlds import Maze, Position, shortest_path
from ..pool import map_seeds
from ..records import mean
from ..session import Session, explored
from .donut_rows import CLOSED, CORNER, DOORS, GOAL, GOAL_ROOM, MAZE, DonutRow, DonutStep
from .imagined import imagined_paths

WEIGHT = 1.0
"""Log preference of the goal, in nats: as much weight on exploiting as on exploring."""
MOST = 40
"""Moves after which the agent has not found the goal."""
SETTINGS = Settings(look_ahead=12)
"""From the closed room the way round is 9 moves and a `stay`; 12 leaves some to spare."""


@dataclass(frozen=True, slots=True)
class DonutResult:
    """All agents, in the order of their seeds."""

    rows: tuple[DonutRow, ...]

    def to_dict(self) -> dict[str, Any]:
        """World, protocol, rows and summary as plain JSON values."""
        protocol = {"moved_to": list(CORNER), "goal": GOAL, "weight": WEIGHT, "closed": list(CLOSED), "max_moves": MOST}
        rows = [row.to_dict() for row in self.rows]
        return {"world": MAZE.name, "protocol": protocol, "rows": rows, "summary": self.summary()}

    def summary(self) -> dict[str, Any]:
        """Counts over the agents, and the mean moves of those that reached the goal."""
        moves = [row.moves for row in self.rows if row.moves is not None]
        return {
            "agents": len(self.rows),
            "explored": sum(row.steps_to_explore is not None for row in self.rows),
            "met_closed_room": sum(row.met for row in self.rows),
            "reached": len(moves),
            "detour": detour(),
            "in_detour": moves.count(detour()),
            "mean_moves": mean(moves),
            "second_tries": sum(row.second_tries for row in self.rows),
            "bumps": sum(row.bumps for row in self.rows),
        }


def donut_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> DonutResult:
    """Let each agent explore, close a room on its way to the goal, move it to the corner without a word, and watch.

    Agent i has the seed `seed` + i.

    Raises:
        CogmapError: `agents` below 1, or a negative seed.
    """
    one = partial(_agent, settings or SETTINGS)
    return DonutResult(tuple(map_seeds(one, runs=agents, seed=seed, executor=executor, on_done=on_done)))


def donut_lines(result: DonutResult) -> list[str]:
    """What the terminal shows."""
    from ..text import number

    summary = result.summary()
    total = summary["agents"]
    return [
        f"{summary['explored']} of {total} agents explored {MAZE.name}; moved to {CORNER}, sight {GOAL} preferred, "
        f"room {CLOSED} closed",
        f"met the closed room {summary['met_closed_room']}/{total}, reached the goal {summary['reached']}/{total}, "
        f"in {number(summary['mean_moves'])} moves (mean)",
        f"in exactly {summary['detour']} moves (there, back, and round) {summary['in_detour']}/{total}",
        f"second tries at the closed way {summary['second_tries']}, of them against its door {summary['bumps']}",
    ]


def detour() -> int:
    """Moves of who meets the closed room, turns back, and takes the shortest way round."""
    way_open = Maze(MAZE.name, {room: sight for room, sight in MAZE.sights.items() if room != CLOSED})
    met = DOORS["from the left"][0]
    return len(shortest_path(way_open, CORNER, met)) - 1 + len(shortest_path(way_open, met, GOAL_ROOM)) - 1


def _agent(settings: Settings, seed: int) -> DonutRow:
    session = explored("donut", MAZE, seed, settings=settings)
    if session.steps is None:
        return DonutRow(seed, session.start, None, (), False)
    session.world.displace(CORNER)
    session.world.close_room(CLOSED)
    steps, reached = _walk(session)
    return DonutRow(seed, session.start, session.steps, tuple(steps), reached)


def _walk(session: Session) -> tuple[list[DonutStep], bool]:
    agent, world = session.agent, session.world
    agent.prefer({GOAL: WEIGHT})
    steps: list[DonutStep] = []
    while True:
        observation = world.observe()
        action = agent.step(observation)
        steps.append(_step(agent, world.position, session.start))
        at_goal = action == agent.map.motions.stay and observation["sight"] == GOAL
        if at_goal or len(steps) > MOST:
            return steps, at_goal
        world.step(action)


def _step(agent: Agent, room: Position, start: Position) -> DonutStep:
    plan, names = agent.plan, agent.map.motions.names
    return DonutStep(
        room=room,
        action=names[plan.action],
        probability=float(plan.probability[plan.chosen]),
        first_action=dict(zip(names, plan.action_probability.tolist(), strict=True)),
        paths=imagined_paths(plan, agent.map, start),
        way_open={name: _open(agent, at, action, start) for name, (at, action) in DOORS.items()},
    )


def _open(agent: Agent, at: Position, action: str, start: Position) -> float:
    place = agent.map.place_at((at[0] - start[0], at[1] - start[1]))
    assert place is not None  # it has explored the maze
    return float(1.0 - agent.map.blocked(np.array([place]))[0, agent.map.motions.names.index(action)])

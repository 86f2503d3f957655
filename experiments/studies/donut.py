"""The paper's study of remapping: on its way round the donut the agent meets a room that has been closed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...agent import Agent, Settings
from ...views import BLUE, VERMILION
from ...worlds import MAZES, Label, Position, shortest_path
from .. import Session, default_steps, explored, mean, number
from .figures import draw_room, plot_ways
from .imagined import ImaginedPath, imagined_paths
from .study import Findings, Study, failed_seeds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MAZE = MAZES["donut"]
CORNER: Position = (0, 0)
GOAL_ROOM: Position = (2, 4)
GOAL: Label = MAZE.sights[GOAL_ROOM]
CLOSED: Position = (0, 2)
DOORS: dict[str, tuple[Position, str]] = {"from the left": ((0, 1), "right"), "from the right": ((0, 3), "left")}
"""The doors of the closed room: from where, and the action that leads in."""
WEIGHT = 1.0
"""Log preference of the goal, in nats: as much weight on exploiting as on exploring."""
MOST = 40
"""Moves after which the agent has not found the goal."""
FRAMES, ACROSS = 11, 4


@dataclass(frozen=True, slots=True)
class DonutStep:
    """One observation after the move.

    Attributes:
        room: where the agent is.
        action: what it chose, by name.
        probability: P(policy) of the chosen one.
        first_action: P(first action) by name.
        paths: what the policies imagine, the most probable path first.
        way_open: P(way open) of each door in `DOORS`, after this observation.
    """

    room: Position
    action: str
    probability: float
    first_action: dict[str, float]
    paths: tuple[ImaginedPath, ...]
    way_open: dict[str, float]


@dataclass(frozen=True, slots=True)
class DonutRow:
    """One agent.

    Attributes:
        seed: of its start and of all it does.
        start: the room where it began to explore.
        steps_to_explore: None where it gave up, and was not moved.
        reached: whether it chose to stay at the goal.
        moves: actions until then; None if never.
        met_closed_room: whether it came to a door of the closed room.
        second_tries: how often it took the closed way again from the corner, or tried to enter the closed room.
        bumps: how often it tried to enter the closed room.
        path: the rooms, from the corner on.
        steps: every observation after the move.
    """

    seed: int
    start: Position
    steps_to_explore: int | None
    reached: bool
    moves: int | None
    met_closed_room: bool
    second_tries: int
    bumps: int
    path: tuple[Position, ...]
    steps: tuple[DonutStep, ...]

    @classmethod
    def of(
        cls, seed: int, start: Position, explored: int | None, steps: Sequence[DonutStep] = (), reached: bool = False
    ) -> DonutRow:
        """What these steps come to."""
        path = tuple(step.room for step in steps)
        bumps = sum((step.room, step.action) in DOORS.values() for step in steps)
        again = sum(way == (CORNER, DOORS["from the left"][0]) for way in pairwise(path)) - 1
        moves = len(steps) - 1 if reached else None
        met = any(room in path for room, _ in DOORS.values())
        return cls(seed, start, explored, reached, moves, met, max(again, 0) + bumps, bumps, path, tuple(steps))


class Donut(Study[int, DonutRow]):
    """Each agent explores; a room on its way to the goal is closed, it is moved to the corner without a word."""

    name = "donut"
    title = "A way that was closed"
    question = (
        "On its way round the donut the agent meets a room that has been closed since it explored. Does it turn "
        "back at once and take the long way round?"
    )
    notes = ("The paper shows one agent; here every agent is counted, and one is drawn.",)
    settings = Settings(look_ahead=12)  # from the closed room the way round is 9 moves and a `stay`

    def run(self, task: int, settings: Settings) -> DonutRow:
        """The agent with this seed."""
        session = explored("donut", MAZE, settings=settings, seed=task, most=default_steps(MAZE))
        if session.steps is None:
            return DonutRow.of(task, session.start, None)
        session.world.displace(CORNER)
        session.world.close_room(CLOSED)
        return DonutRow.of(task, session.start, session.steps, *_walk(session))

    def summarise(self, rows: Sequence[DonutRow]) -> Findings:
        """Counts over the agents, and the frames of the first that explored."""
        done = [row for row in rows if row.steps_to_explore is not None]
        protocol = {"moved_to": CORNER, "goal": GOAL, "weight": WEIGHT, "closed": CLOSED, "max_moves": MOST}
        summary = _summary(rows)
        return Findings(
            json={"world": MAZE.name, "protocol": protocol, "rows": rows, "summary": summary},
            lines=_lines(summary),
            figures={"donut_frames": partial(_frames, done[0])} if done else {},
            failed=[
                *failed_seeds("did not explore the maze", rows, lambda row: row.steps_to_explore is None),
                *failed_seeds("did not reach the goal", rows, lambda row: row in done and not row.reached),
            ],
        )


def detour() -> int:
    """Moves of who meets the closed room, turns back, and takes the shortest way round."""
    met = DOORS["from the left"][0]
    ways = shortest_path(MAZE, CORNER, met), shortest_path(MAZE, met, GOAL_ROOM, closed=[CLOSED])
    return sum(len(way) - 1 for way in ways)


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


def _summary(rows: Sequence[DonutRow]) -> dict[str, Any]:
    moves = [row.moves for row in rows if row.moves is not None]
    return {
        "agents": len(rows),
        "explored": sum(row.steps_to_explore is not None for row in rows),
        "met_closed_room": sum(row.met_closed_room for row in rows),
        "reached": len(moves),
        "detour": detour(),
        "in_detour": moves.count(detour()),
        "mean_moves": mean(moves),
        "second_tries": sum(row.second_tries for row in rows),
        "bumps": sum(row.bumps for row in rows),
    }


def _lines(summary: dict[str, Any]) -> list[str]:
    total = summary["agents"]
    return [
        f"{summary['explored']} of {total} agents explored {MAZE.name}; moved to {CORNER}, sight {GOAL} preferred, "
        f"room {CLOSED} closed",
        f"met the closed room {summary['met_closed_room']}/{total}, reached the goal {summary['reached']}/{total}, "
        f"in {number(summary['mean_moves'])} moves (mean)",
        f"in exactly {summary['detour']} moves (there, back, and round) {summary['in_detour']}/{total}",
        f"second tries at the closed way {summary['second_tries']}, of them against its door {summary['bumps']}",
    ]


def _frames(row: DonutRow) -> Figure:
    from matplotlib.figure import Figure

    count = min(len(row.steps), FRAMES)
    shown = [round(frame * (len(row.steps) - 1) / max(count - 1, 1)) for frame in range(count)]
    down = -(-(count + 1) // ACROSS)
    figure = Figure(figsize=(14.0, 3.1 * down + 0.9), layout="constrained")
    title = (
        "Path so far (white), paths imagined (darker: more probable), the closed room (hatched), the goal (red square)"
    )
    figure.suptitle(title, fontsize=13)
    axes = figure.subplots(down, ACROSS, squeeze=False).ravel()
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax, number_ in zip(axes, shown, strict=False):
        step = row.steps[number_]
        plot_ways(ax, MAZE, closed=CLOSED, imagined=step.paths, way=row.path[: number_ + 1])
        draw_room(ax, GOAL_ROOM, facecolor="none", edgecolor="#cc0000", linewidth=3.0, zorder=2.2)
        ax.set_title(f"{number_ + 1}) {step.action}, P = {step.first_action[step.action]:.2f}", fontsize=12)
    _draw_way_open(axes[-1].inset_axes((0.12, 0.14, 0.86, 0.78)), row)  # its labels take no room from the frames
    return figure


def _draw_way_open(ax: Axes, row: DonutRow) -> None:
    frames = range(1, len(row.steps) + 1)
    for name, colour, style, marker in zip(DOORS, (BLUE, VERMILION), ("-", "--"), ("o", "s"), strict=True):
        values = [step.way_open[name] for step in row.steps]
        ax.plot(frames, values, label=name, color=colour, linestyle=style, marker=marker, markersize=5)
    ax.set_ylim(-0.05, 1.05)
    ax.set_xlabel("frame")
    ax.set_title("P(way open) into the closed room", fontsize=12)
    ax.legend(frameon=False, loc="center right")


STUDY = Donut()

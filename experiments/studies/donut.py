"""The paper's study of remapping: on its way round the donut the agent meets a room that has been closed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from ...agent import Settings
from ...model import CognitiveMap
from ...views import BLUE, VERMILION
from ...worlds import MAZES, Label, Position, shortest_path
from .. import Moment, Session, explored, mean, number
from .figures import Figure, ImaginedPath, Look, draw_room, imagined_paths, panels, plot_ways
from .study import Findings, Study, failed_seeds

MAZE = MAZES["donut"]
CORNER: Position = (0, 0)
GOAL_ROOM: Position = (2, 4)
GOAL: Label = MAZE.sights[GOAL_ROOM]
CLOSED: Position = (0, 2)
DOORS: dict[str, tuple[Position, str]] = {"from the left": ((0, 1), "right"), "from the right": ((0, 3), "left")}
"""The doors of the closed room: from where, and the action that leads in."""
DETOUR = len(shortest_path(MAZE, (0, 1), GOAL_ROOM, closed=[CLOSED]))
"""Moves of who meets the closed room one room from the corner, turns back, and takes the shortest way round."""
WEIGHT = 1.0  # log preference of the goal, in nats: as much weight on exploiting as on exploring
MOST = 40  # moves after which the agent has not found the goal
FRAMES, ACROSS = 11, 4


@dataclass(frozen=True, slots=True)
class DonutStep:
    """One observation after the move."""

    room: Position  # where the agent is
    action: str  # what it chose
    probability: float  # P(policy) of the chosen one
    first_action: dict[str, float]  # P(first action)
    paths: tuple[ImaginedPath, ...]  # what the policies imagine, the most probable path first
    way_open: dict[str, float]  # P(way open) of each of `DOORS`, after this observation


@dataclass(frozen=True, slots=True)
class DonutRow:
    """One agent."""

    seed: int
    start: Position  # the room where it began to explore
    steps_to_explore: int | None  # None where it gave up, and was not moved
    reached: bool  # whether it chose to stay at the goal
    moves: int | None  # until then
    met_closed_room: bool  # whether it came to a door of the closed room
    second_tries: int  # how often it took the closed way again from the corner, or bumped
    bumps: int  # how often it tried to enter the closed room
    path: tuple[Position, ...]  # from the corner on
    steps: tuple[DonutStep, ...]  # after the move

    @classmethod
    def of(cls, seed: int, start: Position, explored: int | None, steps: Sequence[DonutStep]) -> DonutRow:
        """What these steps come to."""
        path = tuple(step.room for step in steps)
        reached = bool(steps) and (path[-1], steps[-1].action) == (GOAL_ROOM, "stay")
        bumps = sum((step.room, step.action) in DOORS.values() for step in steps)
        again = sum(way == (CORNER, DOORS["from the left"][0]) for way in pairwise(path)) - 1
        met, moves = any(room in path for room, _ in DOORS.values()), len(steps) - 1 if reached else None
        return cls(seed, start, explored, reached, moves, met, max(again, 0) + bumps, bumps, path, tuple(steps))


class Donut(Study[int, DonutRow]):
    """A way that was closed

    On its way round the donut the agent meets a room that has been closed since it explored. Does it turn
    back at once and take the long way round?
    """

    name = "donut"
    notes = ("The paper shows one agent; here every agent is counted, and one is drawn.",)
    settings = Settings(look_ahead=12)  # from the closed room the way round is 9 moves and a `stay`

    def run(self, task: int, settings: Settings) -> DonutRow:
        """Let it explore, move it to the corner without a word, and watch it."""
        session = explored("donut", MAZE, task, settings=settings)
        steps: list[DonutStep] = []

        def note(moment: Moment) -> bool:
            steps.append(_step(session))
            return (session.place, steps[-1].action) == (GOAL_ROOM, "stay")

        if session.steps is not None:
            session.world.displace(CORNER)
            session.world.close_room(CLOSED)
            session.agent.prefer({GOAL: WEIGHT})
            session.run(MOST + 1, note)
        return DonutRow.of(task, session.start, session.steps, steps)

    def summarise(self, rows: Sequence[DonutRow]) -> Findings:
        done = [row for row in rows if row.steps_to_explore is not None]
        protocol = {"moved_to": CORNER, "goal": GOAL, "weight": WEIGHT, "closed": CLOSED, "max_moves": MOST}
        summary = _summary(rows)
        json = {"world": MAZE.name, "protocol": protocol, "rows": rows, "summary": summary}
        figures = {"donut_frames": partial(_frames, done[0])} if done else {}
        failed = failed_seeds("did not explore the maze", rows, lambda row: row.steps_to_explore is None)
        failed += failed_seeds("did not reach the goal", rows, lambda row: row in done and not row.reached)
        return Findings(json, _lines(summary), figures, failed=failed)


def _step(session: Session) -> DonutStep:
    map_, plan = session.agent.map, session.agent.plan
    names = map_.motions.names
    doors = {name: (session.truth.place(map_, at), names.index(action)) for name, (at, action) in DOORS.items()}
    return DonutStep(
        room=session.place,
        action=names[plan.action],
        probability=float(plan.probability[plan.chosen]),
        first_action=dict(zip(names, plan.action_probability.tolist(), strict=True)),
        paths=imagined_paths(plan, map_, session.start),
        way_open={name: _open(map_, at, way) for name, (at, way) in doors.items()},
    )


def _open(map_: CognitiveMap, at: int | None, way: int) -> float:
    """P(open) of a way; nothing is known of one of a place that the map does not have."""
    return 0.5 if at is None else float(1.0 - map_.blocked(np.array([at]))[0, way])


def _summary(rows: Sequence[DonutRow]) -> dict[str, Any]:
    moves = [row.moves for row in rows if row.moves is not None]
    return {
        "agents": len(rows),
        "explored": sum(row.steps_to_explore is not None for row in rows),
        "met_closed_room": sum(row.met_closed_room for row in rows),
        "reached": len(moves),
        "detour": DETOUR,
        "in_detour": moves.count(DETOUR),
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
    count = min(len(row.steps), FRAMES)
    shown, down = np.linspace(0, len(row.steps) - 1, count).round().astype(int), -(-(count + 1) // ACROSS)
    legend = "Path so far (white), paths imagined (darker: more probable), the closed room (hatched), "
    figure, axes = panels(f"{legend}the goal (red square)", (down, ACROSS), (14.0, 3.1 * down + 0.9))
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax, frame in zip(axes, shown.tolist(), strict=False):
        step = row.steps[frame]
        plot_ways(ax, MAZE, closed=CLOSED, imagined=step.paths, way=row.path[: frame + 1])
        draw_room(ax, GOAL_ROOM, facecolor="none", edgecolor="red", linewidth=3.0, zorder=2.2)
        ax.set_title(f"{frame + 1}) {step.action}, P = {step.first_action[step.action]:.2f}", fontsize=12)
    ax, frames = axes[-1].inset_axes((0.12, 0.14, 0.86, 0.78)), range(1, len(row.steps) + 1)  # labels take no room
    looks: list[Look] = [{"color": BLUE, "marker": "o"}, {"color": VERMILION, "marker": "s", "linestyle": "--"}]
    for name, look in zip(DOORS, looks, strict=True):
        ax.plot(frames, [step.way_open[name] for step in row.steps], label=name, markersize=5, **look)
    ax.set(ylim=(-0.05, 1.05), xlabel="frame")
    ax.set_title("P(way open) into the closed room", fontsize=12)
    ax.legend(frameon=False, loc="center right")
    return figure

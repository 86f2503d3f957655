"""The paper's study of localisation: put at the foot of an aliased T, where does the agent think it is?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...agent import Agent, Settings
from ...worlds import MAZES, Label, MazeEnv, Position, shortest_path
from ..knowledge import Truth
from ..pool import map_seeds
from ..records import mean, std
from ..session import Session, explored
from .imagined import imagined_paths, room_of
from .intervals import Interval, bootstrap
from .localisation_rows import CANDIDATE, CONDITIONS, Condition, LocalisationRow, LocalisationStep, LocalisationTrial

MAZE = MAZES["t_maze_alias"]
FOOT: Position = (3, 2)
GOAL: Label = 0
WEIGHT = 3.0
"""Log preference of the goal, in nats."""
MOST = 40
"""Moves after which the agent has not found the goal."""
SETTINGS = Settings()


@dataclass(frozen=True, slots=True)
class LocalisationResult:
    """All agents, in the order of their seeds."""

    rows: tuple[LocalisationRow, ...]

    def trials(self, condition: str) -> list[LocalisationTrial]:
        """The trials under one condition."""
        return [trial for row in self.rows for trial in row.trials if trial.condition == condition]

    def to_dict(self) -> dict[str, Any]:
        """World, protocol, rows and summary as plain JSON values."""
        return {
            "world": MAZE.name,
            "protocol": {
                "moved_to": list(FOOT),
                "goal": GOAL,
                "weight": WEIGHT,
                "candidate": CANDIDATE,
                "max_moves": MOST,
                "conditions": {condition.name: condition.text for condition in CONDITIONS},
            },
            "rows": [row.to_dict() for row in self.rows],
            "summary": self.summary(),
        }

    def summary(self) -> dict[str, Any]:
        """Counts and means over the agents that explored, by condition; None where there are none."""
        shortest = min(len(shortest_path(MAZE, FOOT, room)) - 1 for room in MAZE.rooms if MAZE.sights[room] == GOAL)
        return {
            "agents": len(self.rows),
            "explored": sum(row.steps_to_explore is not None for row in self.rows),
            "shortest": shortest,
            "conditions": {condition.name: _summary(self.trials(condition.name)) for condition in CONDITIONS},
        }


def localisation_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
) -> LocalisationResult:
    """Let each agent explore the maze, move it to the foot of the T, and watch what it believes on its way to the goal.

    Every condition starts from a copy of the same agent. Agent i has the seed `seed` + i.

    Raises:
        CogmapError: `agents` below 1, or a negative seed.
    """
    one = partial(_agent, settings or SETTINGS)
    return LocalisationResult(tuple(map_seeds(one, runs=agents, seed=seed, executor=executor, on_done=on_done)))


def localisation_lines(result: LocalisationResult) -> list[str]:
    """What the terminal shows."""
    from ..text import number, spread

    summary = result.summary()
    lines = [
        f"{summary['explored']} of {summary['agents']} agents explored {MAZE.name}; moved to {FOOT}, sight {GOAL} "
        f"preferred, {summary['shortest']} moves away"
    ]
    for condition in CONDITIONS:
        part = summary["conditions"][condition.name]
        first = ", ".join(f"{part[name]} {name}" for name in ("split", "right", "wrong"))
        lines += [
            f"{condition.text}{' (the paper)' if condition.name == 'told_sights' else ''}:",
            f"  after the first sight {first}; {number(part['mean_candidates_first'])} rooms to choose from (mean)",
            f"  certain of the right room after {spread(part, 'steps_to_localise')} steps "
            f"({part['localised']}/{part['trials']}), "
            f"certain but wrong at {number(part['mean_steps_certain_but_wrong'])}; "
            f"at the goal after {number(part['mean_moves'])} moves ({part['reached']}/{part['trials']}), "
            f"map intact {part['map_intact']}/{part['trials']}",
        ]
    return lines


def by_step(trials: Sequence[LocalisationTrial], name: str) -> list[Interval]:
    """The mean of a figure at each step, with its interval; who is done keeps the last value."""
    longest = max((len(trial.steps) for trial in trials), default=0)
    steps = [[trial.steps[min(t, len(trial.steps) - 1)] for trial in trials] for t in range(longest)]
    means = [bootstrap([float(getattr(step, name)) for step in at]) for at in steps]
    return [interval for interval in means if interval is not None]


def _summary(trials: Sequence[LocalisationTrial]) -> dict[str, Any]:
    found = [trial.steps_to_localise for trial in trials if trial.steps_to_localise is not None]
    summary: dict[str, Any] = {"trials": len(trials)}
    summary |= {name: sum(trial.first == name for trial in trials) for name in ("split", "right", "wrong")}
    summary |= {
        "mean_candidates_first": mean([trial.steps[0].candidates for trial in trials]),
        "localised": len(found),
        "mean_steps_to_localise": mean(found),
        "std_steps_to_localise": std(found),
        "mean_steps_certain_but_wrong": mean([trial.steps_certain_but_wrong for trial in trials]),
        "reached": sum(trial.reached for trial in trials),
        "map_intact": sum(trial.map_intact for trial in trials),
        "mean_moves": mean([len(trial.steps) - 1 for trial in trials if trial.reached]),
    }
    for name in ("entropy", "candidates"):
        summary[f"{name}_by_step"] = [interval.to_dict() for interval in by_step(trials, name)]
    return summary


def _agent(settings: Settings, seed: int) -> LocalisationRow:
    session = explored("localisation", MAZE, seed, settings=settings)
    expected = session.world.position
    done = session.steps is not None
    trials = tuple(_trial(session, condition) for condition in CONDITIONS) if done else ()
    return LocalisationRow(seed, session.start, session.steps, expected, trials)


def _trial(session: Session, condition: Condition) -> LocalisationTrial:
    settings = session.agent.settings
    floor = settings.priors.door_floor if condition.doors else 0.5  # every door as likely open as blocked
    moved = 1.0 if condition.told else settings.filter.displacement
    agent = _with(session.agent, floor, moved)
    agent.prefer({GOAL: WEIGHT})
    world = MazeEnv(session.world.maze)
    world.reset(options={"start": FOOT})
    steps: list[LocalisationStep] = []
    while True:
        observation = world.observe()
        action = agent.step(observation)
        steps.append(_step(agent, world, session.start))
        at_goal = action == agent.map.motions.stay and observation["sight"] == GOAL
        if at_goal or len(steps) > MOST:
            break
        if len(steps) == 1 and condition.told:
            agent = _with(agent, floor, settings.filter.displacement)
        world.step(action)
    right = [t for t, step in enumerate(steps) if step.certain and step.right]
    wrong = sum(step.certain and not step.right for step in steps)
    intact = Truth(MAZE, session.start).learned(agent.map)
    return LocalisationTrial(condition.name, tuple(steps), at_goal, right[0] if right else None, wrong, intact)


def _with(agent: Agent, door_floor: float, displacement: float) -> Agent:
    """A copy of the agent that believes in doors and in being moved as told here."""
    header, arrays = agent.state()
    header["settings"]["priors"]["door_floor"] = door_floor
    header["settings"]["filter"]["displacement"] = displacement
    return Agent.from_state(header, arrays)


def _step(agent: Agent, world: MazeEnv, start: Position) -> LocalisationStep:
    belief, map_ = agent.belief, agent.map
    q = np.array(list(belief.places.values()))
    posterior = [
        (place, room, belief.places.get(place, 0.0))
        for place in map_.visited_places.tolist()
        if (room := room_of(map_, place, start)) is not None
    ]
    return LocalisationStep(
        room=world.position,
        sight=world.maze.sights[world.position],
        posterior=tuple(sorted(posterior, key=lambda part: part[1])),
        entropy=max(0.0, float(-(q * np.log(q)).sum())),
        certainty=belief.certainty,
        certain=agent.certain,
        right=room_of(map_, belief.place, start) == world.position,
        candidates=int((q >= CANDIDATE).sum()),
        moved=belief.moved,
        first_action=dict(zip(map_.motions.names, agent.plan.action_probability.tolist(), strict=True)),
        paths=imagined_paths(agent.plan, map_, start),
    )

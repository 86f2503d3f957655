"""The paper's study of remapping: three blocks of runs in Tolman's maze, by the routes that were taken."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ...agent import Settings
from ..pool import map_tasks
from .shares import Share, wilson
from .tolman_maze import (
    GOAL,
    MAZE,
    RUNS,
    SETTINGS,
    START,
    STEPS,
    TolmanRun,
    agent_run,
    check_counts,
    new_agent,
    new_world,
    set_closed,
)
from .tolman_rows import BLOCKS, PAPER, PAPER_RUNS, KnobSetting, TolmanCounts, TolmanRow, named

KNOB = "information_weight"
KNOB_VALUES = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
"""How much finding out is worth beside the goal: the balance of exploring and exploiting."""
KNOB_AGENTS = 4
"""At most, for each value of the knob."""


@dataclass(frozen=True, slots=True)
class TolmanResult:
    """All agents in the order of their seeds, and a few with every value of the knob.

    Attributes:
        rows: the agents of the study.
        settings: theirs.
        knob: by value; the one of the study holds all its agents.
    """

    rows: tuple[TolmanRow, ...]
    settings: Settings
    knob: tuple[KnobSetting, ...]

    @property
    def counts(self) -> tuple[TolmanCounts, ...]:
        """By block."""
        return tuple(TolmanCounts.of(self.rows, block) for block in range(len(BLOCKS)))

    @property
    def nearest(self) -> KnobSetting:
        """The value of the knob that is nearest to the paper's table."""
        return min(self.knob, key=lambda setting: setting.distance)

    def to_dict(self) -> dict[str, Any]:
        """World, protocol, rows, summary, knob and the paper's table as plain JSON values."""
        closed = {name: None if room is None else list(room) for name, room in BLOCKS.items()}
        paper = {name: named([wilson(count, PAPER_RUNS) for count in PAPER[name]]) for name in BLOCKS}
        return {
            "world": MAZE.name,
            "protocol": {"start": list(START), "goal": list(GOAL), "steps_a_run": STEPS, "closed": closed},
            "rows": [row.to_dict() for row in self.rows],
            "summary": {name: part.to_dict() for name, part in zip(BLOCKS, self.counts, strict=True)},
            "paper": paper,
            "knob": {
                "name": KNOB,
                "settings": [setting.to_dict() for setting in self.knob],
                "nearest_to_paper": self.nearest.value,
            },
        }


def tolman_study(
    *,
    agents: int,
    seed: int = 0,
    settings: Settings | None = None,
    executor: Executor | None = None,
    on_done: Callable[[], None] | None = None,
    runs: int = RUNS,
    knob: Sequence[float] = KNOB_VALUES,
) -> TolmanResult:
    """Let each agent run three blocks with one memory: no obstacle, room A closed, room B closed.

    Args:
        agents: how many; agent i has the seed `seed` + i.
        seed: of the first.
        settings: of the agents; `SETTINGS` unless given.
        executor: where the agents run, in this process if None; the result does not depend on it.
        on_done: called `agents` times while the work goes on.
        runs: in a block.
        knob: values of `KNOB` that a few agents are tried with as well.

    Raises:
        CogmapError: `agents` or `runs` below 1, a negative seed, or a bad value of the knob.
    """
    settings = settings or SETTINGS
    check_counts("tolman", agents=agents, runs=runs)
    own = float(getattr(settings, KNOB))
    others = [replace(settings, **{KNOB: value}) for value in sorted(set(knob) - {own})]
    few = range(seed, seed + min(agents, KNOB_AGENTS))
    tasks = [(settings, number) for number in range(seed, seed + agents)]
    tasks += [(other, number) for other in others for number in few]
    every = _in_step(on_done, len(tasks), agents)
    rows = map_tasks(partial(_agent, runs), tasks, executor=executor, on_done=every)
    tried = [_knob_setting(own, rows[:agents])]
    for place, other in enumerate(others):
        first = agents + place * len(few)
        tried.append(_knob_setting(getattr(other, KNOB), rows[first : first + len(few)]))
    return TolmanResult(tuple(rows[:agents]), settings, tuple(sorted(tried, key=lambda setting: setting.value)))


def tolman_lines(result: TolmanResult) -> list[str]:
    """What the terminal shows."""
    lines: list[str] = []
    for name, part in zip(BLOCKS, result.counts, strict=True):
        first = "attempts" if name == "B closed" else "reached"
        lines += [
            f"{name}: {part.goal.count} of {part.runs} runs reached the goal{_why(part.missed)}",
            f"  reached by route 1, 2, 3   {_counted(part.shares('reached'))}",
            f"  set out on route 1, 2, 3   {_counted(part.shares('attempted'))}",
            f"  the paper ({first})".ljust(29) + _counted([wilson(count, PAPER_RUNS) for count in PAPER[name]]),
        ]
        if BLOCKS[name] is not None:
            lines.append(f"  once it was met, {part.after[1]} agents tried route 2 next and {part.after[2]} route 3")
    near = result.nearest
    tried = ", ".join(f"{setting.value:g}: {setting.distance:.2f}" for setting in result.knob)
    lines.append(f"{KNOB} nearest to the paper's table: {near.value:g} (total variation by value: {tried})")
    return lines


def _agent(runs: int, task: tuple[Settings, int]) -> TolmanRow:
    settings, seed = task
    agent, world = new_agent(settings, seed), new_world()
    blocks: list[tuple[TolmanRun, ...]] = []
    for closed in BLOCKS.values():
        set_closed(world, room=closed)
        blocks.append(tuple(agent_run(agent, world) for _ in range(runs)))
    return TolmanRow(seed, tuple(blocks), len(agent.map.places))


def _knob_setting(value: float, rows: Sequence[TolmanRow]) -> KnobSetting:
    return KnobSetting(value, len(rows), tuple(TolmanCounts.of(rows, block) for block in range(len(BLOCKS))))


def _in_step(on_done: Callable[[], None] | None, tasks: int, calls: int) -> Callable[[], None] | None:
    """Calls `on_done` `calls` times, evenly over the tasks."""
    if on_done is None:
        return None
    done = 0

    def one_more() -> None:
        nonlocal done
        done += 1
        if done * calls // tasks > (done - 1) * calls // tasks:
            on_done()

    return one_more


def _counted(shares: Sequence[Share]) -> str:
    return "  ".join(f"{s.count:3d} ({s.share:4.0%}, {s.low:.0%} to {s.high:.0%})" for s in shares)


def _why(missed: dict[str, int]) -> str:
    reasons = [f"{count} {reason}" for reason, count in missed.items() if count]
    return f"; missed: {', '.join(reasons)}" if reasons else ""

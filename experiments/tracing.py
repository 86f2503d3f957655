"""Walks recorded as traces, which `cogmap replay` shows."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..agent import Agent
from ..model.errors import CogmapError
from ..views import Recorder
from ..worlds import Label, Maze, MazeEnv
from .exploring import Watch
from .walkers import Walker


def check_trace(agent: str, path: Path | None) -> None:
    """Refuse to record an agent that believes nothing.

    Raises:
        CogmapError: `path` is given, and the agent is not `cogmap`.
    """
    if path is not None and agent != "cogmap":
        raise CogmapError(f"agent {agent} leaves no trace of beliefs; leave --trace out, or use --agent cogmap")


def recorder_of(maze: Maze, *, title: str, goals: Iterable[Label] = ()) -> Recorder:
    """A recorder of a walk in this maze."""
    return Recorder(maze.sights, title=title, goals=goals)


def recording(recorder: Recorder) -> Watch:
    """Looks on and records."""

    def watch(walker: Walker, world: MazeEnv, _: int) -> None:
        if isinstance(walker, Agent):
            recorder.add(
                walker, position=world.position, closed_rooms=world.closed_rooms, closed_doors=world.closed_doors
            )

    return watch

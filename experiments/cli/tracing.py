"""Walks recorded as traces, which `cogmap replay` shows."""

from pathlib import Path
from typing import Any

from ...agent import Agent
from ...model import CogmapError
from ...views import Recorder
from ...worlds import MOST_WALKED, Chart, place_of
from ..running import Moment


def check_trace(agent: str, path: Path | None) -> None:
    """Refuse to record an agent that believes nothing."""
    if path is not None and agent != "cogmap":
        raise CogmapError(f"agent {agent} leaves no trace of beliefs; leave --trace out, or use --agent cogmap")


class Tracing:
    """Looks on and records, if there is a file for it."""

    def __init__(self, path: Path | None, chart: Chart, *, title: str, goals: tuple[Any, ...] = ()) -> None:
        if path is not None and len(chart.places) > MOST_WALKED:
            raise CogmapError(f"trace: {chart.name!r} has more than {MOST_WALKED} places; leave --trace out")
        self._path = path
        self._recorder = None if path is None else Recorder(chart, title=title, goals=goals)

    def __call__(self, moment: Moment) -> None:
        """Record a choice."""
        if self._recorder is not None and isinstance(moment.agent, Agent):
            world = moment.world.unwrapped
            closed = {name: getattr(world, name, ()) for name in ("closed_rooms", "closed_doors")}
            self._recorder.add(
                moment.agent, place=place_of(moment.info), pixels=getattr(world, "pixels", None), **closed
            )

    def save(self) -> None:
        """Write the file."""
        if self._path is not None and self._recorder is not None:
            self._recorder.save(self._path)

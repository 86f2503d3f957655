"""A walk as it was believed, step by step: recorded beside the agent, kept in a file, shown by `views.replay`."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any

from ..agent import Agent, StepRecord
from ..model.errors import CogmapError
from ..model.labels import decode, encode
from . import recording_file
from .recording_check import check
from .recording_map import KNOWN, MapPicture, MapWatch
from .recording_plan import plan_frame
from .recording_window import Window, window_frames

DIGITS = 4
MOST_PLACES = 8
"""Places of the belief that are kept, the most probable ones."""

Room = Sequence[int]


@dataclass(frozen=True, slots=True)
class Recording:
    """A recorded walk.

    Attributes:
        data: the content of the file, as JSON values.
    """

    data: dict[str, Any]

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Recording:
        """The recording that `save` wrote.

        Raises:
            CogmapError: no such file, no recording, truncated, damaged, or of another schema.
        """
        data = recording_file.read(path)
        check(data, where=str(path))
        return cls(data)

    def save(self, path: str | PathLike[str]) -> None:
        """Write it as JSON, packed where the name ends in .gz; the file is replaced whole, or not at all.

        Raises:
            CogmapError: it cannot be written.
        """
        recording_file.write(self.data, path)

    @property
    def frames(self) -> list[dict[str, Any]]:
        """The steps, in order."""
        return self.data["frames"]

    @property
    def actions(self) -> list[str]:
        """Names of the actions."""
        return self.data["motions"]["names"]

    @property
    def sights(self) -> list[Hashable]:
        """Labels of the sights, by number."""
        return [decode(label) for label in self.data["sights"]]

    def maps(self) -> Iterator[MapPicture]:
        """The map after each step: always the same object, changed in place."""
        picture = MapPicture()
        for frame in self.frames:
            picture.apply(frame["map"])
            yield picture

    def __len__(self) -> int:
        return len(self.frames)


class Recorder:
    """Records an agent; call `add` after every `agent.step`.

    Args:
        sights: label of each true room by (row, column), where they are to be shown.
        title: what the walk is called.
        goals: labels of the preferred sights, to be marked.
    """

    def __init__(
        self,
        sights: Mapping[tuple[int, int], Hashable] | None = None,
        *,
        title: str = "",
        goals: Iterable[Hashable] = (),
    ) -> None:
        self._maze = None if sights is None else [[*map(int, room), encode(label)] for room, label in sights.items()]
        self._title = str(title)
        self._goals = [encode(label) for label in goals]
        self._agent: Agent | None = None
        self._frames: list[dict[str, Any]] = []
        self._map = MapWatch()
        self._windows: list[Window] = []
        self._origin: list[int] | None = None

    def __len__(self) -> int:
        return len(self._frames)

    def add(
        self,
        agent: Agent,
        *,
        position: Room | None = None,
        closed_rooms: Iterable[Room] = (),
        closed_doors: Iterable[tuple[Room, Room]] = (),
    ) -> None:
        """Record the step that the agent has just made, before its action is carried out.

        Args:
            agent: always the same.
            position: the true room it is in, for showing only.
            closed_rooms: rooms closed at present.
            closed_doors: doors closed by themselves, as pairs of rooms.

        Raises:
            CogmapError: another agent, one that has made no step since the last call, or a label that JSON has not.
        """
        record = self._fresh(agent)
        encode(record.sight)  # refuses now what could not be written later
        frame = _senses(agent, record) | _belief(record)
        frame["map"] = self._map.delta(agent)
        frame["plan"] = plan_frame(agent.plan)
        self._windows.append(agent.window)
        if position is not None:
            frame["at"] = [int(part) for part in position]
            if record.step == 0:  # the agent calls the room where it wakes the origin
                self._origin = frame["at"]
        if rooms := sorted([int(x) for x in room] for room in closed_rooms):
            frame["closed_rooms"] = rooms
        if doors := sorted([[int(x) for x in room] for room in door] for door in closed_doors):
            frame["closed_doors"] = doors
        self._frames.append(frame)

    def _fresh(self, agent: Agent) -> StepRecord:
        if self._agent is None:
            self._agent = agent
        if agent is not self._agent:
            raise CogmapError("recorder: this is another agent; use a recorder of its own for each")
        if not agent.trace:
            raise CogmapError("recorder: the agent has made no step; call add after agent.step")
        if self._frames and agent.trace[-1].step <= self._frames[-1]["step"]:
            raise CogmapError(f"recorder: step {agent.trace[-1].step} is recorded already; call add once a step")
        return agent.trace[-1]

    def recording(self) -> Recording:
        """All that was recorded so far.

        Raises:
            CogmapError: nothing was.
        """
        if self._agent is None or not self._frames:
            raise CogmapError("recorder: nothing was recorded; call add after agent.step")
        map_, settings = self._agent.map, self._agent.settings
        return Recording(
            {
                "format": recording_file.FORMAT,
                "schema": recording_file.SCHEMA,
                "title": self._title,
                "motions": {
                    "names": list(map_.motions.names),
                    "displacements": [list(vector) for vector in map_.motions.displacements],
                    "stay": map_.motions.stay,
                },
                "settings": settings.to_dict(),
                "terms": list(self._agent.plan.expected_free_energy.names),
                "known": list(KNOWN),
                "sights": [encode(label) for label in map_.sights],
                "maze": self._maze,
                "origin": self._origin,
                "goals": self._goals,
                "frames": [
                    {**frame, "window": window}
                    for frame, window in zip(self._frames, window_frames(map_, self._windows), strict=True)
                ],
            }
        )

    def save(self, path: str | PathLike[str]) -> None:
        """`recording().save(path)`."""
        self.recording().save(path)


def _senses(agent: Agent, record: StepRecord) -> dict[str, Any]:
    return {
        "step": record.step,
        "sight": agent.map.sights.index(record.sight),
        "open": [int(is_open) for is_open in record.open],
        "grown": [
            [event.kind, event.index, event.source, event.action] for event in record.grown if event.kind != "time"
        ],
        "retracted": record.retracted,
    }


def _belief(record: StepRecord) -> dict[str, Any]:
    places = [[place, round(q, DIGITS)] for place, q in list(record.places.items())[:MOST_PLACES]]
    return {
        "belief": places,
        "rest": round(max(0.0, 1.0 - sum(q for _, q in places)), DIGITS),
        "certain": record.certain,
        **{
            name: round(float(getattr(record, name)), DIGITS)
            for name in ("certainty", "doubt", "moved", "free_energy", "complexity", "accuracy", "evidence")
        },
    }

"""One agent among the places of a chart: what mazes and graphs have in common."""

import operator
from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium as gym
from gymnasium import spaces

from .closures import Closures, Door
from .errors import WorldError
from .maze import Maze
from .motions import Motions
from .protocol import Chart, Observation, Place

Action = Any

_OPTIONS = frozenset({"start", "keep_closed"})


class NoMazeError(WorldError, AttributeError):
    """The world is no maze; `hasattr(world, "maze")` is false."""


class PlaceEnv(gym.Env[Observation, Action]):
    """A world whose true map is a chart. The reward is 0.0, and an episode never ends.

    An action whose way is shut, or is none, leaves the agent where it is. Subclasses say what is sensed (`sense`) and
    what is told of a move (`moved`).

    Args:
        chart: the true map.
        motions: the actions.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}  # pyright: ignore[reportIncompatibleVariableOverride]

    truth = "place"
    """The key of `info` that has the true place."""

    def __init__(self, chart: Chart, motions: Motions) -> None:
        self.chart = chart
        self.motions = motions
        self._closures = Closures(chart)
        self._place: Place | None = None

    def sense(self, place: Place, exits: Mapping[Any, Place | None]) -> Observation:
        """What the agent senses at `place`, from which each action leads as `exits` says."""
        raise NotImplementedError

    def moved(self, place: Place, way: Any, ahead: Place | None) -> dict[str, Any]:
        """Note that the agent took `way` from `place`, and return what `info` tells of it."""
        return {}

    @property
    def maze(self) -> Maze:
        """The maze, where the chart is one. Raises WorldError: it is none."""
        if not isinstance(self.chart, Maze):
            raise NoMazeError(f"{self.chart.name!r} is no maze, and a maze is needed here; give one")
        return self.chart

    @property
    def place(self) -> Any:
        """The true place of the agent: for experiments, never for agents.

        Raises:
            WorldError: the world was never reset.
        """
        if self._place is None:
            raise WorldError(f"nobody is in {self.chart.name!r} yet; call reset() first")
        return self._place

    @property
    def closed_rooms(self) -> frozenset[Any]:
        """The rooms closed at present."""
        return frozenset(self._closures.rooms)

    @property
    def closed_doors(self) -> frozenset[Door]:
        """The doors closed by themselves at present, as pairs in order (row-major in a maze)."""
        return frozenset(self._closures.doors)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Put the agent in a room and open everything that was closed.

        Args:
            seed: seeds `np_random`, which draws the start.
            options: `start`, a room, instead of a random open one; `keep_closed=True` leaves closed rooms and doors
                as they are.

        Raises:
            WorldError: unknown option, a start that is no room or is closed, no open room to start in.
        """
        options = options or {}
        if unknown := sorted(str(key) for key in options.keys() - _OPTIONS):
            raise WorldError(f"unknown reset option {', '.join(unknown)}; use 'start' and 'keep_closed'")
        closures = self._closures if options.get("keep_closed") else Closures(self.chart)
        start = options.get("start")
        room = None if start is None else closures.enterable(start)
        super().reset(seed=seed)
        self._place = self._random_room(closures) if room is None else room
        self._closures = closures
        return self.observe(), {self.truth: self.place}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Take one action: (observation, 0.0, False, False, info).

        Raises:
            WorldError: no such action, or the world was never reset.
        """
        place = self.place
        exits = self._closures.exits(place)
        way = self._way(action, tuple(exits))
        ahead = exits.get(way)
        if ahead is not None:
            self._place = ahead
        told = self.moved(place, way, ahead)
        return self.observe(), 0.0, False, False, {self.truth: self._place, **told}

    def observe(self) -> Observation:
        """What the agent senses now, without acting. Raises WorldError: the world was never reset."""
        return self.sense(self.place, self._closures.exits(self.place))

    def displace(self, place: Place) -> Observation:
        """Move the agent to `place` without a word, and return what it senses there.

        Raises:
            WorldError: no such room, the room is closed, or the world was never reset.
        """
        _ = self.place
        self._place = self._closures.enterable(place)
        return self.observe()

    def close_room(self, room: Place) -> None:
        """Close every way into and out of `room`; it shows from the next rooms only.

        Raises:
            WorldError: no such room, or the agent is in it.
        """
        found = self.chart.find(room)
        if found == self._place:
            raise WorldError(f"room {found} cannot be closed with the agent inside; move it first")
        self._closures.rooms.add(found)

    def open_room(self, room: Place) -> None:
        """Open `room` again; doors closed by themselves stay closed. Raises WorldError: no such room."""
        self._closures.rooms.discard(self.chart.find(room))

    def close_door(self, a: Place, b: Place) -> None:
        """Close the door between rooms `a` and `b`, both ways. Raises WorldError: no such door."""
        self._closures.doors.add(self._closures.door(a, b))

    def open_door(self, a: Place, b: Place) -> None:
        """Open the door between rooms `a` and `b` again. Raises WorldError: no such door."""
        self._closures.doors.discard(self._closures.door(a, b))

    def _way(self, action: Any, ways: tuple[Any, ...]) -> Any:
        """What the action is called here; None of an action that other places have."""
        count = self.action_space.n if isinstance(self.action_space, spaces.Discrete) else len(ways)
        try:
            index = operator.index(action)
        except TypeError:
            index = -1
        if not 0 <= index < count:
            named = ", ".join(map(str, ways[:8])) + (", ..." if len(ways) > 8 else "")
            raise WorldError(f"no action {action!r}; use 0 to {len(ways) - 1} ({named})")
        return ways[index] if index < len(ways) else None

    def _random_room(self, closures: Closures) -> Place:
        rooms = self.chart.places
        if closures.rooms:
            rooms = tuple(room for room in rooms if room not in closures.rooms)
        if not rooms:
            raise WorldError(f"every room of {self.chart.name!r} is closed; open one, or reset without keep_closed")
        return rooms[int(self.np_random.integers(len(rooms)))]

"""A maze to live in, as a Gymnasium environment."""

from __future__ import annotations

import operator
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .closures import Closures
from .drawing import draw
from .errors import WorldError
from .maze import Door, Maze, Position
from .motions import GRID, Motions
from .protocol import Observation

Action = int | np.int64

_OPTIONS = frozenset({"start", "keep_closed"})


class MazeEnv(gym.Env[Observation, Action]):
    """One agent in one maze.

    An observation is `{"sight": label, "open": bool array (5,)}`, one flag an action in the order of
    `motions.names`; `stay` is always open. The true position is in `info["position"]` alone. The reward
    is 0.0 and an episode never ends. An action into a wall or a closed door leaves the agent in its room.

    Args:
        maze: the layout.
        render_mode: `"rgb_array"` or None.

    Raises:
        WorldError: unknown render mode.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"], "render_fps": 4}  # pyright: ignore[reportIncompatibleVariableOverride]

    motions: Motions = GRID

    def __init__(self, maze: Maze, *, render_mode: str | None = None) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise WorldError(f"unknown render mode {render_mode!r}; use 'rgb_array' or None")
        self.maze = maze
        self.render_mode = render_mode
        self.action_space = spaces.Discrete(len(self.motions.names))
        self.observation_space = spaces.Dict(
            {"sight": _sight_space(maze), "open": spaces.MultiBinary(len(self.motions.names))}
        )
        self._closures = Closures(maze)
        self._position: Position | None = None

    @property
    def position(self) -> Position:
        """The true (row, column) of the agent: for experiments, never for agents.

        Raises:
            WorldError: the world was never reset.
        """
        if self._position is None:
            raise WorldError(f"nobody is in {self.maze.name!r} yet; call reset() first")
        return self._position

    @property
    def place(self) -> Position:
        """The same: worlds that are no mazes have a place as well."""
        return self.position

    @property
    def chart(self) -> Maze:
        """The true map: the maze."""
        return self.maze

    @property
    def closed_rooms(self) -> frozenset[Position]:
        """The rooms closed at present."""
        return frozenset(self._closures.rooms)

    @property
    def closed_doors(self) -> frozenset[Door]:
        """The doors closed by themselves at present, as pairs in row-major order."""
        return frozenset(self._closures.doors)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Put the agent in a room and open everything that was closed.

        Args:
            seed: seeds `np_random`, which draws the start.
            options: `start`, a room (row, column), instead of a random open one; `keep_closed=True`
                leaves closed rooms and doors as they are.

        Raises:
            WorldError: unknown option, a start that is no room or is closed, no open room to start in.
        """
        options = options or {}
        if unknown := sorted(str(key) for key in options.keys() - _OPTIONS):
            raise WorldError(f"unknown reset option {', '.join(unknown)}; use 'start' and 'keep_closed'")
        closures = self._closures if options.get("keep_closed") else Closures(self.maze)
        start = options.get("start")
        room = None if start is None else closures.enterable(start)
        super().reset(seed=seed)
        self._position = self._random_room(closures) if room is None else room
        self._closures = closures
        return self.observe(), self._info()

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Take one action: (observation, 0.0, False, False, info).

        Raises:
            WorldError: no such action, or the world was never reset.
        """
        ahead = self._closures.exits(self.position)[self._action(action)]
        if ahead is not None:
            self._position = ahead
        return self.observe(), 0.0, False, False, self._info()

    def observe(self) -> Observation:
        """What the agent senses now, without acting.

        Raises:
            WorldError: the world was never reset.
        """
        room = self.position
        is_open: NDArray[np.bool_] = np.array([ahead is not None for ahead in self._closures.exits(room)])
        return {"sight": self.maze.sights[room], "open": is_open}

    def displace(self, room: Position) -> Observation:
        """Move the agent to `room` without a word, and return what it senses there.

        Raises:
            WorldError: no such room, the room is closed, or the world was never reset.
        """
        _ = self.position
        self._position = self._closures.enterable(room)
        return self.observe()

    def close_room(self, room: Position) -> None:
        """Close every door of `room`; it shows from the next rooms only.

        Raises:
            WorldError: no such room, or the agent is in it.
        """
        if self._closures.room(room) == self._position:
            raise WorldError(f"room {self._position} cannot be closed with the agent inside; move it first")
        self._closures.rooms.add(self._closures.room(room))

    def open_room(self, room: Position) -> None:
        """Open `room` again; doors closed by themselves stay closed.

        Raises:
            WorldError: no such room.
        """
        self._closures.rooms.discard(self._closures.room(room))

    def close_door(self, a: Position, b: Position) -> None:
        """Close the door between rooms `a` and `b`, both ways.

        Raises:
            WorldError: no such door.
        """
        self._closures.doors.add(self._closures.door(a, b))

    def open_door(self, a: Position, b: Position) -> None:
        """Open the door between rooms `a` and `b` again.

        Raises:
            WorldError: no such door.
        """
        self._closures.doors.discard(self._closures.door(a, b))

    def render(self) -> NDArray[np.uint8] | None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """The maze as an RGB image, uint8 (height, width, 3); None without a render mode."""
        if self.render_mode is None:
            return None
        return draw(self.maze, agent=self._position, rooms=self.closed_rooms, doors=self.closed_doors)

    def _action(self, action: Any) -> int:
        count = len(self.motions.names)
        try:
            index = operator.index(action)
        except TypeError:
            index = -1
        if not 0 <= index < count:
            raise WorldError(f"no action {action!r}; use 0 to {count - 1} ({', '.join(self.motions.names)})")
        return index

    def _random_room(self, closures: Closures) -> Position:
        rooms = self.maze.rooms
        if closures.rooms:
            rooms = tuple(room for room in rooms if room not in closures.rooms)
        if not rooms:
            raise WorldError(f"every room of {self.maze.name!r} is closed; open one, or reset without keep_closed")
        return rooms[int(self.np_random.integers(len(rooms)))]

    def _info(self) -> dict[str, Any]:
        return {"position": self.position}


def _sight_space(maze: Maze) -> spaces.Space[Any]:
    labels = maze.sights.values()
    words = [label for label in labels if isinstance(label, str)]
    if words:
        return spaces.Text(max(map(len, words)), charset=frozenset("".join(words)))
    return spaces.Discrete(max(label for label in labels if isinstance(label, int)) + 1)

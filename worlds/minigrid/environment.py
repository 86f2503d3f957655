"""A room maze as a MiniGrid environment: coloured rooms, corridors with closed doors at random places."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from gymnasium import spaces
from minigrid.core.constants import COLOR_NAMES
from minigrid.core.grid import Grid
from minigrid.core.mission import MissionSpace
from minigrid.core.world_object import Door, Key, Wall
from minigrid.minigrid_env import MiniGridEnv
from numpy.typing import NDArray

from ..errors import WorldError
from ..maze import Maze, Position
from .floorplan import Floorplan, Tile, draw_floorplan, size_of
from .geometry import Geometry
from .palette import WHITE, floors_of
from .tally import Tally
from .tiles import TILE, ColouredFloor, paint

VIEWS = ("symbolic", "rgb")
STEPS_A_TILE = 18  # low-level steps a tile after which the authors end a run

_OPTIONS = frozenset({"start", "heading"})


class RoomsEnv(MiniGridEnv):
    """A maze of rooms in tiles. Whoever acts in it sees the seven by seven tiles before it, no more.

    Observations are MiniGrid's: `image`, `direction`, `mission`; the `direction` is a compass, and nothing of this
    library reads it. `info` has the truth: `position`, the room (that of the last floor, while in a passage); `tile`
    and `heading`; `tiles_seen`, a share; `white`, whether the agent stands on the white tile. Reward is 1.0 where it
    does; an episode ends at the limit of steps alone.

    Args:
        maze: the rooms; each sight is a colour of the floor.
        geometry: sizes, passages and doors; drawn anew at each reset with a seed of its own.
        view: `"symbolic"` or `"rgb"`.
        white: the room in which one tile of the floor is white; None of no room.
        max_steps: `STEPS_A_TILE` a tile of the maze unless given.
        render_mode: `"rgb_array"`, `"human"` or None.

    Raises:
        WorldError: more sights than colours, no such view, no such room, or a geometry that cannot be.
    """

    def __init__(
        self,
        maze: Maze,
        *,
        geometry: Geometry | None = None,
        view: str = "symbolic",
        white: Position | None = None,
        max_steps: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.maze, self.geometry, self.view = maze, geometry or Geometry(), view
        self.floors = floors_of(maze.name, maze.sights.values())
        self.white = None if white is None else maze.find(white)
        if view not in VIEWS:
            raise WorldError(f"view is {view!r}; use {' or '.join(VIEWS)}")
        if render_mode not in (None, *MiniGridEnv.metadata["render_modes"]):
            raise WorldError(f"unknown render mode {render_mode!r}; use 'rgb_array', 'human' or None")
        draw_floorplan(maze, self.geometry, np.random.default_rng(0))  # are so many doors there to lock
        width, height = size_of(maze, self.geometry)
        super().__init__(
            MissionSpace(mission_func=_mission),
            width=width,
            height=height,
            max_steps=max_steps or STEPS_A_TILE * width * height,
            render_mode=render_mode,
        )
        if view == "rgb":
            side = self.agent_view_size * TILE
            image = spaces.Box(0, 255, (side, side, 3), np.uint8)
            told: Any = self.observation_space
            self.observation_space = spaces.Dict({**told.spaces, "image": image})
        self.plan: Floorplan
        self.tally: Tally

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Draw a floor plan, close all doors, and put the agent somewhere in a room.

        Args:
            seed: of the plan, of the start and of the heading.
            options: `start`, a room, instead of a random one; `heading` 0 to 3 (right, down, left, up).

        Raises:
            WorldError: an unknown option, or a start that is no room.
        """
        options = options or {}
        if unknown := sorted(str(key) for key in options.keys() - _OPTIONS):
            raise WorldError(f"unknown reset option {', '.join(unknown)}; use 'start' and 'heading'")
        start = options.get("start")
        self._start = None if start is None else self.maze.find(start)
        self._heading = options.get("heading")
        if self._heading not in (None, 0, 1, 2, 3):
            raise WorldError(f"heading is {self._heading!r}; use 0 to 3: right, down, left, up")
        observation, _ = super().reset(seed=seed)
        self.tally = Tally(self.plan)
        return observation, self._told()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """As MiniGrid; standing on the white tile is rewarded, and ends nothing."""
        observation, _, terminated, truncated, _ = super().step(action)
        told = self._told()
        return observation, float(told["white"]), terminated, truncated, told

    def gen_obs(self) -> Any:
        """The view, in pixels where they are asked for."""
        observation: Any = super().gen_obs()
        self.symbols: NDArray[np.uint8] = observation["image"]
        if self.view == "rgb":
            observation["image"] = paint(self.symbols)
        return observation

    def displace(self, room: Position, *, heading: int | None = None) -> Any:
        """Put the agent somewhere in `room` without a word, and return what it sees there.

        Args:
            room: where.
            heading: which way it then looks; drawn unless given.

        Raises:
            WorldError: no such room.
        """
        self._put(self.maze.find(room), heading)
        observation = self.gen_obs()
        self._told()
        return observation

    @property
    def position(self) -> Position:
        """The true room of the agent: for experiments, never for agents."""
        return self.tally.room

    @property
    def shut_doors(self) -> frozenset[Tile]:
        """The tiles of the doors that are closed at present."""
        doors = ((passage.door, self.grid.get(*passage.door)) for passage in self.plan.passages)
        return frozenset(tile for tile, door in doors if isinstance(door, Door) and not door.is_open)

    @property
    def goal_tiles(self) -> Mapping[Any, frozenset[Tile]]:
        """Where the goal of each name is: the floors of each sight, and the white tile as `"white"`."""
        goals: dict[Any, frozenset[Tile]] = {}
        for room, sight in self.maze.sights.items():
            goals[sight] = goals.get(sight, frozenset()) | frozenset(self.plan.floor(room))
        return goals if self._white_tile is None else {**goals, "white": frozenset([self._white_tile])}

    def _told(self) -> dict[str, Any]:
        tile: Tile = (int(self.agent_pos[0]), int(self.agent_pos[1]))
        self.tally.note(tile, int(self.agent_dir), self.symbols, step=self.step_count)
        if tile == self._white_tile:
            self.tally.white.append(self.step_count)
        return {
            "position": self.tally.room,
            "tile": tile,
            "heading": int(self.agent_dir),
            "tiles_seen": self.tally.share,
            "white": tile == self._white_tile,
        }

    def _gen_grid(self, width: int, height: int) -> None:
        plan = self.plan = draw_floorplan(self.maze, self.geometry, self.np_random)
        grid = self.grid = Grid(width, height)
        for i in range(width * height):
            grid.grid[i] = Wall()
        for room, sight in self.maze.sights.items():
            for tile in plan.floor(room):
                grid.set(*tile, ColouredFloor(self.floors[sight]))
        colours = iter(self.np_random.permutation(COLOR_NAMES).tolist())
        for passage in plan.passages:
            for tile in passage.tiles:
                grid.set(*tile, None)
            colour = next(colours) if passage.locked else "grey"
            grid.set(*passage.door, Door(colour, is_locked=passage.locked))
            if passage.locked:
                grid.set(*self._free_tile(self._any_room()), Key(colour))
        self._white_tile: Tile | None = None
        if self.white is not None:
            self._white_tile = self._free_tile(self.white)
            grid.set(*self._white_tile, ColouredFloor(WHITE))
        self._put(self._any_room() if self._start is None else self._start, self._heading)
        self.mission = _mission()

    def _put(self, room: Position, heading: int | None) -> None:
        self.agent_pos = self._free_tile(room)
        self.agent_dir = int(self.np_random.integers(4)) if heading is None else heading

    def _any_room(self) -> Position:
        return self.maze.rooms[int(self.np_random.integers(len(self.maze.rooms)))]

    def _free_tile(self, room: Position) -> Tile:
        """A tile of the plain floor of a room: no key, not the white one."""
        plain = self.floors[self.maze.sights[room]]
        tiles = [t for t in self.plan.floor(room) if getattr(self.grid.get(*t), "number", None) == plain]
        return tiles[int(self.np_random.integers(len(tiles)))]


def rooms_env(
    maze: Maze | str,
    *,
    view: str = "symbolic",
    white: Position | None = None,
    max_steps: int | None = None,
    render_mode: str | None = None,
    **geometry: Any,
) -> RoomsEnv:
    """The environment of a maze, or of the name of a built-in one; the rest are fields of `Geometry`.

    Raises:
        WorldError: no such maze, or what `RoomsEnv` raises.
    """
    from ..builtin import MAZES

    if isinstance(maze, str):
        if maze not in MAZES:
            raise WorldError(f"no maze is called {maze!r}; use one of {', '.join(MAZES)}")
        maze = MAZES[maze]
    try:
        measured = replace(Geometry(), **geometry)
    except TypeError as error:
        raise WorldError(f"geometry: {error}; its fields are least, most, passage, door and locked") from error
    return RoomsEnv(maze, geometry=measured, view=view, white=white, max_steps=max_steps, render_mode=render_mode)


def _mission() -> str:
    return "find your way"

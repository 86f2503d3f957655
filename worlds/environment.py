"""A maze to live in, as a Gymnasium environment."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .base import PlaceEnv
from .drawing import draw
from .errors import WorldError
from .maze import Maze, Position
from .motions import GRID, Motions
from .protocol import Observation
from .spaces import label_space


class MazeEnv(PlaceEnv):
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

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"], "render_fps": 4}

    motions: Motions = GRID
    truth = "position"

    def __init__(self, maze: Maze, *, render_mode: str | None = None) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise WorldError(f"unknown render mode {render_mode!r}; use 'rgb_array' or None")
        super().__init__(maze, GRID)
        self.render_mode = render_mode
        self.action_space = spaces.Discrete(len(GRID.names))
        self.observation_space = spaces.Dict(
            {"sight": label_space(maze.sights.values()), "open": spaces.MultiBinary(len(GRID.names))}
        )

    @property
    def position(self) -> Position:
        """The true (row, column) of the agent: for experiments, never for agents.

        Raises:
            WorldError: the world was never reset.
        """
        return self.place

    def sense(self, place: Position, exits: Mapping[str, Position | None]) -> Observation:
        """The sight, and a flag an action."""
        is_open: NDArray[np.bool_] = np.array([ahead is not None for ahead in exits.values()])
        return {"sight": self.maze.sights[place], "open": is_open}

    def render(self) -> NDArray[np.uint8] | None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """The maze as an RGB image, uint8 (height, width, 3); None without a render mode."""
        if self.render_mode is None:
            return None
        return draw(self.maze, agent=self._place, rooms=self.closed_rooms, doors=self.closed_doors)

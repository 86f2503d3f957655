"""A body in its world, as a world for the level above."""

from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces

from ..model import UNSEEN
from ..worlds import GRID, Maze, Motions, Observation, Place, WorldError
from ..worlds import minigrid as mg
from .minigrid import MiniGridBody
from .protocol import Percept

GOAL = "white"
"""What a room with a white tile is called."""

_NAMES = ("right", "down", "left", "up")  # the ways of a body by their numbers, as the actions of mazes are called


class EmbodiedWorld(gym.Env[Observation, Any]):
    """A MiniGrid room maze as the upper-level agent sees it: actions are ways, observations are percepts.

    The body sees the view alone. Its frame, as it is once it has looked round, is called as the map is drawn, which
    changes names and nothing else. The truth is in `info`: `position`, `low_level_steps`, `tiles_seen`.

    Args:
        env: a `RoomsEnv`, in wrappers or not.
        glance: see `MiniGridBody`.
        turned: whether a silent move turns the body as well, so that its frame is turned from then on.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}  # pyright: ignore[reportIncompatibleVariableOverride]
    motions: Motions = GRID

    def __init__(self, env: gym.Env[Any, Any], *, glance: int = 0, turned: bool = False) -> None:
        self.env, self.turned = env, turned
        self.rooms: Any = env.unwrapped
        self.chart = _chart(self.rooms)
        self.body = MiniGridBody(env, glance=glance)
        self.action_space = spaces.Discrete(len(GRID.names))
        self._labels: dict[int, Any] = {number: self._named(label) for label, number in self.rooms.floors.items()}
        if self.rooms.white is not None:
            self._labels[mg.WHITE] = GOAL
        seen = _Labels(tuple(self._labels.values()))
        self.observation_space = spaces.Dict({"sight": seen, "open": spaces.MultiBinary(len(GRID.names))})
        self._turn, self._percept = 0, Percept(None)

    @property
    def maze(self) -> Maze:
        """The rooms, by what the body tells of them."""
        return self.chart

    @property
    def place(self) -> Place:
        """The true room of the agent: for experiments, never for agents."""
        return self.rooms.position

    position = place

    @property
    def low_level_steps(self) -> int:
        """Low-level steps since the last reset."""
        return self.body.steps

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Wake up somewhere; the options are those of `RoomsEnv`."""
        super().reset(seed=seed)
        seen, _ = self.env.reset(seed=seed, options=options)
        self.body.begin(seen)
        self._percept = self.body.wake()
        self._turn = (int(self.rooms.agent_dir) - self.body.pose[2]) % 4
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Go through a way; who stays looks at what was not looked at yet. Raises WorldError: no such action."""
        if action not in range(len(GRID.names)):
            raise WorldError(f"no action {action!r}; use 0 to 4 ({', '.join(GRID.names)})")
        name, before = GRID.names[int(action)], self.body.reward
        body = self.body
        self._percept = body.settle(mg.WHITE) if name == "stay" else body.perform(self._way(name))
        return self._observation(), body.reward - before, False, body.ended, self._info()

    def observe(self) -> Observation:
        """What the agent senses now, without acting."""
        seen = {**self._observation()}
        seen.pop("outcome", None)
        return seen

    def displace(self, place: Place) -> Observation:
        """Move the agent into a room without a word, and return what it senses there."""
        heading = None if self.turned else int(self.rooms.agent_dir)
        self.body.glimpse(self.env.get_wrapper_attr("displace")(place, heading=heading))
        self._percept = self.body.look(range(4))
        return self.observe()

    def least_to_cover(self) -> int | None:
        """The fewest low-level steps in which every room can be entered; None where that is out of reach."""
        return mg.covering_low_steps(self.rooms.plan, self.rooms.tally.path[0])

    def least_to(self, goal: Any) -> int | None:
        """The fewest low-level steps from here to the goal of that name, doors as they are; None of no goal."""
        goals = {self._named(label): tiles for label, tiles in self.rooms.goal_tiles.items()}
        if goal not in goals:
            return None
        return mg.low_steps_between(self.rooms.plan, self.rooms.tally.path[-1], goals[goal], shut=self.rooms.shut_doors)

    def low_level_steps_to_goal(self, begin: int) -> int:
        """Low-level steps since `begin`: until the white tile was stood on, or until now."""
        white = [step for step in self.rooms.tally.white if step >= begin]
        return (white[0] if white else self.body.steps) - begin

    @property
    def pixels(self) -> Any:
        """`[56, 56, 3]` what the body saw last, as it looks; for replays."""
        image = self.body.image
        return image if len(image) > 7 else mg.paint(image)

    def scene(self, *, pixels: int = 16) -> tuple[Any, Any]:
        """The world from above, `[height, width, 3]`, and the path so far, `[n, 2]` in its pixels: for pictures."""
        rooms = self.rooms
        image = np.asarray(rooms.grid.render(pixels, (-1, -1))).astype(np.uint8)
        return image, (np.array([pose[:2] for pose in rooms.tally.path], dtype=np.float64) + 0.5) * pixels - 0.5

    def _named(self, label: Any) -> Any:
        return label if self.rooms.white is None else str(label)

    def _way(self, name: str) -> int:
        return (_NAMES.index(name) - self._turn) % 4

    def _observation(self) -> Observation:
        percept = self._percept
        ways = {_NAMES[(way + self._turn) % 4]: is_open for way, is_open in percept.ways.items()}
        seen: Observation = {"sight": self._label(percept.sight), "open": [ways.get(n, True) for n in GRID.names]}
        costs = {_NAMES[(way + self._turn) % 4]: self.body.cost(way) for way in range(4)}
        seen = {**seen, "costs": [costs.get(n) for n in GRID.names]}
        return seen if percept.outcome is None else {**seen, "outcome": percept.outcome, "cost": percept.steps}

    def _label(self, sight: Any) -> Any:
        if sight is None:
            return UNSEEN
        if isinstance(sight, Mapping):
            likely = {self._labels[n]: p for n, p in sight.items() if n in self._labels}
            return likely or UNSEEN
        return self._labels.get(sight, UNSEEN)

    def _info(self) -> dict[str, Any]:
        return {"position": self.place, "low_level_steps": self.body.steps, "tiles_seen": self.rooms.tally.share}


def embodied(
    maze: Maze | str,
    *,
    view: str = "symbolic",
    white: Place | None = None,
    noise: Mapping[str, float] | None = None,
    turned: bool = False,
    glance: int = 1,
    **geometry: Any,
) -> EmbodiedWorld:
    """A room maze in MiniGrid with a body in it.

    Args:
        maze: a maze, or the name of a built-in one.
        view: what the body sees, `"symbolic"` or `"rgb"`.
        white: the room in which one tile is white; its sight is then `"white"`, and all sights are words.
        noise: rates of `Unsteady`: pixels, gain, slips.
        turned, glance: see `EmbodiedWorld`.
        geometry: fields of `Geometry`.

    Raises:
        WorldError: MiniGrid is not installed, or what `rooms_env` and `Unsteady` raise.
    """
    env: Any = mg.rooms_env(maze, view=view, white=white, **geometry)
    if noise:
        env = mg.Unsteady(env, **noise)
    return EmbodiedWorld(env, glance=glance, turned=turned)


def _chart(rooms: Any) -> Maze:
    """The true map by what the body tells: a white tile is what its room is known by."""
    maze: Maze = rooms.maze
    if rooms.white is None:
        return maze
    sights = {room: GOAL if room == rooms.white else str(label) for room, label in maze.sights.items()}
    return Maze(maze.name, sights, maze.walls)


class _Labels(spaces.Space[Any]):
    """One of some labels, likelihoods of some, or nothing made out."""

    def __init__(self, labels: tuple[Any, ...]) -> None:
        super().__init__()
        self.labels = labels

    def sample(self, mask: Any = None, probability: Any = None) -> Any:
        return self.labels[int(self.np_random.integers(len(self.labels)))]

    def contains(self, x: Any) -> bool:
        return x is UNSEEN or set(x if isinstance(x, Mapping) else [x]) <= set(self.labels)

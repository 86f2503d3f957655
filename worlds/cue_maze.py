"""The T maze with a cue: a reward is in one of two arms, and a cue tells in which."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium as gym
from gymnasium import spaces

from .errors import WorldError
from .motions import Motions
from .protocol import Observation, Place

if TYPE_CHECKING:
    import networkx as nx

ARMS = ("left", "right")
PLACES = ("centre", "left", "right", "cue")
REWARD, NOTHING = "reward", "nothing"
_OTHER = {"left": "right", "right": "left"}


class CueMaze(gym.Env[Observation, Any]):
    """The T maze with a cue. A trial begins in the centre; centre and cue lead everywhere, the arms nowhere.

    In which arm the reward is, the context, is drawn at each reset; each look at the cue points there as often as it is
    right. Who enters the right arm is rewarded, once. After Friston et al., Cognitive Neuroscience 2015, 6, 187.

    Args:
        right: how often the cue is right, from 0.5.
        moves: of a trial.

    Raises:
        WorldError: a number out of range.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}  # pyright: ignore[reportIncompatibleVariableOverride]
    motions = Motions((*PLACES, "stay"))

    def __init__(self, *, right: float = 1.0, moves: int = 2) -> None:
        if isinstance(right, bool) or not isinstance(right, int | float) or not 0.5 <= right <= 1.0:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"cue maze: right is {right!r}; the cue is right in a share of 0.5 to 1")
        if isinstance(moves, bool) or not isinstance(moves, int) or moves < 1:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"cue maze: moves is {moves!r}; use 1 or more")
        self.right, self.moves = float(right), moves
        self.action_space = spaces.Discrete(len(self.motions.names))
        ways = spaces.MultiBinary(len(self.motions.names))
        self.observation_space = spaces.Dict({"sight": spaces.Text(20), "open": ways})
        self._place, self._moved, self.context = PLACES[0], 0, ARMS[0]

    @property
    def place(self) -> Place:
        """Where the agent truly is."""
        return self._place

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin a trial in the centre."""
        super().reset(seed=seed)
        self.context = ARMS[int(self.np_random.integers(2))]
        self._place, self._moved = PLACES[0], 0
        return self._sensed(), self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Go there, if one can; the trial ends after so many moves. Raises WorldError: no such action."""
        if action not in range(len(self.motions.names)):
            raise WorldError(f"no action {action!r}; use 0 to 4 ({', '.join(self.motions.names)})")
        name = self.motions.names[int(action)]
        goes = name != "stay" and self._place not in ARMS
        self._place = name if goes else self._place
        self._moved += 1
        seen = self._sensed()
        return seen, float(goes and seen["sight"] == REWARD), self._moved >= self.moves, False, self._info()

    def _sensed(self) -> Observation:
        here, sight = self._place, self._place
        if here in ARMS:
            sight = REWARD if here == self.context else NOTHING
        elif here == "cue":
            told = self.context if self.np_random.random() < self.right else _OTHER[self.context]
            sight = points(told)
        ways = [here not in ARMS and name != here for name in PLACES]
        return {"sight": sight, "open": [*ways, True]}

    def _info(self) -> dict[str, Any]:
        return {"place": self._place, "context": self.context}

    def map(self) -> nx.MultiDiGraph[Any]:
        """What is known of it before a trial, in two contexts: the `map` of an `Agent`, with `pose=NoPose()`."""
        import networkx as nx

        graph: Any = nx.MultiDiGraph(contexts=list(ARMS))
        graph.add_node("centre", sight="centre")
        shares = {k: {points(k): self.right, points(_OTHER[k]): 1.0 - self.right} for k in ARMS}
        told = {k: {label: p for label, p in shares[k].items() if p} for k in ARMS}
        graph.add_node("cue", contexts={k: {"sight": told[k]} for k in ARMS})
        for arm in ARMS:
            graph.add_node(arm, contexts={k: {"sight": REWARD if k == arm else NOTHING} for k in ARMS})
        for here in ("centre", "cue"):
            for there in PLACES:
                if there != here:
                    graph.add_edge(here, there, way=there)
        return graph


def points(arm: str) -> str:
    """What the cue shows that points to an arm."""
    return f"points {arm}"


def best_cue_action(place: str, seen: int, *, right: float, moves: int) -> str:
    """The action that brings the highest expected reward in the remaining moves, exactly.

    Args:
        place: where the agent is.
        seen: how often the cue pointed left, less how often it pointed right.
        right: how often it is right.
        moves: that are left.
    """
    return max((value, name) for name, value in _worth(place, seen, right, moves).items())[1]


def _worth(place: str, seen: int, right: float, moves: int) -> dict[str, float]:
    """Expected rewards of each action, the best to follow."""
    if place in ARMS:
        return {"stay": 0.0}
    worth: dict[str, float] = {}
    for name in (*PLACES, "stay"):
        there = place if name == "stay" else name
        if there in ARMS:
            worth[name] = _probability(there, seen, right)
        elif there == "cue":
            p = _probability("left", seen, right)
            left = p * right + (1.0 - p) * (1.0 - right)
            worth[name] = left * _value(there, seen + 1, right, moves - 1)
            worth[name] += (1.0 - left) * _value(there, seen - 1, right, moves - 1)
        else:
            worth[name] = _value(there, seen, right, moves - 1)
    return worth


def _value(place: str, seen: int, right: float, moves: int) -> float:
    return max(_worth(place, seen, right, moves).values()) if moves else 0.0


def _probability(arm: str, seen: int, right: float) -> float:
    """P(the reward is in this arm)."""
    towards = seen if arm == "left" else -seen
    if right == 1.0:
        return 0.5 if not towards else float(towards > 0)
    return 1.0 / (1.0 + ((1.0 - right) / right) ** towards)

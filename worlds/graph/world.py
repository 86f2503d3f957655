"""A graph to live in, as a Gymnasium environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

from ..base import PlaceEnv
from ..protocol import Observation
from ..sights import Sights
from ..spaces import PerWay, label_space
from .build import BEARINGS, build
from .layout import Layout
from .raw import RawGraph

if TYPE_CHECKING:
    import networkx as nx

_FARTHEST = 1e9  # a displacement beyond is none


class GraphWorld(PlaceEnv):
    """One agent on a graph.

    Where the layout has actions of the whole world (`motions.local` is false), an observation is
    `{"sight": label, "open": bool array}`, one flag an action. Where ways belong to the place, it is
    `{"sight": label, "ways": {label of a way: open}}`: action 0 stays, action i + 1 takes the i-th way listed. With
    several sensors each has a key of its own instead of `sight`. Where bearings are told there is `"bearings": {way:
    degrees}`, where displacements are told `"displacement"`, what the last step measured along each axis, and where
    lengths are told `"lengths": {way: how long}`. The true place is in `info["place"]` alone, the length of the last
    move in `info["cost"]`.

    Args:
        layout: the places and ways; see `read_graph` and `from_networkx`.
    """

    def __init__(self, layout: Layout) -> None:
        super().__init__(layout, layout.motions)
        self.layout = layout
        most = int(np.diff(layout.first).max()) if layout.motions.local else 0
        self.action_space = spaces.Discrete(len(layout.motions.names) + most)
        self.observation_space = spaces.Dict(_spaces(layout))
        self._displacement = np.zeros(2 if layout.coordinates is None else layout.coordinates.shape[1])

    @classmethod
    def from_networkx(
        cls,
        graph: nx.Graph[Any],
        *,
        name: str | None = None,
        sights: Sights | None = None,
        seed: int = 0,
        sensors: Sequence[str] | None = None,
        pose: str | None = None,
        strong: bool = True,
    ) -> GraphWorld:
        """The world of a networkx graph: any, directed or not, multigraph or not.

        Nodes have a `sight` and perhaps a `position`, edges perhaps a `way` (a name), a `bearing` and a `length`.

        Args:
            graph: the graph; `graph.graph["motions"]`, if there, gives the displacement of each way.
            name: what the world is called; that of the graph unless given.
            sights: for nodes that have none: `"distinct"`, `"ways"` or a number of sights at random.
            seed: of sights at random.
            sensors: names of the attributes of nodes that are sensed, if they are others than `sight`.
            pose: what the agent is told of a pose, one of `POSES`; the most that is known unless given.
            strong: refuse a graph in which some place cannot be reached from some other.

        Raises:
            WorldError: the graph cannot be a world.
        """
        called = name or str(graph.graph.get("name") or "graph")
        raw = RawGraph.of(graph, name=called, source=called)
        return cls(build(raw, sights=sights, seed=seed, sensors=sensors, pose=pose, strong=strong))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Put the agent at a place, as `PlaceEnv.reset` says."""
        before, self._displacement = self._displacement, np.zeros_like(self._displacement)
        try:
            return super().reset(seed=seed, options=options)
        except ValueError:
            self._displacement = before
            raise

    def sense(self, place: Any, exits: Mapping[Any, Any | None]) -> Observation:
        """The label of each sensor, and what is seen of the ways."""
        layout = self.layout
        seen = layout.sights[place]
        labels = (seen,) if len(layout.sensors) == 1 else seen
        observation: Observation = dict(zip(layout.sensors, labels, strict=True))
        if layout.motions.local:
            observation["ways"] = {way: other is not None for way, other in exits.items() if way != "stay"}
        else:
            observation["open"] = np.array([other is not None for other in exits.values()])
        if layout.pose in BEARINGS:
            observation["bearings"] = layout.told_bearings(place)
        if layout.pose == "lengths":
            observation["lengths"] = layout.told_lengths(place)
        if layout.pose in ("displacement", "lengths"):
            observation["displacement"] = self._displacement.copy()
        return observation

    def moved(self, place: Any, way: Any, ahead: Any | None) -> dict[str, Any]:
        """Measure the move that was just made."""
        passed = way if ahead is not None else None
        if self.layout.pose in ("displacement", "lengths"):
            self._displacement = self.layout.displacement(place, passed)
        length = self.layout.length(place, passed)
        return {} if length is None else {"cost": length}


def _spaces(layout: Layout) -> dict[str, spaces.Space[Any]]:
    found: dict[str, spaces.Space[Any]] = {
        sensor: label_space(labels) for sensor, labels in zip(layout.sensors, layout.labels, strict=True)
    }
    if layout.motions.local:
        found["ways"] = PerWay(layout.ways)
    else:
        found["open"] = spaces.MultiBinary(len(layout.motions.names))
    if layout.pose in BEARINGS:
        found["bearings"] = PerWay(layout.ways, numbers=True)
    if layout.pose == "lengths":
        found["lengths"] = PerWay(layout.ways, numbers=True)
    if layout.pose in ("displacement", "lengths"):
        size = 2 if layout.coordinates is None else layout.coordinates.shape[1]
        found["displacement"] = spaces.Box(-_FARTHEST, _FARTHEST, (size,), dtype=np.float64)
    return found

"""What came of a cell, as a row that can be kept in a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from hashlib import sha256
from typing import Any

from ..model.errors import CogmapError
from ..worlds import Maze
from .exploring import ExploreRun

Key = tuple[str, str, str, str, int]
"""World, layout, agent, growth, seed."""


@dataclass(frozen=True, slots=True)
class Row:
    """One exploration that was made. Rows are equal whatever seconds they took.

    Attributes:
        world: name of the maze.
        agent: name of the agent.
        growth: of the agent `cogmap`.
        run: its figures.
        layout: digest of rooms and sights, since two mazes may have one name.
    """

    world: str
    agent: str
    growth: str
    run: ExploreRun
    layout: str = field(repr=False)

    @property
    def key(self) -> Key:
        """That of its cell."""
        return self.world, self.layout, self.agent, self.growth, self.run.seed

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values."""
        head = {"world": self.world, "layout": self.layout, "agent": self.agent, "growth": self.growth}
        return {**head, **self.run.to_dict()}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Row:
        """The row that `to_dict` gave.

        Raises:
            CogmapError: a value is missing, unknown or of a wrong kind.
        """
        known = {**dict.fromkeys(("world", "layout", "agent", "growth"), "a word"), **_KINDS}
        for name, kind in known.items():
            if name not in values and name != "frontier_steps":
                raise CogmapError(f"row has no {name}; remove it, its run is made again")
            if not _fits(values.get(name), kind):
                raise CogmapError(f"row has {name} = {values[name]!r}, not {kind}; remove it, its run is made again")
        if unknown := sorted(set(values) - set(known)):
            raise CogmapError(f"row has an unknown value {unknown[0]!r}; remove it, its run is made again")
        figures: dict[str, Any] = {name: values.get(name) for name in _KINDS}
        figures["start"] = tuple(values["start"])
        return cls(values["world"], values["agent"], values["growth"], ExploreRun(**figures), values["layout"])


def layout_digest(maze: Maze) -> str:
    """Twelve hexadecimal digits that stand for the rooms and their sights."""
    text = "\n".join(f"{row} {column} {maze.sights[row, column]!r}" for row, column in maze.rooms)
    return sha256(text.encode()).hexdigest()[:12]


_KINDS = {field.name: "a whole number or null" for field in fields(ExploreRun)} | {
    "seed": "a whole number",
    "start": "a room",
    "seconds": "a number",
}


def _fits(value: Any, kind: str) -> bool:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if kind == "a word":
        return isinstance(value, str)
    if kind == "a room":
        return isinstance(value, list) and len(value) == 2 and all(isinstance(part, int) for part in value)
    if kind == "a number":
        return whole or isinstance(value, float)
    return whole or (value is None and kind.endswith("null"))

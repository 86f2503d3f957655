"""Where the places of a graph lie, which way their ways lead, and how long they are."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import WorldError
from .raw import Attributes, Edges, RawGraph, number, shown, some

Floats = NDArray[np.float64]
Ends = NDArray[np.int32]
_AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Geometry:
    """Positions of places, bearings and lengths of ways; None where unknown."""

    coordinates: Floats | None
    bearings: Floats | None
    lengths: Floats | None

    @classmethod
    def of(cls, raw: RawGraph, ends: Ends, edges: Edges, *, needed: bool) -> Geometry:
        """What a graph tells of it; see `coordinates`, `bearings` and `lengths`."""
        where = coordinates(raw, needed=needed)
        return cls(where, bearings(raw, ends, edges, where), lengths(raw, ends, edges, where))

    def poses(self) -> list[str]:
        """What can be told of a pose, the usual first."""
        lies = self.coordinates is not None or (self.bearings is not None and self.lengths is not None)
        return ["displacement", "lengths"] * lies + ["bearing"] * (self.bearings is not None) + ["none"]

    def order(self, sources: NDArray[np.int32]) -> NDArray[np.intp]:
        """The ways by the place that they leave, and there by their bearings."""
        return np.lexsort((np.zeros(len(sources)) if self.bearings is None else self.bearings, sources))

    def ordered(self, order: NDArray[np.intp]) -> Geometry:
        """The same with ways in this order."""
        bearings, lengths = (None if values is None else values[order] for values in (self.bearings, self.lengths))
        return Geometry(self.coordinates, bearings, lengths)


def coordinates(raw: RawGraph, *, needed: bool) -> Floats | None:
    """`[R, 2 or 3]` the position of each node (`position`, or `x`, `y` and perhaps `z`); None if none has one.

    Args:
        raw: the graph.
        needed: whether positions of some nodes alone are refused; else they count as none.

    Raises:
        WorldError: some have none, or they are not two or three finite numbers each.
    """
    found = [_position(attributes, f"{raw.source}: position of {shown(node)}") for node, attributes in raw.nodes]
    without = [node for (node, _), position in zip(raw.nodes, found, strict=True) if position is None]
    if len(without) == len(found) or (without and not needed):
        return None
    if without:
        raise WorldError(
            f"{raw.source}: {len(without)} of {len(found)} nodes have no position ({some(without)}); give all of them "
            "one, or pose='none' to do without (they are laid out)"
        )
    if len({len(position) for position in found if position is not None}) != 1:
        raise WorldError(f"{raw.source}: some positions have two numbers, others three; give all of them the same")
    return np.array(found, dtype=np.float64)


def bearings(raw: RawGraph, ends: Ends, edges: Edges, where: Floats | None) -> Floats | None:
    """`[W]` degrees of each way, 0 is +y, clockwise: its `bearing`, or what the positions say; None if unknown.

    Raises:
        WorldError: some ways have none and there are no positions, or one is no number.
    """
    given = _column(raw, edges, "bearing")
    given = np.where([back for _, back in edges], given + 180.0, given) % 360.0
    if where is not None:
        across, up = (where[ends[:, 1], :2] - where[ends[:, 0], :2]).T
        given = np.where(np.isnan(given), np.rad2deg(np.arctan2(across, up)) % 360.0, given)
    return _all_or_none(raw, given, "bearing")


def lengths(raw: RawGraph, ends: Ends, edges: Edges, where: Floats | None) -> Floats | None:
    """`[W]` the `length` of each way, or the distance between its ends; None if unknown.

    Raises:
        WorldError: one is not above 0 (but between places of one position), or some ways have none and there are no
            positions.
    """
    given = _column(raw, edges, "length")
    apart = np.ones(len(given))
    if where is not None:
        apart = np.linalg.norm(where[ends[:, 1]] - where[ends[:, 0]], axis=1)
        given = np.where(np.isnan(given), apart, given)
    wrong = np.flatnonzero((given < 0.0) | ((given == 0.0) & (apart > 0.0)))  # two places may have one position
    if wrong.size:
        source, target = (f"{shown(raw.nodes[i][0])}" for i in ends[wrong[0]])
        raise WorldError(
            f"{raw.source}: the way from {source} to {target} is {given[wrong[0]]:g} long; lengths are above 0"
        )
    return _all_or_none(raw, given, "length")


def _position(attributes: Attributes, where: str) -> tuple[float, ...] | None:
    value: Any = attributes.get("position")
    if value is None:
        value = [attributes[axis] for axis in _AXES if axis in attributes] or None
    if isinstance(value, str):  # GraphML has no lists
        try:
            value = json.loads(value)
        except ValueError as error:
            raise WorldError(f"{where} is {shown(value)}; write it as [x, y]") from error
    if value is None:
        return None
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):  # pyright: ignore[reportUnknownArgumentType]
        raise WorldError(f"{where} is {shown(value)}; use two or three numbers")
    return tuple(number(part, where) for part in value)  # pyright: ignore[reportUnknownVariableType]


def _column(raw: RawGraph, edges: Edges, key: str) -> Floats:
    """`[W]` the attribute of each way, NaN where it has none."""
    return np.array(
        [
            number(attributes[key], f"{raw.source}: {key} of a way") if attributes.get(key) is not None else np.nan
            for attributes, _ in edges
        ],
        dtype=np.float64,
    )


def _all_or_none(raw: RawGraph, values: Floats, what: str) -> Floats | None:
    missing = int(np.isnan(values).sum())
    if missing == len(values):
        return None
    if missing:
        raise WorldError(f"{raw.source}: {missing} of {len(values)} ways have no {what}; give all of them one, or none")
    return values

"""What is sensed at the nodes of a graph."""

from collections.abc import Sequence
from typing import Any

from ..errors import WorldError
from ..sights import Sights, give_sights
from .raw import RawGraph, label, shown, some

_GIVEN = "sights='distinct', 'ways' or K (on the command line --sights)"
_TAKEN = ("open", "ways", "bearings", "lengths", "displacement", "taken", "outcome", "turn", "moved", "cost")
_NO_SENSORS = frozenset({"id", "position", "x", "y", "z", "name", "label"})


def sensors_of(
    raw: RawGraph, sensors: Sequence[str] | None, sights: Sights | None, ways: Sequence[int], seed: int
) -> tuple[tuple[str, ...], tuple[tuple[Any, ...], ...]]:
    """The sensors, and the labels of each at each place.

    Raises:
        WorldError: no sensors, a place without a label, or a name that observations use for something else.
    """
    sensed = tuple(_named_sensors(raw, sensors))
    if taken := [sensor for sensor in sensed if sensor in _TAKEN]:
        raise WorldError(f"{raw.source}: {taken[0]!r} cannot be a sensor; observations have another use for the name")
    columns = [[attributes.get(sensor) for _, attributes in raw.nodes] for sensor in sensed]
    if sights is not None and sensed in ((), ("sight",)):
        given = columns[0] if columns else [None] * len(raw.nodes)
        known = {label(value, "sight") for value in given if value is not None}
        drawn = give_sights(sights, ways, seed=seed, taken=known, where=raw.source)
        sensed, columns = ("sight",), [[b if a is None else a for a, b in zip(given, drawn, strict=True)]]
    if not columns:
        raise WorldError(
            f"{raw.source}: nodes have no sights; give each a 'sight', or use sights='distinct', 'ways' or K"
        )
    for sensor, column in zip(sensed, columns, strict=True):
        if missing := [node for (node, _), value in zip(raw.nodes, column, strict=True) if value is None]:
            raise WorldError(
                f"{raw.source}: {len(missing)} of {len(column)} nodes have no {shown(sensor)} ({some(missing)}); "
                f"give each one, or use {_GIVEN}"
            )
    return sensed, tuple(
        tuple(label(value, f"{raw.source}: {sensor} of a node") for value in column)
        for sensor, column in zip(sensed, columns, strict=True)
    )


def _named_sensors(raw: RawGraph, sensors: Sequence[str] | None) -> Sequence[str]:
    chosen: Any = raw.attributes.get("sensors") if sensors is None else sensors
    if isinstance(chosen, str):
        chosen = [chosen]
    if chosen is not None:
        if not isinstance(chosen, list | tuple) or not all(isinstance(name, str) for name in chosen):  # pyright: ignore[reportUnknownVariableType]
            raise WorldError(f"{raw.source}: sensors are {shown(chosen)}; give the names of attributes of nodes")
        return [str(name) for name in chosen]  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
    if any("sight" in attributes for _, attributes in raw.nodes):
        return ["sight"]
    first = raw.nodes[0][1]
    return [
        key
        for key, value in first.items()
        if key not in _NO_SENSORS
        and isinstance(value, str | int)
        and all(isinstance(attributes.get(key), str | int) for _, attributes in raw.nodes)
    ]

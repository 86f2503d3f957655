"""The parts of an agent, described so that a file can name them, and made again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..model import GROWTHS, POSES, SENSORS, CogmapError, GenerativeModel, Growth, Pose, Sensor


class MissingPart(CogmapError):  # noqa: N818 - reads as what it says
    """A file has a part that is not of this library."""


def parts_of(model: GenerativeModel, growth: Growth) -> dict[str, Any]:
    """Kind and options of every part."""
    return {
        "sensors": [_described(sensor, SENSORS) for sensor in model.sensors.values()],
        "pose": _described(model.pose, POSES),
        "growth": _described(growth, GROWTHS),
    }


def made_of(
    parts: Mapping[str, Any],
    *,
    sensors: Iterable[Sensor] | None = None,
    pose: Pose | None = None,
    growth: Growth | None = None,
) -> tuple[list[Sensor], Pose, Growth]:
    """The parts that a file speaks of; those that are given take their place.

    Raises:
        MissingPart: one is not of this library, and not given.
    """
    return (
        [_made("sensor", part, SENSORS) for part in parts["sensors"]] if sensors is None else list(sensors),
        _made("pose", parts["pose"], POSES) if pose is None else pose,
        _made("growth", parts["growth"], GROWTHS) if growth is None else growth,
    )


def _described(part: Any, kinds: Mapping[str, type[Any]]) -> dict[str, Any]:
    names = [name for name, kind in kinds.items() if kind is type(part)]
    return {"kind": names[0] if names else type(part).__name__, "options": part.options}


def _made(what: str, part: Mapping[str, Any], kinds: Mapping[str, type[Any]]) -> Any:
    kind = part["kind"]
    if kind not in kinds:
        raise MissingPart(f"load: the file has a {what} {kind!r}, which is not of this library; give yours to load()")
    return kinds[kind](**part["options"])

"""The parts of an agent, described so that a file can name them, and made again."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from ..model import GROWTHS, POSES, SENSORS, CogmapError, GenerativeModel, Growth, Pose, Sensor
from ..planning import CHOICES, POLICIES, TERMS, Cost, Options, Planner

Kinds = Mapping[str, type[Any]]

_EXPLORERS: Kinds = {Options.name: Options}
_TERMS: Kinds = {term.name: type(term) for term in (*TERMS, Cost())}


class MissingPart(CogmapError):  # noqa: N818 - reads as what it says
    """A file has a part that is not of this library."""


def parts_of(model: GenerativeModel, growth: Growth, planner: Planner) -> dict[str, Any]:
    """Kind and options of every part."""
    return {
        "sensors": [_described(sensor, SENSORS) for sensor in model.sensors.values()],
        "pose": _described(model.pose, POSES),
        "growth": _described(growth, GROWTHS),
        "planner": {
            "policies": _described(planner.policies, POLICIES),
            "terms": [_described(term, _TERMS) for term in planner.terms],
            "choice": _described(planner.choice, CHOICES),
            "explorer": None if planner.explorer is None else _described(planner.explorer, _EXPLORERS),
        },
    }


def made_of(
    parts: Mapping[str, Any],
    *,
    sensors: Iterable[Sensor] | None = None,
    pose: Pose | None = None,
    growth: Growth | None = None,
    planner: Planner | None = None,
) -> tuple[list[Sensor], Pose, Growth, Planner]:
    """The parts that a file speaks of; those that are given take their place.

    Raises:
        MissingPart: one is not of this library, and not given.
    """
    return (
        [_made("sensor", part, SENSORS) for part in parts["sensors"]] if sensors is None else list(sensors),
        _made("pose", parts["pose"], POSES) if pose is None else pose,
        _made("growth", parts["growth"], GROWTHS) if growth is None else growth,
        _planner(parts["planner"]) if planner is None else planner,
    )


def _planner(parts: Mapping[str, Any]) -> Planner:
    explorer = parts.get("explorer")  # earlier versions have none
    return Planner(
        policies=_made("planner with policies", parts["policies"], POLICIES),
        terms=[_made("planner with a term", term, _TERMS) for term in parts["terms"]],
        choice=_made("planner with a choice", parts["choice"], CHOICES),
        explorer=_made("planner with an explorer", explorer, _EXPLORERS) if explorer else None,
    )


def _described(part: Any, kinds: Kinds) -> dict[str, Any]:
    names = [name for name, kind in kinds.items() if kind is type(part)]
    options = {f.name: getattr(part, f.name) for f in fields(part)} if is_dataclass(part) else part.options
    return {"kind": names[0] if names else type(part).__name__, "options": options}


def _made(what: str, part: Mapping[str, Any], kinds: Kinds) -> Any:
    kind = part["kind"]
    if kind not in kinds:
        raise MissingPart(f"load: the file has a {what} {kind!r}, which is not of this library; give yours to load()")
    return kinds[kind](**part["options"])

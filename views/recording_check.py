"""Whether a recording says what a recording should, so that no page fails on it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..model import decode
from .map_picture import MapPicture

NUMBERS = ("step", "rest", "certainty", "doubt", "moved", "free_energy", "complexity", "accuracy", "evidence")
A_POLICY = ("policies", "P", "G", "terms", "paths")
A_TERM = ("name", "label", "kind", "colour", "meaning")


def check(data: dict[str, Any]) -> None:
    """Go through all of it once.

    Raises:
        AttributeError, LookupError, TypeError, ValueError: something is missing, of the wrong kind, or about places
            that there are not.
    """
    _check_head(data)
    _check_world(data)
    picture = MapPicture.recorded(data)
    _need(data["motions"]["stay"] == picture.motions.stay, "stay")
    for frame in data["frames"]:
        picture.apply(frame["map"])
        _check_map(data, picture, frame["map"])
        _check_frame(data, frame, len(picture.places))


def _check_head(data: dict[str, Any]) -> None:
    _need(isinstance(data["title"], str) and isinstance(data["frames"], list) and bool(data["frames"]), "frames")
    for term in data["terms"]:
        _need(all(isinstance(term[name], str) for name in A_TERM) and term["sign"] in (-1, 1), "terms")
    _need(all(isinstance(name, str) for name in [*data["known"], *data["sensors"]]), "names")
    _need(all(isinstance(data[name], list) for name in ("goals", "terms", "known", "places")), "lists")
    for label in [*data["goals"], *data["places"], *(label for of in data["sensors"].values() for label in of)]:
        hash(decode(label))
    _number(data["settings"]["certainty"])


def _check_world(data: dict[str, Any]) -> None:
    world, size = data["world"], len(data["places"])
    _need(data["origin"] is None or data["origin"] in range(size), "origin")
    if world is None:
        return
    _need(isinstance(world["rooms"], bool) and len(world["places"]) <= size, "world")
    for row, column, label in world["places"]:
        _numbers([row, column])
        hash(decode(label))
    for a, b, one_way, *line in world["ways"]:
        _need({a, b} <= {*range(len(world["places"]))} and one_way in (0, 1), "ways of the world")
        _numbers(part for point in line for part in point)
    for wall in world["walls"]:
        _need(len(wall) == 4 and _numbers(wall), "walls")


def _check_frame(data: dict[str, Any], frame: dict[str, Any], places: int) -> None:
    _numbers(frame[name] for name in NUMBERS)
    for name, label in frame["seen"].items():
        _need(label in range(len(data["sensors"][name])), "what is seen")
    _need(len(frame["open"]) == len(data["motions"]["names"]), "open")
    _need(all(place in range(places) and _number(q) >= 0 for place, q in frame["belief"]), "belief")
    _need(bool(frame["belief"]), "belief")
    _need(all(isinstance(kind, str) and len(rest) == 3 for kind, *rest in frame["grown"]), "grown")
    _need(frame["retracted"] is None or isinstance(frame["retracted"], int), "retracted")
    _need(isinstance(frame["certain"], bool), "certain")
    doors = (place for door in frame.get("closed_doors", ()) for place in door)
    rooms = [*([frame["at"]] if "at" in frame else []), *frame.get("closed_rooms", ()), *doors]
    _need(all(place in range(len(data["places"])) for place in rooms), "places of the world")
    _check_plan(data, frame["plan"], places)
    _check_window(frame["window"])


def _check_map(data: dict[str, Any], picture: MapPicture, delta: dict[str, Any]) -> None:
    size = len(picture.places)
    labels = len(next(iter(data["sensors"].values()), ()))
    _need(delta.get("size", size) == size, "size of the map")
    for place, position, _, sight, probability in delta.get("places", ()):
        _need(place in range(size) and (position is None or _numbers(position)), "place")
        _need(sight is None or sight in range(labels), "sight of a place")
        _number(probability)
    for place, action, known, *ways in delta.get("ways", ()):
        _need(place in range(size) and action in range(len(picture.motions)), "way")
        _need(known in range(len(data["known"])), "way")
        pairs = zip(ways[::2], ways[1::2], strict=True)
        _need(all(there in range(size) and _number(p) >= 0 for there, p in pairs), "way")


def _check_plan(data: dict[str, Any], plan: dict[str, Any], places: int) -> None:
    count, actions = len(plan["policies"]), range(len(data["motions"]["names"]))
    _need(all(len(plan[name]) == count for name in A_POLICY), "plan")
    _need(plan["chosen"] in range(count) and plan["action"] in actions, "choice")
    _need(all(action in actions for policy in plan["policies"] for action in policy), "policy")
    _need(all(len(terms) == len(data["terms"]) for terms in [plan["mean"], *plan["terms"]]), "terms")
    _need(all(place in range(-1, places) for path in plan["paths"] for place in path), "path")
    _numbers(plan[name] for name in ("considered", "cut", "ties"))
    for numbers in (plan["mean"], plan["P"], plan["G"], *plan["terms"]):
        _numbers(numbers)


def _check_window(window: dict[str, Any]) -> None:
    _number(window["since"])
    for name, time, *_ in window["variables"]:
        _need(isinstance(name, str) and isinstance(time, int), "variable")
    for name, kind, *scope in window["factors"]:
        _need(bool(scope) and all(isinstance(part, str) for part in (name, kind, *scope)), "factor")
    for name, _, probability in window["tops"]:
        _need(isinstance(name, str) and _number(probability) >= 0, "marginal")


def _need(fine: bool, what: str) -> None:
    if not fine:
        raise ValueError(f"{what} does not fit")


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{value!r} is no number")
    return value


def _numbers(values: Iterable[Any]) -> bool:
    return bool([_number(value) for value in values])

"""Whether a recording says what a recording should, so that no page fails on it."""

from __future__ import annotations

from typing import Any

from ..model.errors import CogmapError
from ..model.labels import decode
from .recording_map import MapPicture

NUMBERS = ("step", "sight", "rest", "certainty", "doubt", "moved", "free_energy", "complexity", "accuracy", "evidence")
A_POLICY = ("policies", "P", "G", "terms", "paths")


def check(data: dict[str, Any], *, where: str) -> None:
    """Go through all of it once.

    Raises:
        CogmapError: something is missing, of the wrong kind, or about places that there are not.
    """
    try:
        _check_head(data)
        picture = MapPicture()
        for frame in data["frames"]:
            picture.apply(frame["map"])
            _check_map(data, picture, frame["map"])
            _check_frame(data, frame, len(picture.places))
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        raise CogmapError(
            f"recording: {where} is damaged ({type(error).__name__}: {error}); record it again"
        ) from error


def _check_head(data: dict[str, Any]) -> None:
    motions = data["motions"]
    size = len(motions["displacements"][0])
    _need(len(motions["names"]) == len(motions["displacements"]), "motions")
    _need(all(isinstance(name, str) for name in motions["names"]), "names of the motions")
    _need(all(len(_whole(vector)) == size for vector in motions["displacements"]), "displacements")
    _need(motions["stay"] in range(len(motions["names"])), "stay")
    _need(isinstance(data["title"], str) and isinstance(data["frames"], list) and bool(data["frames"]), "frames")
    _need(all(isinstance(name, str) for name in [*data["terms"], *data["known"]]), "terms")
    _need(all(isinstance(data[name], list) for name in ("sights", "goals", "terms", "known")), "lists of labels")
    for label in [*data["sights"], *data["goals"], *(room[2] for room in data["maze"] or ())]:
        hash(decode(label))
    for room in data["maze"] or ():
        _need(len(_whole(room[:2])) == 2, "maze")
    _need(data["origin"] is None or bool(_whole(data["origin"])), "origin")
    _number(data["settings"]["certainty"])


def _check_frame(data: dict[str, Any], frame: dict[str, Any], places: int) -> None:
    for name in NUMBERS:
        _number(frame[name])
    _need(frame["sight"] in range(len(data["sights"])), "sight")
    _need(len(frame["open"]) == len(data["motions"]["names"]), "open")
    _need(all(place in range(places) and _number(q) >= 0 for place, q in frame["belief"]), "belief")
    _need(bool(frame["belief"]), "belief")
    _need(all(isinstance(kind, str) and len(rest) == 3 for kind, *rest in frame["grown"]), "grown")
    _need(frame["retracted"] is None or isinstance(frame["retracted"], int), "retracted")
    _need(isinstance(frame["certain"], bool), "certain")
    _need("at" not in frame or len(_whole(frame["at"])) == len(data["motions"]["displacements"][0]), "at")
    for room in frame.get("closed_rooms", ()):
        _whole(room)
    for one, other in frame.get("closed_doors", ()):
        _whole([*one, *other])
    _check_plan(data, frame["plan"], places)
    _check_window(frame["window"])


def _check_map(data: dict[str, Any], picture: MapPicture, delta: dict[str, Any]) -> None:
    size = len(picture.places)
    _need(delta.get("size", size) == size, "size of the map")
    for place, position, _, sight, probability in delta.get("places", ()):
        _need(place in range(size) and (position is None or bool(_whole(position))), "place")
        _need(sight is None or sight in range(len(data["sights"])), "sight of a place")
        _number(probability)
    for place, action, known, *ways in delta.get("ways", ()):
        _need(place in range(size) and action in range(len(data["motions"]["names"])), "way")
        _need(known in range(len(data["known"])), "way")
        _need(
            all(there in range(size) and _number(p) >= 0 for there, p in zip(ways[::2], ways[1::2], strict=True)), "way"
        )


def _check_plan(data: dict[str, Any], plan: dict[str, Any], places: int) -> None:
    count, actions = len(plan["policies"]), range(len(data["motions"]["names"]))
    _need(all(len(plan[name]) == count for name in A_POLICY), "plan")
    _need(plan["chosen"] in range(count) and plan["action"] in actions, "choice")
    _need(all(action in actions for policy in plan["policies"] for action in policy), "policy")
    _need(all(len(terms) == len(data["terms"]) for terms in plan["terms"]), "terms")
    _need(all(place in range(-1, places) for path in plan["paths"] for place in path), "path")
    _need(len(plan["mean"]) == len(data["terms"]), "terms")
    for numbers in [plan["mean"], plan["P"], plan["G"], *plan["terms"]]:
        for number in numbers:
            _number(number)
    for name in ("considered", "cut", "ties"):
        _number(plan[name])


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


def _whole(values: Any) -> list[int]:
    if not isinstance(values, list) or not all(isinstance(value, int) for value in values):  # pyright: ignore
        raise TypeError(f"{values!r} is no list of whole numbers")
    return values  # pyright: ignore

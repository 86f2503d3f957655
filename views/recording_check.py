"""What a recording has to look like, so that no page fails on it."""

from collections.abc import Callable
from typing import Any

from ..model import decode
from .map_picture import MapPicture
from .pixels import PNG
from .recording_frames import NUMBERS, TERM

Fits = Callable[[Any], bool]
Shape = Any
"""A dict of parts by name, `[shape]` of any number alike, a tuple of shapes one by one (`..., shape` for any number
more of it), or what a leaf must fit."""


def _kind(*kinds: type) -> Fits:
    return lambda value: isinstance(value, kinds) and (bool in kinds or not isinstance(value, bool))


_any, _text, _flag, _whole, _number = _kind(object, bool), _kind(str), _kind(bool), _kind(int), _kind(int, float)


def _label(value: Any) -> bool:
    return hash(decode(value)) < 2**64


def check(data: dict[str, Any]) -> None:
    """Go through all of a recording once.

    Raises:
        AttributeError, LookupError, TypeError, ValueError: something is missing, of the wrong kind, or about places
            that there are not.
    """
    _need(data, _head(data), "recording")
    picture = MapPicture.recorded(data)
    for number, frame in enumerate(data["frames"]):
        picture.apply(frame["map"])
        _need(frame, _frame(data, frame, len(picture.places)), f"frame {number}")


def _head(data: dict[str, Any]) -> Shape:
    world, place = data["world"], _below(len(data["places"]))
    shape: dict[str, Shape] = {
        "title": _text,
        "motions": {"names": [_text], "displacements": [[_whole]], "stay": _whole},
        "settings": {"certainty": _number},
        "terms": [dict.fromkeys(TERM, _text) | {"sign": _number}],
        "known": [_text],
        "goals": [_label],
        "places": [_label],
        "sights": [_label],
        "origin": _or_none(place),
        "frames": (_any, ..., _any),
    }
    if world is not None:
        room = _below(len(world["places"]))
        ways = [(room, room, _below(2), ..., [_number])]
        places = [(_number, _number, _label)]
        shape["world"] = {"rooms": _flag, "places": places, "ways": ways, "walls": [(_number,) * 4]}
    return shape


def _frame(data: dict[str, Any], frame: dict[str, Any], places: int) -> Shape:
    plan, delta, actions, terms = frame["plan"], frame["map"], len(data["motions"]["names"]), len(data["terms"])
    place, action, at, count = _below(places), _below(actions), _below(len(data["places"])), len(plan["policies"])
    of_map = {
        "size": _below(places + 1, least=places),
        "places": [(place, _or_none([_number]), _any, _or_none(_below(len(data["sights"]))), _number)],
        "ways": [_way(place, action, _below(len(data["known"])))],
    }
    optional = {"open": (_or_none(_share),) * actions, "at": at, "closed_rooms": [at], "closed_doors": [(at, at)]}
    optional["pixels"] = _picture
    return {
        **dict.fromkeys(("step", "rest", *NUMBERS), _number),
        **{name: shape for name, shape in optional.items() if name in frame},
        "seen": dict.fromkeys(frame["seen"], _label),
        **({"spoke": dict.fromkeys(frame["spoke"], (_or_none(_number), _or_none(_text)))} if "spoke" in frame else {}),
        "grown": [(_text, _any, _any, _any)],
        **({"retracted": _or_none(_whole)} if "retracted" in frame else {"revised": _flag}),  # the first as earlier
        "certain": _flag,
        "belief": ((place, _number), ..., (place, _number)),
        "map": {name: shape for name, shape in of_map.items() if name in delta},
        "plan": {
            **dict.fromkeys(("considered", "cut", "ties"), _number),
            **dict.fromkeys(("P", "G"), (_number,) * count),
            "chosen": _below(count),
            "action": action,
            "policies": [[action]],
            "terms": ((_number,) * terms,) * count,
            "mean": (_number,) * terms,
            "paths": ([_below(places, least=-1)],) * count,
        },
        "window": {
            "since": _number,
            "variables": [(_text, _whole, ..., _any)],
            "factors": [(_text, _text, _text, ..., _text)],
            "tops": [(_text, _any, _number)],
        },
    }


def _need(value: dict[str, Any], shape: dict[str, Shape], where: str) -> None:
    for name, part in shape.items():
        if not _fits(value[name], part):
            raise ValueError(f"{name} of {where} does not fit")


def _fits(value: Any, shape: Shape) -> bool:
    if callable(shape):
        return bool(shape(value))
    if isinstance(shape, dict):
        return all(_fits(value[name], part) for name, part in shape.items())
    if not isinstance(value, list | tuple):
        return False
    if isinstance(shape, list):
        shape = tuple(shape * len(value))
    elif ... in shape:
        shape = shape[:-2] + shape[-1:] * (len(value) - len(shape) + 2)
    return len(shape) == len(value) and all(map(_fits, value, shape))


def _or_none(shape: Shape) -> Fits:
    return lambda value: value is None or _fits(value, shape)


def _way(place: Fits, action: Fits, known: Fits) -> Fits:
    """Where one action leads: a place, the action, how that is known, and pairs of a place and a probability."""
    return lambda row: len(row) % 2 == 1 and _fits(row, (place, action, known, *(place, _number) * (len(row) // 2 - 1)))


def _picture(value: Any) -> bool:
    return _text(value) and value.startswith(PNG)


def _share(value: Any) -> bool:
    return _number(value) and 0.0 <= value <= 1.0


def _below(size: int, *, least: int = 0) -> Fits:
    return lambda value: _whole(value) and least <= value < size

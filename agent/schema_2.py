"""Files of schema 2, made into the present one. What was learned before cannot be taken back any more."""

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief, Message
from ..model import Percept, Slice, Table, decode
from ..planning import TERMS
from .packing import Arrays, pack
from .state import Choice, GivenPreferences, State

_COLUMNS = {"position_of": "position_of.values", "place_at": "place_at.values", "visits": "visits.order"}
_PARTS = ("places", "growth", "policies", "beam", "choice")  # names among the settings that are parts now

_SCALARS = ("evidence", "moved", "dropped", "examined", "doubt")


def from_schema_2(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> tuple[dict[str, Any], Arrays]:
    """Header and arrays as they would be written now.

    Raises:
        CogmapError, KeyError, TypeError, ValueError: the file is damaged.
    """
    settings = dict(header["settings"])
    new: Arrays = {name: values for name, values in arrays.items() if name.partition(".")[0] in ("A_o", "A_p", "B_s")}
    new |= {name: arrays[f"map.{old}"] for old, name in _COLUMNS.items()}
    new |= {f"{name}.values": arrays[f"map.{name}"] for name in ("sensed", "walked")}
    growth = np.pad(arrays["growth"], ((0, 0), (0, 1)), constant_values=-1)
    growth[growth[:, 1] == 1, 6] = 0  # a label of the first sensor
    new["growth"] = growth
    factors = {"displacement": {}, "transition": {}, "pose": {"positions": header["positions"]}, "open": {}}
    places, growth, policies, beam, choice = (settings.pop(name) for name in _PARTS)
    options = {"places": places} if growth == "static" else {}
    made = {
        "motions": header["motions"],
        "settings": settings,
        "parts": {
            "sensors": [{"kind": "sight", "options": {}}, {"kind": "ways", "options": {}}],
            "pose": {"kind": "lattice", "options": {}},
            "growth": {"kind": growth, "options": options},
            "planner": {
                "policies": {"kind": policies, "options": {"beam": beam} if policies == "map_guided" else {}},
                "terms": [{"kind": term.name, "options": {}} for term in TERMS],
                "choice": {"kind": choice, "options": {}},
            },
        },
        "rng": header["rng"],
        "map": {"places": len(arrays["A_o.keys"]), "factors": {**factors, "sight": {"labels": header["sights"]}}},
        "state": pack(_state(header, arrays), new, "state"),
    }
    return made, new


def _state(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> State:
    sights = [decode(label) for label in header["sights"]]
    names = header["motions"]["names"]
    slices = [_slice(at, slice_, arrays, sights, names) for at, slice_ in enumerate(header["window"])]
    choice = header.get("choice")  # the first files have none
    return State(
        window=deque(slices),
        steps=header["steps"],
        action=header["action"],
        open=tuple(header["open"]) or None,
        belief=_belief(header["belief"], arrays),
        preferences=_preferences(header["goals"], header["goal_places"]),
        choice=None
        if choice is None
        else Choice(_preferences(choice["sights"], choice["places"]), tuple(choice["policy"])),
    )


def _preferences(sights: Sequence[Sequence[Any]], places: Sequence[Sequence[Any]]) -> GivenPreferences:
    return GivenPreferences(
        {decode(label): float(value) for label, value in sights}, {int(at): float(value) for at, value in places}
    )


def _belief(header: Mapping[str, Any] | None, arrays: Mapping[str, NDArray[Any]]) -> Belief | None:
    if header is None:
        return None
    parts = [arrays[f"belief.{i}"] for i in range(7)]
    scalars: dict[str, Any] = {name: header[name] for name in _SCALARS}
    pairwise = parts[3], parts[4], parts[5]
    return Belief(message=Message(*parts[:3]), pairwise=pairwise, log_likelihood=parts[6], **scalars)


def _slice(
    at: int, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], sights: list[Any], names: Sequence[str]
) -> Slice:
    t, action, label, open_ = header["step"], header["action"], decode(header["sight"]), decode(header["open"])
    part = {name.split(".")[2]: values for name, values in arrays.items() if name.startswith(f"window.{at}.")}
    percept = Percept(action, True, {"sight": sights.index(label), "open": open_})
    tables = [
        Table("A_p", (f"p{t}", f"s{t}"), part["place"], "place", "P(p_t | s_t)"),
        Table("A_o", (f"o{t}", f"s{t}"), part["sight_likelihood"][None], "sight", "P(o_t | s_t)", (label,)),
        Table("c", (f"c{t}", f"s{t}"), part["doors_likelihood"][None], "walls", "P(c_t | s_t)", (open_,)),
    ]
    if action is not None and part["transition"].shape[1]:
        moved, B_s, B_p = f"moved{t}", part["transition"], part["motion"]
        arrival = np.broadcast_to(part["arrival"][:, None], B_s.shape)
        equations = [f"P({x}_t | {x}_t-1, a_t-1, moved_t)" for x in "sp"]
        scopes = [(f"{x}{t}", f"{x}{t - 1}", moved) for x in "sp"]
        displacement = np.array(decode(header["displacement"]), dtype=np.float64)
        tables[:0] = [
            Table("M", (moved,), displacement, "displacement", "P(moved_t)"),
            Table(f"B_s[{names[action]}]", scopes[0], np.stack([B_s, arrival], -1), "transition", equations[0]),
            Table(f"B_p[{names[action]}]", scopes[1], np.stack([B_p, np.ones_like(B_p)], -1), "motion", equations[1]),
        ]
    return Slice(t, percept, part["places"], part["positions"], part["joint"], tuple(tables))

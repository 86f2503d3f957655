"""Records as plain JSON values and arrays, and back; no pickle."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief, Message
from ..model import CogmapError, CognitiveMap, Percept, Slice, Table, encode, plain
from .checks import check_state
from .fitting import checked
from .state import Choice, GivenPreferences, State

Arrays = dict[str, NDArray[Any]]

RECORDS: dict[str, type[Any]] = {
    kind.__name__: kind for kind in (State, Belief, Message, Slice, Table, Percept, Choice)
} | {"GivenPreferences": GivenPreferences}
"""What is taken apart field by field, by name."""


_OF_THE_STEP = ("likelihoods", "pruned", "ahead")  # of a belief, what only the step that it is of needs


def pack(value: Any, arrays: Arrays, path: str) -> Any:
    """A JSON value; what are arrays goes into `arrays`, named by where it stands.

    Raises:
        CogmapError: a label cannot be written as JSON.
    """
    if isinstance(value, np.ndarray):
        arrays[path] = value.copy()
        return {"array": path}
    if isinstance(value, Table):
        value = replace(value, values=value.array)
    if is_dataclass(value):
        left_out = _OF_THE_STEP if isinstance(value, Belief) else ()
        parts = {field.name: getattr(value, field.name) for field in fields(value) if field.name not in left_out}
        packed = {name: pack(part, arrays, f"{path}.{name}") for name, part in parts.items()}
        return {"record": type(value).__name__, **packed}
    if isinstance(value, tuple | list | deque):
        items = [pack(item, arrays, f"{path}.{i}") for i, item in enumerate(cast(Sequence[Any], value))]
        return {"tuple" if isinstance(value, tuple) else "list": items}
    if isinstance(value, Mapping):
        pairs = cast(Mapping[Any, Any], value).items()
        return {"pairs": [[encode(key), pack(item, arrays, f"{path}.{i}")] for i, (key, item) in enumerate(pairs)]}
    return encode(plain(value))


def unpack(value: Any, arrays: Mapping[str, NDArray[Any]]) -> Any:
    """What `pack` took apart; lists come back as lists.

    Raises:
        CogmapError, KeyError, TypeError: it is nothing that `pack` wrote.
    """
    if not isinstance(value, dict):
        if isinstance(value, list):
            raise CogmapError("a list stands where a value should")
        return value
    parts = cast(dict[str, Any], value)
    if "array" in parts:
        return arrays[parts["array"]]
    if "record" in parts:
        kind = RECORDS[parts["record"]]
        return checked(kind, {name: unpack(part, arrays) for name, part in parts.items() if name != "record"})
    if "pairs" in parts:
        return {unpack(key, arrays): unpack(item, arrays) for key, item in parts["pairs"]}
    items = [unpack(item, arrays) for item in parts["tuple" if "tuple" in parts else "list"]]
    return tuple(items) if "tuple" in parts else items


def unpacked_state(packed: Any, arrays: Mapping[str, NDArray[Any]], map_: CognitiveMap, window: int) -> State:
    """The state that `pack` took apart, of an agent with this map.

    Raises:
        CogmapError: belief or window are not about the map.
    """
    state = unpack(packed, arrays)
    if not isinstance(state, State):
        raise CogmapError("there is no state of an agent")
    state.window, state.begun = deque(state.window, maxlen=window + 1), 0
    check_state(state, map_)
    return state

"""Files of schema 3: they have rivals of the belief and steps that could be taken back, but no hypotheses."""

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

_GONE = ("rivals", "pending", "recent", "retracted")

Arrays = Mapping[str, NDArray[Any]]


def from_schema_3(header: Mapping[str, Any], arrays: Arrays) -> tuple[dict[str, Any], Arrays]:
    """Header and arrays as they would be written now. Raises KeyError, ValueError: the file is damaged."""
    state = {name: part for name, part in header["state"].items() if name not in _GONE}
    for name in arrays:
        if name.startswith(("state.rivals.", "state.recent.")):
            _ = arrays[name]  # nothing is left of it, but it may not be damaged either
    return {**header, "state": state}, arrays

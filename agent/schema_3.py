"""Files of schema 3: they have rivals of the belief and steps that could be taken back, but no hypotheses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_GONE = ("rivals", "pending", "recent", "retracted")


def from_schema_3(header: Mapping[str, Any]) -> dict[str, Any]:
    """The header as it would be written now.

    Raises:
        KeyError: the file is damaged.
    """
    state = {name: part for name, part in header["state"].items() if name not in _GONE}
    return {**header, "state": state}

"""The one error of the worlds."""

from __future__ import annotations


class WorldError(ValueError):
    """Bad input to a world: the message says what, where and how to mend it."""

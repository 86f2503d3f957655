"""The one error of the library folders."""

from __future__ import annotations


class CogmapError(ValueError):
    """Bad input to the library: the message says what, where and how to mend it."""

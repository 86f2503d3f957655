"""What an observation gives where a sensor saw nothing."""

from __future__ import annotations

from typing import final


@final
class Unseen:
    """The type of `UNSEEN`: a reading that is no evidence and teaches nothing."""

    __slots__ = ()

    def __new__(cls) -> Unseen:
        """The one."""
        return UNSEEN

    def __repr__(self) -> str:
        return "UNSEEN"

    def __reduce__(self) -> str:
        return "UNSEEN"  # copies and pickles are the one, too


UNSEEN = object.__new__(Unseen)
"""In an observation, instead of a reading: nothing was seen. No evidence; teaches nothing."""

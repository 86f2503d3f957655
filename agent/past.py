"""What of the recent past must be kept, so that a restored agent can still change its mind: plain JSON values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from ..inference.message import Evidence
from ..inference.rivals import Rivals
from ..model.errors import CogmapError
from ..model.lesson import Lesson
from ..model.retraction import Chapter
from .mapper import Mapper


def rivals_state(rivals: Rivals) -> dict[str, list[Any]]:
    """The rivals of the belief."""
    return {name: getattr(rivals, name).tolist() for name in rivals.__slots__}


def restore_rivals(header: Mapping[str, Sequence[Any]], dimensions: int) -> Rivals:
    """The rivals that `rivals_state` took apart.

    Raises:
        CogmapError: the lists do not fit one another, or hold what is no number.
        KeyError: a list is missing.
    """
    kinds = {"positions": np.int64, "since": np.int64, "visits": np.int64, "odds": float, "coincidence": float}
    arrays = {name: np.array(header[name], dtype=kind) for name, kind in kinds.items()}
    count = len(arrays["odds"])
    arrays["positions"] = arrays["positions"].reshape(count, dimensions)
    if any(len(array) != count for array in arrays.values()) or not np.isfinite(arrays["odds"]).all():
        raise CogmapError("rivals: the lists do not fit one another; save the agent again")
    return Rivals(**arrays)


def past_state(mapper: Mapper) -> dict[str, list[Any]]:
    """The steps that the mapper can take back."""
    chapters = [asdict(chapter) for chapter in mapper.learner.chapters]
    recent = [[step, asdict(evidence)] for step, evidence in mapper.recent]
    return {"chapters": chapters, "recent": recent}


def restore_past(mapper: Mapper, header: Mapping[str, Sequence[Any]]) -> None:
    """Give a new mapper the steps that `past_state` took apart.

    Raises:
        KeyError, TypeError: a part is missing or unknown.
    """
    chapters = mapper.learner.chapters
    chapters.clear()
    for chapter in header["chapters"]:
        parts: dict[str, Any] = dict(chapter)
        parts["lessons"] = [Lesson(**lesson) for lesson in chapter["lessons"]]
        parts["doors"] = [tuple(door) for door in chapter["doors"]]
        chapters.append(Chapter(**parts))
    for step, evidence in header["recent"]:
        mapper.recent.append((int(step), Evidence(**evidence)))

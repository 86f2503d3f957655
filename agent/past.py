"""What of the recent past must be kept, so that a restored agent can still change its mind: plain JSON values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from ..inference.message import Evidence
from ..inference.rivals import Rivals
from ..model.errors import CogmapError
from .mapper import Mapper, Moment


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


def past_state(mapper: Mapper) -> list[dict[str, Any]]:
    """The steps that the mapper can take back; their marks are those of the log of changes, the last ones there are."""
    return [asdict(moment) for moment in mapper.recent]


def restore_past(mapper: Mapper, header: Sequence[Mapping[str, Any]]) -> None:
    """Give a new mapper the steps that `past_state` took apart.

    Raises:
        KeyError, TypeError: a part is missing or unknown.
    """
    for moment in header:
        parts: dict[str, Any] = {**moment, "evidence": Evidence(**moment["evidence"])}
        mapper.recent.append(Moment(**parts))

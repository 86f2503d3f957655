"""The tables of a map with their labels, as many places of them as are asked for."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import cast

import numpy as np
from numpy.typing import NDArray

from .cognitive_map import ELSEWHERE, CognitiveMap
from .dirichlet import SparseDirichlet
from .errors import CogmapError
from .graph import LabelledTable
from .labels import plain

OTHER = {"A_o": "(any other sight)", "A_p": "(no position)", "B_s": "(elsewhere)"}
"""Label of the last row: what has no row of its own."""


def map_table(
    map_: CognitiveMap, name: str, *, action: str | int | None = None, places: Sequence[int] | None = None
) -> LabelledTable:
    """The expected probabilities of a table, with labels; axes as in the arrays: `[outcome, place]`.

    Each column is a place, and sums to one. Only outcomes that have counts of their own in one of these places get
    a row; the last row holds all others together.

    Args:
        map_: the map.
        name: `A_o`, `A_p` or `B_s`.
        action: for `B_s`, by name or index.
        places: by number, the columns; all of them unless given.

    Raises:
        CogmapError: no such table, action or place; `B_s` without an action, or another table with one.
    """
    if name not in OTHER:
        raise CogmapError(f"map: no table {name!r}; choose one of {', '.join(OTHER)}")
    chosen = checked_places(map_, places)
    rows, title = _rows(map_, name, action, chosen)
    outcomes, cells = _sparse(getattr(map_, name), rows)
    labels = [_outcome(map_, name, key) for key in outcomes]
    index = (*labels, OTHER[name])
    return LabelledTable(cells, index, tuple(chosen.tolist()), OUTCOMES[name], ("place",), title)


OUTCOMES = {"A_o": "sight", "A_p": "position", "B_s": "next place"}


def checked_places(map_: CognitiveMap, places: Sequence[int] | None) -> NDArray[np.int64]:
    """The places asked for, or all.

    Raises:
        CogmapError: there is no such place.
    """
    if places is None:
        return np.arange(len(map_.places))
    for place in places:
        if place not in map_.places:
            raise CogmapError(f"map: there is no place {place!r}; places are 0 to {len(map_.places) - 1}")
    return np.array(list(places), dtype=np.int64)


def action_named(map_: CognitiveMap, action: str | int) -> int:
    """Index of an action given by name or index.

    Raises:
        CogmapError: there is none.
    """
    names = map_.motions.names
    if isinstance(action, str) and action in names:
        return names.index(action)
    if isinstance(action, int | np.integer) and not isinstance(action, bool) and 0 <= action < len(names):
        return int(action)
    raise CogmapError(f"map: no action {action!r}; choose one of {', '.join(names)}")


def _rows(
    map_: CognitiveMap, name: str, action: str | int | None, places: NDArray[np.int64]
) -> tuple[NDArray[np.int64], str]:
    if name != "B_s":
        if action is not None:
            raise CogmapError(f"map: {name} has no actions; leave `action` out")
        return places, f"{name}: P({OUTCOMES[name]} | place)"
    if action is None:
        names = ", ".join(map_.motions.names)
        raise CogmapError(f"map: B_s is one table an action; give `action`, one of {names}")
    index = action_named(map_, action)
    return map_.rows(places, index), f"B_s: P(next place | place, {map_.motions.names[index]})"


def _sparse(table: SparseDirichlet, rows: NDArray[np.int64]) -> tuple[list[int], NDArray[np.float64]]:
    """Outcomes with counts of their own, ascending, and P `[outcomes + 1, rows]`; the last line is all the rest."""
    keys, p, other = table.mean(rows)
    outcomes = np.unique(keys[keys >= 0])
    cells = np.zeros((len(outcomes) + 1, len(rows)))
    cells[:-1] = other
    row, slot = np.nonzero(keys >= 0)
    cells[np.searchsorted(outcomes, keys[row, slot]), row] = p[row, slot]
    cells[-1] = np.maximum(1.0 - cells[:-1].sum(axis=0), 0.0)
    return outcomes.tolist(), cells


def _outcome(map_: CognitiveMap, name: str, key: int) -> Hashable:
    if name == "B_s":
        return key
    return plain(map_.sights[key] if name == "A_o" else map_.positions[key])


def counts_of(map_: CognitiveMap, place: int) -> dict[str, dict[Hashable, float]]:
    """The evidence for one place, prior left out: by table (`B_s[up]` for an action) and outcome.

    Raises:
        CogmapError: there is no such place.
    """
    checked_places(map_, [place])
    found = {name: _counts(map_, name, getattr(map_, name).counts(place)) for name in ("A_o", "A_p")}
    for action, motion in enumerate(map_.motions.names):
        found[f"B_s[{motion}]"] = _counts(map_, "B_s", map_.B_s.counts(map_.row(place, action)))
    return found


def _counts(map_: CognitiveMap, name: str, counts: dict[int, float]) -> dict[Hashable, float]:
    kept = {key: value for key, value in counts.items() if key >= ELSEWHERE and value > 0.0}
    other = cast(Hashable, OTHER[name])
    return {other if key == ELSEWHERE else _outcome(map_, name, key): value for key, value in kept.items()}

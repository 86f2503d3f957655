"""The tables of a map with their labels, as many places of them as are asked for."""

from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray

from .dirichlet import SparseDirichlet
from .domain import Domain
from .errors import CogmapError
from .factors import ELSEWHERE
from .graph import LabelledTable
from .labels import plain
from .readable_map import ReadableMap


def map_table(
    map_: ReadableMap, name: str, *, action: str | int | None = None, places: Sequence[int] | None = None
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
    if name not in map_.tables:
        raise CogmapError(f"map: no table {name!r}; choose one of {', '.join(_names(map_))}")
    chosen = checked_places(map_, places)
    rows, title = _rows(map_, name, action, chosen)
    outcomes, cells = _sparse(map_.tables[name], rows)
    outcome, other, domain = _outcomes(map_, name)
    index = (*(_label(domain, key) for key in outcomes), other)
    return LabelledTable(cells, index, tuple(chosen.tolist()), outcome, ("place",), title)


def _names(map_: ReadableMap) -> list[str]:
    """Tables of labels, of positions, then of transitions."""
    return sorted(map_.tables, key=lambda name: (name == "B_s", name == "A_p"))


def _outcomes(map_: ReadableMap, name: str) -> tuple[str, str, Domain | None]:
    """What the outcomes of a table are, what all others together are called, and their labels."""
    if name == "B_s":
        return "next place", "(elsewhere)", None
    if name == "A_p":
        return "position", "(no position)", map_.positions
    sight = next(sight for sight in map_.sights_sensed if sight.symbol == name)
    return sight.name, f"(any other {sight.name})", sight.labels


def checked_places(map_: ReadableMap, places: Sequence[int] | None) -> NDArray[np.int64]:
    """The places asked for, or all. Raises CogmapError: there is no such place."""
    if places is None:
        return np.arange(len(map_.places))
    for place in places:
        if place not in map_.places:
            raise CogmapError(f"map: there is no place {place!r}; places are 0 to {len(map_.places) - 1}")
    return np.array(list(places), dtype=np.int64)


def action_named(map_: ReadableMap, action: str | int) -> int:
    """Index of an action given by name or index. Raises CogmapError: there is none."""
    index = map_.motions.index(action)
    if index is None:
        raise CogmapError(f"map: no action {action!r}; choose one of {', '.join(map_.motions.names)}")
    return index


def _rows(
    map_: ReadableMap, name: str, action: str | int | None, places: NDArray[np.int64]
) -> tuple[NDArray[np.int64], str]:
    if name != "B_s":
        if action is not None:
            raise CogmapError(f"map: {name} has no actions; leave `action` out")
        return places, f"{name}: P({_outcomes(map_, name)[0]} | place)"
    if action is None:
        names = ", ".join(map_.motions.names)
        raise CogmapError(f"map: B_s is one table an action; give `action`, one of {names}")
    index = action_named(map_, action)
    return places * len(map_.motions) + index, f"B_s: P(next place | place, {map_.motions.names[index]})"


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


def _label(domain: Domain | None, key: int) -> Hashable:
    return key if domain is None else plain(domain[key])


def counts_of(map_: ReadableMap, place: int) -> dict[str, dict[Hashable, float]]:
    """The evidence for one place, prior left out: by table (`B_s[up]` for an action) and outcome.

    Raises:
        CogmapError: there is no such place.
    """
    checked_places(map_, [place])
    found = {name: _counts(map_, name, map_.tables[name].counts(place)) for name in _names(map_) if name != "B_s"}
    for action, motion in enumerate(map_.motions.names):
        found[f"B_s[{motion}]"] = _counts(map_, "B_s", map_.B_s.counts(map_.row(place, action)))
    return found


def _counts(map_: ReadableMap, name: str, counts: dict[int, float]) -> dict[Hashable, float]:
    kept = {key: value for key, value in counts.items() if key >= ELSEWHERE and value > 0.0}
    _, other, domain = _outcomes(map_, name)
    return {other if key == ELSEWHERE else _label(domain, key): value for key, value in kept.items()}

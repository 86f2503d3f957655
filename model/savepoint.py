"""Back to how a model was, also where it was left in the middle of a change.

Whatever writes to a store tells the log of changes first, so that what was half done is in the log as well. Going back
puts the old values, then cuts everything that only grows to the length it had, and works out anew what follows from it.
That costs as much as the map is large; a savepoint costs next to nothing.
"""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from .changes import Change, Changes
from .dirichlet import SparseDirichlet
from .errors import CogmapError
from .factors import ModelFactor
from .generative import GenerativeModel
from .visits import Visits

_OURS = __name__.partition(".")[0] + "."


@dataclass(frozen=True, slots=True)
class Savepoint:
    """The state of a model between two steps, to return to."""

    places: int  # how many there were
    growth: int  # events in its log of growth
    changes: Any  # where its log of changes was
    stores: tuple[Any, ...]  # what each store needs to go back, besides the log
    factors: tuple[Any, ...]  # the same of each factor
    # attributes of parts that are not of this library; None where they cannot be copied
    others: tuple[Mapping[str, Any] | None, ...]


def savepoint(model: GenerativeModel) -> Savepoint:
    """A savepoint of the model as it is now. Until `release` its logs drop nothing."""
    return Savepoint(
        len(model.places),
        len(model.growth),
        model.changes.hold(),
        tuple(map(_point, model.stores[1:])),
        tuple(factor.savepoint() for factor in model.factors),
        tuple(_copied(factor) for factor in model.factors),
    )


def release(model: GenerativeModel) -> None:
    """Give up a savepoint, so that the logs may drop what lies before it."""
    model.changes.release()
    model.growth.tidy()


def go_back(model: GenerativeModel, point: Savepoint) -> None:
    """Restore the model to a savepoint, whatever was changed since.

    Raises:
        CogmapError: a part that is not of this library has what cannot be copied.
    """
    if None in point.others:
        part = model.factors[point.others.index(None)]
        raise CogmapError(f"{part.name}: a {type(part).__name__} has attributes that cannot be copied")
    _undo(model, model.changes, point.changes)
    _resize(model, point.places)
    for store, kept in zip(model.stores[1:], point.stores, strict=True):
        _store_back(store, kept)
    for factor, kept, others in zip(model.factors, point.factors, point.others, strict=True):
        _put_back(factor, others)
        factor.go_back(kept)
    model.growth[point.growth :] = []
    model.changes.cut(point.changes)


def _undo(model: GenerativeModel, changes: Changes, since: Any) -> None:
    for store in model.stores[1:]:
        if isinstance(store, SparseDirichlet):
            store.level()
    _resize(model, len(model.places))
    for entry in reversed(changes.held(since)):
        if not isinstance(entry, Change):
            continue
        if entry.store is model:
            _resize(model, entry.where)  # then what was the last place begins anew
            _resize(model, entry.where + bool(entry.old))
        elif isinstance(entry.store, Visits):
            entry.store.undo(entry.where, entry.old)
        else:
            entry.store.put(entry.where, entry.old)


def _point(store: Any) -> Any:
    """What a store needs to go back besides the log: little where it says so itself, else all that it has."""
    return store.savepoint() if hasattr(store, "savepoint") else store.state()


def _store_back(store: Any, point: Any) -> None:
    if hasattr(store, "savepoint"):
        store.go_back(point)
    else:
        store.restore(point)


def _resize(model: GenerativeModel, places: int) -> None:
    model.resize(places)
    for factor in model.factors:
        factor.grow(places)


def _copied(factor: ModelFactor) -> Mapping[str, Any] | None:
    if type(factor).__module__.startswith(_OURS):
        return {}
    own = {name: value for name, value in vars(factor).items() if not type(value).__module__.startswith(_OURS)}
    try:
        return deepcopy(own)
    except Exception:  # whatever its author thinks of copies
        return None


def _put_back(factor: ModelFactor, others: Mapping[str, Any] | None) -> None:
    if type(factor).__module__.startswith(_OURS):
        return
    for name, value in list(vars(factor).items()):
        if name not in (others or ()) and not type(value).__module__.startswith(_OURS):
            delattr(factor, name)
    vars(factor).update(others or {})

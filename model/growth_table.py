"""The growth log as a table, and what was added and taken away between two steps."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

from .errors import CogmapError
from .generative import GenerativeModel
from .graph import LabelledTable
from .growth_event import GrowthEvent
from .labels import shown
from .motions import Position

if TYPE_CHECKING:
    from networkx import DiGraph

Log = GenerativeModel | Sequence[GrowthEvent]  # A map, whose actions have names, or a log alone
MOST = 8  # items of one kind that a text lists


@dataclass(frozen=True, slots=True)
class GrownPlace:
    """A place that was added or removed."""

    place: int  # its number; numbers of places that were taken away are given again
    step: int  # time step at which it was added
    # where it is at the end of the time looked at (of one that was taken away: where it was before)
    position: Position | None
    source: int | None  # the place from which it was seen or entered, or None
    action: str | None  # the name of the action that leads there from `source`, or None

    def __str__(self) -> str:
        at = "" if self.position is None else f" at {self.position}"
        seen = "" if self.source is None else f" ({self.action} of {self.source})"
        return f"{self.place}{at}{seen}"


@dataclass(frozen=True, slots=True)
class GrowthDifference:
    """How a model after the step `until` differs from the same one before the step `since`."""

    since: int  # the first step that counts
    until: int  # the last step that counts
    variables: tuple[str, ...]  # names of the variables that were added, as `window_graph` names them
    sights: tuple[Hashable, ...]  # labels added to the domain of o
    positions: tuple[Position, ...]  # labels added to the domain of p
    places: tuple[GrownPlace, ...]  # values added to the domain of s
    taken: tuple[GrownPlace, ...]  # values taken away from it
    bound: tuple[tuple[int, Position], ...]  # places that were there before, and their new position
    unbound: tuple[tuple[int, Position], ...]  # places that still are there, and the position they lost

    def __str__(self) -> str:
        parts = (
            ("+ variables", self.variables),
            ("+ sights", tuple(map(shown, self.sights))),
            ("+ positions", self.positions),
            ("+ places", self.places),
            ("+ positions of places", tuple(f"{place} at {position}" for place, position in self.bound)),
            ("- places", self.taken),
            ("- positions of places", tuple(f"{place} at {position}" for place, position in self.unbound)),
        )
        lines = [f"{name} ({len(items)}): {_listed(items)}" for name, items in parts if items]
        return "\n".join([f"steps {self.since} to {self.until}:", *(lines or ["nothing was added or taken away"])])

    def to_networkx(self) -> DiGraph[Any]:
        """The added nodes, and how they hang together.

        Nodes are `("variable", name)`, `("sight", label)`, `("position", p)` and `("place", number)`, with `kind`,
        `label` and `added`; places also have `step` and `position`. Edges lead from the place from which a place was
        seen or entered (`relation="leads to"`, with `action`), and from a place to its position
        (`relation="is at"`). An end of these that was there before is a node with `added=False`.
        """
        import networkx as nx

        graph: nx.DiGraph[Any] = nx.DiGraph()
        for kind, labels in (("variable", self.variables), ("sight", self.sights), ("position", self.positions)):
            for label in labels:
                graph.add_node((kind, label), kind=kind, label=label, added=True)
        for new in self.places:
            node = ("place", new.place)
            graph.add_node(node, kind="place", label=new.place, added=True, step=new.step, position=new.position)
        for new in self.places:
            if new.source is not None:
                source = _old(graph, "place", new.source)
                graph.add_edge(source, ("place", new.place), relation="leads to", action=new.action)
        for place, position in [(new.place, new.position) for new in self.places] + list(self.bound):
            if position is not None:
                ends = _old(graph, "place", place), _old(graph, "position", position)
                graph.add_edge(*ends, relation="is at")
        return graph


def growth_table(log: Log, since: int = 0, until: int | None = None) -> LabelledTable:
    """The events of the steps `since` to `until` (both included): step, kind, index, label, source, action name."""
    rows = [
        (event.step, event.kind, event.index, event.label, event.source, _action(log, event.action))
        for event in _events(log)
        if event.step >= since and (until is None or event.step <= until)
    ]
    columns = ("step", "kind", "index", "label", "source", "action")
    return LabelledTable(rows, tuple(range(len(rows))), columns, "event", title="growth")


def growth_between(log: Log, since: int = 0, until: int | None = None) -> GrowthDifference:
    """What was added and taken away in the steps `since` to `until`, both included; the last step unless given.

    What was added and taken away again in between is left out.

    Raises:
        CogmapError: `until` is before `since`.
    """
    events = _events(log)
    last = max((event.step for event in events), default=0) if until is None else until
    if since > last:
        raise CogmapError(f"growth: no step from {since} to {last}; give `since` of {last} or less")
    before, after = _Replay(), _Replay()
    for event in events:
        for replay, most in ((before, since - 1), (after, last)):
            if event.step <= most:
                replay.apply(event)
    return _difference(log, since, last, before, after)


@dataclass(slots=True)
class _Replay:
    """What the domains were after some events; a place is known by the event that added it."""

    times: list[int] = field(default_factory=list[int])
    sights: list[Hashable] = field(default_factory=list[Hashable])
    positions: list[Hashable] = field(default_factory=list[Hashable])
    places: list[GrowthEvent] = field(default_factory=list[GrowthEvent])
    where: list[Hashable] = field(default_factory=list[Hashable])

    def apply(self, event: GrowthEvent) -> None:
        if event.kind == "time":
            self.times.append(event.index)
        elif event.kind in ("sight", "position"):
            (self.sights if event.kind == "sight" else self.positions).append(event.label)
        elif event.kind == "place":
            self.places.append(event)
            self.where.append(event.label)
        elif event.kind in ("bind", "unbind"):
            self.where[event.index] = event.label if event.kind == "bind" else None
        else:
            left = len(self.places) - event.index
            del self.places[left:], self.where[left:]


def _difference(log: Log, since: int, until: int, before: _Replay, after: _Replay) -> GrowthDifference:
    old, new = ({id(event): place for place, event in enumerate(part.places)} for part in (before, after))
    stayed = [place for place, event in enumerate(after.places) if id(event) in old]
    moved = [(place, before.where[place], after.where[place]) for place in stayed]
    return GrowthDifference(
        since=since,
        until=until,
        variables=tuple(name for t in after.times[len(before.times) :] for name in _variables(t)),
        sights=tuple(after.sights[len(before.sights) :]),
        positions=tuple(_position(label) for label in after.positions[len(before.positions) :]),
        places=tuple(_grown(log, after, place) for key, place in new.items() if key not in old),
        taken=tuple(_grown(log, before, place) for key, place in old.items() if key not in new),
        bound=tuple((place, _position(now)) for place, then, now in moved if now is not None and now != then),
        unbound=tuple((place, _position(then)) for place, then, now in moved if then is not None and now != then),
    )


def _variables(t: int) -> tuple[str, ...]:
    """Names of the variables of a time step; the first has neither a move nor evidence of its own."""
    names = ("s", "p", "moved", "o", "c") if t > 0 else ("s", "p")
    return tuple(f"{name}{t}" for name in names)


def _grown(log: Log, replay: _Replay, place: int) -> GrownPlace:
    event = replay.places[place]
    position = replay.where[place]
    at = None if position is None else _position(position)
    return GrownPlace(place, event.step, at, event.source, _action(log, event.action))


def _position(label: Hashable) -> Position:
    return cast(Position, label)


def _events(log: Log) -> Sequence[GrowthEvent]:
    return log.growth if isinstance(log, GenerativeModel) else log


def _action(log: Log, action: int | None) -> str | None:
    if action is None:
        return None
    return log.motions.names[action] if isinstance(log, GenerativeModel) else f"action {action}"


def _listed(items: Sequence[object]) -> str:
    more = f", … and {len(items) - MOST} more" if len(items) > MOST else ""
    return ", ".join(map(str, items[:MOST])) + more


def _old(graph: DiGraph[Any], kind: str, label: Hashable) -> tuple[str, Hashable]:
    """The node, which is added as one that was there before if it is not there yet."""
    node = (kind, label)
    if node not in graph:
        graph.add_node(node, kind=kind, label=label, added=False)
    return node

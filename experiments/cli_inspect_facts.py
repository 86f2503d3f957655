"""What is in a saved agent, as plain JSON values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from pathlib import Path
from typing import Any

import numpy as np

from ..agent import Agent, Settings, read_header
from ..model import BLOCKED, ELSEWHERE, OPEN, CognitiveMap
from ..model.growth_event import KINDS
from ..model.growth_table import growth_between, growth_table
from ..model.labels import encode, plain
from ..model.map_graph import LEAST, how_known, map_graph, transitions
from ..model.map_tables import counts_of

DOORS = {OPEN: "open", BLOCKED: "blocked"}


def summary(path: Path, agent: Agent) -> dict[str, Any]:
    """What the file and the map in it are, in numbers."""
    map_, header = agent.map, read_header(path)
    tables = {name: getattr(map_, name).nbytes for name in ("A_o", "A_p", "B_s")}
    settings, default = agent.settings.to_dict(), Settings().to_dict()
    graph = agent.graph
    return {
        "file": str(path),
        "bytes": path.stat().st_size,
        "schema": header["schema"],
        "version": header.get("version"),
        "steps": agent.steps,
        "settings": settings,
        "changed_settings": {name: value for name, value in settings.items() if value != default[name]},
        "motions": dict(zip(map_.motions.names, map(list, map_.motions.displacements), strict=True)),
        "places": {
            "all": len(map_.places),
            "visited": int(map_.visited.sum()),
            "imagined": int((~map_.visited).sum()),
            "without_position": int((map_.position_index < 0).sum()),
        },
        "positions": len(map_.positions),
        "sights": [_json(label) for label in map_.sights],
        "ways": _ways(map_),
        "events": {kind: Counter(event.kind for event in map_.growth)[kind] for kind in KINDS},
        "belief": _belief(agent),
        "window": {"variables": len(graph.variables), "factors": len(graph.factors)},
        "memory": {**tables, "all_tables": sum(tables.values())},
    }


def place_rows(agent: Agent) -> list[dict[str, Any]]:
    """A row a place: what is known of it."""
    belief = agent.belief.places if agent.steps else {}
    rows: list[dict[str, Any]] = []
    for place, facts in map_graph(agent.map).nodes(data=True):
        sight, probability = _best(facts["sights"]) if facts["visited"] else (None, None)
        rows.append(
            {
                "place": place,
                "position": facts["position"],
                "visited": facts["visited"],
                "sight": _json(sight),
                "sight_probability": probability,
                "belief": belief.get(place, 0.0),
            }
        )
    return rows


def transition_rows(map_: CognitiveMap) -> list[dict[str, Any]]:
    """A row a transition within the map, besides staying, of probability `LEAST` or more."""
    return [
        {
            "place": place,
            "action": map_.motions.names[action],
            "next": next_,
            "probability": probability,
            "count": count,
            "known": how_known(map_, place, action),
        }
        for place, action, next_, probability, count in transitions(map_)
        if action != map_.motions.stay and probability >= LEAST
    ]


def place_facts(agent: Agent, place: int) -> dict[str, Any]:
    """Everything about one place.

    Raises:
        CogmapError: there is no such place.
    """
    map_ = agent.map
    counts = counts_of(map_, place)  # raises where there is no such place
    visits = map_.visited_places.tolist()
    rows = [row for row in transition_rows(map_) if place in (row["place"], row["next"])]
    return {
        "place": place,
        "position": map_.position(place),
        "visited": bool(map_.visited[place]),
        "visited_as": visits.index(place) + 1 if place in visits else None,
        "belief": agent.belief.places.get(place, 0.0) if agent.steps else 0.0,
        "sights": [[_json(label), p] for label, p in _sights(map_, place)],
        "ways": [_way(map_, place, action) for action in range(len(map_.motions))],
        "reached_from": [row for row in rows if row["next"] == place and row["place"] != place],
        "counts": {name: [[_json(key), value] for key, value in found.items()] for name, found in counts.items()},
    }


def growth_rows(map_: CognitiveMap, since: int) -> dict[str, Any]:
    """The events from step `since` on, and what they come to.

    Raises:
        CogmapError: the map is younger.
    """
    table = growth_table(map_, since)
    difference = growth_between(map_, since)
    events = [dict(zip(map(str, table.columns), row, strict=True)) for row in table.cells]
    return {
        "since": since,
        "until": difference.until,
        "added": {
            "variables": list(difference.variables),
            "sights": [_json(label) for label in difference.sights],
            "positions": list(difference.positions),
            "places": [new.place for new in difference.places],
        },
        "taken_away": {"places": [old.place for old in difference.taken]},
        "events": [{**event, "label": _json(event["label"])} for event in events],
    }


def _ways(map_: CognitiveMap) -> dict[str, int]:
    names = ("walked", "imagined", "refuted", "unknown")
    ways = [action for action in range(len(map_.motions)) if action != map_.motions.stay]
    found = Counter(how_known(map_, place, action) for place in map_.places for action in ways)
    return {name: found[name] for name in names}


def _belief(agent: Agent) -> dict[str, Any] | None:
    if not agent.steps:
        return None
    belief = agent.belief
    at = agent.map.position(belief.place)
    return {"place": belief.place, "position": at, "certainty": belief.certainty, "doubt": belief.doubt}


def _best(sights: dict[Hashable, float]) -> tuple[Hashable, float | None]:
    return next(iter(sights.items()), (None, None))


def _sights(map_: CognitiveMap, place: int) -> list[tuple[Hashable, float]]:
    keys, p, _ = map_.A_o.mean(np.array([place]))
    found = zip(keys[0].tolist(), p[0].tolist(), strict=True)
    return sorted(((map_.sights[key], q) for key, q in found if key >= 0 and q >= LEAST), key=lambda pair: -pair[1])


def _way(map_: CognitiveMap, place: int, action: int) -> dict[str, Any]:
    keys, p, _ = map_.B_s.mean(np.array([map_.row(place, action)]))
    found = zip(keys[0].tolist(), p[0].tolist(), strict=True)
    leads = sorted(((key, q) for key, q in found if key >= ELSEWHERE and q >= LEAST), key=lambda pair: -pair[1])
    return {
        "action": map_.motions.names[action],
        "door": DOORS.get(int(map_.sensed[place, action]), "unknown"),
        "known": how_known(map_, place, action),
        "leads_to": [[None if key == ELSEWHERE else key, q] for key, q in leads],
    }


def _json(label: Any) -> Any:
    return encode(plain(label), where="inspect")

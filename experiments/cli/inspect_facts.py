"""What is in a saved agent, as plain JSON values."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from ...agent import Agent, Settings, read_header
from ...model import (
    BLOCKED,
    ELSEWHERE,
    KINDS,
    LEAST,
    OPEN,
    CognitiveMap,
    SparseDirichlet,
    counts_of,
    encode,
    growth_between,
    growth_table,
    how_known,
    map_graph,
    plain,
    transitions,
)

DOORS = {OPEN: "open", BLOCKED: "blocked"}
Facts = dict[str, Any]


def summary(path: Path, agent: Agent) -> Facts:
    """What the file and the map in it are, in numbers."""
    map_, header, graph = agent.map, read_header(path), agent.graph
    tables = {name: getattr(map_, name).nbytes for name in ("A_o", "A_p", "B_s")}
    settings, default = agent.settings.to_dict(), Settings().to_dict()
    visited, events = int(map_.visited.sum()), Counter(event.kind for event in map_.growth)
    return {
        "file": str(path),
        "bytes": path.stat().st_size,
        "schema": header["schema"],
        "version": header.get("version"),
        "steps": agent.steps,
        "settings": settings,
        "parts": agent.parts,
        "changed_settings": {name: value for name, value in settings.items() if value != default[name]},
        "motions": dict(zip(map_.motions.names, map(list, map_.motions.displacements), strict=True)),
        "places": {
            "all": len(map_.places),
            "visited": visited,
            "imagined": len(map_.places) - visited,
            "without_position": sum(map_.position(place) is None for place in map_.places),
        },
        "positions": len(map_.positions),
        "sights": [_json(label) for label in map_.sights],
        "ways": ways_known(map_),
        "events": {kind: events[kind] for kind in KINDS},
        "belief": _belief(agent),
        "window": {"variables": len(graph.variables), "factors": len(graph.factors)},
        "memory": {**tables, "all_tables": sum(tables.values())},
    }


def ways_known(map_: CognitiveMap) -> dict[str, int]:
    """How many ways out of places are known how; staying is none."""
    ways = [action for action in range(len(map_.motions)) if action != map_.motions.stay]
    found = Counter(how_known(map_, place, action) for place in map_.places for action in ways)
    return {name: found[name] for name in ("walked", "imagined", "refuted", "unknown")}


def place_rows(agent: Agent) -> list[Facts]:
    """A row a place: what is known of it."""
    belief = agent.belief.places if agent.steps else {}
    rows: list[Facts] = []
    for place, facts in map_graph(agent.map).nodes(data=True):
        sight, probability = next(iter(facts["sights"].items()), (None, None)) if facts["visited"] else (None, None)
        known = {"place": place, "position": facts["position"], "visited": facts["visited"], "sight": _json(sight)}
        rows.append({**known, "sight_probability": probability, "belief": belief.get(place, 0.0)})
    return rows


def transition_rows(map_: CognitiveMap) -> list[Facts]:
    """A row a transition within the map, besides staying, of probability `LEAST` or more."""
    names = ("place", "action", "next", "probability", "count", "known")
    return [
        dict(zip(names, (place, map_.motions.names[action], *rest, how_known(map_, place, action)), strict=True))
        for place, action, *rest in transitions(map_)
        if action != map_.motions.stay and rest[1] >= LEAST
    ]


def place_facts(agent: Agent, place: int) -> Facts:
    """Everything about one place. Raises CogmapError: there is no such place."""
    map_ = agent.map
    counts = counts_of(map_, place)  # raises where there is no such place
    visits = map_.visited_places.tolist()
    into = [row for row in transition_rows(map_) if row["next"] == place and row["place"] != place]
    return {
        "place": place,
        "position": map_.position(place),
        "visited": bool(map_.visited[place]),
        "visited_as": visits.index(place) + 1 if place in visits else None,
        "belief": agent.belief.places.get(place, 0.0) if agent.steps else 0.0,
        "sights": [[_json(map_.sights[key]), p] for key, p in _probable(map_.A_o, place, least=0)],
        "ways": [_way(map_, place, action) for action in range(len(map_.motions))],
        "reached_from": into,
        "counts": {name: [[_json(key), value] for key, value in found.items()] for name, found in counts.items()},
    }


def growth_rows(map_: CognitiveMap, since: int) -> Facts:
    """The events from step `since` on, and what they come to. Raises CogmapError: the map is younger."""
    table, difference = growth_table(map_, since), growth_between(map_, since)
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


def _belief(agent: Agent) -> Facts | None:
    if not agent.steps:
        return None
    belief = agent.belief
    at = agent.map.position(belief.place)
    return {"place": belief.place, "position": at, "certainty": belief.certainty, "doubt": belief.doubt}


def _way(map_: CognitiveMap, place: int, action: int) -> Facts:
    leads = _probable(map_.B_s, map_.row(place, action), least=ELSEWHERE)
    return {
        "action": map_.motions.names[action],
        "door": DOORS.get(int(map_.sensed[place, action]), "unknown"),
        "known": how_known(map_, place, action),
        "leads_to": [[None if key == ELSEWHERE else key, p] for key, p in leads],
    }


def _probable(table: SparseDirichlet, row: int, *, least: int) -> list[tuple[int, float]]:
    """Outcomes from `least` on of a probability of `LEAST` or more, the most probable first."""
    keys, p, _ = table.mean(np.array([row]))
    found = zip(keys[0].tolist(), p[0].tolist(), strict=True)
    return sorted(((key, q) for key, q in found if key >= least and q >= LEAST), key=lambda pair: -pair[1])


def _json(label: Any) -> Any:
    return encode(plain(label), where="inspect")

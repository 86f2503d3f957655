"""The cognitive map as a networkx graph, as Graphviz source and as JSON, for people's own scripts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from .factors import BLOCKED, OPEN, Carried, Sight
from .graph import quoted
from .labels import shown
from .readable_map import ReadableMap
from .written import PlaceFacts, shares_json

if TYPE_CHECKING:
    import networkx as nx

LEAST = 1e-3  # probability of a sight that is told, and of a transition that Graphviz draws


def map_graph(map_: ReadableMap) -> nx.MultiDiGraph[Any]:
    """Places as nodes, transitions as edges keyed by action name.

    Nodes carry `position` (None where it has none), `visited` (else it was imagined only), and
    `sights` (label -> probability above a thousandth; what another sensor of labels sees stands under its name), and
    what is carried there, where the map has places for that.
    Edges carry `action`, `probability` (of B_s), `count` (the evidence for it, prior left out), and `known`, what is
    known of this way out of the place: `walked`, `imagined` (its door was sensed open), `refuted` (sensed blocked) or
    `unknown` (its door was never sensed from this side; it may still have a `count`, which came with the way here).
    Beyond a door without a known place there is no edge, and none through a door that is sensed blocked: that way leads
    back to the place itself. networkx writes it as GraphML and GEXF, positions and sights as JSON text.
    """
    import networkx as nx

    graph: Any = nx.MultiDiGraph()
    graph.node_attr_dict_factory = PlaceFacts
    seen = [_sights(map_, sight) for sight in map_.sights_sensed]
    names = ["sights", *(sight.name for sight in map_.sights_sensed[1:])]
    carried = [sensor for sensor in map_.sensors.values() if isinstance(sensor, Carried)]
    for place in map_.places:
        facts: dict[str, Any] = dict(zip(names, (labels[place] for labels in seen), strict=False)) or {"sights": {}}
        facts |= {sensor.name: sensor.carried_in(place) for sensor in carried}
        graph.add_node(place, position=map_.position(place), visited=bool(map_.visited[place]), **facts)
    for place, action, next_, probability, count in transitions(map_):
        name = map_.motions.names[action]
        known = how_known(map_, place, action)
        if known == "refuted" and next_ != place:
            continue
        graph.add_edge(place, next_, key=name, action=name, probability=probability, count=count, known=known)
    return graph


def transitions(map_: ReadableMap) -> Iterator[tuple[int, int, int, float, float]]:
    """Place, action, next place, P(s' | s, a) and the evidence for it, of every transition within the map."""
    rows = np.arange(len(map_.B_s))
    keys, p, _ = map_.B_s.mean(rows)
    evidence = map_.B_s.state()["evidence"]
    for row, slot in np.argwhere(keys >= 0).tolist():
        place, action = divmod(row, len(map_.motions))
        yield place, action, int(keys[row, slot]), float(p[row, slot]), float(evidence[row, slot])


def how_known(map_: ReadableMap, place: int, action: int) -> str:
    """What is known of the way that `action` takes out of `place`; see `map_graph`."""
    if action == map_.motions.stay:
        return "walked"
    sensed = int(map_.sensed[place, action])
    if sensed == BLOCKED:
        return "refuted"
    if map_.walked[place, action]:
        return "walked"
    return "imagined" if sensed == OPEN else "unknown"


def map_node_link(map_: ReadableMap) -> dict[str, Any]:
    """The map as plain JSON values in networkx' node-link layout: `networkx.node_link_graph(values, edges="edges")`.

    Nodes carry `sights` as a list of `{"sight", "probability"}`; tuples in labels are written `{"tuple": [...]}`.

    Raises:
        CogmapError: a label cannot be written as JSON.
    """
    graph = map_graph(map_)
    return {
        "directed": True,
        "multigraph": True,
        "graph": {
            "format": "cogmap map",
            "motions": dict(zip(map_.motions.names, map(list, map_.motions.displacements), strict=True)),
        },
        "nodes": [{"id": place, **_plain_place(facts)} for place, facts in graph.nodes(data=True)],
        "edges": [
            {"source": place, "target": next_, "key": key, **facts}
            for place, next_, key, facts in graph.edges(keys=True, data=True)
        ],
    }


def map_json(map_: ReadableMap, *, indent: int | None = None) -> str:
    """`map_node_link` as text."""
    return json.dumps(map_node_link(map_), allow_nan=False, indent=indent)


def map_dot(map_: ReadableMap) -> str:
    """Graphviz source: visited places are filled, imagined ones dashed; a wall (a way back to itself) is not drawn.

    Positions are given as `pos`, rows downwards, for `neato -n2`; `dot` lays out by itself. A transition is as dark
    as it is probable, and dashed where it was only imagined.
    """
    graph = map_graph(map_)
    lines = ["digraph cognitive_map {", "  node [shape=circle, fontsize=11];", "  edge [fontsize=9];"]
    for place, facts in graph.nodes(data=True):
        lines.append(f"  {place} [{_dot_place(place, facts)}];")
    for place, next_, facts in graph.edges(data=True):
        if place != next_ and facts["probability"] >= LEAST:
            style = "dashed" if facts["known"] in ("imagined", "unknown") else "solid"
            shade = f"gray{round(85 * (1.0 - facts['probability']))}"
            tip = f"{facts['action']}: {facts['probability']:.3f}, {facts['known']}"
            label = quoted(facts["action"])
            lines.append(f"  {place} -> {next_} [label={label}, style={style}, color={shade}, tooltip={quoted(tip)}];")
    return "\n".join([*lines, "}"]) + "\n"


def _sights(map_: ReadableMap, sight: Sight) -> list[dict[object, float]]:
    """Of each place its labels above a thousandth, the most probable first."""
    sights: list[dict[object, float]] = [{} for _ in map_.places]
    keys, p, _ = sight.table.mean(np.arange(len(sights)))
    order = np.argsort(-p, axis=1, kind="stable")
    for place, (row, ranked) in enumerate(zip(keys.tolist(), order.tolist(), strict=True)):
        for slot in ranked:
            if row[slot] >= 0 and p[place, slot] > LEAST:
                sights[place][sight.labels[row[slot]]] = float(p[place, slot])
    return sights


def _plain_place(facts: dict[str, Any]) -> dict[str, Any]:
    position = None if facts["position"] is None else list(facts["position"])
    seen = {name: shares_json(facts[name]) for name in facts if isinstance(facts[name], dict)}
    return {**facts, "position": position, **seen}


def _dot_place(place: int, facts: dict[str, Any]) -> str:
    best = next(iter(facts["sights"]), None) if facts["visited"] else None
    label = f"{place}\n{shown(best, most=20)}" if facts["visited"] and facts["sights"] else str(place)
    label = "\n".join([label, *(facts[name] for name in facts if isinstance(facts[name], str))])
    style = "filled" if facts["visited"] else "dashed"
    position = facts["position"]
    at = ""
    if position is not None and len(position) <= 2:
        row, column = (0, *position)[-2:]
        at = f', pos="{72 * column},{-72 * row}"'
    return f"style={style}, fillcolor=lightgrey, label={quoted(label)}, tooltip={quoted(str(position))}{at}"

"""What is in a saved agent, as tables in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...model import CognitiveMap, decode, growth_between, shown
from ..statistics import count, number
from .inspect_facts import Facts
from .tables import say, show_facts, show_table


def show_summary(facts: Facts) -> None:
    """The summary, a line a fact."""
    places, belief, window = facts["places"], facts["belief"], facts["window"]
    events = [count(number, kind) for kind, number in facts["events"].items() if number]
    lost = f", {places['without_position']} without a position" if places["without_position"] else ""
    changed = ", ".join(f"{name} {value}" for name, value in facts["changed_settings"].items())
    sights = [_label(label, 16) for label in facts["sights"]]
    at = "" if belief is None or belief["position"] is None else f" at {belief['position']}"
    show_facts(
        {
            "file": f"{facts['file']} ({_bytes(facts['bytes'])})",
            "schema": f"{facts['schema']}, written by cogmap {facts['version'] or '(unknown version)'}",
            "steps": str(facts["steps"]),
            "settings": changed or "all default",
            "actions": ", ".join(facts["motions"]),
            "places": f"{places['all']} ({places['visited']} visited, {places['imagined']} imagined{lost})",
            "positions": str(facts["positions"]),
            "sights": f"{len(sights)}: {_listed(sights)}" if sights else "none",
            "ways out": ", ".join(f"{number} {name}" for name, number in facts["ways"].items()),
            "growth": _listed(events, most=9),
            "belief": "it has seen nothing yet"
            if belief is None
            else f"place {belief['place']}{at}, certainty {belief['certainty']:.3f}, doubt {belief['doubt']:.3f}",
            "window": f"{count(window['variables'], 'variable')}, {count(window['factors'], 'factor')}",
            "memory": f"{_bytes(facts['memory']['all_tables'])} of counts",
        }
    )


def show_places(rows: Sequence[Facts], limit: int) -> None:
    """A row a place."""
    cells = [
        (
            row["place"],
            _position(row["position"]),
            "visited" if row["visited"] else "imagined",
            _label(row["sight"]) if row["visited"] else "-",
            number(row["sight_probability"], digits=3),
            number(row["belief"] or None, digits=3),
        )
        for row in rows[:limit]
    ]
    headings = (">place", "position", "known", "sight", ">P(sight)", ">Q(place)")
    show_table("places", headings, cells, more=len(rows) - limit)


def show_transitions(rows: Sequence[Facts], limit: int, *, title: str = "transitions") -> None:
    """A row a transition."""
    cells = [
        (
            row["place"],
            row["action"],
            "itself" if row["next"] == row["place"] else row["next"],
            f"{row['probability']:.3f}",
            f"{row['count']:g}",
            row["known"],
        )
        for row in rows[:limit]
    ]
    show_table(title, (">place", "action", ">next", ">P", ">count", "known"), cells, more=len(rows) - limit)


def show_place(facts: Facts, limit: int) -> None:
    """Everything about one place."""
    counts = [
        f"{name}: " + ", ".join(f"{_label(key)} {value:g}" for key, value in found)
        for name, found in facts["counts"].items()
        if found
    ]
    show_facts(
        {
            "place": str(facts["place"]),
            "position": _position(facts["position"]),
            "known": f"visited (the {_ordinal(facts['visited_as'])} place)" if facts["visited"] else "imagined",
            "belief": f"{facts['belief']:.3f}",
            "sights": ", ".join(f"{_label(label)} {p:.3f}" for label, p in facts["sights"]) or "none known",
            "counts": "\n".join(counts) or "none",
        }
    )
    ways = [(way["action"], way["door"], way["known"], _leads(way["leads_to"])) for way in facts["ways"]]
    show_table("ways out", ("action", "door", "known", "leads to"), ways)
    show_transitions(facts["reached_from"], limit, title="ways here")


def show_growth(map_: CognitiveMap, facts: Facts, limit: int) -> None:
    """What was added and taken away, and the events."""
    say(growth_between(map_, facts["since"]))
    cells = [
        (
            event["step"],
            event["kind"],
            event["index"],
            "-" if event["label"] is None and event["kind"] != "sight" else _label(event["label"]),
            "-" if event["source"] is None else event["source"],
            event["action"] or "-",
        )
        for event in facts["events"][:limit]
    ]
    headings = (">step", "kind", ">index", "label", ">source", "action")
    show_table("growth", headings, cells, more=len(facts["events"]) - limit)


def _leads(pairs: Sequence[tuple[int | None, float]]) -> str:
    return ", ".join(f"{'elsewhere' if place is None else place} {p:.3f}" for place, p in pairs)


def _label(label: Any, most: int = 24) -> str:
    return shown(decode(label), most=most)


def _position(position: Sequence[int] | None) -> str:
    return "-" if position is None else str(tuple(position))


def _ordinal(number: int) -> str:
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def _listed(items: Sequence[str], most: int = 12) -> str:
    return ", ".join(items[:most]) + (f", … {len(items) - most} more" if len(items) > most else "")


def _bytes(number: int) -> str:
    return f"{number} bytes" if number < 1024 else f"{number / 1024:.1f} KiB"

"""What is in a saved agent, as tables in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

from ..model.growth_table import growth_between
from ..model.labels import decode, shown
from .cli_table import console, count

Row = dict[str, Any]


def show_summary(facts: Row) -> None:
    """The summary, a line a fact."""
    places, ways, belief = facts["places"], facts["ways"], facts["belief"]
    events = [count(number, kind) for kind, number in facts["events"].items() if number]
    lost = f", {places['without_position']} without a position" if places["without_position"] else ""
    changed = ", ".join(f"{name} {value}" for name, value in facts["changed_settings"].items())
    sights = [shown(decode(label), most=16) for label in facts["sights"]]
    at = "" if belief is None or belief["position"] is None else f" at {belief['position']}"
    lines = {
        "file": f"{facts['file']} ({_bytes(facts['bytes'])})",
        "schema": f"{facts['schema']}, written by cogmap {facts['version'] or '(unknown version)'}",
        "steps": str(facts["steps"]),
        "settings": changed or "all default",
        "actions": ", ".join(facts["motions"]),
        "places": f"{places['all']} ({places['visited']} visited, {places['imagined']} imagined{lost})",
        "positions": str(facts["positions"]),
        "sights": f"{len(sights)}: {_listed(sights)}" if sights else "none",
        "ways out": ", ".join(f"{number} {name}" for name, number in ways.items()),
        "growth": _listed(events, most=9),
        "belief": "it has seen nothing yet"
        if belief is None
        else f"place {belief['place']}{at}, certainty {belief['certainty']:.3f}, doubt {belief['doubt']:.3f}",
        "window": f"{count(facts['window']['variables'], 'variable')}, {count(facts['window']['factors'], 'factor')}",
        "memory": f"{_bytes(facts['memory']['all_tables'])} of counts",
    }
    _show_facts(lines)


def show_places(rows: Sequence[Row], limit: int) -> None:
    """A row a place."""
    cells = [
        (
            row["place"],
            _position(row["position"]),
            "visited" if row["visited"] else "imagined",
            "-" if not row["visited"] else shown(decode(row["sight"]), most=24),
            _probability(row["sight_probability"]),
            _probability(row["belief"] or None),
        )
        for row in rows[:limit]
    ]
    headings = (">place", "position", "known", "sight", ">P(sight)", ">Q(place)")
    show_table("places", headings, cells, more=len(rows) - limit)


def show_transitions(rows: Sequence[Row], limit: int) -> None:
    """A row a transition."""
    show_table("transitions", _TRANSITION, _transitions(rows[:limit]), more=len(rows) - limit)


def show_place(facts: Row, limit: int) -> None:
    """Everything about one place."""
    known = f"visited (the {_ordinal(facts['visited_as'])} place)" if facts["visited"] else "imagined"
    sights = [f"{shown(decode(label), most=24)} {p:.3f}" for label, p in facts["sights"]]
    counts = [
        f"{name}: " + ", ".join(f"{shown(decode(key), most=24)} {value:g}" for key, value in found)
        for name, found in facts["counts"].items()
        if found
    ]
    _show_facts(
        {
            "place": str(facts["place"]),
            "position": _position(facts["position"]),
            "known": known,
            "belief": f"{facts['belief']:.3f}",
            "sights": ", ".join(sights) or "none known",
            "counts": "\n".join(counts) or "none",
        }
    )
    ways = [(way["action"], way["door"], way["known"], _leads(way["leads_to"])) for way in facts["ways"]]
    show_table("ways out", ("action", "door", "known", "leads to"), ways)
    reached = facts["reached_from"]
    show_table("ways here", _TRANSITION, _transitions(reached[:limit]), more=len(reached) - limit)


def show_growth(map_: Any, facts: Row, limit: int) -> None:
    """What was added and taken away, and the events."""
    console().print(str(growth_between(map_, facts["since"])), markup=False, highlight=False, soft_wrap=True)
    events = facts["events"]
    cells = [
        (
            event["step"],
            event["kind"],
            event["index"],
            "-" if event["label"] is None and event["kind"] != "sight" else shown(decode(event["label"]), most=24),
            "-" if event["source"] is None else event["source"],
            event["action"] or "-",
        )
        for event in events[:limit]
    ]
    show_table("growth", (">step", "kind", ">index", "label", ">source", "action"), cells, more=len(events) - limit)


def show_table(title: str, headings: Sequence[str], rows: Sequence[Sequence[object]], *, more: int = 0) -> None:
    """A table; a heading that begins with > is set right. `more` rows were left out."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        table.add_column(heading.removeprefix(">"), justify="right" if heading.startswith(">") else "left")
    for row in rows:
        table.add_row(*(escape(str(cell)) for cell in row))
    to = console()
    to.print(title, style="bold", markup=False, highlight=False)
    to.print(table)
    if more > 0:
        to.print(f"… {more} more; show them with --limit {len(rows) + more}", style="dim", highlight=False)


_TRANSITION = (">place", "action", ">next", ">P", ">count", "known")


def _transitions(rows: Sequence[Row]) -> list[tuple[object, ...]]:
    return [
        (
            row["place"],
            row["action"],
            "itself" if row["next"] == row["place"] else row["next"],
            _probability(row["probability"]),
            f"{row['count']:g}",
            row["known"],
        )
        for row in rows
    ]


def _show_facts(lines: dict[str, str]) -> None:
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, text in lines.items():
        table.add_row(name, escape(text))
    console().print(table)


def _leads(pairs: Sequence[tuple[int | None, float]]) -> str:
    return ", ".join(f"{'elsewhere' if place is None else place} {p:.3f}" for place, p in pairs)


def _position(position: Sequence[int] | None) -> str:
    return "-" if position is None else str(tuple(position))


def _probability(p: float | None) -> str:
    return "-" if p is None else f"{p:.3f}"


def _ordinal(number: int) -> str:
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def _listed(items: Sequence[str], most: int = 12) -> str:
    return ", ".join(items[:most]) + (f", … {len(items) - most} more" if len(items) > most else "")


def _bytes(number: int) -> str:
    return f"{number} bytes" if number < 1024 else f"{number / 1024:.1f} KiB"

"""What is in a saved agent, as tables in a terminal."""

from collections.abc import Callable, Sequence
from operator import itemgetter
from typing import Any

from ...model import decode, shown
from ..text import count, number, show_facts, show_table
from .inspect_facts import Facts

Columns = dict[str, Callable[[Facts], object]]
"""What a table shows of a row under each heading; a heading that begins with > is set right."""


def _label(label: Any, most: int = 24) -> str:
    return shown(decode(label), most=most)


def _position(position: Sequence[int] | None) -> str:
    return "-" if position is None else str(tuple(position))


def _leads(row: Facts) -> str:
    return ", ".join(f"{'elsewhere' if place is None else place} {p:.3f}" for place, p in row["leads_to"])


PLACES: Columns = {
    ">place": itemgetter("place"),
    "position": lambda row: _position(row["position"]),
    "known": lambda row: "visited" if row["visited"] else "imagined",
    "sight": lambda row: _label(row["sight"]) if row["visited"] else "-",
    ">P(sight)": lambda row: number(row["sight_probability"], digits=3),
    ">Q(place)": lambda row: number(row["belief"] or None, digits=3),
}
TRANSITIONS: Columns = {
    ">place": itemgetter("place"),
    "action": itemgetter("action"),
    ">next": lambda row: "itself" if row["next"] == row["place"] else row["next"],
    ">P": lambda row: number(row["probability"], digits=3),
    ">count": lambda row: f"{row['count']:g}",
    "known": itemgetter("known"),
}
WAYS: Columns = {**{name: itemgetter(name) for name in ("action", "door", "known")}, "leads to": _leads}
GROWTH: Columns = {
    ">step": itemgetter("step"),
    "kind": itemgetter("kind"),
    ">index": itemgetter("index"),
    "label": lambda row: "-" if row["label"] is None and row["kind"] != "sight" else _label(row["label"]),
    ">source": lambda row: "-" if row["source"] is None else row["source"],
    "action": lambda row: row["action"] or "-",
}


def show_rows(title: str, columns: Columns, rows: Sequence[Facts], limit: int) -> None:
    """A table of rows, at most `limit` of them."""
    cells = [[cell(row) for cell in columns.values()] for row in rows]
    show_table(list(columns), cells, title=title, most=limit)


def show_summary(facts: Facts) -> None:
    """The summary, a line a fact."""
    places, belief, window = facts["places"], facts["belief"], facts["window"]
    lost = f", {places['without_position']} without a position" if places["without_position"] else ""
    changed = [f"{name} {value}" for name, value in facts["changed_settings"].items()]
    sights, believed = [_label(label, 16) for label in facts["sights"]], "it has seen nothing yet"
    if belief is not None:
        at = "" if belief["position"] is None else f" at {belief['position']}"
        sure = f"certainty {belief['certainty']:.3f}, doubt {belief['doubt']:.3f}"
        believed = f"place {belief['place']}{at}, {sure}"
    lines = {
        "file": f"{facts['file']} ({_bytes(facts['bytes'])})",
        "schema": f"{facts['schema']}, written by cogmap {facts['version'] or '(unknown version)'}",
        "steps": str(facts["steps"]),
        "settings": ", ".join(changed) or "all default",
        "actions": ", ".join(facts["motions"]),
        "places": f"{places['all']} ({places['visited']} visited, {places['imagined']} imagined{lost})",
        "positions": str(facts["positions"]),
        "sights": f"{len(sights)}: {_listed(sights)}" if sights else "none",
        "ways out": ", ".join(f"{number} {name}" for name, number in facts["ways"].items()),
        "growth": ", ".join(count(number, kind) for kind, number in facts["events"].items() if number),
        "belief": believed,
        "window": f"{count(window['variables'], 'variable')}, {count(window['factors'], 'factor')}",
        "memory": f"{_bytes(facts['memory']['all_tables'])} of counts",
    }
    show_facts(lines)


def show_place(facts: Facts, limit: int) -> None:
    """Everything about one place."""
    counted = {name: [f"{_label(key)} {value:g}" for key, value in found] for name, found in facts["counts"].items()}
    visited = f"visited (the {_ordinal(facts['visited_as'])} place)" if facts["visited"] else "imagined"
    lines = {
        "place": str(facts["place"]),
        "position": _position(facts["position"]),
        "known": visited,
        "belief": f"{facts['belief']:.3f}",
        "sights": ", ".join(f"{_label(label)} {p:.3f}" for label, p in facts["sights"]) or "none known",
        "counts": "\n".join(f"{name}: {', '.join(found)}" for name, found in counted.items() if found) or "none",
    }
    show_facts(lines)
    show_rows("ways out", WAYS, facts["ways"], len(facts["ways"]))
    show_rows("ways here", TRANSITIONS, facts["reached_from"], limit)


def _ordinal(number: int) -> str:
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def _listed(items: Sequence[str], most: int = 12) -> str:
    return ", ".join(items[:most]) + (f", … {len(items) - most} more" if len(items) > most else "")


def _bytes(number: int) -> str:
    return f"{number} bytes" if number < 1024 else f"{number / 1024:.1f} KiB"

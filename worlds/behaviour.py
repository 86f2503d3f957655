"""Which places behave alike, so that no agent that is not told positions can tell them apart."""

from typing import Any

from .protocol import Chart


def behaviour(chart: Chart, *, doors: bool = True) -> dict[Any, int]:
    """A number for each place, equal for places that no sequence of actions can tell apart.

    Partition refinement (Moore 1956): places that look alike are told apart where an action leads to places that
    were told apart.

    Args:
        chart: a maze, or the chart of another world.
        doors: whether an agent senses which ways are open.
    """
    exits = {place: chart.exits(place) for place in chart.places}
    sights = chart.sights
    looks = {
        place: (sights[place], tuple((way, ahead is not None or not doors) for way, ahead in exits[place].items()))
        for place in chart.places
    }
    classes, count = _numbered(looks), 0
    while len(set(classes.values())) > count:
        count = len(set(classes.values()))
        beyond = {
            place: tuple(classes[place if ahead is None else ahead] for ahead in exits[place].values())
            for place in chart.places
        }
        classes = _numbered({place: (classes[place], beyond[place]) for place in chart.places})
    return classes


def distinguishable(chart: Chart, *, doors: bool = True) -> bool:
    """Whether any two places can be told apart by some sequence of actions."""
    return len(set(behaviour(chart, doors=doors).values())) == len(chart.places)


def _numbered(looks: dict[Any, Any]) -> dict[Any, int]:
    numbers: dict[Any, int] = {}
    return {place: numbers.setdefault(look, len(numbers)) for place, look in looks.items()}

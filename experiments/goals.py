"""Goals that can be reached: labels, rooms that are closed, and the shortest way."""

from collections.abc import Collection
from math import inf

from ..model import CogmapError
from ..worlds import CanClose, Chart, Label, Place, WorldError, offered, shortest_path
from .session import World, chart_of

WEIGHT = 8.0
"""Log preference of the goal over all other sights, in nats a step: more than a step into a room never seen can teach,
log of the number of sights and log 2 for each of its three other doors, up to 370 sights."""

MOST_LABELS = 40  # listed in an error


def check_goal(
    world: World, goal: Label, *, weight: float = WEIGHT, closed: Collection[Place] = (), known: bool = True
) -> None:
    """Refuse a goal that cannot be reached or is not preferred, before the agent walks.

    Raises:
        CogmapError: no room has the label, a weight that is not above 0 or not finite, or rooms to close that are not
            there, leave no way to the goal from a room that is open, or are given for an unexplored world.
        WorldError: a world without a chart, or whose rooms cannot be closed.
    """
    chart = chart_of(world)
    labels = sorted(set(chart.sights.values()), key=lambda label: (str(type(label)), label))
    if goal not in labels:
        more = f" and {len(labels) - MOST_LABELS} more" if len(labels) > MOST_LABELS else ""
        named = f"no room of maze {chart.name!r} has label {goal!r}; use one of "
        raise CogmapError(f"navigate: {named}{', '.join(map(str, labels[:MOST_LABELS]))}{more}")
    if not 0.0 < weight < inf:
        raise CogmapError(f"navigate: weight is {weight}; use a log preference above 0, in nats")
    if missing := [room for room in closed if room not in chart.sights]:
        where = f"maze {chart.name!r} has no room at {missing[0]}"
        raise CogmapError(f"close: {where}; `cogmap worlds {chart.name}` shows them")
    if closed and not known:
        when = "rooms close after exploring, and this agent sets out unexplored"
        raise CogmapError(f"close: {when}; leave one of them out")
    if closed and chart is not world:
        offered(world, CanClose, "close")
    for room in chart.places if closed else ():
        if room not in closed:
            shortest(chart, room, goal, closed)


def parse_goal(world: World, text: str) -> Label:
    """The label that `text` names in this world: a whole number where its labels are numbers, else a word.

    Raises:
        CogmapError: no room has that label.
    """
    words = any(isinstance(label, str) for label in chart_of(world).sights.values())
    goal = text if words or not (text.isascii() and text.isdecimal()) else int(text)
    check_goal(world, goal)
    return goal


def shortest(chart: Chart, start: Place, goal: Label, closed: Collection[Place] = ()) -> int:
    """Steps of the shortest path to the nearest room with the label that is open; a `CogmapError` if there is none."""
    steps: list[int] = []
    for room in chart.places:
        if chart.sights[room] == goal and room not in closed:
            try:
                steps.append(len(shortest_path(chart, start, room, closed=closed)) - 1)
            except WorldError:
                continue
    if not steps:
        rooms = ", ".join(map(str, sorted(closed)))
        raise CogmapError(f"close: with {rooms} closed there is no way from {start} to label {goal!r}; leave one open")
    return min(steps)

"""What a map is worth beside the truth, whatever its places are called and whether or not they have positions."""

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import islice

import numpy as np

from ..agent import Agent
from ..model import CognitiveMap
from ..worlds import Chart, Place, place_of
from .running import Moment

BELIEVED = 0.6
"""A true transition counts as known from this probability on."""
CERTAIN = 0.7  # from this probability on an agent counts as certain of a place
OPEN = 0.5
"""What is imagined behind a way counts as a place of the map if the way is believed to lead there at least so much."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The comparison of a map with the truth."""

    places: int  # those that were visited, and those that are imagined behind ways believed open
    # whether each visited room is one place, each visited place one room, and every true transition among
    # visited rooms, walls included, is believed at `BELIEVED` or more
    map_right: bool
    known: float  # share of all true transitions of the world that are believed so much


def judge(map_: CognitiveMap, chart: Chart, rooms: Mapping[int, Place], visited: Collection[Place]) -> Verdict:
    """Compare a map with the truth.

    Args:
        map_: the map.
        chart: the true map, everything open.
        rooms: the room that each visited place stands for, None where nobody knows.
        visited: the rooms that were truly visited.
    """
    here = {room: place for place, room in rooms.items() if room is not None}
    one_to_one = len(here) == len(rooms) == int(map_.visited.sum()) and here.keys() == set(visited)
    actions, imagined = len(map_.motions), _imagined(map_)
    known, rows, ahead = 0, list[int](), list[int]()
    for room, place in here.items():
        for action, other in enumerate(islice(chart.successors(room).values(), actions)):
            if other in here:
                rows.append(map_.row(place, action))
                ahead.append(here[other])
            else:  # the room beyond was never entered: what is imagined there stands for it
                known += imagined.get((place, action), (0, 0.0))[1] >= BELIEVED
    believed = map_.B_s.probability(np.array(ahead, dtype=np.int64), np.array(rows, dtype=np.int64)) >= BELIEVED
    places = int(map_.visited.sum()) + len({to for to, _ in imagined.values()})
    known += int(believed.sum())
    return Verdict(places, one_to_one and bool(believed.all()), known / _transitions(chart))


class Trail:
    """Records where an agent truly was, where it believed it was, and how often it was certain and wrong.

    Attributes:
        rooms: the true room at each step.
        wrong: steps at which its certainty was `CERTAIN` or more, and the most probable place belonged to another room
            than the true one. A place belongs to the room in which it was visited most.
    """

    def __init__(self) -> None:
        self.rooms: list[Place] = []
        self.wrong = 0

    def __call__(self, moment: Moment) -> None:
        """Look at a choice."""
        agent, room = moment.agent, place_of(moment.info)
        self.rooms.append(room)
        if isinstance(agent, Agent):
            belief = agent.belief
            self.wrong += belief.certainty >= CERTAIN and self.room(agent, belief.place) != room

    def room(self, agent: Agent, place: int) -> Place | None:
        """The room in which a place was visited most, as the agent now believes; None if it never was."""
        first = agent.steps - len(self.rooms)
        been = Counter(self.rooms[step - first] for step in agent.steps_in(place) if step >= first)
        return been.most_common(1)[0][0] if been else None

    def right(self, agent: Agent) -> bool:
        """Whether it is where it most probably takes itself to be: the room of that place, or a new one of a new one.

        A place belongs to the room in which it was visited most; one that was never visited before is right where the
        room was not either.
        """
        place, room = agent.belief.place, self.rooms[-1]
        if len(agent.steps_in(place)) < 2:
            return room not in self.rooms[:-1]
        return self.room(agent, place) == room

    def verdict(self, agent: Agent, chart: Chart) -> Verdict:
        """What its map is worth now."""
        rooms = {place: self.room(agent, place) for place in agent.map.visited_places.tolist()}
        return judge(agent.map, chart, rooms, set(self.rooms))


def _imagined(map_: CognitiveMap) -> dict[tuple[int, int], tuple[int, float]]:
    """What is imagined behind each way of a visited place, by (place, action), and how probably it leads there."""
    places, actions = map_.visited_places, len(map_.motions)
    keys, p, _ = map_.B_s.mean(map_.rows_of(places))
    found = [
        (int(row), int(keys[row, slot]), float(p[row, slot])) for row, slot in np.argwhere((keys >= 0) & (p >= OPEN))
    ]
    return {(int(places[row // actions]), row % actions): (to, q) for row, to, q in found if not map_.visited[to]}


def _transitions(chart: Chart) -> int:
    """How many true transitions there are."""
    if chart.motions.local:
        return sum(len(chart.exits(place)) for place in chart.places)
    return len(chart.places) * len(chart.motions.names)

"""What the study `mice` counts along a walk, and its labyrinth: that of the recordings, or one like it."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

from ...agent import Agent, Settings
from ...behaviour import Ground, Route, load_ground, load_walks, new_agent, routes_of
from ...model import CogmapError

FOLDER = "COGMAP_RECORDINGS"
"""Names a folder with `mouse_labyrinth.json` and `mice/`; else `../shared/worlds` is looked into."""
PORT, HOME = 116, 127
LEVELS = 6  # of the labyrinth, its ends below
LENGTHS = (4, 4, 2, 2, 1, 1)  # of the corridors below each level


@dataclass(frozen=True, slots=True)
class Recorded:
    """The animals, their labyrinth, and which of them were thirsty."""

    ground: Ground
    routes: tuple[Route, ...]
    thirsty: tuple[bool, ...]


@cache
def recorded() -> Recorded | None:
    """The recordings; None where they are not at hand."""
    folder = Path(os.environ.get(FOLDER) or os.environ.get("COGMAP_SHARED", "../shared"))
    folder = folder if (folder / "mice").is_dir() else folder / "worlds"
    if not (folder / "mice").is_dir():
        return None
    walks = load_walks(folder / "mice")
    routes, ground = routes_of(walks, load_ground(str(folder / "mouse_labyrinth.json")))
    return Recorded(ground, tuple(routes), tuple(bool(walk.about.get("water_restricted")) for walk in walks))


def labyrinth() -> Ground:
    """A binary labyrinth of six levels with a home cage before its first fork, as that of Rosenberg et al. (2021)."""
    import networkx as nx

    from ...worlds import GraphWorld

    graph: nx.Graph[int] = nx.Graph(name="binary labyrinth")
    graph.add_node(0, position=(7, 7))
    for node in range(1, 2 ** (LEVELS + 1) - 1):
        above = (node - 1) // 2
        level = (above + 1).bit_length() - 1
        at, far = graph.nodes[above]["position"], LENGTHS[level] * (2 * (node % 2 == 0) - 1)
        graph.add_node(node, position=(at[0] + far * (level % 2 == 0), at[1] + far * (level % 2)))
        graph.add_edge(above, node)
    graph.add_node(HOME, position=(7, -1))
    graph.add_edge(0, HOME)
    world = GraphWorld.from_networkx(graph, sights="distinct")
    return Ground.of(world.chart, home=HOME)


def ground() -> Ground:
    """The labyrinth of the recordings, or the one like it."""
    found = recorded()
    return labyrinth() if found is None else found.ground


@dataclass(frozen=True, slots=True)
class Ends:
    """How a walk finds the ends of the labyrinth."""

    new: tuple[int, ...]  # of each visit to an end, in order, how many different ones were found by then
    steps_to_all: int | None  # moves until every place was entered; None if that never happened

    @property
    def half(self) -> int | None:
        """N32: visits to ends until half of them were found; None if they never were."""
        return next((i + 1 for i, found in enumerate(self.new) if found >= 2 ** (LEVELS - 1)), None)

    @property
    def efficiency(self) -> float | None:
        """32 / N32: 1 where no end is visited twice."""
        return None if self.half is None else 2 ** (LEVELS - 1) / self.half


def ends_of(places: Sequence[int], ground: Ground) -> Ends:
    """How a walk finds the ends; home is none."""
    ends = {i for i, ways in enumerate(ground.ways) if len(ways) == 1 and i != ground.home}
    found, entered, new, all_at = set[int](), set[int](), list[int](), None
    for step, place in enumerate(places):
        entered.add(place)
        if place in ends:
            found.add(place)
            new.append(len(found))
        if all_at is None and len(entered) == len(ground.places):
            all_at = step
    return Ends(tuple(new), all_at)


def explored(seed: int, settings: Settings, *, most: int) -> list[int]:
    """The walk of the agent itself from home, until every place was entered."""
    here = ground()
    agent = new_agent(here, look_ahead=settings.look_ahead, seed=seed)
    names, places = list(agent.map.motions.names), [here.home or 0]
    observation = here.observation(places[-1])
    while len(set(places)) < len(here.places) and len(places) <= most:
        name = names[agent.step(observation)]
        places.append(next((way.target for way in here.ways[places[-1]] if way.action == name), places[-1]))
        observation = here.observation(places[-1])
    return places


@dataclass(frozen=True, slots=True)
class Trips:
    """Ways home and to the port after the first water."""

    # bouts in which the port was visited, and how often the way there from home was the shortest
    to_port: tuple[int, int]
    home: tuple[int, int]  # bouts, and how often the way home from the last end was the shortest


def trips_of(route: Route, ground: Ground) -> Trips | None:
    """Of one animal; None if it never found the port."""
    places, port, home = route.places.tolist(), ground.find(PORT, "port"), ground.find(HOME, "home")
    if port not in places:
        return None
    far_port, far_home, first = ground.distances(port), ground.distances(home), places.index(port)
    leaves = [i for i in range(first, len(places) - 1) if places[i] == home and places[i + 1] != home]
    bouts = [places[a : b + 1] for a, b in pairwise(leaves)]
    to_port = [bout.index(port) for bout in bouts if port in bout]
    direct = sum(steps == far_port[home] for steps in to_port)
    ways = [_way_home(bout, ground) for bout in bouts]
    straight = sum(steps == far_home[end] for end, steps in ways)
    return Trips((len(to_port), direct), (len(bouts), straight))


def _way_home(bout: Sequence[int], ground: Ground) -> tuple[int, int]:
    """The last end of a bout, or its farthest place, and the moves from there home."""
    last = next((i for i in range(len(bout) - 2, 0, -1) if len(ground.ways[bout[i]]) == 1), None)
    if last is None:
        far = ground.distances(ground.find(HOME, "home"))
        last = max(range(len(bout)), key=lambda i: far[bout[i]])
    return bout[last], len(bout) - 1 - last


def agent_trip(route: Route, ground: Ground, settings: Settings) -> tuple[int, int]:
    """Moves to the port and back of an agent that was led along an animal's walk, and now wants nothing else."""
    places, port, home = route.places.tolist(), ground.find(PORT, "port"), ground.find(HOME, "home")
    if port not in places:
        raise CogmapError(f"{route.individual} never found the port; leave it out")
    end = places.index(home, places.index(port))
    settled = Settings(look_ahead=settings.look_ahead, information_weight=0.0)
    agent = Agent(dict(ground.motions), settings=settled, seed=0)
    for observation in ground.observations(places[: end + 1]):
        agent.perceive(observation)
    names, at, moves = list(agent.map.motions.names), home, list[int]()
    for goal in (port, home):
        agent.prefer({ground.sights[goal]: 50.0})
        steps = 0
        while at != goal and steps < len(ground.places):
            name = names[agent.act()]
            before, at = at, next((way.target for way in ground.ways[at] if way.action == name), at)
            agent.perceive(ground.observation(at, before=before))
            steps += 1
        moves.append(steps)
    return moves[0], moves[1]

"""Small inputs that once failed: one test each, through public names."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import gymnasium as gym
import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import Parts, check_outputs, explore
from cogmap.experiments.studies import study_named
from cogmap.experiments.studies.running import Outcome, write_index
from cogmap.inference import TrackerOptions, infer
from cogmap.model import CogmapError, CognitiveMap, FactorGraph, Motions, Priors, Rates, Sight, Ways, shown
from cogmap.views import plot_factor_graph
from cogmap.worlds import GRID as MOTIONS
from cogmap.worlds import MAZES, WorldError, frozen_lake, load_world
from command_line import cogmap
from shared import shared
from walks import GRID

ACTIONS = list(GRID)
RIGHT, STAY = ACTIONS.index("right"), ACTIONS.index("stay")
SHUT = [False] * 4 + [True]


def walked(name: str = "4x4", steps: int = 30, **options: Any) -> tuple[Any, Any, Agent]:
    """A world, what it shows last, and an agent that has walked in it."""
    world = load_world(name)
    observation, _ = world.reset(seed=0)
    agent = Agent(world.motions, seed=0, **options)
    for _ in range(steps):
        observation, *_ = world.step(agent.step(observation))
    return world, observation, agent


# -- worlds ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "steps", "rooms"),
    [
        ("torus_3x3", 30, 9),
        ("torus_4x4", 40, 16),
        ("torus_4x4_alias", 100, 16),
        ("torus_5x5", 60, 25),
        ("portal_4x4", 80, 16),
    ],
)
def test_as_many_places_as_rooms(name: str, steps: int, rooms: int) -> None:
    world = load_world(shared(f"cases/{name}.json"))
    observation, _ = world.reset(seed=0)
    agent = Parts.named("cogmap").make(world, np.random.SeedSequence(0))
    for _ in range(steps):
        observation, *_ = world.step(agent.step(observation))
    assert len(agent.map.places) == rooms
    assert agent.map.visited.all()


def test_a_one_way_ring_has_six_places_after_six_steps() -> None:
    world = load_world(shared("cases/one_way_ring.json"))
    observation, _ = world.reset(seed=0)
    agent = Parts.named("cogmap").make(world, np.random.SeedSequence(0))
    visited: list[int] = []
    for _ in range(14):
        observation, *_ = world.step(agent.step(observation))
        visited.append(int(agent.map.visited.sum()))
    assert visited == [1, 2, 3, 4, 5, *[6] * 9]
    assert len(agent.map.places) == 6  # nothing is imagined any more once the last way was walked twice


def test_a_maze_without_positions() -> None:
    run = explore(load_world(shared("cases/4x4_alias_no_positions.json")), 0)
    assert (run.places, run.map_right, run.known) == (16, True, 1.0)


def test_the_frozen_lake_without_a_sensor_of_ways() -> None:
    lake, cells = frozen_lake(4, 4), set[int]()
    observation, info = lake.reset(seed=0)
    agent = Agent(lake.motions, sensors=[Sight("sight")], seed=0)
    for _ in range(80):
        cells.add(info["place"])
        observation, _, _, _, info = lake.step(agent.step(observation))
    assert (len(cells), len(agent.map.places)) == (16, 16)


def test_ascii_mazes_and_commas_are_refused_unless_asked_for() -> None:
    ascii_, commas = shared("cases/ascii.txt"), shared("cases/commas.txt")
    with pytest.raises(WorldError, match="looks like walls of an ASCII maze; read it with format='ascii'"):
        load_world(ascii_)
    with pytest.raises(WorldError, match="has commas; read it with format='commas'"):
        load_world(commas)
    assert len(load_world(commas, format="commas").maze.rooms) == 6
    assert len(load_world(ascii_, format="ascii").maze.rooms) == ascii_.read_text().count(".")
    refused = cogmap("explore", ascii_, "--max-steps", 5)
    assert refused.exit_code == 2
    assert len(refused.stderr.splitlines()) == 1


def test_ids_are_there_once_the_worlds_are() -> None:
    assert gym.make("cogmap.worlds:cogmap/4x4-v0").unwrapped.maze == MAZES["4x4"]
    assert load_world("cogmap/4x4-v0").maze == MAZES["4x4"]
    alone = "import gymnasium; print(gymnasium.make('cogmap.worlds:cogmap/4x4-v0').unwrapped.maze.shape)"
    assert subprocess.run([sys.executable, "-c", alone], capture_output=True, text=True).stdout == "(4, 4)\n"


# -- what is sensed, and told ------------------------------------------------------------------------------


@pytest.mark.parametrize("sight", [np.ma.masked, None, float("nan"), np.float64("nan")], ids=str)
def test_what_was_not_seen_is_refused_with_the_way_to_say_so(sight: Any) -> None:
    with pytest.raises(CogmapError, match="give UNSEEN where nothing was seen"):
        Agent(GRID).step({"sight": sight, "open": SHUT})


def test_tuples_of_numpy_numbers_are_saved(tmp_path: Path) -> None:
    world = load_world("3x3")
    observation, _ = world.reset(seed=0)
    agent = Agent(world.motions, seed=0)
    for _ in range(30):
        sight = np.int64(observation["sight"]), np.int32(3)
        observation, *_ = world.step(agent.step({**observation, "sight": sight}))
    agent.save(tmp_path / "map.npz")
    assert list(Agent.load(tmp_path / "map.npz").map.sights) == list(agent.map.sights)


def test_moves_by_hand_that_are_told_leave_the_map_right() -> None:
    world, observation, agent = walked(steps=8)
    rng = np.random.default_rng(0)
    for action in rng.integers(4, size=12).tolist():
        agent.step(observation)
        observation, *_ = world.step(action)
        observation["taken"] = action
    for _ in range(25):
        observation, *_ = world.step(agent.step(observation))
    assert len(agent.map.places) == 16


def test_two_sensors_know_a_place_of_which_one_is_new() -> None:
    world, sensors = load_world("4x4"), [Sight("colour"), Sight("smell"), Ways()]
    observation, info = world.reset(seed=0)
    start, agent = info["position"], Agent(world.motions, sensors=sensors, seed=0)
    for _ in range(20):
        colour = observation["sight"]
        percept = {"colour": colour, "smell": f"smell {colour % 5}", "open": observation["open"]}
        observation, _, _, _, info = world.step(agent.step(percept))
    for room in MAZES["4x4"].rooms[::3]:
        observation = world.displace(room)
        percept = {"colour": observation["sight"], "smell": f"new in {room}", "open": observation["open"]}
        agent.perceive({**percept, "moved": True})
        assert agent.map.position(agent.belief.place) == tuple(a - b for a, b in zip(room, start, strict=True))
        agent.act()


def test_who_meets_a_closed_room_goes_round() -> None:
    rows = study_named("donut").rows(1)
    assert [(row.reached, row.moves) for row in rows] == [(True, 10)]


# -- inference and learning --------------------------------------------------------------------------------


def test_one_reading_more_for_b_than_for_a() -> None:
    graph, readings = FactorGraph(), [0] * 345 + [1] * 346
    graph.variable("cause", ("a", "b"))
    graph.factor("P", ["cause"], [0.5, 0.5])
    for number in range(len(readings)):
        graph.variable(f"r{number}", (0, 1))
        graph.factor("P", [f"r{number}", "cause"], [[0.9, 0.1], [0.1, 0.9]])
    posterior = infer(graph, evidence={f"r{number}": reading for number, reading in enumerate(readings)})
    assert posterior.probability("cause", "b") == pytest.approx(0.9, abs=1e-9)


def test_what_an_answer_is_written_over_does_not_change_it() -> None:
    graph = FactorGraph()
    graph.variable("x", ("a", "b"))
    graph.factor("P", ["x"], [0.3, 0.7])
    posterior = infer(graph)
    with pytest.raises(ValueError, match="read-only"):
        posterior.marginal("x")[:] /= posterior.marginal("x").max()
    assert posterior.probability("x", "a") == pytest.approx(0.3)


@pytest.mark.parametrize("domain", [{"a", "b"}, frozenset("ab")])
def test_a_set_is_no_domain(domain: Any) -> None:
    with pytest.raises(CogmapError, match="it has no order; give a tuple of labels"):
        FactorGraph().variable("x", domain)


@pytest.mark.parametrize("possible", [3, (3.0,), (1, 2, 3)])
def test_rates_that_are_no_pair(possible: Any) -> None:
    with pytest.raises(CogmapError, match=r"rates.possible is .*; use two numbers"):
        Rates(possible=possible)


def test_a_door_found_shut_with_little_weight_is_hardly_shut() -> None:
    map_ = CognitiveMap(Motions.of(MOTIONS))
    for number in range(2):
        map_.new_place((0, number), step=0)
    map_.transitions.learn(0, RIGHT, 1, 1.0)
    open_before = map_.transition(1, 0, RIGHT)
    map_.transitions.learn(0, RIGHT, 0, 0.01)
    assert map_.transition(1, 0, RIGHT) == pytest.approx(open_before, abs=0.02)
    ways = {facts["known"] for _, to, facts in map_.to_networkx().edges(data=True) if to == 1}
    assert "refuted" not in ways
    map_.transitions.learn(0, RIGHT, 0, 1.0)
    assert map_.transition(1, 0, RIGHT) < 0.02


def test_priors_too_small_to_count_are_refused() -> None:
    with pytest.raises(CogmapError, match=r"priors.door_floor is 1e-80; use a number from 1e-15 to 0.5"):
        Priors(transition=1e-80, door_floor=1e-80)
    least = Settings(priors=Priors(transition=1e-80, door_floor=1e-15))
    assert len(walked("3x3", 20, settings=least)[2].map.places) == 9


@pytest.mark.parametrize(("hypotheses", "early", "late"), [(None, 98, 398), (TrackerOptions(), 38, 98)])
def test_a_step_costs_the_same_however_many_labels_there_were(hypotheses: Any, early: int, late: int) -> None:
    agent, calls = Agent(GRID, settings=Settings(look_ahead=2, hypotheses=hypotheses), seed=0), dict[int, int]()

    def count(frame: Any, event: str, argument: Any) -> None:
        calls[step] = calls.get(step, 0) + (event in ("call", "c_call"))

    for step in range(late + 2):
        sys.setprofile(count if step in (early, early + 1, late, late + 1) else None)
        agent.step({"sight": f"new {step}", "open": SHUT})
    sys.setprofile(None)
    assert max(calls[late], calls[late + 1]) <= 1.1 * min(calls[early], calls[early + 1])


# -- files -------------------------------------------------------------------------------------------------


def test_the_maze_is_not_written_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    house, picture = Path("house.txt"), Path("house.png")
    house.write_text("a b\nc d\n")
    picture.write_bytes(b"mine")
    with pytest.raises(CogmapError, match="is the file that is read"):
        check_outputs([house], inputs=[house])
    refused = cogmap("explore", house, "--json", house)
    assert (refused.exit_code, house.read_text()) == (2, "a b\nc d\n")
    done = cogmap("explore", house)
    assert (done.exit_code, picture.read_bytes()) == (0, b"mine")
    assert next(path.name for path in tmp_path.glob("*.png") if path.name != picture.name) in done.stdout


def _pipe(path: Path) -> None:
    os.mkfifo(path)


def _device(path: Path) -> None:
    try:
        os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(1, 3))  # what /dev/null is
    except PermissionError:
        pytest.skip("making a device node needs to be root")


@pytest.mark.parametrize("make", [_pipe, _device])
def test_what_is_no_file_is_not_replaced(make: Callable[[Path], None], tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    make(path)
    kind = stat.S_IFMT(path.stat().st_mode)
    with pytest.raises(CogmapError):
        Agent(GRID).save(path)
    assert stat.S_IFMT(path.stat().st_mode) == kind


def test_a_saved_file_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    for _ in range(2):
        Agent(GRID).save(path)
        path.chmod(0o640)
    Agent(GRID).save(path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


@pytest.mark.parametrize("kind", ["graphml", "gexf"])
@pytest.mark.parametrize("name", ["4x4", "cases/4x4_alias_no_positions.json"])
def test_a_map_is_written_and_read_again(kind: str, name: str, tmp_path: Path) -> None:
    world = load_world(shared(name) if "/" in name else name)
    observation, _ = world.reset(seed=0)
    agent = Parts.named("cogmap").make(world, np.random.SeedSequence(0))
    for _ in range(10):
        observation, *_ = world.step(agent.step(observation))
    graph, path = agent.map.to_networkx(), tmp_path / f"map.{kind}"
    getattr(nx, f"write_{kind}")(graph, path)
    again: Any = getattr(nx, f"read_{kind}")(path)
    assert list(again.nodes) == [str(place) for place in agent.map.places]
    assert again.number_of_edges() == graph.number_of_edges()
    assert {facts["visited"] for _, facts in again.nodes(data=True)} <= {True, False}
    if kind == "graphml" and name == "4x4":  # another agent begins with it
        assert [*Agent(world.motions, map=path).map.visited] == [True] * int(agent.map.visited.sum())


def test_shortest_paths_do_not_go_through_doors_that_are_shut() -> None:
    world, observation, agent = walked("donut", 40)
    world.close_room((0, 2))
    for _ in range(60):
        observation, *_ = world.step(agent.step(observation))
    graph = agent.map.to_networkx()
    for one, other in nx.all_pairs_shortest_path(graph):
        for path in other.values():
            for a, b in pairwise(path):
                assert any(facts["known"] != "refuted" for facts in graph[a][b].values()), (one, path)
    refuted = [(a, b) for a, b, facts in graph.edges(data=True) if facts["known"] == "refuted"]
    assert refuted
    assert all(a == b for a, b in refuted)


# -- what is shown -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("label", ["x" * 300, "東京都庁前駅" * 20, "ﷺ" * 40, "👩‍👩‍👧‍👦" * 30])
def test_labels_of_any_length_stay_in_their_circles(label: str) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": label, "open": SHUT})
    texts = [text.get_text() for text in plot_factor_graph(agent.graph).texts]
    assert len(shown(label)) <= 40
    assert max(map(len, "\n".join(texts).splitlines())) <= 24


def test_what_is_printed_is_short() -> None:
    agent = walked(steps=3)[2]
    for thing in (agent, agent.map, agent.plan, agent.belief):
        assert len(repr(thing)) < 300
        assert repr(thing).startswith(f"{type(thing).__name__}(")


def test_the_package_itself() -> None:
    import cogmap as package

    assert package.Agent is Agent
    assert package.__version__.count(".") >= 1


def test_what_failed_is_said_in_one_way(tmp_path: Path) -> None:
    study = study_named("donut")
    done = Outcome(study, 10, 1.0, failed=[str(seed) for seed in range(10)])
    write_index(tmp_path, [done, replace(done, failed=[])], 0, "cogmap study all")
    page = (tmp_path / "index.md").read_text()
    assert "donut: 10 listed in its report" in page
    assert "Nothing." not in page

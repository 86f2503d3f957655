"""Contexts: what is not seen, and what sights and ways depend on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.baselines import CueOptimum
from cogmap.experiments.studies import run_study
from cogmap.experiments.studies.cue import Cue
from cogmap.inference import infer
from cogmap.model import Carried, CogmapError, Contexts, Motions, NoPose, Sight, Ways
from cogmap.worlds import GRID, CueMaze, WorldError, best_cue_action
from command_line import cogmap

EXACT = Settings(hypotheses=None)
KEYS = Motions(("left", "right", "take", "stay"), (), (1, 0, -1, 3))


def cued(*, right: float = 0.8, **options: Any) -> Agent:
    agent = Agent(CueMaze.motions, pose=NoPose(), map=CueMaze(right=right).map(), seed=0, **options)
    agent.prefer({"reward": 3.0, "nothing": -3.0})
    return agent


def seen(sight: str, *ways: bool) -> dict[str, Any]:
    return {"sight": sight, "open": [*ways, True]}


CENTRE, CUE = seen("centre", False, True, True, True), seen("points left", True, True, True, False)


@pytest.mark.parametrize("right", [0.8, 1.0, 0.6])
def test_the_cue_is_asked_and_believed_as_far_as_it_is_right(right: float) -> None:
    agent = cued(right=right, settings=EXACT)
    assert CueMaze.motions.names[agent.step(CENTRE)] == "cue"
    assert agent.contexts == pytest.approx({"left": 0.5, "right": 0.5}, abs=1e-6)
    assert CueMaze.motions.names[agent.step(CUE)] == "left"
    assert agent.contexts == pytest.approx({"left": right, "right": 1.0 - right}, abs=1e-6)


def test_the_graph_has_the_context_and_says_the_same() -> None:
    agent = cued(settings=EXACT)
    for percept in (CENTRE, CUE):
        agent.step(percept)
    posterior = infer(agent.graph)
    for step, left in ((1, 0.8), (0, 0.8)):  # the past is smoothed
        assert posterior.marginal(f"context{step}") == pytest.approx([left, 1.0 - left], abs=1e-6)
    assert posterior.marginal("context1") == pytest.approx([*agent.contexts.values()], abs=1e-9)
    (factor,) = [f for f in agent.graph.factors if [v.name for v in f.scope] == ["context1", "s1"]]
    assert factor.equation == "P(k_t | s_t)"


def test_filter_and_brute_force_agree_on_context_and_place() -> None:
    """Q(s, k) of the filter, against sums over all pairs of a place and a context, step by step."""
    rng, names = np.random.default_rng(3), CueMaze.motions.names
    for right in (0.7, 0.9):
        agent = cued(right=right, settings=Settings(hypotheses=None, certainty=1.0))  # it learns nothing new
        agent.step(CENTRE)
        prior = np.array([0.5, 0.5])
        for _ in range(3):
            told = str(rng.choice(["left", "right"]))
            agent.perceive({**seen(f"points {told}", True, True, True, False), "taken": names.index("cue")})
            prior = prior * np.where(np.array(["left", "right"]) == told, right, 1.0 - right)
            prior /= prior.sum()
            assert [*agent.contexts.values()] == pytest.approx(prior, abs=1e-6)
            agent.act()
            agent.perceive({**CENTRE, "taken": names.index("centre")})
            agent.act()


def test_what_is_sensed_of_the_context_counts() -> None:
    agent = cued(settings=EXACT)
    agent.step({**CENTRE, "context": {"left": 0.9, "right": 0.1}})
    assert agent.contexts["left"] == pytest.approx(0.9, abs=1e-6)
    posterior = infer(agent.graph)
    assert posterior.marginal("context0") == pytest.approx([0.9, 0.1], abs=1e-6)
    agent.step({**CUE, "context": "right"})
    assert agent.contexts["right"] == pytest.approx(1.0, abs=1e-6)
    assert "context_sensed1" in [variable.name for variable in agent.graph.variables]


def test_a_loaded_agent_knows_the_contexts(tmp_path: Path) -> None:
    for settings in (EXACT, Settings()):
        agent = cued(settings=settings)
        agent.step(CENTRE)
        agent.save(tmp_path / "cue.npz")
        again = Agent.load(tmp_path / "cue.npz")
        assert again.contexts == agent.contexts
        assert again.step(CUE) == agent.step(CUE)
        assert again.contexts == agent.contexts


def with_keys() -> Any:
    """A hall, a store with a key two rooms to the left, and a vault behind a locked door on the right."""
    graph: Any = nx.MultiDiGraph(contexts=["nothing", "key"])
    for node in ("store", "room", "hall", "vault"):
        graph.add_node(node, sight=node)
    for left, right in (("store", "room"), ("room", "hall")):
        graph.add_edge(left, right, way="right")
        graph.add_edge(right, left, way="left")
    graph.add_edge("hall", "vault", way="right", only="key")
    graph.add_edge("vault", "hall", way="left")
    graph.add_edge("store", "store", way="take", only=["nothing"], then="key")
    return graph


class Keys:
    """The same as a world."""

    ROOMS = ("store", "room", "hall", "vault")

    def __init__(self) -> None:
        self.at, self.key = 2, False

    def sense(self) -> dict[str, Any]:
        ways = (self.at > 0, self.at < 2 or (self.at == 2 and self.key), self.at == 0 and not self.key)
        return {**seen(self.ROOMS[self.at], *ways), "context": "key" if self.key else "nothing"}

    def act(self, name: str) -> None:
        left, right, take, _ = self.sense()["open"]
        self.at += (name == "right" and right) - (name == "left" and left)
        self.key = self.key or (name == "take" and take)


@pytest.mark.parametrize("settings", [EXACT, Settings()])
def test_a_key_is_fetched_because_a_plan_foresees_the_open_door(settings: Settings) -> None:
    world, agent = Keys(), Agent(KEYS, pose=NoPose(), map=with_keys(), seed=0, settings=settings)
    agent.prefer({"vault": 2.0})
    names = list[str]()
    while world.at != 3 and len(names) < 12:
        names.append(KEYS.names[agent.step(world.sense())])
        world.act(names[-1])
    assert names == ["left", "left", "take", "right", "right", "right"]
    assert agent.contexts["key"] > 0.99


FETCH = Motions(KEYS.names, (), (1, 0, -1, 3), (None, None, "key", None))


class Locked(Keys):
    """The same, of which nothing is known beforehand; it tells of the lock."""

    def sense(self) -> dict[str, Any]:
        told = super().sense()
        locks = {"right": "key"} if self.at == 2 else {}
        return {"sight": told["sight"], "open": told["open"], "carried": told["context"], "locks": locks}


def fetched(agent: Agent, world: Locked, steps: int) -> list[str]:
    names = list[str]()
    for _ in range(steps):
        names.append(FETCH.names[agent.step(world.sense())])
        world.act(names[-1])
    return names


def test_a_key_that_was_found_is_fetched_for_a_door_that_was_seen() -> None:
    world, agent = Locked(), Agent(FETCH, seed=0)
    assert fetched(agent, world, 3) == ["left", "left", "take"]
    plan = [FETCH.names[action] for action in agent.plan.policy]
    assert plan[:4] == ["take", "right", "right", "right"]  # through rooms in which it never carried a key
    assert fetched(agent, world, 3) == ["right", "right", "right"]
    assert world.at == 3
    assert agent.contexts["key"] > 0.99
    fetched(agent, world, 1)
    assert {len(set(agent.map.sensors["carried"].peers.values[place])) for place in agent.map.visited_places} == {2}
    posterior = infer(agent.graph)
    assert posterior.marginal(f"carried{agent.steps - 1}")[1] == pytest.approx(agent.contexts["key"], abs=1e-9)


def test_the_map_as_a_graph_says_what_is_carried_where() -> None:
    world, agent = Locked(), Agent(FETCH, seed=0)
    fetched(agent, world, 3)
    told = [
        (next(iter(facts["sights"]), None), facts["carried"]) for _, facts in agent.map.to_networkx().nodes(data=True)
    ]
    rooms = ("hall", "room", "store")
    assert sorted((room, what) for room, what in told if room) == [(r, c) for r in rooms for c in ("key", "nothing")]
    assert (None, "key") in told  # behind the locked door
    assert {"carried"} <= set(json.loads(agent.map.to_json())["nodes"][0])
    assert "nothing" in agent.map.to_dot()


def test_what_is_learned_with_a_key_is_known_without() -> None:
    world, agent = Locked(), Agent(FETCH, seed=0)
    fetched(agent, world, 4)
    world.key = False  # it was lost, and nobody said so
    fetched(agent, world, 1)
    assert agent.contexts["nothing"] > 0.99
    assert agent.belief.certainty > 0.9
    assert agent.map.visited[agent.belief.place]
    here = agent.belief.place
    left, right = (agent.map.beyond(here, FETCH.names.index(way)) for way in ("left", "right"))
    assert left is not None
    assert right is not None
    assert agent.map.visited[[left, right]].all()


def test_an_agent_that_carries_is_saved_and_loaded(tmp_path: Path) -> None:
    world, agent = Locked(), Agent(FETCH, seed=0)
    fetched(agent, world, 4)
    agent.save(tmp_path / "key.npz")
    again, other = Agent.load(tmp_path / "key.npz"), Locked()
    other.at, other.key = world.at, world.key
    assert fetched(again, other, 4) == fetched(agent, world, 4)
    assert again.contexts == agent.contexts


def test_a_key_for_no_door_is_left_alone() -> None:
    class Unlocked(Locked):
        def sense(self) -> dict[str, Any]:
            return {**super().sense(), "locks": {}}

    world, agent = Unlocked(), Agent(FETCH, seed=0)
    world.at = 0
    assert "take" not in fetched(agent, world, 6)


def test_the_optimum_asks_once_and_then_goes() -> None:
    assert best_cue_action("centre", 0, right=0.8, moves=2) == "cue"
    assert best_cue_action("cue", -1, right=0.8, moves=1) == "right"
    assert best_cue_action("centre", 0, right=0.8, moves=1) in ("left", "right")
    world = CueMaze(right=0.8)
    agent, (observation, _) = CueOptimum(world), world.reset(seed=1)
    assert world.motions.names[agent.step(observation)] == "cue"


def test_the_study_compares_with_the_optimum(tmp_path: Path) -> None:
    outcome = run_study(Cue(cases=((1.0, 2), (0.8, 2))), tmp_path, runs=12)
    assert not outcome.failure
    told = json.loads((tmp_path / "cue.json").read_text())
    assert [row["of the optimum"] for row in told["summary"]] == [1.0, 1.0]
    assert [row["asked first"] for row in told["summary"]] == [12, 12]
    assert {row["optimum"] for row in told["runs"][:12]} == {1.0}


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Contexts(["one"]), "two or more that differ"),
        (lambda: Contexts(["one", "one"]), "two or more that differ"),
        (lambda: cued().step({**CENTRE, "context": "up"}), "the contexts are 'left', 'right'"),
        (lambda: cued().step({**CENTRE, "context": {"left": 0.0}}), "not all of them 0"),
        (lambda: cued().step({**CENTRE, "context": {"left": -1.0}}), "not all of them 0"),
        (lambda: Agent(KEYS, pose=NoPose(), map=nx.DiGraph([(0, 1)], contexts=["one"])), "a list of two or more"),
        (lambda: Agent(KEYS, pose=NoPose(), map=odd(only="sesame")), "speaks of context 'sesame'"),
        (lambda: Motions(KEYS.names, (), (), ("key",)), "give each action a word for what it takes"),
        (lambda: Agent(FETCH, sensors=[Carried(["nothing", "lamp"])], seed=0), "carried is 'key'"),
        (lambda: Agent(GRID, sensors=[Carried(["nothing", "key"])], seed=0), "without displacements"),
        (lambda: Agent(FETCH, seed=0).step({**Locked().sense(), "locks": {"up": "key"}}), "give each action one of"),
        (lambda: Agent(FETCH, seed=0).step({**Locked().sense(), "locks": ["lamp"] * 4}), "give each action one of"),
        (lambda: Agent(FETCH, seed=0).step({**Locked().sense(), "carried": "lamp"}), "the contexts are"),
        (lambda: Agent(KEYS, pose=NoPose(), map=odd(then="sesame")), "speaks of context 'sesame'"),
    ],
)
def test_bad_input(make: Any, said: str) -> None:
    with pytest.raises(CogmapError, match=said):
        make()


def odd(**facts: str) -> Any:
    graph = with_keys()
    graph.add_edge("room", "room", way="take", **facts)
    return graph


@pytest.mark.parametrize("options", [{"right": 0.3}, {"right": True}, {"moves": 0}, {"moves": 1.5}])
def test_a_cue_maze_that_cannot_be(options: Any) -> None:
    with pytest.raises(WorldError, match="cue maze"):
        CueMaze(**options)


def test_sensors_of_contexts_by_hand() -> None:
    agent = Agent(KEYS, sensors=[Sight(), Ways(), Contexts(["nothing", "key"], "carried")], pose=NoPose(), seed=0)
    agent.step(seen("hall", True, False, False))
    assert agent.contexts == {"nothing": 0.5, "key": 0.5}
    agent.perceive({**seen("hall", True, False, False), "carried": "key", "taken": "stay"})
    assert agent.contexts["key"] == pytest.approx(1.0)
    assert cogmap("study", "cue", "--runs", 0).exit_code == 2

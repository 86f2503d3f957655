"""What an agent keeps does not grow with time."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference import TrackerOptions
from cogmap.inference.hypotheses.tracker import DECIDED
from cogmap.model import SHOWN, CogmapError, Domain, GrowthEvent, growth_between
from cogmap.model.domain import FORGOTTEN
from cogmap.model.growth_log import GrowthLog
from cogmap.model.information import KnownInformation, dirichlet_information
from cogmap.worlds import load_world
from walks import GRID, assert_map_is_sound, assert_same_map, walk


def twins(steps: int, *, keep: int, displace_every: int = 0) -> tuple[Agent, Agent]:
    """Two agents on the same walk, of which one forgets."""
    agents: list[Agent] = []
    for kept in (None, keep):
        world = load_world("4x4_alias")
        agent = Agent(world.motions, settings=Settings(look_ahead=2), seed=0, keep=kept)
        for _ in walk(world, agent, steps, displace_every=displace_every):
            pass
        agents.append(agent)
    return agents[0], agents[1]


@pytest.mark.parametrize("displace_every", [0, 40])
def test_what_is_long_ago_is_made_shorter_and_the_map_stays_the_same(displace_every: int) -> None:
    whole, short = twins(150, keep=60, displace_every=displace_every)
    short.map.growth.shorten(short.steps - 60)
    assert len(short.map.growth) < len(whole.map.growth) - 85
    assert list(short.map.sights) == list(whole.map.sights)
    for since in (100, 120, 149):
        mine, theirs = (growth_between(agent.map, since) for agent in (short, whole))
        assert mine == theirs
    loaded = Agent.from_state(*short.state())
    assert_same_map(loaded.map, short.map)
    seen = {"sight": 0, "open": [True] * 5}
    assert loaded.step(seen) == short.step(seen)


def test_the_log_is_made_shorter_by_itself() -> None:
    log = GrowthLog(keep=100)
    log.append(GrowthEvent(0, "place", 0, (0, 0)))
    for step in range(20_000):
        log.append(GrowthEvent(step, "time", step))
        if step % 3 == 0:
            log.append(GrowthEvent(step, "place", 1, (0, 1)))
            log.append(GrowthEvent(step, "unbind", 1, (0, 1)))
            log.append(GrowthEvent(step, "retract", 1))
        log.tidy()
    assert len(log) < 5_000
    assert sum(event.kind == "place" for event in log) == 1 + sum(event.kind == "retract" for event in log)


def test_the_trace_is_bounded() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=1), seed=0, keep=50)
    for _ in range(170):
        agent.step({"sight": 0, "open": [False] * 4 + [True]})
    assert 50 <= len(agent.trace) < 100
    assert [record.step for record in agent.trace] == list(range(170 - len(agent.trace), 170))
    agent.keep = None
    for _ in range(60):
        agent.step({"sight": 0, "open": [False] * 4 + [True]})
    assert len(agent.trace) > 100


@pytest.mark.parametrize("keep", [0, -1, True, 1.5, "all"])
def test_keep_is_a_number_of_steps(keep: Any) -> None:
    with pytest.raises(CogmapError, match="give a positive whole number of steps, or None"):
        Agent(GRID, keep=keep)


def test_what_is_known_of_information_is_bounded_and_right() -> None:
    known, rng = KnownInformation(most=50_000), np.random.default_rng(0)
    for _ in range(400):
        alpha = rng.uniform(0.1, 3.0, size=(2, int(rng.integers(2, 30))))
        for _ in range(2):
            np.testing.assert_allclose(known(alpha, 4), dirichlet_information(alpha, 4), rtol=1e-12)
        assert sum(len(key) + row.nbytes for (key, _), row in known._known.items()) <= 50_000
    assert known._known


def test_a_place_has_counts_of_so_many_labels() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=1, hypotheses=TrackerOptions(most=2)), seed=0)
    for step in range(96):
        agent.step({"sight": ("new", step) if step % 3 else "usual", "open": [False] * 4 + [True]})
    for h in agent._recognition.tracker.hypotheses:
        counts = h.places[0].sights[0]
        assert len(counts) == SHOWN
        assert h.places[0].label() == agent.map.sights.find("usual")
        assert agent.steps - 1 in h.places[h.here].recent


def test_what_was_open_for_long_and_is_improbable_is_let_go() -> None:
    """Those that go back to the four most probable hypotheses are left, and each is a beginning from then on."""
    agent = Agent(GRID, settings=Settings(look_ahead=1), seed=0)
    agent.step({"sight": 0, "open": [True] * 5})
    tracker = agent._recognition.tracker
    found = [tracker.best.fork() for _ in range(7)]
    weights = (-0.7, -0.9, -2.0, -4.0, -5.0, -6.0, -12.0)
    for h, clan, weight in zip(found, (7, 8, 8, 1, 2, 3, 2), weights, strict=True):
        h.clan, h.weight = clan, weight
    tracker.time = DECIDED - 1
    assert tracker._decided(found) == found
    tracker.time = DECIDED
    left = tracker._decided(found)
    assert (left, [h.clan for h in left]) == ([*found[:5], found[6]], [0, 1, 2, 3, 4, 5])
    for h, weight in zip(left, (-0.1, -9.0, -9.0, -9.0, -9.0, -9.0), strict=True):
        h.weight = weight
    assert tracker._decided(left) == left[:1]
    tracker.time, tracker.best.clan = 1, 5
    assert Agent.from_state(*agent.state())._recognition.tracker.best.fork().clan == 5


def test_a_new_sight_each_step_leaves_nothing_behind_in_the_module() -> None:
    agent, other = Agent(GRID, seed=0), Agent(GRID, seed=0)
    for step in range(50):
        agent.step({"sight": ("new", step), "open": [False] * 4 + [True]})
    kept = agent.map._context.information
    assert sum(sys.getsizeof(key) + row.nbytes for (key, _), row in kept._known.items()) <= kept.most
    assert not other.map._context.information._known


def fleeting(most: int, steps: int) -> Agent:
    """An agent that is put into a place that it has never seen at each step, and is told so."""
    agent = Agent(
        GRID,
        settings=Settings(look_ahead=1, hypotheses=TrackerOptions(most=2, folded=0, fragments=most)),
        seed=0,
        keep=10,
    )
    for step in range(steps):
        agent.step(put_into(step))
    return agent


def put_into(number: int) -> dict[str, Any]:
    return {"sight": ("new", number), "open": [False] * 4 + [True], "moved": True}


def test_what_was_left_behind_for_good_is_forgotten(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("cogmap.inference.hypotheses.tracker.DECIDED", 16)
    monkeypatch.setattr("cogmap.agent.forgetting.EVERY", 8)
    monkeypatch.setattr("cogmap.agent.forgetting.SPARE", 4)
    monkeypatch.setattr("cogmap.inference.hypotheses.replaying.History.__init__.__defaults__", (34,))
    whole, agent = fleeting(100, 56), fleeting(3, 56)
    assert agent.map.visited.sum() < 24 < 40 < whole.map.visited.sum()
    assert FORGOTTEN in set(agent.map.positions)
    assert len(agent.map.positions) < len(whole.map.positions)
    assert agent.map.sights.find(("new", 3)) is None
    assert whole.map.sights[agent.map.sights.index(("new", 55))] != ("new", 55)  # it has the number of another
    assert_map_is_sound(agent.map)
    assert all(event.label in agent.map.sights for event in agent.map.growth if event.kind == "sight")
    agent.save(tmp_path / "map.npz")
    again = Agent.load(tmp_path / "map.npz")
    assert list(again.map.sights) == list(agent.map.sights)
    for step in range(56, 66):
        assert agent.step(put_into(step)) == again.step(put_into(step))
    assert list(again.map.sights) == list(agent.map.sights)
    np.testing.assert_array_equal(again.map.A(), agent.map.A())


def test_numbers_of_forgotten_labels_are_given_again() -> None:
    domain = Domain("sights", "abcde")
    assert domain.forget({0, 3}, least=4) == []
    point = domain.savepoint()
    assert domain.forget({0, 3}, least=3) == ["b", "c", "e"]
    assert list(domain) == ["a", FORGOTTEN, FORGOTTEN, "d", FORGOTTEN]
    assert (domain.find("b"), len(domain)) == (None, 5)
    forgotten = domain.savepoint()
    assert [domain.add(label) for label in "xbyz"] == [1, 2, 4, 5]
    domain.go_back(forgotten)
    assert list(domain) == ["a", FORGOTTEN, FORGOTTEN, "d", FORGOTTEN]
    again = Domain("sights")
    again.take(domain)
    assert [again.add(label) for label in "xa"] == [1, 0]
    assert point[0] == 5
    with pytest.raises(CogmapError, match="two labels of sights are the same"):
        again.take(["a", FORGOTTEN, "a"])

"""Worlds in which most actions go astray: the pattern of slips is learned, and places are recognised nevertheless."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference.hypotheses import Sensed, Tracker, TrackerOptions
from cogmap.inference.hypotheses.replaying import History
from cogmap.inference.hypotheses.surveying import surveyed
from cogmap.model import Sight
from cogmap.worlds import GRID, NoisyWorld, frozen_lake, load_world


def skated(rows: int, columns: int, steps: int, *, seed: int) -> tuple[Tracker, list[int], Any]:
    """A tracker led at random over a slippery lake; the cell that each place was first seen as, by its number."""
    world, rng = frozen_lake(rows, columns, slippery=True), np.random.default_rng(seed)
    sensing = Agent(world.motions, sensors=[Sight()], seed=0)._recognition.sensing
    tracker, cells, action = Tracker(sensing.scheme, TrackerOptions(most=8)), list[int](), None
    observation, _ = world.reset(seed=seed)
    for _ in range(steps):
        cells.append(int(observation["sight"]))
        way = None if action is None else sensing.ways[action]
        labels = [*dict.fromkeys(cells)]
        ways = (None,) * sensing.scheme.count
        tracker.step(Sensed((labels.index(cells[-1]),), ways, way), [len(labels)])
        action = int(rng.integers(4))
        observation, *_ = world.step(action)
    return tracker, cells, world


def test_a_slippery_lake_is_surveyed_as_a_whole() -> None:
    tracker, cells, _ = skated(3, 3, 70, seed=3)
    best = tracker.best
    assert best.size == len(set(cells)) == 9
    at = {cells[number]: np.array(best.places[number].position) for number in best.places}
    right = {tuple((at[cell + 1] - at[cell]).tolist()) for cell in (0, 1, 3, 4, 6, 7)}
    down = {tuple((at[cell + 3] - at[cell]).tolist()) for cell in range(6)}
    assert (right, down) == ({(0, 1)}, {(1, 0)})  # which way is up shows in what slips hardly do: turn round
    assert best.chances.astray == pytest.approx(2 / 3, abs=0.15)


def test_labels_that_no_move_leads_to_are_surveyed_too() -> None:
    tracker, _, _ = skated(2, 3, 12, seed=3)
    best, history = tracker.best, History()
    for time, (label, way) in enumerate([(0, None), (1, 0), (2, None), (None, 1), (3, 1), (4, 1)]):
        history.add(Sensed((label,), (None,) * 4, way, told=label == 4), time)
    assert surveyed(best, history, floor=-1e9) is None  # one label was not read
    only = History()
    for time, label in enumerate((0, 0, 1, 0)):  # another label though it stayed
        only.add(Sensed((label,), (None,) * 4, None), time)
    found = surveyed(best, only, floor=-1e9)
    assert found is not None
    assert found.size == 2


def test_the_map_says_where_actions_lead_that_go_astray() -> None:
    world = frozen_lake(2, 3, slippery=True)
    settings = Settings(hypotheses=TrackerOptions(most=8), look_ahead=2)
    agent = Agent(world.motions, sensors=[Sight()], settings=settings, seed=1)
    observation, _ = world.reset(seed=1)
    for _ in range(140):
        observation, *_ = world.step(agent.step(observation))
    places = agent.map.visited_places.tolist()
    cell = {int(agent.map.sights[max(c := agent.map.A_o.concentrations(p), key=c.__getitem__)]): p for p in places}
    assert len(places) == len(cell) == 6
    errors: list[float] = []
    for here, action in np.ndindex(6, 4):
        true: dict[int, float] = {}
        for p, there, *_ in world.unwrapped.P[here][action]:
            true[there] = true.get(there, 0.0) + p
        errors += [abs(agent.map.transition(cell[there], cell[here], action) - p) for there, p in true.items()]
    assert np.mean(errors) < 0.1  # one in three where it is taken for firm


def test_where_actions_are_carried_out_the_table_says_so() -> None:
    world, agent = load_world("3x3"), Agent(GRID, seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(10):
        observation, *_ = world.step(agent.step(observation))
    assert agent.map.transitions.carried_out(0) is None
    assert agent.map.transition(0, 0, GRID.names.index("stay")) == 1.0


def test_the_pattern_of_slips_is_saved(tmp_path: Any) -> None:
    world, agent = NoisyWorld(load_world("3x3"), slip=0.4), Agent(GRID, seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(40):
        observation, *_ = world.step(agent.step(observation))
    shares = agent.map.transitions.carried_out(0)
    assert shares is not None
    assert shares.sum() == pytest.approx(1.0)
    assert 0.4 < shares[0] < 0.8
    agent.save(tmp_path / "agent.npz")
    loaded = Agent.load(tmp_path / "agent.npz")
    np.testing.assert_array_equal(loaded.map.transitions.carried_out(0), shares)
    assert loaded.step(observation) == agent.step(observation)

"""Moved in the middle of exploring: what was learned by mistake is taken back, and learned again where it belongs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import Truth
from cogmap.inference.rivals import COINCIDENCE, Rivals
from cogmap.model import GROWTHS, TABLE_RATES, CogmapError, CognitiveMap, Learner, Motions, growth_named
from cogmap.model.map_state import map_arrays
from cogmap.worlds import MAZES, MazeEnv
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID, assert_agent_is_sound, assert_map_is_sound


def moved_while_exploring(name: str, seed: int, *, save: Path | None = None) -> tuple[Agent, bool, int]:
    """An agent moved once into a room it has seen; whether its map came out right, and steps certain but wrong."""
    maze, rng = MAZES[name], np.random.default_rng(seed)
    rooms = list(maze.rooms)
    start = rooms[int(rng.integers(len(rooms)))]
    world = MazeEnv(maze)
    world.reset(options={"start": start})
    agent = Agent(world.motions, settings=Settings(), seed=seed)
    at, seen, wrong = int(rng.integers(3, len(rooms))), [start], 0
    for step in range(6 * len(rooms)):
        if step == at:
            others = [room for room in seen if room != world.position]
            world.displace(others[int(rng.integers(len(others)))])
        seen += [world.position] * (world.position not in seen)
        action = agent.step(world.observe())
        row, column = world.position
        here = agent.map.place_at((row - start[0], column - start[1]))
        wrong += agent.certain and agent.belief.place != here
        if save is not None and len(agent._rivals) and not save.exists():
            agent.save(save)
            agent = Agent.load(save)
        world.step(action)
    assert_agent_is_sound(agent)
    return agent, len(agent.map.places) == len(rooms) and Truth(maze, start).learned(agent.map), wrong


@pytest.mark.parametrize("name", ["3x3", "4x4", "donut"])
def test_a_map_survives_being_moved_while_it_is_made(name: str, study: bool) -> None:
    runs = [moved_while_exploring(name, seed) for seed in range(20 if study else 8)]
    assert sum(right for _, right, _ in runs) >= 0.85 * len(runs)
    assert any(record.retracted is not None for agent, _, _ in runs for record in agent.trace)
    assert np.mean([wrong for _, _, wrong in runs]) <= 10.0  # 7 to 14 when nothing was taken back


def test_a_saved_agent_can_still_change_its_mind(tmp_path: Path) -> None:
    changed = 0
    for seed in range(12):
        plain, right, _ = moved_while_exploring("donut", seed)
        saved, still, _ = moved_while_exploring("donut", seed, save=tmp_path / f"{seed}.npz")
        assert right == still
        arrays, others = map_arrays(plain.map), map_arrays(saved.map)
        assert all(np.array_equal(array, others[key]) for key, array in arrays.items())
        changed += (tmp_path / f"{seed}.npz").exists() and any(r.retracted is not None for r in saved.trace)
    assert changed


steps = st.lists(
    st.tuples(
        st.integers(0, 7), st.tuples(*[st.booleans()] * 4, st.just(True)), st.integers(0, 4), st.floats(0.7, 1.0)
    ),
    max_size=12,
)


def live(
    map_: CognitiveMap, learner: Learner, growth: str, events: list[tuple[int, tuple[bool, ...], int, float]]
) -> None:
    way = growth_named(growth)
    for step, (at, open_, action, weight) in enumerate(events, start=len(learner.chapters)):
        learner.begin(step)
        learner.forget(0.9)
        place = at % len(map_.places)
        if growth != "static" or map_.position(place) is not None:
            way.enter(map_, place, action, step=step)
            for new in way.look(map_, place, open_, step=step):
                learner.recall(new)
        map_.mark_visited(place)
        learner.sight(place, map_.new_sight(at, step=step), weight)
        learner.doors(place, open_, weight)
        beyond = map_.beyond(place, action)
        learner.transition(place, action, place if beyond is None else beyond, weight)


@given(before=steps, after=steps.filter(bool), growth=st.sampled_from(sorted(GROWTHS)))
@settings(max_examples=60, deadline=None)
def test_taking_back_restores_the_map(before: list, after: list, growth: str) -> None:  # type: ignore[type-arg]
    map_ = CognitiveMap(Motions.of(GRID))
    growth_named(growth).begin(map_, places=40, step=0)
    learner = Learner(map_, TABLE_RATES, memory=100)
    live(map_, learner, growth, before)
    learner.begin(len(learner.chapters))
    B, A, tables = map_.B(), map_.positions_given_places(), map_arrays(map_)
    since = len(learner.chapters)
    learner.take_lessons()
    live(map_, learner, growth, after)
    learner.take_back(since, step=99)
    assert_map_is_sound(map_)
    np.testing.assert_allclose(map_.B(), B, atol=1e-9)
    np.testing.assert_allclose(map_.positions_given_places()[: len(A) - 1], A[:-1], atol=1e-9)
    for name in ("position_of", "visited", "visits", "sensed", "walked"):
        np.testing.assert_array_equal(map_arrays(map_)[f"map.{name}"], tables[f"map.{name}"])
    total: dict[tuple[object, ...], float] = {}
    for lesson in learner.take_lessons():  # what was learned and what undid it
        key = (lesson.table, lesson.outcome, lesson.place, lesson.action)
        total[key] = total.get(key, 0.0) + lesson.amount
    assert all(abs(amount) < 1e-9 for amount in total.values())


def test_what_is_not_remembered_cannot_be_taken_back() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    learner = Learner(map_, TABLE_RATES, memory=2)
    for step in range(4):
        learner.begin(step)
    with pytest.raises(CogmapError, match="step 1 is not remembered; those since 2 are"):
        learner.take_back(1, step=3)


def test_of_two_rivals_at_one_position_the_one_that_explains_more_stays() -> None:
    def rival(since: int, coincidence: float) -> Rivals:
        one = np.array([since])
        return Rivals(np.array([[1, 2]]), one, one, np.array([COINCIDENCE]), np.array([coincidence]))

    assert rival(3, 5.0).joined(rival(4, 7.0)).since.tolist() == [4]
    assert rival(3, 9.0).joined(rival(4, 7.0)).since.tolist() == [3]
    assert Rivals.none(2).joined(rival(4, 7.0)).probability(0) == pytest.approx(COINCIDENCE / (1 + COINCIDENCE))

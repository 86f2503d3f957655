"""Moved in the middle of exploring: what was learned by mistake is taken back, and learned again where it belongs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.experiments import Truth
from cogmap.inference.rivals import COINCIDENCE, Rivals
from cogmap.model import GROWTHS, CognitiveMap, Growth, Motions, Whereabouts, map_state, updates
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
        if save is not None and agent.belief.doubt > 0.0 and not save.exists():
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
        arrays, others = map_state(plain.map)[1], map_state(saved.map)[1]
        assert all(np.array_equal(array, others[key]) for key, array in arrays.items())
        changed += (tmp_path / f"{seed}.npz").exists() and any(r.retracted is not None for r in saved.trace)
    assert changed


steps = st.lists(
    st.tuples(
        st.integers(0, 7), st.tuples(*[st.booleans()] * 4, st.just(True)), st.integers(0, 4), st.floats(0.7, 1.0)
    ),
    max_size=12,
)


def made(growth: str) -> Growth:
    return GROWTHS[growth](*([40] if growth == "static" else []))


def live(
    map_: CognitiveMap, growth: str, events: list[tuple[int, tuple[bool, ...], int, float]], *, first: int
) -> None:
    way = made(growth)
    for step, (at, open_, action, weight) in enumerate(events, start=first):
        map_.transitions.forget(0.9)
        place = at % len(map_.places)
        if growth != "static" or map_.position(place) is not None:
            here = Whereabouts({place: 1.0})
            way.enter(map_, here, action, step=step)
            map_.recall(way.look(map_, here, open_, step=step))
        map_.mark_visited(place)
        map_.sensors["sight"].learn(place, map_.sensors["sight"].read(at, step=step), weight)
        map_.sensors["open"].learn(place, open_, weight)
        beyond = map_.beyond(place, action)
        map_.transitions.learn(place, action, place if beyond is None else beyond, weight)


@given(before=steps, after=steps.filter(bool), growth=st.sampled_from(sorted(GROWTHS)))
@settings(max_examples=60, deadline=None)
def test_taking_back_restores_the_map(before: list, after: list, growth: str) -> None:  # type: ignore[type-arg]
    map_ = CognitiveMap(Motions.of(GRID))
    made(growth).begin(map_, step=0)
    live(map_, growth, before, first=1)
    tables, known = map_state(map_)[1], len(map_.positions)
    mark = map_.changes.mark()
    live(map_, growth, after, first=50)
    map_.take_back(mark, step=99)
    assert_map_is_sound(map_)
    for name, array in map_state(map_)[1].items():
        if not name.startswith(("changes", "growth")):
            old = tables[name]
            now = array[:known] if name in ("place_at.values",) else array  # what was met stays met
            slots = old.shape[1] if old.ndim > 1 else None
            np.testing.assert_array_equal(now if slots is None else now[:, :slots], old, err_msg=name)
    amounts = [update.amount for update in updates(map_.changes.since(mark)[0] or ())]
    assert amounts[: len(amounts) // 2] == [-amount for amount in reversed(amounts[len(amounts) // 2 :])]
    events = [event.kind for event in map_.growth]
    assert events.count("place") - sum(event.index for event in map_.growth if event.kind == "retract") == len(
        map_.places
    )


def test_of_two_rivals_at_one_position_the_one_that_explains_more_stays() -> None:
    def rival(since: int, coincidence: float) -> Rivals:
        one = np.array([since])
        return Rivals(np.array([[1, 2]]), one, one, np.array([COINCIDENCE]), np.array([coincidence]))

    assert rival(3, 5.0).joined(rival(4, 7.0)).since.tolist() == [4]
    assert rival(3, 9.0).joined(rival(4, 7.0)).since.tolist() == [3]
    assert Rivals.none(2).joined(rival(4, 7.0)).probability(0) == pytest.approx(COINCIDENCE / (1 + COINCIDENCE))

"""Places are what they are recognised as: worlds that close on themselves, noise, silent moves, no positions."""

from __future__ import annotations

import copy
from itertools import combinations
from math import exp
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.agent.structure import OpenQuestion
from cogmap.experiments import Trail, Verdict, kidnap
from cogmap.experiments.running import Moment
from cogmap.inference import TrackerOptions, indistinguishable, infer
from cogmap.inference.hypotheses import Sensed, Tracker, WayScheme
from cogmap.model import CogmapError, NoPose, Sight
from cogmap.worlds import (
    GRID,
    MAZES,
    MazeEnv,
    NoisyWorld,
    UnseenWays,
    comb,
    hall,
    labyrinth,
    load_world,
    place_of,
    ring,
    torus,
)
from walks import assert_map_is_sound


def walked(world: Any, agent: Agent, steps: int, *, seed: int = 0, moves: dict[int, Any] | None = None) -> Trail:
    """Where an agent was that has walked; after some steps it is put elsewhere without a word."""
    observation, info = world.reset(seed=seed)
    trail = Trail()
    for step in range(steps):
        if step in (moves or {}):
            observation = world.unwrapped.displace(moves[step])  # type: ignore[index]
            info = {**info, "position": moves[step]}  # type: ignore[index]
        action = agent.step(observation)
        trail(Moment(world=world, agent=agent, step=step, observation=observation, info=info, action=action))
        observation, *_, info = world.step(action)
    return trail


def exact(agent: Agent, trail: Trail, world: Any) -> Verdict:
    """Whether every room is one place, every place one room, and every way right."""
    verdict = trail.verdict(agent, world.unwrapped.chart)
    assert verdict.map_right, [hypothesis.differences for hypothesis in agent.hypotheses]
    assert verdict.places == len(agent.map.places) == len(world.unwrapped.chart.places)
    assert verdict.known == 1.0
    return verdict


@pytest.mark.parametrize("seed", range(2))
def test_a_torus_is_found_to_close_on_itself(seed: int) -> None:
    world = torus(3, 3, seed=seed)
    agent = Agent(world.motions, seed=seed)
    trail = walked(world, agent, 40, seed=seed)
    exact(agent, trail, world)
    assert agent.certain
    assert all(agent.map.position(place) is not None for place in agent.map.places)


def test_rooms_along_a_wall_are_not_moves_that_failed() -> None:
    world = MazeEnv(hall(6, 8, sights=3, rng=np.random.default_rng(0)))
    agent = Agent(world.motions, seed=0)
    trail = walked(world, agent, 32)
    assert len(set(trail.rooms)) == int(agent.map.visited.sum())
    rates = {rate.name: rate.mean for rate in agent.learned_rates}
    assert rates["alike"] > 0.4
    assert rates["fails"] < 0.02


def test_a_loaded_agent_that_tells_hypotheses_apart_has_the_plan_that_was_saved(tmp_path: Path) -> None:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, seed=0)
    walked(world, agent, 11)
    agent.save(tmp_path / "map.npz")
    plan, loaded = agent.plan, Agent.load(tmp_path / "map.npz").plan
    assert plan.model.structure is not None
    assert loaded.policies.tolist() == plan.policies.tolist()
    assert np.allclose(loaded.expected_free_energy.G, plan.expected_free_energy.G)
    assert loaded.action == plan.action


@pytest.mark.parametrize(
    ("name", "seed", "at", "room", "steps"),
    [
        ("4x4_alias", 2, 6, (1, 3), 48),  # two places were only imagined, behind a door that was never there
        ("donut", 3, 4, (0, 1), 40),  # a wall has another place behind it than the chart says
        ("donut", 7, 3, (0, 0), 68),  # the first walk along a way was none
    ],
)
def test_a_map_comes_right_after_a_move_into_a_room_never_seen(
    name: str, seed: int, at: int, room: tuple[int, int], steps: int
) -> None:
    world = load_world(name)
    agent = Agent(world.motions, seed=seed)
    exact(agent, walked(world, agent, steps, seed=seed, moves={at: room}), world)


def test_doors_are_looked_at_again_where_they_are_misread() -> None:
    """Or else rooms behind a door that was read as a wall once would never be entered."""
    maze = comb(4, 3, sights=4, rng=np.random.default_rng(300))
    world = NoisyWorld(MazeEnv(maze), door=0.05)
    agent = Agent(world.unwrapped.motions, seed=0)  # type: ignore[attr-defined]
    exact(agent, walked(world, agent, 240), world)


@pytest.mark.parametrize("seed", range(4))
def test_an_agent_that_is_moved_before_each_step_learns_that_it_is(seed: int) -> None:
    """The map is then one of rooms apart, each what it is recognised as, but for one that it has just come from."""
    world, rng = load_world("4x4"), np.random.default_rng(seed)
    agent = Agent(world.motions, settings=Settings(look_ahead=1), seed=0)
    world.reset(seed=0)
    rooms = [world.maze.rooms[int(number)] for number in rng.integers(16, size=45)]
    for room in rooms:
        agent.step(world.displace(room))
    assert agent.hypotheses[0].places <= len(set(rooms)) + 1
    learned = {each.name: each.mean for each in agent.learned_rates}
    assert learned["moved"] > 0.4


@pytest.mark.parametrize(
    ("noise", "rate", "within"),
    [({"door": 0.05}, "way_misread", 0.03), ({"sight": 0.1}, "sight_misread", 0.06), ({"slip": 0.1}, "astray", 0.06)],
)
def test_a_map_is_right_under_noise_whose_rate_is_learned(noise: dict[str, float], rate: str, within: float) -> None:
    world = NoisyWorld(load_world("4x4"), **noise)
    agent = Agent(world.unwrapped.motions, settings=Settings(look_ahead=3), seed=1)
    trail = walked(world, agent, 160, seed=1)
    exact(agent, trail, world)
    learned = {each.name: each.mean for each in agent.learned_rates}
    assert learned[rate] == pytest.approx(next(iter(noise.values())), abs=within)
    assert trail.wrong <= 8


def test_a_silent_move_while_half_is_known_is_found() -> None:
    world = load_world("4x4")
    agent = Agent(world.motions, seed=0)
    trail = walked(world, agent, 60, moves={7: (3, 3)})
    exact(agent, trail, world)


def test_without_positions_places_are_known_by_what_is_sensed() -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, pose=NoPose(), seed=0)
    trail = walked(world, agent, 40)
    exact(agent, trail, world)
    assert agent.map.position(0) is None


@pytest.mark.parametrize(("name", "steps"), [("3x3_alias", 22), ("t_maze_alias", 18)])
def test_without_positions_squares_spare_a_walk_along_every_way(name: str, steps: int) -> None:
    world = load_world(name)
    agent = Agent(world.motions, pose=NoPose(), settings=Settings(look_ahead=4), seed=1)
    trail = walked(world, agent, steps)
    exact(agent, trail, world)


@pytest.mark.parametrize(("pose", "name", "steps"), [(None, "3x3", 34), (NoPose(), "3x3", 40)])
def test_ways_that_no_sensor_tells_of_are_tried(pose: NoPose | None, name: str, steps: int) -> None:
    world = UnseenWays(load_world(name))
    agent = Agent(world.unwrapped.motions, sensors=[Sight("sight")], pose=pose, settings=Settings(look_ahead=4), seed=0)
    trail = walked(world, agent, steps)
    verdict = trail.verdict(agent, world.unwrapped.chart)
    assert (verdict.map_right, verdict.places, verdict.known) == (True, 9, 1.0)
    actions = [record.action for record in agent.trace[: steps - 4]]
    tried = list(zip(trail.rooms, actions, trail.rooms[1:], strict=False))
    bumped = [(room, action) for room, action, after in tried if room == after]
    assert len(bumped) <= len(set(bumped)) + 1  # a wall is not taken for a room that looks the same, again and again


def test_the_map_holds_ways_that_lead_one_way_only() -> None:
    world = ring(6, seed=1)
    agent = Agent(world.motions, seed=1)
    trail = walked(world, agent, 24, seed=1)
    verdict = trail.verdict(agent, world.unwrapped.chart)
    assert (verdict.map_right, verdict.places, verdict.known) == (True, 6, 1.0)
    learned = {each.name: each.mean for each in agent.learned_rates}
    assert learned["undone"] < 0.9
    assert learned["way_misread"] < 0.02


def test_a_torus_with_three_labels_is_not_left_folded() -> None:
    world = torus(4, 4, diagonal=3, seed=100_000)
    agent = Agent(world.motions, settings=Settings(look_ahead=4), seed=100)
    trail = walked(world, agent, 60, seed=100)
    verdict = trail.verdict(agent, world.unwrapped.chart)
    assert (verdict.map_right, verdict.places) == (True, 16)


def test_hypotheses_say_what_they_differ_in_and_are_saved(tmp_path: Path) -> None:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, seed=0)
    observation, _ = world.reset(seed=0)
    open_questions = 0
    for step in range(30):
        if step == 12:
            observation = world.displace((0, 2))
        agent.step(observation)
        hypotheses = agent.hypotheses
        assert sum(each.probability for each in hypotheses) == pytest.approx(1.0)
        assert [each.probability for each in hypotheses] == sorted((e.probability for e in hypotheses), reverse=True)
        assert sum(not each.differences for each in hypotheses) >= 1
        open_questions += len(hypotheses) > 1
        agent.save(tmp_path / "agent.npz")
        loaded = Agent.load(tmp_path / "agent.npz")
        assert loaded.hypotheses == hypotheses
        assert loaded.learned_rates == agent.learned_rates
        observation, *_ = world.step(agent.trace[-1].action)
    assert open_questions


def test_the_graph_has_the_open_question_as_a_variable() -> None:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, seed=0)
    observation, _ = world.reset(seed=0)
    asked = 0
    for step in range(30):
        if step == 12:
            observation = world.displace((0, 2))
        action = agent.step(observation)
        if len(agent.hypotheses) > 1:
            asked += 1
            posterior, t = infer(agent.graph), agent.steps - 1
            weights = [each.probability for each in agent.hypotheses]
            np.testing.assert_allclose(posterior.marginal(f"h{t}"), np.array(weights) / sum(weights), atol=1e-9)
            here = dict(zip(agent.graph.variable_named(f"here{t}").domain, posterior.marginal(f"here{t}"), strict=True))
            assert here[agent.belief.place] == pytest.approx(agent.belief.certainty, abs=1e-6)
        observation, *_ = world.step(action)
    assert asked


def test_the_last_steps_in_a_place_are_those_of_its_room() -> None:
    world = load_world("4x4_alias")
    agent = Agent(world.motions, seed=3)
    observation, info = world.reset(seed=3)
    rooms: list[Any] = []
    for _ in range(40):
        action = agent.step(observation)
        rooms.append(place_of(info))
        observation, *_, info = world.step(action)
    for place in agent.map.visited_places.tolist():
        assert len({rooms[step] for step in agent.steps_in(place)}) == 1


def test_an_agent_whose_map_is_never_in_question_is_saved_and_told_otherwise(tmp_path: Path) -> None:
    world, path = load_world("4x4_alias"), tmp_path / "agent.npz"
    paper = Settings(hypotheses=None)
    agent = Agent(world.motions, settings=paper, seed=0)
    walked(world, agent, 20)
    assert (agent.hypotheses, agent.learned_rates) == ((), ())
    agent.save(path)
    seen = world.observe()
    assert Agent.load(path).settings == paper
    assert Agent.load(path).step(seen) == agent.step(seen)
    doubting = Agent.load(path, settings=Settings())
    doubting.step(seen)
    assert doubting.hypotheses
    assert doubting.certain
    doubting.save(path)
    again = Agent.load(path, settings=paper)
    again.step(seen)
    assert again.hypotheses == ()
    with pytest.raises(CogmapError, match=r"^load: settings is 3; give Settings"):
        Agent.load(path, settings=3)  # type: ignore[arg-type]


@pytest.mark.parametrize("rate", [0.01, 0.03])
def test_doors_that_are_seldom_misread_do_not_leave_the_map_wrong(rate: float) -> None:
    world = NoisyWorld(load_world("4x4"), door=rate)
    agent = Agent(world.unwrapped.motions, settings=Settings(look_ahead=3), seed=2)
    trail = walked(world, agent, 150, seed=2)
    exact(agent, trail, world)


@pytest.mark.parametrize(
    "options",
    [
        {"most": 0},
        {"most": True},
        {"most": "x"},
        {"folded": 1.5},
        {"least": None},
        {"doubt": float("nan")},
        {"calm": 1},
    ],
)
def test_options_of_hypotheses_that_cannot_work(options: dict[str, Any]) -> None:
    with pytest.raises(CogmapError, match=r"^tracker: "):
        TrackerOptions(**options)


def test_what_is_no_place_and_no_walk() -> None:
    agent = Agent(load_world("3x3").motions, seed=0)
    for place in (99, -1, "a"):
        with pytest.raises(CogmapError, match=f"no place {place!r}"):
            agent.steps_in(place)  # type: ignore[arg-type]
    with pytest.raises(CogmapError, match="the walk is a NoneType"):
        next(agent.follow(None))  # type: ignore[arg-type]


def test_what_is_hardly_probable_counts_for_more_where_trying_is_all_that_is_left() -> None:
    tracker = Tracker(WayScheme(2, (1, 0)))
    for action in (None, 0, 0):
        tracker.step(Sensed((0,), (None, None), action), [1])
    asked, tried = (OpenQuestion(tracker.hypotheses, {0: 0, 1: 1}, tries=tries) for tries in (False, True))
    assert len(asked.weights) > 1
    assert tried.weights == pytest.approx([weight**0.5 for weight in asked.weights])


def test_hypotheses_that_no_walk_tells_apart_are_asked_as_one() -> None:
    tracker = Tracker(WayScheme(2, (1, 0), ((-1, 0), (1, 0))))
    west, both, east = (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)
    for label, ways, action in ((0, both, None), (1, east, 0), (0, both, 1), (2, both, 1), (0, both, 1), (1, west, 1)):
        tracker.step(Sensed((label,), ways, action), [3])
    kept = [h for h in tracker.hypotheses if exp(h.weight) > 1e-5]
    asked = OpenQuestion(kept, {0: 0, 1: 1})
    assert any(indistinguishable(*pair) for pair in combinations(kept, 2))  # where on the chart is no question
    assert 1 < len(asked.weights) < len(kept)
    assert sum(asked.weights) == pytest.approx(sum(exp(h.weight) for h in kept))


def test_a_doubt_that_is_small_is_looked_into_where_nothing_else_is_left_to_do() -> None:
    assert kidnap(MAZES["t_maze_alias"], seed=5).map_intact  # it was moved while it was open how long the stem is


def test_what_has_faded_stays_faded_when_the_map_is_built_anew() -> None:
    world: Any = load_world("tolman")
    world.reset(options={"start": (6, 2)})
    agent, names = Agent(world.motions, settings=Settings(forgetting=0.2), seed=0), world.motions.names
    taken: dict[str, str] = {}
    for walk in ("lluuurruuudrrrdddddl", "uuuuuu", "uuuuuu"):  # it is put back as if by a step to the left
        observation = {**world.unwrapped.displace((6, 2)), **taken}
        for action in (index for letter in walk for index, name in enumerate(names) if name[0] == letter):
            agent.perceive(observation)
            taken = {"taken": names[action]}
            observation = {**world.step(action)[0], **taken}
    transitions, now, long_ago = agent.map.transitions, agent.map.place_at((-4, 0)), agent.map.place_at((0, -1))
    assert now is not None
    assert long_ago is not None
    counts = [transitions.table.concentrations(row) for row in transitions.rows(np.array([now, long_ago])).tolist()]
    assert max(counts[names.index("up")].values()) > 1.0
    assert max(counts[len(names) + names.index("left")].values()) < 0.1


def test_a_large_map_is_changed_at_its_end_to_what_it_would_be_if_it_was_built_anew() -> None:
    """Put elsewhere and shown a label that no place has, it takes places for new that it knows, for some steps."""
    rng = np.random.default_rng(0)
    maze = labyrinth(100, loops=0.2, sights=20, rng=rng)
    options = Settings(look_ahead=1, hypotheses=TrackerOptions(most=6))
    agent, world = Agent(GRID, map=maze.to_networkx(), settings=options, seed=0), MazeEnv(maze)
    observation, _ = world.reset(seed=0)
    taken = 0
    for step in range(20):
        if step % 10 == 5:
            room = maze.rooms[int(rng.integers(100))]
            observation = {**world.displace(room), "sight": ("new", step)}
        before = len(agent.map.places)
        observation = world.step(agent.step(observation))[0]
        taken += sum(event.kind == "retract" and event.index < before for event in agent.trace[-1].grown)
    assert taken >= 2
    assert_map_is_sound(agent.map)
    anew = copy.deepcopy(agent)
    mirror, now = anew._recognition.mirror, anew._recognition._now
    mirror._rebuild(now, mirror.places, mirror._records, step=anew.steps)
    assert anew._recognition.mirror.places.keys() == agent._recognition.mirror.places.keys()
    for number in agent._recognition.mirror.places:
        assert _ways_of(agent, number) == _ways_of(anew, number)


def _ways_of(agent: Agent, number: int) -> list[tuple[object, float]]:
    """Where each way of a place of the best hypothesis leads in the map, and whether it is believed blocked."""
    map_, places = agent.map, agent._recognition.mirror.places
    numbers = {place: number for number, place in places.items()}
    ahead = [map_.beyond(places[number], action) for action in range(len(map_.motions))]
    blocked = map_.transitions.blocked(np.array([places[number]]))[0].round(2).tolist()
    return [
        (None if to is None else numbers.get(to, map_.position(to)), p) for to, p in zip(ahead, blocked, strict=True)
    ]

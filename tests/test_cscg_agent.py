"""The CSCG agent: its walk, what it learns of rooms, its goals, and bad input."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from cogmap.baselines.cscg import (
    CscgAgent,
    CscgSettings,
    Walk,
    baum_welch,
    empty_model,
    room_transitions,
    sprinkled,
)
from cogmap.worlds import GRID, MazeEnv, Motions, WorldError, load_world


def sensed(world: MazeEnv, observation: dict[str, Any]) -> dict[str, Any]:
    return {**observation, "position": world.position}


def target(world: MazeEnv) -> np.ndarray:
    """`[R, K]` the room each action leads to."""
    rooms = {room: number for number, room in enumerate(world.maze.rooms)}
    return np.array(
        [
            [rooms.get((row + dr, column + dc), number) for dr, dc in GRID.displacements]
            for (row, column), number in rooms.items()
        ]
    )


def walking(
    name: str, steps: int, *, seed: int, **options: Any
) -> Iterator[tuple[CscgAgent, MazeEnv, list[int], list[int]]]:
    """An agent after each of `steps` moves, its world, its true rooms and its actions."""
    world = load_world(name)
    observation, _ = world.reset(seed=seed)
    agent = CscgAgent(GRID, observations=len(world.maze.rooms), seed=seed, **options)
    numbers = {room: number for number, room in enumerate(world.maze.rooms)}
    rooms, actions = [numbers[world.position]], list[int]()
    for _ in range(steps):
        actions.append(agent.step(sensed(world, observation)))
        yield agent, world, rooms, actions
        observation, *_ = world.step(actions[-1])
        rooms.append(numbers[world.position])


def explored(name: str, steps: int, *, seed: int, **options: Any) -> tuple[CscgAgent, MazeEnv, list[int], list[int]]:
    """An agent after `steps` moves, its world, its true rooms and its actions."""
    return deque(walking(name, steps, seed=seed, **options), maxlen=1)[0]


def steps_to_learn(name: str, most: int, *, seed: int, **options: Any) -> int | None:
    """The first observation after which every true transition is believed at 0.6."""
    walk = enumerate(walking(name, most, seed=seed, **options))
    return next((number for number, (agent, world, rooms, _) in walk if least(agent, world, rooms) >= 0.6), None)


def least(agent: CscgAgent, world: MazeEnv, rooms: list[int]) -> float:
    """The probability of the true transition believed least."""
    n = len(world.maze.rooms)
    tries = np.array(agent.tries)
    return float(agent.place_transitions(rooms, n)[target(world)[:, tries], np.arange(n)[:, None], tries].min())


def test_a_map_of_random_moves_predicts_every_sight() -> None:
    world = load_world("3x3_alias")
    world.reset(seed=0)
    rng = np.random.default_rng(0)
    actions, places = rng.integers(0, 5, 2000), [world.position]
    for action in actions:
        world.step(int(action))
        places.append(world.position)
    number = {room: index for index, room in enumerate(world.maze.rooms)}
    walk = Walk.of([number[place] for place in places], actions)
    empty = empty_model(observations=9, clones=4, actions=5, pseudocount=0.05)
    fit = baum_welch(sprinkled(empty, rng, among=walk), walk, iterations=20)
    B = fit.model.B.reshape(9, 4, 9, 4, 5).sum(axis=1)  # P(next sight | room, clone, action)
    used = np.zeros((9, 4), dtype=bool)
    for (sight, _, _), block in zip(fit.model.triples.rows.tolist(), fit.model.counts, strict=True):
        used[sight] |= block.sum(axis=1) > 5
    for room, clone in zip(*used.nonzero(), strict=True):
        np.testing.assert_array_equal(B[:, room, clone].argmax(axis=0), target(world)[room])
    assert used.any(axis=1).all()


def test_learns_3x3_with_positions_and_curiosity_sooner() -> None:
    by_chance = steps_to_learn("3x3", 600, seed=1, positions=True, navigation="random")
    curious = steps_to_learn("3x3", 600, seed=1, positions=True, settings=CscgSettings(exploring="curious"))
    assert by_chance is not None
    assert curious is not None
    assert curious < by_chance


@pytest.mark.parametrize("exploring", ["random", "targets", "curious"])
def test_same_seed_same_walk(exploring: str) -> None:
    settings = CscgSettings(exploring=exploring, iterations=20, clones=3)
    walks = [explored("3x3", 60, seed=seed, settings=settings)[3] for seed in (4, 4, 5)]
    assert walks[0] == walks[1] != walks[2]


@pytest.mark.parametrize("stays", [False, True])
def test_random_moves_are_all_that_are_tried_and_do_not_depend_on_learning(stays: bool) -> None:
    quick = CscgSettings(iterations=1, viterbi_iterations=1, clones=1, stays=stays)
    _, _, _, pairs = explored("3x3", 400, seed=0, positions=True, navigation="random", settings=quick)
    other = CscgSettings(iterations=2, viterbi_iterations=1, clones=2, retrain_every=50, stays=stays)
    _, _, _, sights = explored("3x3", 400, seed=0, navigation="viterbi", settings=other)
    assert pairs == sights
    counts = np.bincount(pairs, minlength=5)
    assert counts[:4].min() > 50
    assert counts[4] > 50 if stays else counts[4] == 0


def test_retrains_on_schedule() -> None:
    agent, _, _, _ = explored("3x3", 23, seed=0, settings=CscgSettings(retrain_every=7))
    assert agent.trainings == 3


def test_learning_can_be_switched_off() -> None:
    agent, world, _, _ = explored("3x3", 20, seed=0)
    agent.learning = False
    for _ in range(10):
        agent.step(world.observe())
    assert agent.trainings == 4


def test_a_seed_sequence_can_be_used_again() -> None:
    seed = np.random.SeedSequence(7)
    agents = [CscgAgent(GRID, observations=9, seed=seed) for _ in range(2)]
    observation = {"sight": 0, "open": [True] * 5}
    assert [agents[0].step(observation) for _ in range(20)] == [agents[1].step(observation) for _ in range(20)]


def test_before_training_nothing_is_believed() -> None:
    agent, _, rooms, _ = explored("3x3", 4, seed=0)
    assert not agent.place_transitions(rooms, 9).any()


def test_beliefs_change_with_training_only() -> None:
    agent, world, rooms, _ = explored("3x3", 55, seed=0)
    first = agent.place_transitions(rooms, 9)
    assert agent.place_transitions([*rooms, 3], 9) is first
    agent.step(world.observe())
    assert agent.place_transitions([*rooms, 3], 9) is first
    unvisited = sorted(set(range(9)) - set(rooms[:55]))
    assert not first[:, unvisited].any()
    assert (first.sum(axis=0) <= 1 + 1e-9).all()


@pytest.mark.parametrize("named", [False, True])
def test_room_transitions_equal_their_definition(named: bool) -> None:
    rng = np.random.default_rng(3)
    walk = Walk.of(rng.integers(0, 3, 40), rng.integers(0, 2, 39))
    model = sprinkled(empty_model(observations=4, clones=2, actions=2, pseudocount=0.1), rng, among=walk)
    path, rooms = walk.sights * 2 + rng.integers(0, 2, 40) * (walk.sights > 0), rng.integers(0, 4, 40)
    visits = np.zeros((8, 5))
    np.add.at(visits, (path, rooms), 1)
    pooled = visits.reshape(4, 2, 5).sum(axis=1).repeat(2, axis=0) if named else visits
    with np.errstate(invalid="ignore"):
        state_of_room = np.nan_to_num(visits / visits.sum(axis=0))
        room_of_state = np.nan_to_num(pooled / pooled.sum(axis=1, keepdims=True))
    expected = np.einsum("zr,yza,yq->qra", state_of_room, model.B, room_of_state)
    found = room_transitions(model, path, rooms, 5, named=named)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    assert not found[:, 4].any()


@pytest.mark.parametrize("positions", [False, True])
def test_goes_to_a_preferred_sight_and_stays(positions: bool) -> None:
    settings = CscgSettings(retrain_every=300, clones=3)
    agent, world, _, _ = explored("3x3", 300, seed=1, positions=positions, settings=settings)
    goal = max(world.maze.rooms, key=lambda room: abs(room[0] - world.position[0]) + abs(room[1] - world.position[1]))
    agent.prefer({world.maze.sights[goal]: 1.0, world.maze.sights[world.position]: 0.5})
    for _ in range(12):
        action = agent.step(sensed(world, world.observe()))
        world.step(action)
        if GRID.names[action] == "stay":
            break
    assert world.position == goal
    agent.prefer({})
    moves = {agent.step(sensed(world, world.observe())) for _ in range(40)}
    assert moves == set(agent.tries) == set(range(4))


def test_a_goal_never_met_is_looked_for_at_random() -> None:
    agent, world, _, _ = explored("3x3", 20, seed=0)
    agent.prefer({"nowhere": 1.0})
    moves = {agent.step(sensed(world, world.observe())) for _ in range(40)}
    assert moves == set(agent.tries) == set(range(4))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"clones": 0}, "clones of a CSCG agent is a whole number of 1 or more; got 0"),
        ({"retrain_every": 2.5}, "retrain_every of a CSCG agent is a whole number of 1 or more; got 2.5"),
        ({"iterations": -1}, "iterations of a CSCG agent is a whole number of 0 or more; got -1"),
        ({"pseudocount": -0.1}, "pseudocount of a CSCG agent is a finite number of 0 or more"),
        ({"tolerance": float("inf")}, "tolerance of a CSCG agent is a finite number of 0 or more"),
        ({"exploring": "bold"}, "exploring of a CSCG agent is one of random, targets, curious; got 'bold'"),
        ({"retraining": "never"}, "retraining of a CSCG agent is one of restart, continue; got 'never'"),
    ],
)
def test_bad_settings(options: dict[str, Any], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        CscgSettings(**options)


def test_settings_as_a_dictionary() -> None:
    settings = CscgSettings(clones=4, exploring="targets")
    assert CscgSettings(**settings.to_dict()) == settings


@pytest.mark.parametrize(
    ("observation", "message"),
    [
        ({"open": [True] * 5}, "needs a 'sight' and an 'open' flag"),
        ({"sight": 0}, "needs a 'sight' and an 'open' flag"),
        ({"sight": 0, "open": [True] * 4, "position": (0, 0)}, r"shape \(4,\); give one flag an action, 5"),
        ({"sight": 0, "open": [True] * 5}, "observes positions: add the true 'position'"),
        ({"sight": [], "open": [True] * 5, "position": 1}, "must be hashable"),
    ],
)
def test_bad_observations(observation: dict[str, Any], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        CscgAgent(GRID, observations=9, positions=True).step(observation)


def test_more_sights_than_foreseen() -> None:
    agent = CscgAgent(GRID, observations=2)
    for sight in ("a", "b", "a"):
        agent.step({"sight": sight, "open": [True] * 5})
    for _ in range(2):
        with pytest.raises(WorldError, match=r"'c' is one more than the 2 observations foreseen; give more"):
            agent.step({"sight": "c", "open": [True] * 5})


def test_bad_agents() -> None:
    with pytest.raises(WorldError, match=r"navigation of a CSCG agent is one of viterbi, random; got 'blind'"):
        CscgAgent(GRID, observations=9, navigation="blind")
    with pytest.raises(WorldError, match=r"observations of a CSCG agent is a whole number of 1 or more; got 0"):
        CscgAgent(GRID, observations=0)
    with pytest.raises(WorldError, match=r"need an action that stays"):
        CscgAgent(Motions(("on",), ((1,),)), observations=9)


@pytest.mark.parametrize("weights", [{"a": "much"}, 3, {"a": None}])
def test_bad_preferences(weights: Any) -> None:
    with pytest.raises(WorldError, match=r"prefer takes a weight for each sight, such as \{'red': 1.0\}; got"):
        CscgAgent(GRID, observations=9).prefer(weights)


def test_bad_rooms() -> None:
    agent, _, rooms, _ = explored("3x3", 10, seed=0)
    with pytest.raises(WorldError, match=r"the true room of each of the 10 steps learned from; got 3"):
        agent.place_transitions(rooms[:3], 9)
    with pytest.raises(WorldError, match=r"rooms are numbered from 0 to 1"):
        agent.place_transitions([*rooms[:9], 5], 2)

"""The forward filter against brute force over dense tables, and against the factor graph of the window."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference import free_energy, infer, most_probable
from cogmap.inference.filter import advance, begin
from cogmap.inference.message import Belief, Evidence, FilterOptions, Message
from cogmap.model import CognitiveMap, FactorGraph, Learner, Motions, Rates
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID, RIGHT, walk

ENGINES = ("numpy", "gtsam")
WALKS = [
    ("3x3", "predicted"),
    ("3x3_alias", "predicted"),
    ("4x4_alias", "predicted"),
    ("donut", "predicted"),
    ("t_maze_alias", "observed"),
    ("3x3_alias", "observed"),
]


# -- one step against brute force ------------------------------------------------------------------------------


def random_map(rng: np.random.Generator) -> CognitiveMap:
    """Four to seven places on a small grid with random counts everywhere, some without a visit."""
    map_ = CognitiveMap(Motions.of(GRID))
    cells = rng.permutation(9)[: int(rng.integers(4, 8))]
    for cell in cells.tolist():
        map_.new_place((cell // 3, cell % 3), step=0)
    for sight in "abc":
        map_.new_sight(sight, step=0)
    learner = Learner(map_, Rates())
    for place in map_.places:
        learner.sight(place, int(rng.integers(3)), float(rng.random()) * 1e-8)
        learner.doors(place, [*(rng.random(4) < 0.6), True], float(rng.random()) * 0.1)
        if place == 0 or rng.random() < 0.7:
            map_.mark_visited(place)
    return map_


def brute_force(
    map_: CognitiveMap, q: np.ndarray, evidence: Evidence, options: FilterOptions
) -> tuple[np.ndarray, np.ndarray]:
    """Unnormalised joint [s', p', s, p, moved] with and without evidence, over every place and position."""
    S, P, a = len(map_.places), len(map_.positions), evidence.action
    assert a is not None
    A, B, A_p = map_.A(), map_.B()[:-1], map_.positions_given_places()[:-1]
    like = np.array([A[evidence.sight, s] * map_.doors_likelihood(np.array([s]), evidence.open)[0] for s in range(S)])
    moves = 1.0 - options.slip if evidence.was_open else options.slip
    if a == map_.motions.stay:
        moves = 1.0
    B_p = np.zeros((P, P))
    for p in range(P):
        ahead = map_.positions.find(map_.motions.move(map_.positions[p], a))  # type: ignore[arg-type]
        if ahead is not None:
            B_p[ahead, p] += moves
        B_p[p, p] += 1.0 - moves
    joint = np.zeros((S, P, S, P, 2))
    d = options.displacement
    joint[..., 0] = (1.0 - d) * np.einsum("ij,kl,ki,jl->ikjl", B[:, :, a], B_p, A_p, q)
    arrival = map_.visited / map_.visited.sum()
    joint[..., 1] = d * np.einsum("i,ki,jl->ikjl", arrival, A_p, q)
    predicted = joint.copy()
    if not evidence.open[a]:  # not having got through and sensing the door shut are one event
        for s in range(S):
            joint[s, :, s, :, 0] /= map_.blocked(np.array([s]))[0, a] * max(B[s, s, a], 1.0 - moves)
    return joint * like[:, None, None, None, None], predicted


@pytest.mark.parametrize("closed", [[(3, 1)], [(3, 1), (2, 2)], [(3, 1), (2, 2), (1, 1)]])
def test_a_door_shut_in_the_face_is_one_surprise_and_not_three(closed: list[tuple[int, int]]) -> None:
    world = load_world("4x4_alias")
    observation, info = world.reset(seed=1)
    agent, start = Agent(world.motions, seed=1), info["position"]
    for _ in range(40):
        observation, *_, info = world.step(agent.step(observation))
    world.displace((2, 1))
    for _ in range(3):  # until it knows
        agent.step(world.observe())
    agent.prefer({4: 8.0})
    action = agent.step(world.observe())
    for room in closed:
        world.close_room(room)
    for _ in range(2):  # shut in the face, then seen from where it stands
        world.step(action)
        action = agent.step(world.observe())
        assert agent.certain
        row, column = world.position
        assert agent.belief.place == agent.map.place_at((row - start[0], column - start[1]))


@given(seed=st.integers(0, 10**6), action=st.integers(0, 4), displacement=st.sampled_from([0.0, 1e-4, 0.3]))
@settings(max_examples=60, deadline=None)
def test_one_step_is_the_exact_posterior(seed: int, action: int, displacement: float) -> None:
    rng = np.random.default_rng(seed)
    map_ = random_map(rng)
    options = FilterOptions(displacement=displacement, slip=0.05, support=0.0)
    S, P = len(map_.places), len(map_.positions)
    held = rng.permutation(S)[: int(rng.integers(1, S))]
    mass = rng.dirichlet(np.ones(len(held)))
    q = np.zeros((S, P))
    q[held, map_.position_index[held]] = mass
    evidence = Evidence(action, bool(rng.random() < 0.5), int(rng.integers(3)), [*(rng.random(4) < 0.5).tolist(), True])
    joint, predicted = brute_force(map_, q, evidence, options)
    z = joint.sum()
    belief = advance(map_, Message(held, map_.position_index[held], mass), evidence, options)

    posterior = joint.sum(axis=(2, 3, 4)) / z
    found = np.zeros((S, P))
    found[belief.message.places, belief.message.positions] = belief.message.mass
    np.testing.assert_allclose(found, posterior, atol=1e-9)
    assert belief.evidence == pytest.approx(np.log(z), abs=1e-9)
    if belief.examined:
        assert belief.moved == pytest.approx(joint[..., 1].sum() / z, abs=1e-9)
    walks = np.zeros((S, S))
    np.add.at(walks, (belief.walks[1], belief.walks[0]), belief.walks[2])
    np.testing.assert_allclose(walks, joint[..., 0].sum(axis=(1, 3)) / z, atol=1e-9)
    # free energy, from its definition
    prior = predicted.sum(axis=(2, 3, 4))
    used = posterior > 0.0
    complexity = (posterior[used] * np.log(posterior[used] / prior[used])).sum()
    accuracy = (posterior[used] * np.log(joint.sum(axis=(2, 3, 4))[used] / prior[used])).sum()
    assert belief.complexity == pytest.approx(complexity, abs=1e-7)
    assert belief.accuracy == pytest.approx(accuracy, abs=1e-7)
    assert belief.free_energy == pytest.approx(-np.log(z), abs=1e-7)
    assert belief.dropped == pytest.approx(0.0, abs=1e-9)


def test_the_first_belief_knows_its_place() -> None:
    map_ = random_map(np.random.default_rng(3))
    evidence = Evidence(None, False, 1, [True, False, True, True, True])
    belief = begin(map_, 2, evidence)
    assert belief.places == {2: 1.0}
    assert belief.positions == {int(map_.position_index[2]): 1.0}
    assert (belief.place, belief.certainty, belief.moved, belief.complexity) == (2, 1.0, 0.0, 0.0)
    like = map_.A()[1, 2] * map_.doors_likelihood(np.array([2]), evidence.open)[0]
    assert belief.evidence == pytest.approx(np.log(like)) == pytest.approx(belief.accuracy)
    assert all(len(part) == 0 for part in belief.walks)


@pytest.mark.parametrize("support", [0.0, 0.01, 0.2, 1.0])
def test_what_is_left_out_of_the_support_is_told(support: float) -> None:
    map_ = random_map(np.random.default_rng(8))
    held = np.array([0, 1, 2, 3])
    message = Message(held, map_.position_index[held], np.full(4, 0.25))
    evidence = Evidence(RIGHT, True, 0, [True, True, True, True, True])
    exact = advance(map_, message, evidence, FilterOptions(displacement=0.3, slip=0.05, support=0.0))
    cut = advance(map_, message, evidence, FilterOptions(displacement=0.3, slip=0.05, support=support))
    kept = {place: q for place, q in exact.places.items() if q >= min(support, exact.certainty)}
    assert cut.places == pytest.approx({place: q / sum(kept.values()) for place, q in kept.items()})
    assert cut.evidence == pytest.approx(exact.evidence + np.log(sum(kept.values())))
    assert cut.dropped == pytest.approx(1.0 - sum(kept.values()), abs=1e-12)
    assert list(cut.places.values()) == sorted(cut.places.values(), reverse=True)


def test_being_moved_is_not_examined_where_it_would_be_dropped() -> None:
    map_ = random_map(np.random.default_rng(1))
    message = Message(np.array([0]), map_.position_index[[0]], np.ones(1))
    evidence = Evidence(4, True, 0, [True] * 5)
    likely = advance(map_, message, evidence, FilterOptions(displacement=1e-15, support=0.5))
    assert not likely.examined
    assert likely.moved == 0.0
    assert 0.0 < likely.dropped < 1e-6
    assert advance(map_, message, evidence, FilterOptions(displacement=0.1, support=0.0)).examined


# -- the window ------------------------------------------------------------------------------------------------


def beliefs(
    name: str, growth: str, *, steps: int = 40, seed: int = 1, window: int = 6
) -> Iterator[tuple[Agent, list[Belief]]]:
    """A walk with silent moves, step by step, and the beliefs so far."""
    world = load_world(name)
    options = Settings(look_ahead=2, growth=growth, window=window)
    agent = Agent(world.motions, settings=options, seed=seed)
    held: list[Belief] = []
    for _ in walk(world, agent, steps, seed=seed, displace_every=5, steer=growth == "observed"):
        held.append(agent.belief)
        yield agent, held


def joint_of(agent: Agent, graph: FactorGraph, belief: Belief) -> np.ndarray:
    """The filtered Q(s, p) on the domains of the last slice."""
    t = agent.steps - 1
    s, p = graph.variable_named(f"s{t}"), graph.variable_named(f"p{t}")
    table = np.zeros((s.cardinality, p.cardinality))
    message = belief.message
    for place, position, mass in zip(message.places, message.positions, message.mass, strict=True):
        table[s.index(int(place)), p.index(agent.map.positions[int(position)])] = mass
    return table


def walks_of(graph: FactorGraph, t: int, belief: Belief) -> np.ndarray:
    now, before = graph.variable_named(f"s{t}"), graph.variable_named(f"s{t - 1}")
    table = np.zeros((now.cardinality, before.cardinality))
    for previous, next_, mass in zip(*(part.tolist() for part in belief.walks), strict=True):
        table[now.index(next_), before.index(previous)] += mass
    return table


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("name", "growth"), WALKS)
def test_filter_and_window_agree(name: str, growth: str, engine: str) -> None:
    uncertain = 0
    for agent, held in beliefs(name, growth):
        graph, belief, t = agent.graph, agent.belief, agent.steps - 1
        posterior = infer(graph, engine=engine)
        np.testing.assert_allclose(posterior.joint(f"s{t}", f"p{t}"), joint_of(agent, graph, belief), atol=1e-9)
        np.testing.assert_allclose(posterior.marginal(f"s{t}").max(), belief.certainty, atol=1e-9)
        first = int(graph.variables[0].name[1:])
        retracted = [record.step for record in agent.trace if record.retracted is not None]
        assert first == max(0, t - agent.settings.window, *retracted)  # then the window begins anew
        expected = sum(earlier.evidence for earlier in held[first + 1 :])
        assert posterior.log_evidence == pytest.approx(expected, abs=1e-9)
        if t > first:
            pair = posterior.joint(f"s{t}", f"s{t - 1}", f"moved{t}")[:, :, 0]
            np.testing.assert_allclose(pair, walks_of(graph, t, belief), atol=1e-9)
        uncertain += len(belief.places) > 1
    if "alias" in name:
        assert uncertain, "the walk was meant to have places that look alike"


@pytest.mark.parametrize(("name", "growth"), WALKS)
def test_moved_agrees_with_the_window(name: str, growth: str) -> None:
    examined = 0
    for agent, held in beliefs(name, growth):
        t, belief = agent.steps - 1, held[-1]
        if t and agent.trace[-1].retracted is None:
            assert infer(agent.graph).marginal(f"moved{t}")[1] == pytest.approx(belief.moved, abs=1e-9)
            examined += belief.examined
    assert examined, "the walk was meant to have silent moves"


@pytest.mark.parametrize(("name", "growth"), WALKS)
def test_free_energy_is_minus_log_evidence(name: str, growth: str) -> None:
    for agent, held in beliefs(name, growth):
        belief = held[-1]
        record = agent.trace[-1]
        assert belief.free_energy == pytest.approx(-belief.evidence, abs=1e-9)
        assert record.free_energy == pytest.approx(-record.evidence, abs=1e-9)
        assert belief.complexity >= -1e-9


def test_the_window_free_energy_is_minus_its_log_evidence() -> None:
    for agent, _ in beliefs("4x4_alias", "predicted", steps=20):
        parts = free_energy(infer(agent.graph))
        assert parts.free_energy == pytest.approx(-parts.log_evidence, abs=1e-7)
        assert parts.divergence == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("engine", [*ENGINES, "brute"])
@pytest.mark.parametrize("name", ["3x3_alias", "t_maze_alias"])
def test_the_most_probable_path_is_the_best_of_all(name: str, engine: str) -> None:
    for agent, _ in beliefs(name, "predicted", steps=24, window=3):
        graph = agent.graph
        best = most_probable(graph, engine=engine)
        assert best.log_probability == pytest.approx(brute_best(graph), abs=1e-9)
        assert best.log_probability <= infer(graph).log_evidence + 1e-9
        for name_, label in best.assignment.items():
            assert label in graph.variable_named(name_).domain


def brute_best(graph: FactorGraph) -> float:
    """max_x Σ_f log f(x_f), by one dense table over everything."""
    names = {variable.name: i for i, variable in enumerate(graph.variables)}
    shape = [variable.cardinality for variable in graph.variables]
    total: Any = np.zeros(shape)
    with np.errstate(divide="ignore"):
        for factor in graph.factors:
            axes = [names[variable.name] for variable in factor.scope]
            log = np.log(factor.dense()).transpose(np.argsort(axes))
            total = total + log.reshape([n if i in axes else 1 for i, n in enumerate(shape)])
    return float(total.max())


@pytest.mark.parametrize("engine", ENGINES)
def test_the_most_probable_path_is_the_way_that_was_walked(engine: str) -> None:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=0)
    rooms = []
    for _ in walk(world, agent, 30, seed=2):
        rooms.append(world.position)
        path = most_probable(agent.graph, engine=engine).assignment
        for name, label in path.items():
            if name[0] == "p":
                row, column = rooms[int(name[1:])]
                assert label == (row - rooms[0][0], column - rooms[0][1])
                assert agent.map.position(path["s" + name[1:]]) == label  # type: ignore[arg-type]
            assert not name.startswith("moved") or label is False


def test_the_window_slides() -> None:
    window = 4
    for agent, held in beliefs("3x3_alias", "predicted", steps=12, window=window):
        t = agent.steps - 1
        steps = sorted({variable.time for variable in agent.graph.variables if variable.time is not None})
        assert steps == list(range(max(0, t - window), t + 1))
        prior = agent.graph.factors[0]
        assert prior.kind == "prior"
        np.testing.assert_allclose(prior.dense().sum(), 1.0)
        assert sorted(held[steps[0]].places) == list(agent.graph.variables[0].domain)


# -- committed -------------------------------------------------------------------------------------------------


def two_hypotheses() -> tuple[CognitiveMap, Belief]:
    map_ = random_map(np.random.default_rng(8))
    held = np.array([0, 1, 2, 3])
    message = Message(held, map_.position_index[held], np.array([0.4, 0.3, 0.2, 0.1]))
    belief = advance(
        map_, message, Evidence(RIGHT, True, 0, [True] * 5), FilterOptions(displacement=0.3, slip=0.05, support=0.0)
    )
    assert len(belief.places) > 2
    return map_, belief


def test_a_committed_belief_has_one_place() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.places == {belief.place: pytest.approx(1.0)}
    assert committed.evidence == pytest.approx(belief.evidence + np.log(belief.certainty))
    assert committed.dropped == pytest.approx(1.0 - belief.certainty)
    there = belief.walks[1] == belief.place
    assert committed.walks[2].sum() == pytest.approx(belief.walks[2][there].sum() / belief.certainty)
    assert (committed.walks[1] == belief.place).all()
    twice = committed.committed()
    assert (twice.places, twice.evidence) == (committed.places, pytest.approx(committed.evidence))


def test_a_committed_belief_has_its_own_free_energy() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.free_energy == pytest.approx(-committed.evidence, abs=1e-9)


def test_a_committed_belief_has_its_own_probability_of_having_been_moved() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.moved == pytest.approx(1.0 - committed.walks[2].sum(), abs=1e-9)


# -- a large map -----------------------------------------------------------------------------------------------


def large_map(rng: np.random.Generator, sights: int) -> CognitiveMap:
    """Twelve by ten places, most of them visited and most of those seen for sure."""
    map_ = CognitiveMap(Motions.of(GRID))
    for cell in range(120):
        map_.new_place((cell // 10, cell % 10), step=0)
    for sight in range(sights):
        map_.new_sight(sight, step=0)
    learner = Learner(map_, Rates())
    for place in rng.permutation(120)[:110].tolist():
        map_.mark_visited(place)
        for _ in range(int(rng.integers(1, 3))):
            learner.sight(place, int(rng.integers(sights)), float(rng.choice([1.0, 0.8, 1e-3], p=[0.7, 0.2, 0.1])))
        learner.doors(place, [*(rng.random(4) < 0.6), True], 1.0)
    return map_


@given(
    seed=st.integers(0, 10**6),
    action=st.integers(0, 4),
    displacement=st.sampled_from([1e-4, 0.3]),
    support=st.sampled_from([1e-3, 0.0, 0.2]),
    sights=st.sampled_from([3, 8, 40]),
)
@settings(max_examples=60, deadline=None)
def test_looking_a_sight_up_changes_nothing(
    seed: int, action: int, displacement: float, support: float, sights: int
) -> None:
    rng = np.random.default_rng(seed)
    map_ = large_map(rng, sights)
    options = FilterOptions(displacement=displacement, support=support)
    held = rng.permutation(120)[: int(rng.integers(1, 5))]
    message = Message(held, map_.position_index[held], rng.dirichlet(np.ones(len(held))))
    doors = [*(rng.random(4) < 0.5).tolist(), True]
    evidence = Evidence(action, bool(rng.random() < 0.5), int(rng.integers(sights)), doors)
    belief = advance(map_, message, evidence, options)
    map_.visited_with = lambda sight: (map_.visited_places, 0.0)  # type: ignore[method-assign]
    plain = advance(map_, message, evidence, options)

    for name in ("places", "positions", "mass"):
        np.testing.assert_allclose(getattr(belief.message, name), getattr(plain.message, name), rtol=0, atol=1e-9)
    for one, other in zip(belief.walks, plain.walks, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)
    assert belief.evidence == pytest.approx(plain.evidence, abs=1e-9)
    assert belief.moved == pytest.approx(plain.moved, abs=1e-9)
    assert plain.dropped - 1e-12 <= belief.dropped <= plain.dropped + 1e-6
    told = dict(zip(*belief.faint, strict=True))
    for place, odds in zip(*plain.faint, strict=True):  # rivals hear of every one that matters
        assert place in told or odds < 1e-8

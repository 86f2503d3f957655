"""The forward filter against brute force over dense tables, and against the factor graph of the window."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference import Belief, ImpossibleEvidence, Message, advance, begin, free_energy, infer, most_probable
from cogmap.model import (
    CogmapError,
    CognitiveMap,
    FactorGraph,
    Lattice,
    Motions,
    NoPose,
    Percept,
    Sensor,
    Sight,
    Slice,
    Ways,
    take_slice,
    window_graph,
)
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from parts import agent_with
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

SIGHTS = ("sight", "smell", "sound")


def random_map(
    rng: np.random.Generator,
    *,
    sights: int = 1,
    ways: bool = True,
    pose: bool = True,
    displacement: float | None = 1e-4,
    slip: float = 1e-4,
) -> CognitiveMap:
    """Four to seven places with random counts everywhere, some without a visit, of any list of factors."""
    noise = [None, 0.1, 2.0]
    sensors: list[Sensor] = [Sight(name, prior=noise[at]) for at, name in enumerate(SIGHTS[:sights])]
    map_ = CognitiveMap(
        Motions.of(GRID),
        sensors=[*sensors, *([Ways()] if ways else [])],
        pose=Lattice() if pose else NoPose(),
        displacement=displacement,
        slip=slip,
    )
    cells = rng.permutation(9)[: int(rng.integers(4, 8))]
    for at, cell in enumerate(cells.tolist()):
        if pose:
            map_.new_place((cell // 3, cell % 3), step=0)
        else:
            free = [(p, a) for p in range(at) for a in range(4) if map_.beyond(p, a) is None]
            source, action = free[int(rng.integers(len(free)))] if free else (None, None)
            map_.new_place(step=0, source=source, action=action)
    for sight in map_.sights_sensed:
        for label in "abc":
            sight.read(label, step=0)
    for place in map_.places:
        readings = random_readings(map_, rng)
        for name, reading in readings.items():
            map_.sensors[name].learn(place, reading, float(rng.random()) * (0.1 if name == "open" else 1e-8))
        if place == 0 or rng.random() < 0.7:
            map_.mark_visited(place)
    return map_


def random_readings(map_: CognitiveMap, rng: np.random.Generator) -> dict[str, Any]:
    readings: dict[str, Any] = {sight.name: int(rng.integers(3)) for sight in map_.sights_sensed}
    return readings | ({"open": (*(rng.random(4) < 0.5).tolist(), True)} if "open" in map_.sensors else {})


def random_percept(map_: CognitiveMap, rng: np.random.Generator, action: int) -> Percept:
    """With readings that are sure, likelihoods, or missing, and what is said of the move."""
    sure, readings = random_readings(map_, rng), {}
    for name, reading in sure.items():
        kind = rng.integers(4)
        if kind == 0:  # nothing was seen
            continue
        readings[name] = reading
        if kind == 1 and name == "open":
            readings[name] = (*(None if rng.random() < 0.4 else float(rng.random()) for _ in range(4)), True)
        elif kind == 1:
            readings[name] = {int(label): float(rng.random()) for label in rng.permutation(3)[: rng.integers(2, 4)]}
    outcome = [None, None, "arrived", "blocked", "unsure"][int(rng.integers(5))]
    opened, moved = bool(rng.random() < 0.5), map_.displacement is not None and bool(rng.random() < 0.1)
    measured = tuple(rng.normal(size=2)) if rng.random() < 0.5 else None
    return Percept(action, opened, readings, outcome=outcome, displacement=measured, moved=moved)  # type: ignore[arg-type]


def likelihood(map_: CognitiveMap, percept: Percept, action: int) -> float:
    """Of the measured displacement, if that was the move: a Student t, over that of the move that fits best."""
    if percept.displacement is None:
        return 1.0
    far = [np.sum(np.square(np.subtract(percept.displacement, move))) for move in map_.motions.displacements]
    density = [(1.0 + square / (3.0 * 0.1**2)) ** -2.5 for square in far]
    return density[action] / max(density)


def brute_force(map_: CognitiveMap, q: np.ndarray, percept: Percept, slip: float) -> tuple[np.ndarray, np.ndarray]:
    """Unnormalised joint [s', p', s, p, moved] with and without evidence, over every place and position."""
    S, P, a = len(map_.places), max(len(map_.positions), 1), percept.action
    assert a is not None
    B, lattice = map_.B()[:-1], len(map_.positions) > 0
    A_p = map_.positions_given_places()[:-1] if lattice else np.ones((1, S))
    like = np.ones(S)
    for sight in map_.sights_sensed:
        reading = percept.readings.get(sight.name, {0: 1.0, 1: 1.0, 2: 1.0, 3: 1.0})
        told = reading if isinstance(reading, dict) else {reading: 1.0}
        like *= sum(p * sight.table.dense(3)[label] for label, p in told.items())
    blocked = map_.blocked(np.arange(S))
    for way, is_open in enumerate((percept.open or ())[:4]):
        if is_open is not None:
            like *= is_open * (1.0 - blocked[:, way]) + (1.0 - is_open) * blocked[:, way]
    moves = 1.0 - slip if percept.opened else slip
    moves = 1.0 if a == map_.motions.stay else moves
    B_p = np.zeros((P, P)) if lattice else np.ones((1, 1))
    told = np.ones((P, P))  # likelihood of the displacement that was measured
    for p in range(P if lattice else 0):
        ahead = map_.positions.find(map_.motions.move(map_.positions[p], a))  # type: ignore[arg-type]
        if ahead is not None:
            B_p[ahead, p] += moves
            told[ahead, p] = likelihood(map_, percept, a)
        B_p[p, p] += 1.0 - moves
        told[p, p] = likelihood(map_, percept, map_.motions.stay)
    joint = np.zeros((S, P, S, P, 2))
    d = map_.displacement.probability if map_.displacement else 0.0
    d = 1.0 if percept.moved else d
    joint[..., 0] = (1.0 - d) * np.einsum("ij,kl,ki,jl->ikjl", B[:, :, a], B_p, A_p, q)
    arrival = map_.visited / map_.visited.sum()
    joint[..., 1] = d * np.einsum("i,ki,jl->ikjl", arrival, A_p, q)
    predicted = joint.copy()
    joint[..., 0] *= told[None, :, None, :]
    if percept.outcome in ("arrived", "blocked") and a != map_.motions.stay:
        stayed = np.eye(S, dtype=bool)
        wrong = ~stayed if percept.outcome == "blocked" else stayed
        joint[..., 0] *= np.where(wrong, map_.priors.door_floor, 1.0)[:, None, :, None]
    if (
        percept.open is not None and percept.open[a] is False
    ):  # not having got through and sensing it shut are one event
        stays = 1.0 - moves if lattice else 1.0
        for s in range(S):
            joint[s, :, s, :, 0] /= blocked[s, a] * max(B[s, s, a], stays) or 1.0
    return joint * like[:, None, None, None, None], predicted


@pytest.mark.parametrize("closed", [[(3, 1)], [(3, 1), (2, 2)], [(3, 1), (2, 2), (1, 1)]])
def test_a_door_shut_in_the_face_is_one_surprise_and_not_three(closed: list[tuple[int, int]]) -> None:
    world = load_world("4x4_alias")
    observation, info = world.reset(seed=1)
    agent, start = Agent(world.motions, settings=Settings(hypotheses=None), seed=1), info["position"]
    for _ in range(40):
        observation, *_, info = world.step(agent.step(observation))
    world.displace((2, 1))
    agent.step(world.observe())
    for _ in range(3):  # until it knows
        agent.step({**world.observe(), "taken": "stay"})
    agent.prefer({4: 8.0})
    action = agent.step({**world.observe(), "taken": "stay"})
    for room in closed:
        world.close_room(room)
    for _ in range(2):  # shut in the face, then seen from where it stands
        world.step(action)
        action = agent.step(world.observe())
        assert agent.certain
        row, column = world.position
        assert agent.belief.place == agent.map.place_at((row - start[0], column - start[1]))


lists = st.fixed_dictionaries(
    {
        "sights": st.integers(0, 3),
        "ways": st.booleans(),
        "pose": st.booleans(),
        "displacement": st.sampled_from([None, 0.0, 1e-4, 0.3]),
        "slip": st.sampled_from([1e-4, 0.05, 0.5]),
    }
)


@given(seed=st.integers(0, 10**6), action=st.integers(0, 4), factors=lists)
@settings(max_examples=300, deadline=None)
def test_the_filter_is_the_two_slice_graph_is_brute_force(seed: int, action: int, factors: dict[str, Any]) -> None:
    rng = np.random.default_rng(seed)
    map_ = random_map(rng, **factors)
    S, P = len(map_.places), max(len(map_.positions), 1)
    held = np.sort(rng.permutation(S)[: int(rng.integers(1, S))])
    poses = map_.pose.of(held)
    mass = rng.dirichlet(np.ones(len(held)))
    q = np.zeros((S, P))
    q[held, poses] = mass
    percept = random_percept(map_, rng, action)
    joint, predicted = brute_force(map_, q, percept, factors["slip"])
    z = joint.sum()
    belief = advance(map_, Message(held, poses, mass), percept, support=0.0)

    posterior = joint.sum(axis=(2, 3, 4)) / z
    found = np.zeros((S, P))
    found[belief.message.places, belief.message.positions] = belief.message.mass
    np.testing.assert_allclose(found, posterior, atol=1e-9)
    assert belief.evidence == pytest.approx(np.log(z), abs=1e-9)
    assert belief.dropped == pytest.approx(0.0, abs=1e-9)
    if belief.examined:
        assert belief.moved == pytest.approx(joint[..., 1].sum() / z, abs=1e-9)
    pairwise = np.zeros((S, S))
    np.add.at(pairwise, (belief.pairwise[1], belief.pairwise[0]), belief.pairwise[2])
    np.testing.assert_allclose(pairwise, joint[..., 0].sum(axis=(1, 3)) / z, atol=1e-9)

    # free energy, from its definition
    prior = predicted.sum(axis=(2, 3, 4))
    used = posterior > 0.0
    complexity = (posterior[used] * np.log(posterior[used] / prior[used])).sum()
    accuracy = (posterior[used] * np.log(joint.sum(axis=(2, 3, 4))[used] / prior[used])).sum()
    assert belief.complexity == pytest.approx(complexity, abs=1e-7)
    assert belief.accuracy == pytest.approx(accuracy, abs=1e-7)
    assert belief.free_energy == pytest.approx(-np.log(z), abs=1e-7)

    # the same from the graph
    graph = two_slices(map_, Message(held, poses, mass), belief, percept)
    names = ("s1", "s0", *(["moved1"] if map_.displacement else []))
    exact = infer(graph, pairs=[names])
    assert exact.log_evidence == pytest.approx(np.log(z), abs=1e-9)
    s1, s0 = (np.array(graph.variable_named(name).domain) for name in names[:2])
    np.testing.assert_allclose(exact.marginal("s1"), posterior.sum(axis=1)[s1], atol=1e-9)
    pairs = exact.joint(*names)
    pairs = pairs[..., 0] if map_.displacement else pairs
    np.testing.assert_allclose(pairs, pairwise[np.ix_(s1, s0)], atol=1e-9)
    if map_.displacement:
        assert exact.marginal("moved1")[1] == pytest.approx(belief.moved, abs=1e-9)


def two_slices(map_: CognitiveMap, message: Message, belief: Belief, percept: Percept) -> FactorGraph:
    """The window of what was believed, and of one step from there."""
    window: list[Slice] = []
    before = Percept(None, False, percept.readings)
    for step, (held, seen, told, ahead) in enumerate(
        (
            (message, before, map_.likelihoods(message.places, before), None),
            (belief.message, percept, belief.likelihoods, belief.ahead),
        )
    ):
        pairs = held.places, held.positions, held.mass
        last = window[-1] if window else None
        window.append(
            take_slice(map_, last, pairs, told, step=step, percept=seen, examined=belief.examined, ahead=ahead)
        )
    return window_graph(map_, window)


def test_the_first_belief_knows_its_place() -> None:
    map_ = random_map(np.random.default_rng(3))
    percept = Percept(None, False, {"sight": 1, "open": (True, False, True, True, True)})
    belief = begin(map_, 2, percept)
    assert belief.places == {2: 1.0}
    assert belief.positions == {int(map_.position_index[2]): 1.0}
    assert (belief.place, belief.certainty, belief.moved, belief.complexity) == (2, 1.0, 0.0, 0.0)
    like = np.log(map_.A()[1, 2]) + map_.sensors["open"].log_likelihood(np.array([2]), percept.open)[0]
    assert belief.evidence == pytest.approx(like) == pytest.approx(belief.accuracy)
    assert all(len(part) == 0 for part in belief.pairwise)


ALL_OPEN = (True,) * 5


@pytest.mark.parametrize("support", [0.0, 0.01, 0.2, 1.0])
def test_what_is_left_out_of_the_support_is_told(support: float) -> None:
    map_ = random_map(np.random.default_rng(8), displacement=0.3, slip=0.05)
    held = np.array([0, 1, 2, 3])
    message = Message(held, map_.position_index[held], np.full(4, 0.25))
    percept = Percept(RIGHT, True, {"sight": 0, "open": ALL_OPEN})
    exact = advance(map_, message, percept, support=0.0)
    cut = advance(map_, message, percept, support=support)
    kept = {place: q for place, q in exact.places.items() if q >= min(support, exact.certainty)}
    assert cut.places == pytest.approx({place: q / sum(kept.values()) for place, q in kept.items()})
    assert cut.evidence == pytest.approx(exact.evidence + np.log(sum(kept.values())))
    assert cut.dropped == pytest.approx(1.0 - sum(kept.values()), abs=1e-12)
    assert list(cut.places.values()) == sorted(cut.places.values(), reverse=True)


def test_being_moved_is_not_examined_where_it_would_be_dropped() -> None:
    percept = Percept(4, True, {"sight": 0, "open": ALL_OPEN})
    for displacement, support, examined in ((1e-15, 0.5, False), (0.1, 0.0, True)):
        map_ = random_map(np.random.default_rng(1), displacement=displacement)
        message = Message(np.array([0]), map_.position_index[[0]], np.ones(1))
        belief = advance(map_, message, percept, support=support)
        assert belief.examined == examined
        if not examined:
            assert belief.moved == 0.0
            assert belief.dropped == pytest.approx(displacement / (displacement + np.exp(belief.evidence)))


def test_likelihoods_too_small_to_be_told_from_zero_are_still_weighed() -> None:
    map_ = random_map(np.random.default_rng(5), sights=3, displacement=0.3)
    for sight in map_.sights_sensed:
        sight.table.background = 1e-160
    message = Message(np.array([0, 1]), map_.position_index[[0, 1]], np.full(2, 0.5))
    percept = Percept(RIGHT, True, {**dict.fromkeys(SIGHTS, 0), "open": ALL_OPEN})
    map_.sights_sensed[2].learn(0, 1, 1.0)
    belief = advance(map_, message, percept, support=0.0)
    assert np.isfinite(belief.evidence)
    assert sum(belief.places.values()) == pytest.approx(1.0)


def test_a_percept_without_an_action_is_the_first() -> None:
    map_ = random_map(np.random.default_rng(1))
    message = Message.sure(0, int(map_.position_index[0]))
    with pytest.raises(CogmapError, match=r"no action; use begin\(\)"):
        advance(map_, message, Percept(None, False, {"sight": 0, "open": ALL_OPEN}))


def test_an_action_that_leads_nowhere_is_impossible() -> None:
    map_ = CognitiveMap(Motions.of(GRID), displacement=0.0, slip=0.0)
    map_.new_place((0, 0), step=0)
    map_.sensors["sight"].read("a", step=0)
    with pytest.raises(ImpossibleEvidence, match="leads nowhere in this model"):
        advance(map_, Message.sure(0, 0), Percept(RIGHT, True, {"sight": 0, "open": ALL_OPEN}))


# -- the window ------------------------------------------------------------------------------------------------


def beliefs(
    name: str, growth: str, *, steps: int = 40, seed: int = 1, window: int = 6
) -> Iterator[tuple[Agent, list[Belief]]]:
    """A walk with silent moves, step by step, and the beliefs so far."""
    world = load_world(name)
    agent = agent_with(world.motions, look_ahead=2, growth=growth, window=window, seed=seed)
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
    for previous, next_, mass in zip(*(part.tolist() for part in belief.pairwise), strict=True):
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
        np.testing.assert_allclose(posterior.marginal(f"s{t}").max(), belief.message.certainty, atol=1e-9)
        first = int(graph.variables[0].name[1:])
        revised = [record.step for record in agent.trace if record.revised]
        assert first >= max(0, t - agent.settings.window, *revised)  # then the window begins anew
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
        if len(agent.window) > 1:
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
    window, whole = 4, 0
    for agent, held in beliefs("3x3_alias", "predicted", steps=12, window=window):
        t = agent.steps - 1
        steps = sorted({variable.time for variable in agent.graph.variables if variable.time is not None})
        assert steps == list(range(steps[0], t + 1))
        assert steps[0] >= max(0, t - window)  # later only where it changed its mind
        whole += len(steps) == window + 1
        prior = agent.graph.factors[0]
        assert prior.kind == "prior"
        np.testing.assert_allclose(prior.dense().sum(), 1.0)
        assert sorted(held[steps[0]].places) == list(agent.graph.variables[0].domain)
    assert whole >= 2


# -- committed -------------------------------------------------------------------------------------------------


def two_hypotheses() -> tuple[CognitiveMap, Belief]:
    map_ = random_map(np.random.default_rng(8), displacement=0.3, slip=0.05)
    held = np.array([0, 1, 2, 3])
    message = Message(held, map_.position_index[held], np.array([0.4, 0.3, 0.2, 0.1]))
    belief = advance(map_, message, Percept(RIGHT, True, {"sight": 0, "open": ALL_OPEN}), support=0.0)
    assert len(belief.places) > 2
    return map_, belief


def test_a_committed_belief_has_one_place() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.places == {belief.place: pytest.approx(1.0)}
    assert committed.evidence == pytest.approx(belief.evidence + np.log(belief.certainty))
    assert committed.dropped == pytest.approx(1.0 - belief.certainty)
    there = belief.pairwise[1] == belief.place
    assert committed.pairwise[2].sum() == pytest.approx(belief.pairwise[2][there].sum() / belief.certainty)
    assert (committed.pairwise[1] == belief.place).all()
    twice = committed.committed()
    assert (twice.places, twice.evidence) == (committed.places, pytest.approx(committed.evidence))


def test_a_committed_belief_has_its_own_free_energy() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.free_energy == pytest.approx(-committed.evidence, abs=1e-9)


def test_a_committed_belief_has_its_own_probability_of_having_been_moved() -> None:
    _, belief = two_hypotheses()
    committed = belief.committed()
    assert committed.moved == pytest.approx(1.0 - committed.pairwise[2].sum(), abs=1e-9)


# -- a large map -----------------------------------------------------------------------------------------------


def large_map(rng: np.random.Generator, sights: int, displacement: float) -> CognitiveMap:
    """Twelve by ten places, most of them visited and most of those seen for sure."""
    map_ = CognitiveMap(Motions.of(GRID), displacement=displacement)
    for cell in range(120):
        map_.new_place((cell // 10, cell % 10), step=0)
    for sight in range(sights):
        map_.sensors["sight"].read(sight, step=0)
    for place in rng.permutation(120)[:110].tolist():
        map_.mark_visited(place)
        for _ in range(int(rng.integers(1, 3))):
            map_.sensors["sight"].learn(
                place, int(rng.integers(sights)), float(rng.choice([1.0, 0.8, 1e-3], p=[0.7, 0.2, 0.1]))
            )
        map_.sensors["open"].learn(place, [*(rng.random(4) < 0.6), True], 1.0)
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
    map_ = large_map(rng, sights, displacement)
    held = rng.permutation(120)[: int(rng.integers(1, 5))]
    message = Message(held, map_.position_index[held], rng.dirichlet(np.ones(len(held))))
    doors = (*(rng.random(4) < 0.5).tolist(), True)
    percept = Percept(action, bool(rng.random() < 0.5), {"sight": int(rng.integers(sights)), "open": doors})
    belief = advance(map_, message, percept, support=support)
    map_.candidates = lambda percept: None  # type: ignore[method-assign]
    plain = advance(map_, message, percept, support=support)

    for name in ("places", "positions", "mass"):
        np.testing.assert_allclose(getattr(belief.message, name), getattr(plain.message, name), rtol=0, atol=1e-9)
    for one, other in zip(belief.pairwise, plain.pairwise, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)
    assert belief.evidence == pytest.approx(plain.evidence, abs=1e-9)
    assert belief.moved == pytest.approx(plain.moved, abs=1e-9)
    assert plain.dropped - 1e-12 <= belief.dropped <= plain.dropped + 1e-6
    told = dict(zip(*belief.pruned, strict=True))
    for place, odds in zip(*plain.pruned, strict=True):  # rivals hear of every one that matters
        assert place in told or odds < 1e-8

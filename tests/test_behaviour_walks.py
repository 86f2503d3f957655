from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings, follow
from cogmap.behaviour import (
    Foresight,
    Ground,
    Walk,
    choices_of,
    follow_route,
    load_ground,
    load_walks,
    new_agent,
    routes_of,
)
from cogmap.model import CogmapError
from cogmap.worlds import GRID, load_world
from shared import shared

TREE = [(0, 1), (1, 2), (1, 3), (3, 4), (3, 5)]
AT = {0: (0, 0), 1: (0, 2), 2: (-2, 2), 3: (2, 2), 4: (2, 0), 5: (2, 4)}


def tree(**changes: Any) -> dict[str, Any]:
    nodes = [{"id": node, "position": list(at)} for node, at in AT.items()]
    edges = [{"source": a, "target": b} for a, b in TREE]
    return {"directed": False, "multigraph": False, "graph": {"name": "tree"}, "nodes": nodes, "edges": edges} | changes


@pytest.fixture
def world(tmp_path: Path) -> Path:
    path = tmp_path / "tree.json"
    path.write_text(json.dumps(tree()), "utf-8")
    return path


@pytest.fixture
def ground(world: Path) -> Ground:
    return load_ground(str(world))


def test_json_csv_and_traces_are_the_same_walk(tmp_path: Path) -> None:
    bouts = [[1, 3, 4], [1, 2]]
    (tmp_path / "a.json").write_text(json.dumps({"mouse": "A", "thirsty": True, "bouts": bouts}), "utf-8")
    lines = ["bout,extra,node,individual"]
    lines += [f"{n},x,{node},A" for n, bout in enumerate(bouts) for node in bout]
    (tmp_path / "a.csv").write_text("\n".join(lines), "utf-8")
    (one,), (two,) = load_walks(tmp_path / "a.json"), load_walks(tmp_path / "a.csv")
    assert (one.individual, one.bouts, one.about) == ("A", ((1, 3, 4), (1, 2)), {"thirsty": True})
    assert (two.individual, two.bouts) == ("A", (("1", "3", "4"), ("1", "2")))
    with pytest.raises(CogmapError, match="A was given twice"):
        load_walks(tmp_path)


def test_bouts_begin_and_end_at_home(ground: Ground) -> None:
    walks = [Walk("A", ((1, 3, 4, 3, 1), ("1", "2", "1")))]
    (route,), placed = routes_of(walks, ground)
    assert placed.home == 0
    assert route.places.tolist() == [0, 1, 3, 4, 3, 1, 0, 1, 2, 1, 0]
    assert route.bout.tolist() == [0] * 7 + [1] * 4
    (until,), _ = routes_of(walks, ground, until=2)
    assert until.places.tolist() == [0, 1, 3, 4, 3, 1, 0, 1]


def test_a_choice_is_a_step_from_a_place_with_three_ways(ground: Ground) -> None:
    (route,), placed = routes_of([Walk("A", ((1, 3, 4, 3, 1),))], ground.with_home(0))
    choices = choices_of(route, placed)
    assert choices.step.tolist() == [1, 2, 4, 5]
    assert choices.target.tolist() == [[0, 2, 3], [1, 4, 5], [1, 4, 5], [0, 2, 3]]
    assert choices.taken.tolist() == [2, 1, 0, 0]
    back, left, forward, right = (
        2,
        3,
        0,
        1,
    )  # 2 lies to the left of who comes from 0, 4 to the right of who comes from 1
    assert choices.relation.tolist() == [
        [back, left, right],
        [back, right, left],
        [left, back, forward],
        [left, forward, back],
    ]
    assert choices.before.tolist() == [[forward, forward], [right, forward], [back, right], [left, back]]
    assert choices.homeward.tolist() == [[True, False, False]] * 4
    assert choices.end.tolist() == [[True, True, False], [False, True, True], [False, True, True], [True, True, False]]
    assert choices.far.tolist() == pytest.approx([1 / 3, 2 / 3, 2 / 3, 1 / 3])


@pytest.mark.parametrize(
    ("bouts", "says"),
    [
        (((1, 3, 2),), "bout 1, step 3: no way of 'tree' leads from 3 to 2"),
        (((1, 3), (9, 3)), "bout 2, step 1: 'tree' has no node 9"),
        (((1, 3), (2, 1)), "bout 2, step 1: no way of 'tree' leads from 3"),
    ],
)
def test_walks_that_do_not_fit_their_world(ground: Ground, bouts: Any, says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        routes_of([Walk("A", bouts)], ground)


def test_walks_that_are_none(tmp_path: Path, ground: Ground) -> None:
    with pytest.raises(CogmapError, match="bout 2 of A is empty"):
        Walk("A", ((1,), ()))
    with pytest.raises(CogmapError, match="nothing of A is left before node 1"):
        routes_of([Walk("A", ((1, 3),))], ground, until=1)
    for name, text, says in (
        ("no.json", None, "cannot read"),
        ("torn.json", '{"bouts": [[', "is no JSON"),
        ("none.json", "{}", "has no 'bouts'"),
        ("flat.json", '{"bouts": [1, 2]}', "bout 1 is 1"),
        ("heads.csv", "individual,node\nA,1", "has no column 'bout'"),
        ("short.csv", "individual,bout,node\nA,1", "line 2: no node"),
        ("empty.csv", "individual,bout,node\n", "has no walks"),
    ):
        if text is not None:
            (tmp_path / name).write_text(text, "utf-8")
        with pytest.raises(CogmapError, match=says):
            load_walks(tmp_path / name)


def test_worlds_in_which_nobody_knows_where_a_way_leads(tmp_path: Path) -> None:
    path = tmp_path / "bare.json"
    path.write_text(json.dumps(tree(nodes=[{"id": node} for node in AT])), "utf-8")
    with pytest.raises(CogmapError, match="no labels with a displacement and its nodes no position"):
        load_ground(str(path))
    path.write_text(json.dumps(tree(nodes=[{"id": node, "position": [0, 0]} for node in AT])), "utf-8")
    with pytest.raises(ValueError, match="position"):
        load_ground(str(path))


def test_following_says_what_the_agent_would_do() -> None:
    world, agent = load_world("4x4"), Agent(GRID, settings=Settings(look_ahead=4), seed=0)
    observation, _ = world.reset(seed=0, options={"start": (0, 0)})
    walk = [observation]
    for action in ("right", "right", "down"):
        observation, *_ = world.step(GRID.names.index(action))
        walk.append(dict(observation) | {"taken": action})
    steps = list(follow(agent, walk))
    assert [step.step for step in steps] == [0, 1, 2, 3]
    for step, observation in zip(steps, walk, strict=True):
        open_ = [i for i, is_open in enumerate(observation["open"]) if is_open and GRID.names[i] != "stay"]
        assert step.ways == tuple(open_)
        assert step.probability.sum() == pytest.approx(1.0)
        first = step.plan.policies[:, 0]
        mass = np.array([step.plan.probability[first == action].sum() for action in open_])
        assert step.probability[open_] == pytest.approx(mass / mass.sum())
    assert agent.map.position(steps[-1].belief.place) == (1, 2)
    with pytest.raises(CogmapError, match="say what was 'taken'"):
        next(follow(agent, walk[:1]))


def test_what_is_expected_beyond_a_way_is_the_agents_own_G(ground: Ground) -> None:
    agent, walk = new_agent(ground, look_ahead=4), list(ground.observations([0, 1, 3]))
    foresight = Foresight(agent, ground)
    for observation in walk:
        foresight.arrive(observation)
    found = foresight.look(ground.ways[3])
    *_, followed = follow(new_agent(ground, look_ahead=4), walk)
    names = list(agent.map.motions.names)
    for i, way in enumerate(ground.ways[3]):
        of = followed.plan.policies[:, 0] == names.index(way.action)
        worth = found.gain[found.way == i] @ agent.settings.discount ** np.arange(4)
        assert np.sort(worth) == pytest.approx(np.sort(-followed.plan.expected_free_energy.G[of]), abs=1e-4)
    assert not found.extra[found.age == 0].any()
    back = found.way == 0  # where it came from
    assert found.age[back, 0].tolist() == [2] * back.sum()
    assert (found.extra[back, 0] > 1.0).all()


def test_the_map_stays_right_along_recorded_animals() -> None:
    ground = load_ground(str(shared("worlds/mouse_labyrinth.json")))
    routes, ground = routes_of(load_walks(shared("worlds/mice")), ground, until=116)
    assert (len(routes), ground.places[ground.home or 0]) == (12, 127)
    assert sum(len(choices_of(route, ground)) for route in routes) == 4735
    for route in routes:
        if len(route.places) < 100:
            found = follow_route(route, ground)
            assert (found.astray, found.entered) == (0, found.nodes), route.individual
            assert found.nodes == len(set(route.places.tolist()))


def test_a_maze_is_walked_with_its_own_actions() -> None:
    ground = Ground.of(load_world("3x3").chart)
    assert dict(ground.motions) == dict(zip(GRID.names, GRID.displacements, strict=True))
    assert ground.find("0,1", "here") == ground.find((0, 1), "here") == ground.find("(0, 1)", "here") == 1

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import pytest
from cogmap.agent import Agent, Settings
from cogmap.baselines import FrontierAgent
from cogmap.experiments import (
    NavigateRun,
    Parts,
    explore,
    navigate,
    navigate_many,
    navigate_result,
    parse_goal,
    workers,
)
from cogmap.experiments import run as live
from cogmap.model import CogmapError
from cogmap.worlds import GRID, MAZES, hall, load_world, parse_maze, shortest_path

SMALL, ALIAS = MAZES["3x3"], MAZES["t_maze_alias"]
WORDS = parse_maze("a b 3", name="words")


@pytest.mark.parametrize(("name", "goal"), [("3x3", 8), ("t_maze_alias", 2)])
def test_in_a_known_maze_it_walks_the_shortest_path(name: str, goal: int) -> None:
    runs = navigate_many(MAZES[name], runs=4, goal=goal)
    assert all(run.reached for run in runs)
    result = navigate_result(MAZES[name], runs, goal=goal, settings=Settings())
    assert 1.0 <= result["summary"]["ratio"] <= 1.5
    assert len({run.start for run in runs}) > 1


def test_an_unknown_maze_is_searched_from_the_start_of_explore() -> None:
    runs = navigate_many(SMALL, runs=4, goal=8, known=False)
    assert all(run.reached for run in runs)
    for run in runs:
        assert run.start == explore(SMALL, seed=run.seed, max_steps=1).start
        assert run.steps is not None
        assert run.shortest is not None
        assert run.frontier_steps is not None
        assert min(run.steps, run.frontier_steps) >= run.shortest
        assert run.explored_from is None


def test_exploring_first_is_that_of_explore() -> None:
    plain, run = explore(SMALL, seed=3), navigate(SMALL, goal=0, seed=3)
    assert (run.explored_from, run.steps_to_explore) == (plain.start, plain.steps_to_complete)


CORRIDOR = parse_maze("7 0 1 2 7", name="corridor")


class Walking:
    """Makes agents that carry out the given actions; the last one says what was preferred."""

    agent = "walker"

    def __init__(self, *names: str) -> None:
        self.actions, self.preferred = [GRID.names.index(name) for name in names], dict[Any, float]()

    def make(self, world: Any, seed: object) -> Any:
        left = list(self.actions)
        return SimpleNamespace(step=lambda _: left.pop(0), prefer=self.preferred.update)

    def to_dict(self, chart: object) -> dict[str, Any]:
        return {}


def starts_at(column: int) -> int:
    """A seed with which the corridor is entered there."""
    return next(s for s in range(99) if explore(CORRIDOR, s, agent="random", max_steps=1).start == (0, column))


def test_the_shortest_path_is_to_the_nearest_room_with_the_sight() -> None:
    for column, expected in enumerate([0, 1, 2, 1, 0]):
        run = navigate(CORRIDOR, starts_at(column), goal=7, known=False, agent="frontier")
        assert (run.start, run.shortest) == ((0, column), expected)


def test_nearest_frontier_search_stands_on_the_goal() -> None:
    steps = [navigate(CORRIDOR, starts_at(column), goal=2, known=False).frontier_steps for column in range(5)]
    assert (steps[0], steps[3], steps[4]) == (3, 0, 1)
    assert steps[1] in (2, 4)  # one step the wrong way, or none
    assert steps[2] in (1, 3, 5)


@pytest.mark.parametrize(
    ("actions", "steps", "stood"),
    [
        (["right", "stay"], 1, 1),
        (["right", "right", "left", "stay"], 3, 1),
        (["stay", "right", "stay"], 2, 2),
        (["right", "right", "stay", "stay", "stay"], None, 1),
        (["right", "up", "left", "right", "left"], None, 1),
    ],
)
def test_passing_through_is_not_reaching(actions: list[str], steps: int | None, stood: int) -> None:
    walking = Walking(*actions)
    run = navigate(CORRIDOR, starts_at(0), goal=0, known=False, weight=2.5, agent=walking, max_steps=4)
    assert (run.reached, run.steps, run.steps_to_stand) == (steps is not None, steps, stood)
    assert walking.preferred == {0: 2.5}


def test_any_agent_can_be_sent() -> None:
    for seed in range(4):
        search = navigate(MAZES["t_maze"], goal=7, known=False, agent="frontier", seed=seed)
        assert search.reached
        assert search.steps == search.steps_to_stand == search.frontier_steps
        walk = navigate(MAZES["t_maze"], goal=7, known=False, agent="random", seed=seed)
        assert walk.reached
        assert walk.steps is not None
        assert walk.shortest is not None
        assert walk.steps >= walk.shortest
    with pytest.raises(CogmapError, match="no agent is called 'genius'"):
        navigate(SMALL, goal=0, agent="genius")


def test_what_frontier_search_has_seen_it_finds_again_where_it_takes_itself_to_be() -> None:
    world, stay = load_world("3x3"), GRID.names.index("stay")
    agent = live(world, FrontierAgent(GRID, seed=0), steps=20, options={"start": (0, 0)}).agent
    agent.prefer({8: 1.0, 3: 0.5})
    room = world.position
    begin = world.observe(), {"position": room}
    done = live(world, agent, steps=20, begin=begin, watch=lambda moment: moment.action == stay)
    assert len(done.truth) == len(shortest_path(SMALL, room, done.truth[-1]))
    assert SMALL.sights[done.truth[-1]] == 8


def test_failures_are_counted_apart() -> None:
    runs = [
        NavigateRun(0, (0, 0), True, 6, 4, (0, 1), 9),
        NavigateRun(1, (0, 0), False, None, 2, (0, 1), 9),
        NavigateRun(2, None, False, None, None, (0, 1)),
    ]
    summary = navigate_result(SMALL, runs, goal=8, settings=Settings())["summary"]
    assert (summary["runs"], summary["reached"], summary["failed"], summary["explored"]) == (3, 1, 2, 2)
    assert (summary["total_steps"], summary["total_shortest"], summary["ratio"]) == (6, 4, 1.5)
    nothing = navigate_result(SMALL, runs[1:], goal=8, settings=Settings())["summary"]
    assert (nothing["ratio"], nothing["mean_steps"], nothing["total_steps"]) == (None, None, 0)
    at_once = navigate_result(SMALL, [NavigateRun(0, (0, 0), True, 0, 0, (0, 1), 9)], goal=0, settings=Settings())
    assert at_once["summary"]["ratio"] == 1.0


def test_not_explored_sets_out_nowhere() -> None:
    run = navigate(SMALL, goal=8, max_steps=2)
    assert (run.start, run.reached, run.steps, run.shortest, run.steps_to_explore) == (None, False, None, None, None)


def test_one_room() -> None:
    one = parse_maze("5", name="one")
    for known in (True, False):
        run = navigate(one, goal=5, known=known)
        assert (run.reached, run.steps, run.shortest) == (True, 0, 0)


@pytest.mark.parametrize("known", [True, False])
def test_the_result_is_plain_json_and_the_same_on_two_processes(known: bool) -> None:
    one = navigate_many(SMALL, runs=2, seed=4, goal=8, known=known)
    with workers(jobs=2) as executor:
        two = navigate_many(SMALL, runs=2, seed=4, goal=8, known=known, executor=executor)
    assert one == two
    result = json.loads(
        json.dumps(navigate_result(SMALL, one, goal=8, known=known, settings=Settings()), allow_nan=False)
    )
    assert list(result) == ["world", "agent", "goal", "weight", "unexplored", "settings", "runs", "summary"]
    assert [run["seed"] for run in result["runs"]] == [4, 5]
    assert {"seed", "start", "reached", "steps", "shortest"} <= set(result["runs"][0])
    assert ("frontier_steps" in result["runs"][0]) is not known
    assert ("explored_from" in result["runs"][0]) is known
    assert result["settings"] == json.loads(json.dumps(Parts().to_dict(SMALL)))


def test_goals_are_read_as_the_labels_of_the_maze() -> None:
    assert parse_goal(SMALL, "8") == 8
    assert parse_goal(WORDS, "3") == "3"
    for maze, text in ((SMALL, "9"), (SMALL, "-1"), (SMALL, "a"), (SMALL, "²"), (WORDS, "c"), (WORDS, "")):
        with pytest.raises(CogmapError, match=f"no room of maze '{maze.name}' has label"):
            parse_goal(maze, text)
    with pytest.raises(CogmapError, match=r"use one of 0, 1, .* and 60 more"):
        parse_goal(hall(10, 10, sights=None), "1000")


def test_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Agent, "step", lambda *_: pytest.fail("it walked"))
    for bad, message in (
        (lambda: navigate(SMALL, goal=99), "has label 99; use one of 0, 1, 2, 3, 4, 5, 6, 7, 8$"),
        (lambda: navigate(SMALL, goal="8"), "has label '8'"),
        (lambda: navigate(SMALL, goal=8, weight=0.0), "weight is 0.0"),
        (lambda: navigate(SMALL, goal=8, weight=float("nan")), "weight is nan"),
        (lambda: navigate(SMALL, goal=8, weight=float("inf")), "weight is inf"),
        (lambda: navigate(SMALL, goal=8, seed=-1, known=False), "navigate: seed is -1"),
        (lambda: navigate(SMALL, goal=8, max_steps=0), "navigate: max_steps is 0"),
        (lambda: navigate_many(ALIAS, goal=2, runs=0), "runs is 0"),
    ):
        with pytest.raises(CogmapError, match=message):
            bad()

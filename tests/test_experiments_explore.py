from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.experiments import (
    ExploreRun,
    Parts,
    exploration,
    explore,
    explore_many,
    frontier_steps,
    map_tasks,
    oracle_steps,
    summarise,
    walk,
    workers,
)
from cogmap.model import CogmapError
from cogmap.worlds import MAZES, MazeEnv, parse_maze, random_maze

ONE = parse_maze("5", name="one")


def untimed(runs: list[ExploreRun]) -> list[ExploreRun]:
    return [replace(run, seconds=0.0) for run in runs]


def test_a_run_is_made_of_true_moves() -> None:
    done = walk(MAZES["3x3"], seed=4)
    run = done.run
    assert done.finished
    assert run.start == done.path[0]
    assert run.steps_to_complete == len(done.path) - 1
    assert run.steps_to_visit_all is not None
    assert set(done.path[: run.steps_to_visit_all + 1]) == set(MAZES["3x3"].rooms)
    assert set(done.path[: run.steps_to_visit_all]) != set(MAZES["3x3"].rooms)
    assert run.oracle_steps is not None
    assert run.steps_to_visit_all >= run.oracle_steps
    assert run.steps_to_learn is not None
    assert run.steps_to_complete >= max(run.steps_to_learn, run.steps_to_visit_all)


@pytest.mark.parametrize("agent", ["cogmap", "frontier"])
def test_one_room_is_complete_at_once(agent: str) -> None:
    run = explore(ONE, agent=agent)
    assert (run.steps_to_visit_all, run.steps_to_learn, run.steps_to_complete, run.oracle_steps) == (0, 0, 0, 0)
    assert summarise([run], max_steps=1)["ratio"] == 1.0


def test_the_same_seed_walks_the_same_way() -> None:
    assert walk(MAZES["4x4_alias"], seed=7).path == walk(MAZES["4x4_alias"], seed=7).path
    assert len({explore(MAZES["4x4"], agent="random", seed=seed, max_steps=1).start for seed in range(20)}) > 5


def test_run_i_has_seed_s_plus_i() -> None:
    runs = explore_many(MAZES["3x3"], runs=3, seed=10)
    assert untimed(runs) == untimed([explore(MAZES["3x3"], seed=seed) for seed in (10, 11, 12)])


def test_processes_do_not_change_the_rows() -> None:
    calls: list[int] = []
    with workers(jobs=2) as executor:
        several = explore_many(MAZES["3x3"], runs=3, seed=1, executor=executor, on_done=lambda: calls.append(1))
    assert untimed(several) == untimed(explore_many(MAZES["3x3"], runs=3, seed=1))
    assert len(calls) == 3


def test_an_error_in_a_worker_arrives() -> None:
    with pytest.raises(ValueError, match=r"math domain error|nonnegative"), workers(jobs=2) as executor:
        map_tasks(_root, [1.0, -1.0], executor=executor)


def _root(value: float) -> float:
    import math

    return math.sqrt(value)


def test_a_walk_that_fails_is_counted_with_none() -> None:
    done = walk(MAZES["4x4"], seed=0, max_steps=3)
    assert len(done.path) == 4
    assert not done.finished
    assert done.run.steps_to_complete is None
    good = explore(MAZES["4x4"], seed=0)
    summary = summarise([done.run, good], max_steps=3)
    assert (summary["runs"], summary["completed"]) == (2, 1)
    assert summary["mean_steps_to_complete"] == good.steps_to_complete


def test_a_walk_that_takes_exactly_max_steps_counts() -> None:
    steps = explore(MAZES["3x3"], seed=0).steps_to_complete
    assert steps is not None
    assert explore(MAZES["3x3"], seed=0, max_steps=steps).steps_to_complete == steps
    assert explore(MAZES["3x3"], seed=0, max_steps=steps - 1).steps_to_complete is None


def test_a_random_walk_ends_with_the_last_visit_since_it_senses_the_doors() -> None:
    done = walk(MAZES["3x3"], agent="random", seed=0)
    assert done.finished
    assert done.run.steps_to_visit_all == done.run.steps_to_learn == len(done.path) - 1


class Wanderers:
    """Makes agents that move at random and know no transition."""

    agent = "wanderer"

    def make(self, world: Any, seed: np.random.SeedSequence) -> Any:
        rng = np.random.default_rng(seed)
        return SimpleNamespace(step=lambda _: int(rng.integers(len(world.motions.names))), prefer=lambda _: None)

    def to_dict(self, chart: Any) -> dict[str, Any]:
        return {"rooms": len(chart.places)}


def test_agents_of_ones_own_explore_and_without_transitions_nothing_is_learned() -> None:
    done = walk(MAZES["3x3"], agent=Wanderers(), seed=0, max_steps=200)
    assert not done.finished
    assert done.run.steps_to_visit_all is not None
    assert done.run.steps_to_learn is None
    assert set(done.path) == set(MAZES["3x3"].rooms)
    result = exploration(MAZES["3x3"], [done.run], agent=Wanderers(), max_steps=200)
    assert (result["agent"], result["settings"]) == ("wanderer", {"rooms": 9})


def test_static_growth_is_given_the_number_of_rooms() -> None:
    run = explore(MAZES["3x3"], agent=Parts(growth="static"), seed=0)
    assert run.steps_to_complete is not None
    result = exploration(MAZES["3x3"], [run], agent=Parts(growth="static"))
    assert result["settings"]["places"] == 9


def test_imagined_places_save_steps() -> None:
    predicted, observed = (
        summarise(explore_many(MAZES["3x3"], runs=3, agent=Parts(growth=growth)), max_steps=1)
        for growth in ("predicted", "observed")
    )
    assert predicted["mean_steps_to_complete"] < observed["mean_steps_to_complete"]


def test_the_json_has_the_agreed_shape() -> None:
    runs = explore_many(MAZES["3x3"], runs=2, agent="frontier", seed=5)
    result = json.loads(json.dumps(exploration(MAZES["3x3"], runs, agent="frontier", settings=Settings())))
    assert list(result) == ["world", "agent", "settings", "runs", "summary"]
    keys = "seed start steps_to_visit_all steps_to_learn steps_to_complete oracle_steps seconds"
    assert list(result["runs"][0]) == keys.split()
    assert result["runs"][1]["seed"] == 6
    assert result["runs"][0]["start"] == list(runs[0].start)
    for key in ("completed", "mean_steps_to_complete", "std_steps_to_complete", "mean_oracle_steps", "ratio"):
        assert result["summary"][key] is not None


def test_the_summary_by_hand() -> None:
    base = ExploreRun(0, (0, 0), 4, 6, 6, 4, 0.1)
    runs = [base, replace(base, steps_to_complete=8, oracle_steps=5), replace(base, steps_to_complete=None)]
    summary = summarise(runs, max_steps=9)
    assert summary["completed"] == 2
    assert summary["mean_steps_to_complete"] == 7.0
    assert summary["std_steps_to_complete"] == 1.0
    assert summary["mean_oracle_steps"] == pytest.approx(13 / 3)
    assert summary["ratio"] == pytest.approx(14 / 9)  # on the two that completed
    assert summary["max_steps"] == 9
    nobody = summarise([runs[2]], max_steps=9)
    assert nobody["ratio"] is nobody["mean_steps_to_complete"] is nobody["std_steps_to_complete"] is None


def test_out_of_the_oracles_reach_frontier_search_stands_in() -> None:
    maze = random_maze(90, sights=None, rng=np.random.default_rng(0))
    run = explore(maze, agent="frontier", seed=0)
    assert run.oracle_steps is None
    frontier = frontier_steps(maze, run.start)
    assert frontier is not None
    assert run.frontier_steps == frontier >= 89
    assert run.to_dict()["frontier_steps"] == run.frontier_steps
    summary = summarise([run], max_steps=1)
    assert summary["ratio"] is summary["mean_oracle_steps"] is None
    assert summary["mean_frontier_steps"] == run.frontier_steps


def test_the_oracle_of_a_grid() -> None:
    assert oracle_steps(MAZES["4x4"], (0, 0)) == 15
    assert frontier_steps(ONE, (0, 0)) == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"agent": "genius"}, "no agent is called 'genius'"),
        ({"max_steps": 0}, "max_steps is 0"),
        ({"seed": -1}, "seed is -1"),
        ({"agent": Wanderers(), "settings": Settings()}, "agent wanderer has settings of its own"),
    ],
)
def test_bad_walks_are_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        explore(ONE, **options)  # type: ignore[arg-type]


def test_a_sweep_of_no_runs_is_refused() -> None:
    with pytest.raises(CogmapError, match="runs is 0"):
        explore_many(ONE, runs=0)


class Priced(gym.Wrapper[Any, Any, Any, Any]):
    """A world whose moves cost two and a half each."""

    def step(self, action: Any) -> Any:
        observation, *rest = super().step(action)
        return {**observation, "cost": 2.5}, *rest


def test_what_moves_cost_is_in_the_rows() -> None:
    run, dear = explore(MazeEnv(MAZES["3x3"]), 0), explore(Priced(MazeEnv(MAZES["3x3"])), 0)
    assert run.cost is None
    assert "cost" not in run.to_dict()
    assert dear.cost is not None
    assert dear.to_dict()["cost"] == dear.cost == 2.5 * round(dear.cost / 2.5) > 0.0
    assert summarise([dear], max_steps=50)["mean_cost"] == dear.cost

"""Does the agent explore as well as it should? Small by default; `pytest -m study --study` for the full size."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from cogmap.experiments import ExploreRun, Parts, explore
from cogmap.worlds import MAZES, Maze, comb, hall, random_maze, rings, spiral

pytestmark = pytest.mark.study

# mean steps to complete over 20 starts (10 in the small form); the paper's agent needs far more in most
TARGETS = {
    "3x3": 9.5,
    "3x3_alias": 9.5,
    "4x4": 17.0,
    "4x4_alias": 17.0,
    "t_maze": 11.3,
    "t_maze_alias": 11.3,
    "donut": 13.2,
    "tolman": 27.0,
}


def drawn(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


UNKNOWN: dict[str, Maze] = {
    "comb": comb(5, 3),
    "comb_alias": comb(6, 2, sights=3, rng=drawn(1)),
    "deep_comb": comb(3, 7, sights=3, rng=drawn(2)),
    "spiral": spiral(7),
    "spiral_alias": spiral(6, sights=3, rng=drawn(3)),
    "rings": rings(3, 3),
    "rings_alias": rings(2, 5, sights=3, rng=drawn(4)),
    "hall_4x4": hall(4, 4, sights=3, rng=drawn(5)),
    "hall_5x5": hall(5, 5, sights=3, rng=drawn(6)),
    "hall_5x6": hall(5, 6, sights=3, rng=drawn(7)),
    "hall_3x10": hall(3, 10, sights=3, rng=drawn(8)),
    "random": random_maze(26, sights=3, rng=drawn(9)),
}


@cache
def explored(name: str, growth: str, seed: int) -> ExploreRun:
    """A walk that more than one test looks at."""
    return explore(MAZES[name], agent=Parts(growth=growth), seed=seed)


@pytest.mark.parametrize("name", TARGETS)
def test_mazes_of_the_paper_within_target(name: str, study: bool) -> None:
    runs = [explored(name, "predicted", seed) for seed in range(20 if study else 10)]
    steps = [run.steps_to_complete for run in runs]
    assert None not in steps
    assert np.mean(np.array(steps, dtype=float)) <= TARGETS[name]


@pytest.mark.parametrize("name", UNKNOWN)
def test_mazes_never_seen_before_within_a_quarter_of_the_oracle(name: str, study: bool) -> None:
    runs = [explore(UNKNOWN[name], seed=seed) for seed in range(20 if study else 3)]
    assert all(run.steps_to_complete is not None for run in runs)
    ratios = [(run.steps_to_complete or 0) / (run.oracle_steps or run.frontier_steps or 1) for run in runs]
    # where all rooms look like three others, a corridor is now and then taken for another that was walked before
    assert np.median(ratios) <= (1.25 if study and "alias" not in name else 1.5)


@pytest.mark.parametrize("name", ["3x3_alias", "4x4", "4x4_alias", "tolman"])
def test_predicted_growth_needs_the_fewest_steps(name: str, study: bool) -> None:
    def mean(growth: str) -> float:
        runs = [explored(name, growth, seed) for seed in range(20 if study else 4)]
        return float(np.mean([run.steps_to_complete or np.inf for run in runs]))

    predicted = mean("predicted")
    assert predicted < mean("observed")
    assert predicted < mean("static")

"""Nearest-frontier search over tiles."""

from __future__ import annotations

import numpy as np
import pytest
from cogmap.baselines import TileFrontier
from cogmap.worlds import MAZES, WorldError
from cogmap.worlds.minigrid import rooms_env

DONE = 6


@pytest.mark.parametrize("eager", [False, True])
def test_it_sees_everything_and_then_is_done(eager: bool) -> None:
    env, agent = rooms_env(MAZES["t_maze"]), TileFrontier(eager=eager)
    (seen, _), steps, action = env.reset(seed=3), 0, 0
    while action != DONE and steps < 400:
        action, steps = agent.step(seen), steps + 1
        seen, *_ = env.step(action)
    assert action == DONE
    assert env.tally.share > 0.97
    assert set(env.tally.entered) == set(env.maze.rooms)


def test_choosing_anew_at_every_step_is_quicker() -> None:
    needed: dict[bool, int] = {}
    for eager in (False, True):
        env, agent = rooms_env("3x3"), TileFrontier(eager=eager)
        seen, _ = env.reset(seed=0)
        while 9 not in env.tally.shares:
            seen, *_ = env.step(agent.step(seen))
        needed[eager] = env.tally.shares[9]
    assert needed[True] < needed[False]


def test_it_wants_symbols() -> None:
    with pytest.raises(WorldError, match="is no symbolic view"):
        TileFrontier().step({"image": np.zeros((56, 56, 3))})
    with pytest.raises(WorldError, match="is no symbolic view"):
        TileFrontier().step({})

"""Speed buys nothing with exactness: where nothing may be dropped, all is as the plain evaluation has it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.inference import FilterOptions
from cogmap.planning import TERMS, Policies, evaluate_plain, local_model
from cogmap.worlds import MazeEnv, labyrinth, load_world
from parts import agent_with
from walks import walk

MANY = 1_000_000


def assert_plain(agent: Agent) -> None:
    """G of every policy, and the tables that it comes from, worked out again from nothing."""
    plan, options = agent.plan, agent.settings
    plain = evaluate_plain(plan.model, Policies(plan.policies))
    for term in TERMS:
        found, wanted = plan.expected_free_energy[term.name], plain[term.name]
        np.testing.assert_allclose(found, wanted, atol=1e-9, err_msg=term.name)
    places, q = agent.belief.message.by_place
    fresh = local_model(
        agent.map,
        places,
        q,
        open_=agent.trace[-1].open,
        look_ahead=options.look_ahead,
        discount=options.discount,
        starts=options.starts,
        beyond=plan.generator.beyond,
    )
    for name in ("places", "belief", "A", "successor", "blocked", "entered", "position"):
        np.testing.assert_array_equal(getattr(plan.model, name), getattr(fresh, name), err_msg=name)
    for name, table in fresh.information.items():
        np.testing.assert_array_equal(plan.model.information[name], table, err_msg=name)
    np.testing.assert_array_equal(plan.model.B.dense, fresh.B.dense)


@pytest.mark.parametrize("policies", ["map_guided", "self_avoiding"])
@pytest.mark.parametrize("name", ["3x3_alias", "t_maze"])
def test_with_nothing_dropped_all_is_plain(name: str, policies: str) -> None:
    options: dict[str, Any] = {"beam": MANY, "starts": MANY, "filter": FilterOptions(support=0.0)}
    world = load_world(name)
    agent = agent_with(world.motions, look_ahead=3, policies=policies, explorer=False, **options, seed=1)
    entered = 0
    for step, _ in enumerate(walk(world, agent, 26, seed=1, displace_every=9)):
        if len(agent.map.visited_places) == entered:  # else it has committed itself to a new place
            assert agent.belief.dropped <= 1e-12
        entered = len(agent.map.visited_places)
        assert (agent.plan.cut, agent.plan.dropped) == (0, 0.0)
        if step % 5 == 1 or not agent.certain:
            assert_plain(agent)


def test_what_is_dropped_is_told() -> None:
    world = MazeEnv(labyrinth(30, sights=2, rng=np.random.default_rng(0)))
    agent = agent_with(world.motions, look_ahead=3, beam=1, starts=1)
    told: dict[str, list[float]] = {"support": [], "beam": [], "starts": []}
    for _ in walk(world, agent, 60, seed=0, displace_every=20):
        told["support"].append(agent.belief.dropped)
        told["beam"].append(agent.plan.cut)
        told["starts"].append(agent.plan.dropped)
        places, q = agent.belief.message.by_place
        assert agent.plan.dropped == pytest.approx(1.0 - q.max())
        assert len(places) == 1 or agent.plan.dropped > 0.0
    assert all(max(values) > 0.0 for values in told.values())

"""Explanations agree with the plan, to the last digit."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, Features, Sight, Ways
from cogmap.planning import POLICIES, TIE, Outward
from cogmap.views import Explanation, explain
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from parts import agent_with
from walks import GRID, walk, walked

from cogmap import UNSEEN


def assert_agrees(agent: Agent, told: Explanation) -> None:
    plan, terms = agent.plan, agent.plan.expected_free_energy
    assert told.step == agent.steps - 1
    assert told.considered == len(plan.policies)
    assert (told.certainty, told.doubt) == (agent.belief.certainty, agent.belief.doubt)
    assert told.chosen.index == plan.chosen
    assert list(told.chosen.actions) == plan.names
    assert [place.probability for place in told.belief] == list(agent.belief.places.values())[: len(told.belief)]
    assert [policy.terms["G"] for policy in told.best] == sorted(terms.G.tolist())[: len(told.best)]
    for policy in (told.chosen, *told.best, *(lost.policy for lost in told.rejected)):
        assert policy.terms == terms.row(policy.index)
        assert policy.probability == plan.probability[policy.index]
        assert sum(policy.contributions.values()) == pytest.approx(policy.terms["G"], abs=1e-9)
    for first, probability in zip(told.actions, plan.action_probability, strict=True):
        assert first.probability == pytest.approx(probability, abs=1e-12)
    assert sum(first.policies for first in told.actions) == told.considered
    for lost in told.rejected:
        assert lost.policy.index != plan.chosen
        assert lost.difference == pytest.approx(lost.policy.terms["G"] - told.chosen.terms["G"], abs=1e-9)
        if lost.term is not None:
            assert lost.worse[lost.term] == max(lost.worse.values()) > 0.0
            assert lost.difference > 0.0
        else:
            assert lost.difference <= (Outward().slack if lost.verdict == "outward" else TIE) + 1e-12


@settings(max_examples=12, deadline=None)
@given(
    st.sampled_from(["3x3_alias", "4x4", "t_maze_alias"]),
    st.integers(1, 14),
    st.sampled_from(sorted(POLICIES)),
    st.sampled_from(["outward", "best", "sampled"]),
    st.integers(1, 7),
)
def test_numbers_are_those_of_the_plan(name: str, steps: int, policies: str, choice: str, most: int) -> None:
    agent = walked(load_world(name), steps, seed=steps, policies=policies, choice=choice)
    told = explain(agent, most=most)
    assert_agrees(agent, told)
    assert json.loads(json.dumps(told.to_dict()))["chosen"]["terms"] == told.chosen.terms
    assert str(told) == told.text
    formula = "G = way there - way back" if told.generator == "options" else "G = collision - I state"
    for part in ("it weighed", formula, "first actions: up", "preferences: none"):
        assert part in told.text


def test_ties_are_told_and_the_lot() -> None:
    agent = walked(load_world("3x3"), 30)  # it knows everything: all ways are as good
    told, G = explain(agent), agent.plan.expected_free_energy.G
    assert told.equals == (G - G.min() <= TIE).sum() > 1
    assert f"by lot among {told.equals} policies" in told.text
    assert {lost.verdict for lost in told.rejected} == {"lot"}
    assert "as good; the lot fell on another" in told.text


def test_at_a_goal_the_policy_that_moves_least_wins() -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=0)
    for k, _ in enumerate(walk(world, agent, 40)):
        if k == 25:
            agent.prefer({4: 3.0}, places={0: 0.0})
    told = explain(agent)
    assert_agrees(agent, told)
    assert told.sights == ((4, 3.0),)
    assert "preferences, in nats: sight 4 +3, place 0 +0; goal weight 1" in told.text
    assert {"utility"} == {lost.term for lost in told.rejected if lost.term}


def test_what_comes_later_is_told_from_what_is_less() -> None:
    """Of two ways to the same places the one that gets there later loses by the discount alone."""
    world = load_world("t_maze")
    verdicts: set[str] = set()
    agent = agent_with(world.motions, look_ahead=4, discount=0.5, policies="exhaustive")
    for _ in walk(world, agent, 8, seed=4):
        told = explain(agent, most=60)
        verdicts |= {lost.verdict for lost in told.rejected}
        for lost in told.rejected:
            if lost.verdict == "later":
                assert lost.term not in (None, "collision")
    assert {"later", "less"} <= verdicts
    undiscounted = walked(load_world("t_maze"), 4, discount=1.0)
    assert all(lost.verdict != "later" for lost in explain(undiscounted, most=50).rejected)


def test_wishes_are_those_of_the_choice() -> None:
    agent = walked(load_world("3x3"), 5)
    agent.prefer({"cheese": 2.0})
    assert explain(agent).sights == ()
    agent.step({"sight": 0, "open": [False, True, False, True, True]})
    assert explain(agent).sights == (("cheese", 2.0),)


def test_html_is_escaped() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=2), seed=0)
    agent.prefer({"<b>": 1.0})
    agent.step({"sight": "<script>", "open": [True] * 5})
    page = explain(agent)._repr_html_()
    assert "&lt;script&gt;" in page
    assert "<script>" not in page
    assert "<b>" not in page


def test_an_agent_that_planned_nothing() -> None:
    with pytest.raises(CogmapError, match="planned nothing yet"):
        explain(Agent(GRID))
    with pytest.raises(CogmapError, match="most is 0"):
        explain(walked(load_world("3x3"), 1), most=0)


# -- of loaded agents ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{}, {"choice": "sampled"}, {"policies": "exhaustive"}, {"forgetting": 0.1}])
def test_a_loaded_agent_explains_its_last_choice_alike(options: dict[str, Any], tmp_path: Any) -> None:
    world, file = load_world("4x4_alias"), tmp_path / "m.npz"
    agent = agent_with(world.motions, look_ahead=3, **options, seed=2)
    agent.prefer({3: 0.5, (1, "never met"): 0.1})
    for k, _ in enumerate(walk(world, agent, 12, seed=2, displace_every=5)):
        if k % 3 == 2:
            told = explain(agent)
            agent.prefer({4: 0.25 * k})  # of the next choice, not the last
            agent.save(file)
            loaded = Agent.load(file)
            state = loaded.state()[0]
            assert explain(loaded) == told
            assert loaded.state()[0] == state, "explaining must not change the agent, nor its generator"
            np.testing.assert_array_equal(loaded.plan.policies, agent.plan.policies)
            np.testing.assert_array_equal(loaded.plan.probability, agent.plan.probability)
            assert loaded.plan.action == agent.plan.action


def test_files_without_the_choice_say_so() -> None:
    header, arrays = walked(load_world("3x3"), 3).state()
    old = {**header, "state": {**header["state"], "choice": None}}
    with pytest.raises(CogmapError, match="an earlier version wrote it"):
        explain(Agent.from_state(old, arrays))
    choice = {**header["state"]["choice"], "policy": {"tuple": [0] * 99}}
    strange = {**header, "state": {**header["state"], "choice": choice}}
    with pytest.raises(CogmapError, match="does not come out the same"):
        explain(Agent.from_state(strange, arrays))


# -- which sensor spoke for what -------------------------------------------------------------------------------


def test_each_sensor_says_what_it_spoke_for_and_what_was_expected_of_it() -> None:
    agent = Agent(GRID, sensors=[Sight(), Sight("smell"), Ways()], seed=0)
    doors = [False, False, False, True, True]
    for _ in range(3):
        agent.step({"sight": "hall", "smell": "tea", "open": doors, "taken": "stay"})
    agent.prefer(sensors={"smell": {"tea": 2.0}})
    agent.step({"sight": "hall", "smell": UNSEEN, "open": doors, "taken": "stay"})
    told = explain(agent)
    sight, smell, ways = told.spoken
    assert (sight.sensor, sight.seen, sight.sensed, sight.expected) == ("sight", True, "hall", "hall")
    assert sight.nats == pytest.approx(np.log(len(agent.map.sights) + 1), abs=1e-3)  # beyond any label alike
    assert (smell.seen, smell.sensed, smell.expected, smell.nats) == (False, None, "tea", 0.0)
    assert ways.sensed == ways.expected == tuple(doors)
    assert ways.nats == pytest.approx(4 * np.log(2), abs=0.1)
    assert "sight hall (expected hall) spoke for it by 0.693 nats; smell saw nothing; open" in told.text
    assert "smell tea +2" in told.text
    values = json.loads(json.dumps(told.to_dict()))
    assert values["spoken"][1] == {"sensor": "smell", "seen": False, "sensed": None, "expected": "tea", "nats": 0.0}
    assert values["sensors"] == [["smell", "tea", 2.0]]
    agent.step({"sight": {"hall": 0.1, "room": 0.9}, "smell": "tea", "open": UNSEEN, "taken": "stay"})
    against = explain(agent).spoken[0]
    assert against.sensed == (("room", 1.0), ("hall", pytest.approx(1 / 9)))
    assert against.nats < 0.0
    assert "against it" in str(against)


def test_it_says_what_each_sensor_was_expected_to_show_before_it_was_taught() -> None:
    rng = np.random.default_rng(0)
    agent = Agent(GRID, sensors=[Sight(), Sight("smell"), Features("view", size=4), Ways()], seed=0)
    view, there, back = rng.normal(size=4), [False, False, False, True, True], [False, False, True, False, True]
    unknown = {"sight": None, "smell": None, "view": None, "open": None}
    agent.step({"sight": "hall", "smell": {"tea": 0.8, "smoke": 0.2}, "view": view, "open": there})
    assert agent.expected == unknown
    assert [voice.seen for voice in explain(agent).spoken] == [True] * 4
    agent.step({"sight": "room", "smell": "smoke", "view": UNSEEN, "open": back, "taken": "right"})
    assert agent.expected == {**unknown, "open": (None, None, True, None, True)}  # the door that it came through
    agent.step({"sight": UNSEEN, "smell": "smoke", "view": view, "open": there, "taken": "left"})
    known = {"sight": "hall", "smell": "tea", "view": 0, "open": (False, False, False, True, True)}
    assert agent.expected == known
    voices = {voice.sensor: voice for voice in explain(agent).spoken}
    assert {name: voice.expected for name, voice in voices.items()} == known
    assert (voices["sight"].seen, str(voices["sight"])) == (False, "sight saw nothing")
    assert voices["smell"].nats < 0.0 < voices["open"].nats
    assert "smell smoke (expected tea) spoke against it by" in explain(agent).text

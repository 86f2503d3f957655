"""Settings: every knob refuses what makes no sense, and survives the way through JSON."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference import FilterOptions
from cogmap.model import TEXT_RATES, CogmapError, Lattice, PredictedGrowth, Priors, Rates, Sight, StaticGrowth
from cogmap.planning import Exhaustive, LShaped, MapGuided, Planner, SelfAvoiding
from cogmap.worlds import load_world
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st
from walks import GRID

NAN, INF = float("nan"), float("inf")

REFUSED: dict[str, list[Any]] = {
    "look_ahead": [0, -1, NAN, 10**5, 10**30],
    "starts": [0, -1, 10**30],
    "window": [0, -1, 10**30],
    "precision": [-1.0, NAN, INF, 10**30, 1e300, True, "16", np.array([16.0])],
    "information_weight": [1e300, 10**400],
    "discount": [True],
    "collision_cost": [-0.1, NAN, INF],
    "goal_weight": [-1.0, NAN, INF],
    "forgetting": [-0.1, 1.1, NAN],
    "certainty": [-0.1, 1.5, NAN],
    "engine": ["torch", None],
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in REFUSED.items() for value in values])
def test_values_out_of_range_are_refused(name: str, value: Any) -> None:
    with pytest.raises(CogmapError, match=f"^settings: {name} is .*; (use|choose)") as raised:
        Settings(**{name: value})
    assert "\n" not in str(raised.value)


WRONG_KIND: list[dict[str, Any]] = [
    {"look_ahead": "6"},
    {"look_ahead": None},
    {"look_ahead": 1.5},
    {"window": 2.5},
    {"precision": "high"},
    {"certainty": None},
    {"discount": -1.0},
    {"discount": 0.0},
    {"discount": 1.5},
    {"discount": NAN},
    {"rates": 3},
    {"look_ahead": True},
    {"window": False},
    {"filter": None},
    {"priors": None},
]


@pytest.mark.parametrize("wrong", WRONG_KIND, ids=str)
def test_values_of_the_wrong_kind_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(CogmapError, match=r"^settings: "):
        Settings(**wrong)


RECORDS: list[tuple[type[Any], dict[str, Any]]] = [
    (Rates, {"possible": (NAN, 1.0)}),
    (Rates, {"possible": 3}),
    (Rates, {"possible": (3.0,)}),
    (Rates, {"impossible": (1.0, 2.0, 3.0)}),
    (Rates, {"imagined": ("a", "b")}),
    (Rates, {"imagined": (True, 1.0)}),
    (Rates, {"likelihood": -1.0}),
    (Rates, {"likelihood": INF}),
    (Rates, {"ceiling": 0.0}),
    (Rates, {"ceiling": 10**30}),
    (Rates, {"possible": (1e300, 1.0)}),
    (Priors, {"position": 10**400}),
    (FilterOptions, {"slip": True}),
    (FilterOptions, {"displacement": 2.0}),
    (FilterOptions, {"displacement": -1.0}),
    (FilterOptions, {"slip": NAN}),
    (FilterOptions, {"support": "a"}),
    (Priors, {"sight": 0.0}),
    (Priors, {"sight": -1.0}),
    (Priors, {"transition": None}),
    (Priors, {"position": INF}),
    (Priors, {"door_floor": 0.7}),
]


@pytest.mark.parametrize(("kind", "wrong"), RECORDS, ids=str)
def test_records_that_cannot_work_are_refused_when_they_are_made(kind: type[Any], wrong: dict[str, Any]) -> None:
    with pytest.raises(CogmapError, match=r"^settings: (rates|filter|priors)\.\w+ is .*; use") as raised:
        kind(**wrong)
    assert "\n" not in str(raised.value)


def test_unknown_names_are_refused() -> None:
    with pytest.raises(CogmapError, match="settings: unknown gamma, horizon; known are the fields"):
        Settings.from_dict({"horizon": 3, "gamma": 16, "look_ahead": 2})


BAD_DICTS: list[Any] = [{"rates": {"fast": 1}}, {"filter": {"x": 1}}, {"priors": {"y": 1}}, {1: 2}, None, 5]


@pytest.mark.parametrize("values", BAD_DICTS, ids=str)
def test_unknown_nested_names_are_refused(values: Any) -> None:
    with pytest.raises(CogmapError, match=r"^settings: "):
        Settings.from_dict(values)


some = st.builds(
    Settings,
    look_ahead=st.integers(1, 9),
    precision=st.floats(0.0, 99.0),
    rates=st.sampled_from([Rates(), TEXT_RATES, Rates(likelihood=0.5)]),
    forgetting=st.floats(0.0, 1.0),
    certainty=st.floats(0.0, 1.0),
    filter=st.builds(FilterOptions, displacement=st.floats(1e-9, 0.5)),
    priors=st.builds(Priors, sight=st.floats(1e-12, 1.0)),
    discount=st.floats(0.1, 1.0),
)


@given(some)
@budget(max_examples=50, deadline=None)
def test_settings_go_through_json_and_back(settings: Settings) -> None:
    values = settings.to_dict()
    assert Settings.from_dict(values) == settings
    assert Settings.from_dict(json.loads(json.dumps(values))) == settings
    assert Settings.from_dict({}) == Settings()


def test_settings_never_change() -> None:
    settings = Settings()
    with pytest.raises(FrozenInstanceError):
        settings.window = 3  # type: ignore[misc]
    settings.to_dict()["rates"]["possible"] = (1, 1)
    assert settings == Settings()
    with pytest.raises(TypeError):
        Settings(6)  # type: ignore[misc]


def test_settings_of_an_agent_cannot_be_set() -> None:
    agent = Agent(GRID)
    with pytest.raises(AttributeError):
        agent.settings = Settings(window=3)  # type: ignore[misc]


def test_the_paper_is_the_default() -> None:
    settings = Settings()
    assert (settings.certainty, settings.precision) == (0.7, 16.0)
    agent = Agent(GRID)
    assert agent.parts["growth"] == {"kind": "predicted", "options": {}}
    assert agent.parts["planner"]["policies"] == {"kind": "map_guided", "options": {"beam": 64}}
    assert settings.rates == Rates((7, 5), (-7, -5), (5, 3))


@pytest.mark.parametrize(
    "parts",
    [
        {"growth": "predicted"},
        {"growth": PredictedGrowth},
        {"pose": "lattice"},
        {"planner": MapGuided()},
        {"sensors": ["sight"]},
        {"settings": {"look_ahead": 3}},
    ],
    ids=str,
)
def test_parts_are_objects(parts: dict[str, Any]) -> None:
    (name,) = parts
    with pytest.raises(CogmapError, match=rf"agent: (a sensor|\w+) is .*; give an object, such as {name}="):
        Agent(GRID, **parts)


def test_parts_belong_to_one_agent() -> None:
    for parts in ({"sensors": [Sight()]}, {"pose": Lattice()}):
        Agent(GRID, **parts)  # type: ignore[arg-type]
        with pytest.raises(CogmapError, match="belongs to another agent; make one for each"):
            Agent(GRID, **parts)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["", "s", "o", "moved", "two words", "smell2", 3, None])
def test_names_of_sensors_are_words(name: Any) -> None:
    with pytest.raises(CogmapError, match="sensor: cannot be called"):
        Sight(name)


def test_two_sensors_of_one_name_are_refused() -> None:
    with pytest.raises(CogmapError, match="two have the same name"):
        Agent(GRID, sensors=[Sight("smell"), Sight("smell")])


@pytest.mark.parametrize("beam", [0, True, 1.5, 10**30])
def test_beams_that_cannot_be(beam: Any) -> None:
    with pytest.raises(CogmapError, match="give a whole number from 1 to 2,000,000"):
        MapGuided(beam=beam)


@pytest.mark.parametrize("places", [0, True, 10**9, 10**30])
def test_static_growth_of_too_many_places(places: Any) -> None:
    with pytest.raises(CogmapError, match="give the size of the world"):
        StaticGrowth(places)


@pytest.mark.parametrize(
    ("policies", "look_ahead"), [(Exhaustive(), 11), (Exhaustive(), 1000), (SelfAvoiding(), 14), (LShaped(), 800)]
)
def test_too_many_policies_are_refused_before_any_is_made(policies: Any, look_ahead: int) -> None:
    with pytest.raises(CogmapError, match=r"more than 2,000,000 policies at look-ahead"):
        Agent(GRID, planner=Planner(policies=policies), settings=Settings(look_ahead=look_ahead))


@pytest.mark.parametrize("value", [INF, NAN, 1e300, 10**400, "1", None, True])
def test_preferences_are_numbers(value: Any) -> None:
    with pytest.raises(CogmapError, match="is not a finite number; give a log preference"):
        Agent(GRID).prefer({"goal": value})


@pytest.mark.parametrize("seed", [0, 1, None, 2**63, np.int64(4)])
def test_seeds(seed: Any) -> None:
    assert Agent(GRID, seed=seed).steps == 0


@pytest.mark.parametrize("seed", [-1, "a", 1.5])
def test_a_bad_seed_is_refused(seed: Any) -> None:
    with pytest.raises(CogmapError, match="seed is"):
        Agent({"left": (-1,), "right": (1,), "stay": (0,)}, seed=seed)


def test_the_papers_agent() -> None:
    settings, planner = Settings.paper(look_ahead=13), Planner.paper()
    assert (settings.precision, settings.discount, settings.look_ahead) == (16.0, 1.0, 13)
    assert settings.hypotheses is None
    assert (settings.rates.possible, settings.rates.impossible, settings.rates.imagined) == ((7, 5), (-7, -5), (5, 3))
    assert Settings.from_dict(json.loads(json.dumps(settings.to_dict()))) == settings
    world = load_world("3x3_alias")
    observation, _ = world.reset(seed=0)
    agent = Agent(world.motions, settings=Settings.paper(), planner=planner, seed=0)
    for _ in range(30):
        observation, *_ = world.step(agent.step(observation))
    assert len(agent.plan.policies) == 4 * 6**2 + 1
    assert agent.plan.choice.name == "sampled"
    assert agent.map.visited.sum() == len(agent.map.places) == 9
    with pytest.raises(CogmapError, match="discount is 2"):
        Settings.paper(discount=2)

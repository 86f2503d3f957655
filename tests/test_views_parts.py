"""Agents of other parts: terms, sensors and poses show by themselves in plots, words, recordings and on the page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import NoPose, Sight, Ways
from cogmap.planning import TERMS, Planner, Rollout, Step, Term
from cogmap.views import (
    GrowthFrames,
    MapPicture,
    Recorder,
    Recording,
    explain,
    plot_belief_map,
    plot_expected_free_energy,
    plot_factor_graph,
    plot_map,
    plot_policies,
    plot_terms,
    policy_paths,
    replay_html,
)
from cogmap.worlds import load_world
from matplotlib.colors import to_rgb
from matplotlib.patches import Circle
from pages import Page
from pictures import assert_readable, rendered

Adapt = Callable[[dict[str, Any], Any], dict[str, Any]]


class Effort(Term):
    """What every step costs that is none of rest."""

    name = "effort"
    label = "effort"
    sign = 1.0
    kind = "cost"
    colour = "#117733"
    equation = "0.125 (a_t != stay)"
    meaning = "effort of moving"

    def gain(self, rollout: Rollout) -> Any:
        moved = np.where(rollout.staying, 0.0, 0.125)
        moved[: len(moved) - sum(end - begin for begin, end in rollout.levels)] = 0.0
        return moved

    def plain(self, step: Step) -> float:
        return 0.125 * (step.action != step.model.motions.stay)


def walked(steps: int, adapt: Adapt = lambda seen, _: seen, **parts: Any) -> tuple[Agent, Recording, GrowthFrames]:
    world = load_world("3x3_alias")
    observation, _ = world.reset(seed=0)
    agent, frames = Agent(world.motions, settings=Settings(look_ahead=3), seed=0, **parts), GrowthFrames()
    recorder = Recorder(world.chart)
    for _ in range(steps):
        action = agent.step(adapt(observation, world))
        recorder.add(agent, place=world.place)
        frames.add(agent)
        observation, *_ = world.step(action)
    return agent, recorder.recording(), frames


def data_of(recording: Recording) -> dict[str, Any]:
    """What the page has of a recording."""
    text = replay_html(recording)
    assert Page(text).tags
    return json.loads(text.split('id="recording">')[1].split("</script>")[0])


def two_sensors(seen: dict[str, Any], world: Any) -> dict[str, Any]:
    return {"colour": seen["sight"], "smell": f"smell {sum(world.place) % 2}", "open": seen["open"]}


def test_a_term_shows_by_itself(tmp_path: Path) -> None:
    agent, recording, _ = walked(4, planner=Planner(terms=(*TERMS, Effort())))
    assert recording.data["terms"][-1] == {
        "name": "effort",
        "label": "effort",
        "sign": 1.0,
        "kind": "cost",
        "colour": "#117733",
        "meaning": "effort of moving",
    }
    for frame in recording.frames:
        signs = [term["sign"] for term in recording.data["terms"]]
        np.testing.assert_allclose(np.array(frame["plan"]["terms"]) @ signs, frame["plan"]["G"], atol=1e-3)
    ax = plot_terms(agent.plan)
    (bars,) = (part for part in ax.containers if part.get_label() == "effort")
    assert {bar.get_facecolor()[:3] for bar in bars} == {to_rgb("#117733")}  # type: ignore[attr-defined]
    assert "effort" in [line.get_label() for line in plot_expected_free_energy(agent.trace).lines]
    assert_readable(ax)
    told = explain(agent)
    assert "G = collision + effort - I state" in told.text
    assert "effort" in told.chosen.terms
    assert sum(told.chosen.contributions.values()) == pytest.approx(told.chosen.terms["G"])
    recording.save(tmp_path / "walk.json")
    assert data_of(Recording.load(tmp_path / "walk.json"))["terms"][-1]["label"] == "effort"


def test_several_sensors_show_by_themselves(tmp_path: Path) -> None:
    agent, recording, _ = walked(6, two_sensors, sensors=[Sight("colour"), Sight("smell"), Ways()])
    assert [set(frame["seen"]) for frame in recording.frames] == [{"colour", "smell"}] * 6
    assert recording.frames[0]["seen"] == dict(agent.trace[0].sensed)
    names = {name.rstrip("0123456789") for frame in recording.frames for name, *_ in frame["window"]["variables"]}
    assert {"colour", "smell", "c", "s", "p"} <= names
    (first, *_) = explain(agent).belief
    assert str(first).endswith(f"where colour is {first.sight}, smell is {first.senses['smell']}")
    assert explain(agent).to_dict()["belief"][0]["senses"] == first.senses
    ax = plot_factor_graph(agent.graph, last=3)
    assert_readable(ax)
    assert {"colour5", "smell5"} <= {text.get_text() for text in ax.texts}
    recording.save(tmp_path / "walk.json")
    page = data_of(Recording.load(tmp_path / "walk.json"))
    seen = [{sensor: page["looks"][look][0] for sensor, look in frame["seen"].items()} for frame in page["frames"]]
    assert seen == [{sensor: str(label) for sensor, label in record.sensed.items()} for record in agent.trace]


def test_without_a_sensor_of_ways_nothing_is_said_of_them(tmp_path: Path) -> None:
    _, recording, _ = walked(4, lambda seen, _: {"sight": seen["sight"]}, sensors=[Sight()])
    assert all("open" not in frame for frame in recording.frames)
    recording.save(tmp_path / "walk.json")
    assert "open" not in data_of(Recording.load(tmp_path / "walk.json"))["frames"][0]


def test_a_map_without_positions_is_laid_out() -> None:
    agent, recording, frames = walked(8, pose=NoPose())
    picture = MapPicture.of(agent.map).drawn()
    assert len(picture.cells) == len(agent.map.places)
    assert not picture.walls  # a wall has no direction there
    points = np.array([*picture.cells.values()])
    apart = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)) + 9.0 * np.eye(len(points))
    assert apart.min() >= 0.9
    for ax in (
        plot_map(agent.map),
        plot_belief_map(agent.belief, agent.map),
        plot_policies(policy_paths(agent.plan, agent.map), ax=plot_map(agent.map)),
        plot_factor_graph(agent.graph),
        frames.plot(),
    ):
        assert_readable(ax)
        assert not [text for text in ax.texts if "without a position" in text.get_text()]
    one, other = ([p.get_center() for p in frames.plot(i).patches if isinstance(p, Circle)] for i in (2, -1))
    assert one[:-1] == other[: len(one) - 1]  # places stay where they are from frame to frame
    page = data_of(recording)
    assert len(page["layout"]) == len(agent.map.places)
    rendered(plot_map(agent.map))

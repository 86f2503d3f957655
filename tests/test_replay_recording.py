"""Recordings: what changed at each step rebuilds what was; files that are no recordings are refused."""

from __future__ import annotations

import copy
import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from charts import row
from cogmap.agent import Agent, Settings
from cogmap.inference import infer
from cogmap.model import CogmapError, Sight, Ways, decode, encode
from cogmap.views import Recorder, Recording
from cogmap.worlds import load_world
from recordings import close_elsewhere, eventful_walk, kidnaps, outline, probabilities, recorded, witnessed_walk
from walks import GRID


@pytest.fixture(scope="module")
def recording() -> Recording:
    return eventful_walk()


def test_the_map_is_rebuilt_at_every_step() -> None:
    kept, truths, _ = witnessed_walk()
    assert any(frame["revised"] for frame in kept.frames)
    assert any(frame.get("closed_rooms") for frame in kept.frames)
    assert any(not frame["certain"] for frame in kept.frames)
    for truth, picture in zip(truths, kept.maps(), strict=True):
        found = picture.to_networkx()
        kept_, true = outline(found), outline(truth)
        for place, facts in truth.nodes(data=True):
            if len(facts["sights"]) > 1 and np.ptp(sorted(facts["sights"].values())[-2:]) < 1e-6:  # two are as good
                kept_["nodes"][place] = true["nodes"][place]
        assert kept_ == true
        p, q = probabilities(found), probabilities(truth)
        assert max(abs(p[edge] - q[edge]) for edge in q) <= 6e-4


@pytest.mark.parametrize(
    "settings", [{"growth": "observed"}, {"growth": "static", "places": 40}, {"forgetting": 0.2}], ids=str
)
def test_the_map_is_rebuilt_however_it_grows_and_fades(settings: dict[str, Any]) -> None:
    truths: list[Any] = []
    world = load_world("tolman")
    events = {**kidnaps(12, 48, (6, 2), (0, 2)), 30: lambda world, _: close_elsewhere(world, (3, 2))}
    kept = recorded(world, 50, events=events, after=lambda agent: truths.append(agent.map.to_networkx()), **settings)
    for truth, picture in zip(truths, kept.maps(), strict=True):
        found = picture.to_networkx()
        assert outline(found) == outline(truth)
        p, q = probabilities(found), probabilities(truth)
        assert max(abs(p[edge] - q[edge]) for edge in q) <= 1e-3


def test_little_is_written_where_nothing_is_new(recording: Recording) -> None:
    ways = len(json.dumps([frame["map"] for frame in recording.frames]))
    whole = len(json.dumps(recording.frames[-1]["map"])) + len(recording.frames) * len(
        recording.data["motions"]["names"]
    )
    assert recorded(load_world("3x3"), 40).frames[-1]["map"] == {}
    assert ways < len(recording) * max(whole, 2500)


def test_the_window_is_rebuilt_at_every_step() -> None:
    kept, _, graphs = witnessed_walk()
    scopes: dict[str, tuple[str, str, tuple[str, ...]]] = {}
    times: dict[str, int] = {}
    tops: dict[str, tuple[Any, float]] = {}
    for frame, graph in zip(kept.frames[: len(graphs)], graphs, strict=True):
        window = frame["window"]
        times |= {name: time for name, time, *_ in window["variables"]}
        scopes |= {
            f"{name}({', '.join(scope)})": (name, kind, tuple(scope)) for name, kind, *scope in window["factors"]
        }
        tops |= {name: (decode(top), p) for name, top, p in window["tops"]}
        when = {label: max(times[name] for name in scope) for label, (_, _, scope) in scopes.items()}
        since = window["since"]
        present = {
            label
            for label, (_, kind, _) in scopes.items()
            if (when[label] == since if kind == "prior" else when[label] > since)
        }
        assert present == {factor.label for factor in graph.factors}
        assert {name for label in present for name in scopes[label][2]} == {v.name for v in graph.variables}
        posterior = infer(graph)
        for variable in graph.variables:
            if not variable.observed:
                q = posterior.marginal(variable.name)
                top, p = tops[variable.name]
                assert abs(p - q.max()) <= 1e-4, variable.name
                assert q[variable.index(top)] >= q.max() - 1e-4, variable.name
    assert any(p < 0.99 for _, p in tops.values())


def test_belief_and_plan_are_those_of_the_agent() -> None:
    agents: list[Any] = []
    kept = recorded(load_world("3x3_alias"), 12, after=lambda agent: agents.append((agent.belief, agent.plan)))
    for frame, (belief, plan) in zip(kept.frames, agents, strict=True):
        told, best = frame["plan"], frame["plan"]["chosen"]
        assert dict(frame["belief"]) == pytest.approx(dict(list(belief.places.items())[:8]), abs=1e-4)
        assert sum(q for _, q in frame["belief"]) + frame["rest"] == pytest.approx(1.0, abs=1e-3)
        assert frame["free_energy"] == pytest.approx(belief.free_energy, abs=1e-4)
        assert told["policies"][best] == plan.policy.tolist()
        assert told["action"] == plan.action == told["policies"][best][0]
        assert told["P"] == sorted(told["P"], reverse=True)
        assert told["P"][best] == pytest.approx(plan.probability[plan.chosen], abs=1e-6)
        terms = dict(zip([term["name"] for term in kept.data["terms"]], told["terms"][best], strict=True))
        own = {k: v for k, v in plan.expected_free_energy.row(plan.chosen).items() if k != "G"}
        assert terms == pytest.approx(dict.fromkeys(terms, 0.0) | own, abs=1e-4)  # 0 of terms of other plans
        signs = [term["sign"] for term in kept.data["terms"]]
        np.testing.assert_allclose(np.array(told["terms"]) @ signs, told["G"], atol=1e-3)
        assert {path[0] for path in told["paths"]} == {belief.place}


def test_imagined_paths_follow_the_map() -> None:
    kept = recorded(load_world("4x4"), 30)
    plan, picture = kept.frames[-1]["plan"], list(kept.maps())[-1]
    displacements = kept.data["motions"]["displacements"]
    for policy, path in zip(plan["policies"], plan["paths"], strict=True):
        for action, before, after in zip(policy, path, path[1:], strict=False):
            at = picture.places[before][0]
            assert at is not None
            ahead = tuple(x + dx for x, dx in zip(at, displacements[action], strict=True))
            assert picture.places[after][0] in (ahead, at)


@pytest.mark.parametrize("name", ["walk.json", "walk.json.gz"])
def test_files_come_back_as_they_were(recording: Recording, tmp_path: Path, name: str) -> None:
    recording.save(tmp_path / name)
    assert Recording.load(tmp_path / name).data == json.loads(json.dumps(recording.data))
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_packed_files_are_small(recording: Recording, tmp_path: Path) -> None:
    recording.save(tmp_path / "a.json")
    recording.save(tmp_path / "a.json.gz")
    assert (tmp_path / "a.json.gz").stat().st_size * 4 < (tmp_path / "a.json").stat().st_size


def test_any_label_that_json_can_hold() -> None:
    labels = ["word", "</script>", 7, 2.5, None, True, ("a", ("b", 1)), "\u2028"]
    agent, recorder = (
        Agent(GRID, sensors=[Sight(labels=labels), Ways()], settings=Settings(look_ahead=2), seed=0),
        Recorder(row(*labels)),
    )
    for label in labels:
        agent.step({"sight": label, "open": [False, False, False, True, True]})
        recorder.add(agent)
    assert recorder.recording().sights[:2] == labels[:2]
    assert [decode(encode(label)) for label in labels] == labels


def test_the_agent_walks_as_if_nobody_looked() -> None:
    seen: list[int] = []
    recorded(load_world("4x4_alias"), 40, seed=3, after=lambda agent: seen.append(agent.plan.action))
    world = load_world("4x4_alias")
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=3)
    observation, _ = world.reset(seed=3)
    for action in seen:
        assert agent.step(observation) == action
        observation, *_ = world.step(action)


def test_recording_may_begin_late() -> None:
    world, recorder = load_world("4x4_alias"), Recorder()
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=1)
    observation, _ = world.reset(seed=1)
    for step in range(20):
        action = agent.step(observation)
        if step >= 8 and step != 13:
            recorder.add(agent, place=world.position)
        observation, *_ = world.step(action)
    kept = recorder.recording()
    assert kept.data["origin"] is None
    assert [frame["step"] for frame in kept.frames] == [*range(8, 13), *range(14, 20)]
    assert outline(list(kept.maps())[-1].to_networkx()) == outline(agent.map.to_networkx())


def test_recorders_say_what_they_need() -> None:
    agent, other, recorder = Agent(GRID, seed=0), Agent(GRID, seed=0), Recorder()
    with pytest.raises(CogmapError, match=r"nothing was recorded"):
        recorder.recording()
    with pytest.raises(CogmapError, match=r"made no step"):
        recorder.add(agent)
    observation = {"sight": 1, "open": [True] * 5}
    agent.step(observation)
    recorder.add(agent)
    with pytest.raises(CogmapError, match=r"recorded already"):
        recorder.add(agent)
    other.step(observation)
    with pytest.raises(CogmapError, match=r"another agent"):
        recorder.add(other)
    agent.step({"sight": frozenset({1}), "open": [True] * 5})
    with pytest.raises(CogmapError, match=r"frozenset"):
        recorder.add(agent)
    assert len(recorder) == 1


def refused(path: Path, match: str) -> None:
    with pytest.raises(CogmapError, match=match) as caught:
        Recording.load(path)
    assert "\n" not in str(caught.value)


def test_files_that_are_no_recordings(recording: Recording, tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    refused(path, "there is no file")
    refused(tmp_path, "no recording, or truncated")
    recording.save(path)
    text = path.read_bytes()
    for content in (
        text[:-20],
        text[: len(text) // 2],
        b"",
        b"\x89PNG\r\n",
        gzip.compress(text)[:-30],
        b"\x1f\x8b",
        b"[" * 99999,
    ):
        path.write_bytes(content)
        refused(path, "no recording, or truncated")
    for content in (b"[]", b"3", b'{"format": "cogmap agent"}', b'{"runs": []}'):
        path.write_bytes(content)
        refused(path, "JSON, but no recording")
    for schema in (0, 3, "1", None):
        path.write_text(json.dumps({**recording.data, "schema": schema}))
        refused(path, "has schema")


def test_files_with_holes_are_damaged(tmp_path: Path) -> None:
    data = json.loads(json.dumps(recorded(load_world("3x3_alias"), 6).data))
    path = tmp_path / "run.json"
    head = [(name,) for name in data if name not in ("format", "schema")]
    frame = [("frames", 3, name) for name in data["frames"][3] if name not in ("at", "map", "open", "spoke")]
    parts = [("frames", 3, part, name) for part in ("plan", "window") for name in data["frames"][3][part]]
    for *way, name in [*head, *frame, *parts, ("motions", "stay"), ("motions", "names"), ("settings", "certainty")]:
        for value in (None, {"x": ["no label"]} if name == "seen" else {"x": 1}, [["x"]]):
            broken = copy.deepcopy(data)
            parent = broken
            for key in way:
                parent = parent[key]
            parent[name] = value
            if value is None:
                del parent[name]
            path.write_text(json.dumps(broken))
            refused(path, "is damaged")


def test_places_that_there_are_not(tmp_path: Path) -> None:
    data = json.loads(json.dumps(recorded(load_world("3x3_alias"), 6).data))
    path = tmp_path / "run.json"
    for spoil in (
        lambda frame: frame["belief"].append([99, 0.1]),
        lambda frame: frame["plan"]["paths"][0].append(99),
        lambda frame: frame["map"].setdefault("ways", []).append([0, 0, 1, 99, 0.5]),
        lambda frame: frame["map"].setdefault("places", []).append([77, [0, 0], 1, 0, 0.5]),
        lambda frame: frame["map"].__setitem__("size", 50),
        lambda frame: frame["seen"].__setitem__("sight", ["x"]),
        lambda frame: frame.__setitem__("at", 99),
        lambda frame: frame.__setitem__("open", [1]),
    ):
        broken = copy.deepcopy(data)
        spoil(broken["frames"][3])
        path.write_text(json.dumps(broken))
        refused(path, "is damaged")


def test_files_are_written_whole_or_not_at_all(recording: Recording, tmp_path: Path) -> None:
    with pytest.raises(CogmapError, match="cannot write"):
        recording.save(tmp_path / "missing" / "run.json")
    path = tmp_path / "run.json"
    path.write_text("before")
    with pytest.raises(CogmapError, match="finite"):
        Recording({**recording.data, "title": float("nan")}).save(path)
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_recordings_of_before_are_read(tmp_path: Path) -> None:
    """A walk in 3x3_alias that schema 1 has: a door closed at step 4, moved at 5, a room closed at 6."""
    kept = Recording.load(Path(__file__).parent / "saved" / "recording_schema1.json.gz")
    at = [kept.places[frame["at"]] for frame in kept.frames]
    assert at == [(2, 1), (2, 2), (1, 2), (0, 2), (0, 1), (0, 0), (1, 0), (2, 0), (1, 0)]
    assert kept.places[kept.data["origin"] or 0] == at[0]
    assert [kept.places[place] for place in kept.frames[6]["closed_rooms"]] == [(2, 2)]
    assert [[kept.places[place] for place in door] for door in kept.frames[4]["closed_doors"]] == [[(2, 1), (2, 2)]]
    assert [frame["seen"]["sight"] for frame in kept.frames] == [3, 3, 4, 1, 0, 0, 2, 3, 2]
    chart = load_world("3x3_alias").chart
    fresh = Recorder(chart)
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 3, "open": [True] * 5})
    fresh.add(agent, place=(2, 1))
    world = fresh.recording().data["world"]
    of = {tuple(place[:2]): place[2] for place in world["places"]}
    assert {tuple(place[:2]): place[2] for place in kept.data["world"]["places"]} == of
    assert len(kept.data["world"]["ways"]) == len(world["ways"]) == 12
    plan, signs = kept.frames[-1]["plan"], [term["sign"] for term in kept.data["terms"]]
    np.testing.assert_allclose(np.array(plan["terms"]) @ signs, plan["G"], atol=1e-3)
    kept.save(tmp_path / "now.json")
    assert Recording.load(tmp_path / "now.json") == kept

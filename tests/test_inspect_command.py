"""`cogmap inspect`, as a user types it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import FactorGraph
from cogmap.views import explain
from cogmap.worlds import load_world
from command_line import cogmap
from walks import GRID, walk

pytestmark = pytest.mark.usefixtures("empty_folder")


@pytest.fixture
def agent() -> Iterator[Agent]:
    """An agent in the middle of exploring, saved as m.npz."""
    world = load_world("4x4_alias")
    agent = Agent(world.motions, settings=Settings(look_ahead=3, window=4), seed=1)
    agent.prefer({3: 0.25})
    for _ in walk(world, agent, 9, seed=1):
        pass
    agent.save("m.npz")
    before = Path("m.npz").read_bytes()
    yield agent
    assert Path("m.npz").read_bytes() == before, "inspecting must leave the file as it is"


def told(*options: object) -> str:
    result = cogmap("inspect", "m.npz", *options)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def test_the_summary_says_what_is_in_the_file(agent: Agent) -> None:
    shown = told("--json", "s.json")
    for part in ("schema", "window 4", "(9 visited,", "walked", "refuted", "9 times", "certainty", "KiB"):
        assert part in shown, part
    assert max(map(len, shown.splitlines())) <= 80
    facts: dict[str, Any] = json.loads(Path("s.json").read_text())
    assert facts.keys() == {"summary"}
    summary = facts["summary"]
    assert Settings.from_dict(summary["settings"]) == agent.settings
    assert summary["steps"] == 9
    assert summary["places"]["all"] == len(agent.map.places)
    assert sum(summary["ways"].values()) == 4 * len(agent.map.places)
    assert sum(summary["events"].values()) == len(agent.map.growth)
    assert summary["bytes"] == os.path.getsize("m.npz")


def test_places_and_transitions_are_limited_but_not_in_json(agent: Agent) -> None:
    shown = told("--places", "--transitions", "--limit", 3, "--json", "t.json")
    assert f"… {len(agent.map.places) - 3} more" in shown
    facts = json.loads(Path("t.json").read_text())
    assert [row["place"] for row in facts["places"]] == list(agent.map.places)
    for row in facts["transitions"]:
        action = agent.map.motions.names.index(row["action"])
        assert row["probability"] == agent.map.transition(row["next"], row["place"], action)
    assert "more" not in told("--places", "--limit", len(agent.map.places))


def test_one_place(agent: Agent) -> None:
    place = agent.belief.place
    shown = told("--place", place, "--json", "p.json")
    for part in ("visited (the 9th place)", str(agent.map.position(place)), "ways out", "ways here", "A_o:"):
        assert part in shown
    facts = json.loads(Path("p.json").read_text())["place"]
    assert facts["belief"] == agent.belief.places[place]
    assert [way["action"] for way in facts["ways"]] == list(GRID)
    assert all(row["next"] == place for row in facts["reached_from"])
    imagined = int(np.flatnonzero(~agent.map.visited)[0])
    assert "imagined" in told("--place", imagined)


def test_why_is_the_explanation(agent: Agent) -> None:
    shown = told("--why", "--json", "w.json")
    assert explain(agent).text in shown
    facts = json.loads(Path("w.json").read_text())["why"]
    assert facts["chosen"]["terms"] == agent.plan.expected_free_energy.row(agent.plan.chosen)
    assert facts["sights"] == [[3, 0.25]]


def test_growth_since_a_step(agent: Agent) -> None:
    shown = told("--growth", "--since", 7, "--json", "g.json")
    assert "steps 7 to 8:" in shown
    assert "s7, p7" in shown
    facts = json.loads(Path("g.json").read_text())["growth"]
    assert len(facts["events"]) == sum(event.step >= 7 for event in agent.map.growth)
    assert "steps 0 to 8:" in told("--growth")


@pytest.mark.parametrize("graph", ["dot", "json", "png", "svg"])
def test_graphs_of_the_map(graph: str, agent: Agent) -> None:
    assert f"graph saved: m.{graph}" in told("--graph", graph)
    content = Path(f"m.{graph}").read_bytes()
    if graph == "dot":
        assert content.decode() == agent.map.to_dot()
    elif graph == "json":
        twin = nx.node_link_graph(json.loads(content), edges="edges")
        assert twin.number_of_edges() == agent.map.to_networkx().number_of_edges()
    else:
        assert content.startswith(b"\x89PNG") if graph == "png" else b"<svg" in content


def test_graphs_of_the_window(agent: Agent) -> None:
    told("--graph", "json", "--of", "window", "--out", "w.json")
    assert FactorGraph.from_json(Path("w.json").read_text()).same_as(agent.graph)
    told("--graph", "dot", "--of", "window")
    assert Path("m.dot").read_text() == agent.graph.to_dot()
    told("--graph", "svg", "--of", "window")
    assert "<svg" in Path("m.svg").read_text()
    told("--graph", "png", "--of", "window")
    assert Path("m.png").read_bytes().startswith(b"\x89PNG")


def test_an_agent_that_saw_nothing() -> None:
    Agent(GRID).save("m.npz")
    assert "it has seen nothing yet" in told()
    assert "imagined" in told("--place", 0)
    told("--places", "--transitions", "--growth")
    result = cogmap("inspect", "m.npz", "--why")
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)


def test_labels_are_not_markup() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=1))
    agent.step({"sight": "[red]x[/blue]", "open": [True] * 5})
    agent.save("m.npz")
    for option in ([], ["--places"], ["--place", 0], ["--growth"], ["--why"]):
        assert "[red]x[/blue]" in told(*option)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "Missing argument"),
        (["none.npz"], "no file none.npz"),
        (["."], "no saved agent"),
        (["text.npz"], "no saved agent"),
        (["cut.npz"], "truncated"),
        (["array.npz"], "no saved agent"),
        (["newer.npz"], "has schema 999, newer"),
        (["other.npz"], "is a 'something else'"),
        (["m.npz", "--place", "99"], "no place 99; places are 0 to"),
        (["m.npz", "--place", "-1"], "no place -1"),
        (["m.npz", "--place", "x"], "--place"),
        (["m.npz", "--graph", "gif"], "no graph format 'gif'; choose one of dot, json"),
        (["m.npz", "--graph", "dot", "--of", "world"], "no graph of 'world'"),
        (["m.npz", "--graph", "dot", "--out", "no/x.dot"], "cannot write no/x.dot"),
        (["m.npz", "--graph", "dot", "--out", "m.npz"], "the file that is read"),
        (["m.npz", "--json", "m.npz"], "the file that is read"),
        (["m.npz", "--json", "no/x.json"], "cannot write no/x.json"),
        (["m.npz", "--json", "a", "--graph", "dot", "--out", "a"], "two outputs"),
        (["m.npz", "--out", "x.dot"], "add --graph"),
        (["m.npz", "--since", "3"], "--since is for --growth"),
        (["m.npz", "--growth", "--since", "99"], "no step from 99 to 8"),
        (["m.npz", "--growth", "--since", "-1"], "--since"),
        (["m.npz", "--places", "--limit", "0"], "--limit"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(options: list[str], message: str, agent: Agent) -> None:
    whole = Path("m.npz").read_bytes()
    Path("text.npz").write_text("a map")
    Path("cut.npz").write_bytes(whole[: len(whole) // 2])
    np.savez("array.npz", x=np.arange(3))
    header = json.loads(np.load("m.npz")["header"].tobytes())
    for name, change in (("newer", {"schema": 999}), ("other", {"format": "something else"})):
        packed = np.frombuffer(json.dumps({**header, **change}).encode(), dtype=np.uint8)
        np.savez(f"{name}.npz", header=packed)
    before = sorted(os.listdir())
    result = cogmap("inspect", *options)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.startswith("cogmap: ")
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert sorted(os.listdir()) == before

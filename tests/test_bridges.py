"""To other programs and into notebooks: matrices of pymdp, traces as frames, short pictures of everything."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Pomdp, trace_table
from cogmap.inference import infer
from cogmap.model import CogmapError, CognitiveMap, LabelledTable, Motions, NoPose
from cogmap.views import Recorder, Shown, show
from cogmap.worlds import MAZES, Maze, labyrinth, load_world
from pages import Page
from walks import GRID


def explored(name: str = "3x3_alias", steps: int = 25, **options: Any) -> Agent:
    world = load_world(name)
    observation, _ = world.reset(seed=0)
    agent = Agent(world.motions, seed=0, **options)
    for _ in range(steps):
        observation, *_ = world.step(agent.step(observation))
    return agent


# -- A, B, C, D --------------------------------------------------------------------------------------------


def test_the_matrices_of_an_agent_are_its_map() -> None:
    agent = explored()
    agent.prefer({4: 2.0})
    agent.perceive({"sight": 4, "open": [True] * 5, "taken": "stay"} if agent.plan is None else _last(agent))
    out, map_ = Pomdp.of(agent), agent.map
    assert out.names[0] == "sight"
    assert out.actions == tuple(GRID)
    np.testing.assert_allclose(out.A[0][:, :-1], map_.A())
    np.testing.assert_allclose(out.B[:, :-1], map_.B())
    assert out.B[-1, -1].tolist() == [1.0] * 5
    assert out.C[0][out.labels[0].index(4)] == 2.0
    assert out.D[agent.belief.place] == pytest.approx(agent.belief.message.certainty)
    up = out.A[out.names.index("way up")]
    np.testing.assert_allclose(up[1, :-1], map_.blocked(np.arange(len(map_.places)))[:, 0])
    arrays = out.arrays()
    assert {name: len(tables) for name, tables in arrays.items()} == {"A": 6, "B": 1, "C": 6, "D": 1}


def _last(agent: Agent) -> dict[str, Any]:
    record = agent.trace[-1]
    return {"sight": record.sight, "open": list(record.open), "taken": "stay"}


def ring(size: int = 4) -> dict[str, Any]:
    B = np.zeros((size, size, 2))
    for state in range(size):
        B[(state + 1) % size, state, 0] = B[(state - 1) % size, state, 1] = 1.0
    return {"A": [np.eye(size)], "B": [B], "C": [np.array([0.0, 0.0, 3.0, 0.0])], "D": [np.eye(size)[0]]}


def test_matrices_make_a_graph_and_an_agent() -> None:
    given = Pomdp.from_arrays(**ring(), actions=["on", "back"])
    posterior = infer(given.graph(["on", "on", "back"]), evidence={"sight@3": 1})
    assert posterior.probability("s2", 2) == pytest.approx(1.0)
    agent = given.agent(seed=0)
    place = 0
    for _ in range(6):
        action = agent.step({"sight": place})
        place = (place + (1, -1, 0)[action]) % 4
    assert place == 2  # where it hoped to be
    assert list(agent.map.motions.names) == ["on", "back", "stay"]
    assert len(agent.map.places) == 4


def test_arrays_of_arrays_are_read_and_written() -> None:
    made = ring()
    packed = {name: np.empty(1, dtype=object) for name in made}
    for name, tables in made.items():
        packed[name][0] = tables[0]
    for given in (packed, {name: tables[0] for name, tables in made.items()}):
        again = Pomdp.from_arrays(**given).arrays()
        for name, tables in made.items():
            np.testing.assert_array_equal(again[name][0], tables[0])
    without = Pomdp.from_arrays(made["A"], made["B"])
    assert without.D.tolist() == [0.25] * 4
    assert not without.C[0].any()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"B": [np.zeros((4, 4, 2))]}, "B has columns that are no probabilities"),
        ({"B": ring()["B"] * 2}, "B has 2 state factors; give one"),
        ({"A": [np.eye(3)]}, r"A of 'sight' is \(3, 3\)"),
        ({"D": [np.array([0.5, 0.5])]}, r"B is \(4, 4, 2\)"),
        ({"C": [np.zeros(3)]}, "C of 'sight' is"),
        ({"C": [np.full(4, np.nan)]}, "C of 'sight' is"),
        ({"A": "sights"}, "is no array of 2 axes"),
        ({"actions": ["go", "go"]}, "give names that differ"),
        ({"actions": ["go"]}, r"B is \(4, 4, 2\)"),
    ],
)
def test_arrays_that_are_no_model(change: dict[str, Any], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Pomdp.from_arrays(**{**ring(), **change})
    with pytest.raises(CogmapError, match="action 'jump' is unknown"):
        Pomdp.from_arrays(**ring()).graph(["jump"])


# -- traces ------------------------------------------------------------------------------------------------


def test_a_trace_is_a_table_and_a_frame() -> None:
    agent = explored(steps=8)
    shown = trace_table(agent)
    assert isinstance(shown, LabelledTable)
    assert shown.index == tuple(range(8))
    by_name = {name: [row[at] for row in shown.cells] for at, name in enumerate(shown.columns)}
    assert by_name["sight"] == [record.sight for record in agent.trace]
    assert by_name["free energy"] == [record.free_energy for record in agent.trace]
    assert by_name["action"] == [list(GRID)[record.action] for record in agent.trace]
    assert by_name["G"] == [record.G["G"] for record in agent.trace]
    assert len(trace_table(agent, agent.trace[-3:]).index) == 3
    pytest.importorskip("pandas")
    frame: Any = shown.to_pandas()
    assert frame.loc[2, "certainty"] == agent.trace[2].certainty
    with pytest.raises(CogmapError, match="the trace has no step yet"):
        trace_table(Agent(GRID))


# -- notebooks ---------------------------------------------------------------------------------------------


def test_everything_has_a_short_picture() -> None:
    agent = explored()
    for thing in (agent, agent.map, agent.plan, agent.belief):
        page = thing._repr_html_()
        assert len(page) < 10_000
        assert Page(page).tags
    for picture, circles in ((agent.map._repr_svg_(), 9), (MAZES["tolman"]._repr_svg_(), 0)):
        assert picture is not None
        root = ET.fromstring(picture)
        assert len([node for node in root.iter() if node.tag.endswith("circle")]) == circles
    assert len([node for node in ET.fromstring(MAZES["3x3"]._repr_svg_() or "").iter() if "rect" in node.tag]) == 9
    assert "it has seen nothing yet" in Agent(GRID)._repr_html_()


def test_what_is_large_or_has_no_plane_is_told_and_not_drawn() -> None:
    large = labyrinth(1_500, rng=np.random.default_rng(0))
    assert large._repr_svg_() is None
    assert len(repr(large)) < 100
    map_ = CognitiveMap(Motions.of(GRID), pose=NoPose())
    map_.new_place(None, step=0)
    assert map_._repr_svg_() is None
    assert map_._repr_html_() == "<div><p>1 places, 0 visited, 0 sights</p></div>"


@pytest.mark.parametrize("label", ["<script>", "&", "a" * 300, '"'])
def test_labels_are_only_text(label: str) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": label, "open": [False] * 4 + [True]})
    maze = Maze("<b>", {(0, 0): label, (0, 1): "b"})
    for picture in (agent.map._repr_svg_(), maze._repr_svg_()):
        texts = [node.text for node in ET.fromstring(picture or "").iter() if node.tag.endswith("text")]
        assert max(len(text or "") for text in texts) <= 6
    assert "script" not in {tag for tag, _ in Page(agent._repr_html_()).tags}


def test_a_recording_is_shown_in_a_frame_of_its_own() -> None:
    world = load_world("3x3")
    observation, info = world.reset(seed=0)
    agent, recorder = Agent(world.motions, seed=0), Recorder(world.maze, title='a "walk" & more')
    for _ in range(3):
        action = agent.step(observation)
        recorder.add(agent, place=info["position"])
        observation, _, _, _, info = world.step(action)
    shown = show(recorder.recording())
    ((tag, attributes),) = Page(shown._repr_html_()).tags
    assert (tag, attributes["sandbox"]) == ("iframe", "allow-scripts")
    assert attributes["srcdoc"] == shown.page
    assert len(repr(shown)) < 100
    assert isinstance(shown, Shown)
    for bad in ({"recording": agent}, {"recording": recorder.recording(), "height": 3}):
        with pytest.raises(CogmapError, match="show: "):
            show(**bad)  # type: ignore[arg-type]

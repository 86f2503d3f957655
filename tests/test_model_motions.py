"""Actions without displacements: who undoes whom may be known, or not."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from cogmap.agent import Agent
from cogmap.model import CogmapError, Lattice, Motions, NoPose


def spec(*names: str, reverse: tuple[int, ...] = ()) -> SimpleNamespace:
    return SimpleNamespace(names=names, displacements=(), reverse=reverse)


def test_pairs_have_an_axis_of_their_own() -> None:
    motions = Motions.of(spec("in", "out", "jump", "stay", reverse=(1, 0, -1, 3)))
    assert (motions.inverse, motions.stay, motions.placed) == ((1, 0, -1, 3), 3, False)
    assert motions.displacements == ((1, 0), (-1, 0), (0, 1), (0, 0))
    assert Motions.of({"a": (1,), "b": (-1,), "stay": (0,)}).placed


def test_nobody_may_know_who_undoes_whom() -> None:
    motions = Motions.of(spec("a", "b", "stay"))
    assert motions.inverse == (-1, -1, 2)
    assert len(set(motions.displacements)) == 3


@pytest.mark.parametrize(
    ("names", "reverse", "message"),
    [
        (("a", "b"), (), "must be called 'stay'"),
        (("a", "stay"), (0,), "reverse is"),
        (("a", "b", "stay"), (1, 2, 2), "reverse is"),
        (("a", "b", "stay"), (1, 1, 2), "reverse is"),
        (("a", "b", "stay"), (3, 0, 2), "reverse is"),
        (("a", "a", "stay"), (), "names repeat"),
        ((), (), "at least one action"),
    ],
)
def test_bad_motions(names: tuple[str, ...], reverse: tuple[int, ...], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Motions.of(spec(*names, reverse=reverse))


@pytest.mark.parametrize("reverse", [(1, 0, 2), ()])
def test_an_agent_with_such_actions_has_no_pose(reverse: tuple[int, ...], tmp_path: Path) -> None:
    agent = Agent(spec("on", "back", "stay", reverse=reverse), seed=0)
    assert isinstance(agent.map.pose, NoPose)
    for step in range(12):
        agent.step({"sight": step % 3, "open": [True, True, True]})
    agent.save(tmp_path / "m.npz")
    twin = Agent.load(tmp_path / "m.npz")
    assert twin.map.motions == agent.map.motions
    told = {"sight": 1, "open": [True, False, True]}
    assert twin.step(told) == agent.step(told)
    with pytest.raises(CogmapError, match="no displacements"):
        Agent(spec("on", "back", "stay", reverse=reverse), pose=Lattice())


@pytest.mark.parametrize("name", [1, None, ("a", "b"), b"up"])
def test_names_of_actions_are_words(name: Any) -> None:
    with pytest.raises(CogmapError, match="give each action a word"):
        Motions((name, "stay"), ((1,), (0,)))

from __future__ import annotations

import os
from pathlib import Path

import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError
from cogmap.views import GrowthFrames
from cogmap.worlds import GRID, MAZES, load_world
from matplotlib.patches import Circle
from PIL import Image
from strolls import half_way, small, stroll


def short() -> GrowthFrames:
    return stroll("3x3_alias", (1, 1), 3).frames


def test_frames_are_the_map_as_it_was() -> None:
    frames, agent = half_way().frames, half_way().agent
    assert [frame.step for frame in frames.frames] == list(range(len(agent.trace)))
    grown, visited = 1, list[int]()  # it knows that it is somewhere before it sees anything
    for frame, picture, record in zip(frames.frames, frames.maps(), agent.trace, strict=True):
        grown += sum(event.kind == "place" for event in record.grown)
        assert len(picture.places) == grown
        assert frame.place == next(iter(record.places))
        visited.append(picture.visited)
    assert visited == sorted(visited)
    assert visited[0] == 1
    assert visited[-1] == int(agent.map.visited.sum())


def test_what_did_not_change_is_kept_once() -> None:
    frames = small().frames
    told = [place for frame in frames.frames for place, *_ in frame.delta.get("places", ())]
    assert len(told) < len(frames) * len(small().agent.map.places) / 2


def test_all_frames_have_the_room_of_the_last() -> None:
    frames = half_way().frames
    first, last = frames.plot(0, title="first"), frames.plot()
    assert (first.get_xlim(), first.get_ylim()) == (last.get_xlim(), last.get_ylim())
    assert first.get_title() == "first"
    assert last.get_title().startswith(f"step {len(frames) - 1}: ")
    places = [[*picture.places] for index, picture in enumerate(frames.maps()) if index in (0, len(frames) - 1)]
    circles = [sum(isinstance(patch, Circle) for patch in ax.patches) for ax in (first, last)]
    assert circles == [len(picture) + 1 for picture in places]  # and the ring of the agent


def test_frames_over_the_maze() -> None:
    frames = GrowthFrames(chart=MAZES["3x3"], start=(1, 1))
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 4, "open": [True] * 5})
    frames.add(agent)
    centres = {tuple(patch.get_center()) for patch in frames.plot().patches if isinstance(patch, Circle)}
    assert centres == {(1.0, 1.0), (0.0, 1.0), (2.0, 1.0), (1.0, 0.0), (1.0, 2.0)}


def test_news_are_told() -> None:
    agent, frames = Agent(GRID, seed=0), GrowthFrames()
    for sight, doors in (("red", [True, False, False, True]), ("red", [True, False, False, True]), (7, [False] * 4)):
        agent.step({"sight": sight, "open": [*doors, True]})
        frames.add(agent)
    assert frames.frames[0].news == "3 imagined, new sight red"
    assert "new sight 7" in frames.frames[2].news
    assert frames.plot(0).get_title() == "step 0: 3 places, 1 visited\n3 imagined, new sight red"


def test_places_that_were_taken_back_are_told() -> None:
    world, frames = load_world("4x4_alias"), GrowthFrames()
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=0)
    observation, _ = world.reset(seed=0)
    for step in range(60):
        action = agent.step(observation)
        frames.add(agent)
        observation = world.displace([(1, 2), (3, 0)][step // 6 % 2]) if step % 6 == 5 else world.step(action)[0]
    assert any(record.revised for record in agent.trace)
    for frame, record in zip(frames.frames, agent.trace, strict=True):
        gone = sum(event.index for event in record.grown if event.kind == "retract")
        assert (f"{gone} taken back" in frame.news) == (gone > 0)


def test_a_gif_has_every_frame(tmp_path: Path) -> None:
    path = short().save_gif(tmp_path / "map.gif", seconds=0.5, last=1.0)
    with Image.open(path) as picture:
        assert picture.n_frames == 3  # alike frames at the end become one
        durations = []
        for index in range(picture.n_frames):
            picture.seek(index)
            durations.append(picture.info["duration"])
    assert durations == [500, 500, 1000]
    assert os.listdir(tmp_path) == ["map.gif"]


def test_pngs_are_numbered(tmp_path: Path) -> None:
    written = short().save_pngs(tmp_path / "new" / "frames")
    assert [path.name for path in written] == ["frame_0000.png", "frame_0001.png", "frame_0002.png"]
    sizes = set()
    for path in written:
        with Image.open(path) as picture:
            sizes.add(picture.size)
    assert sizes == {(600, 600)}
    assert sorted(os.listdir(tmp_path / "new" / "frames")) == [path.name for path in written]


def test_a_file_that_was_there_stays_where_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "map.gif"
    path.write_bytes(b"old")
    frames = short()

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, "no space left")

    monkeypatch.setattr("matplotlib.animation.PillowWriter.finish", fail)
    with pytest.raises(CogmapError, match="no space left"):
        frames.save_gif(path)
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["map.gif"]


def test_bad_input(tmp_path: Path) -> None:
    frames = short()
    (tmp_path / "file").write_text("")
    with pytest.raises(CogmapError, match=r"is no \.gif"):
        frames.save_gif(tmp_path / "map.png")
    with pytest.raises(CogmapError, match="cannot write"):
        frames.save_gif(tmp_path / "missing" / "map.gif")
    with pytest.raises(CogmapError, match="cannot make folder"):
        frames.save_pngs(tmp_path / "file")
    with pytest.raises(CogmapError, match="seconds"):
        frames.save_gif(tmp_path / "map.gif", seconds=0.0)
    with pytest.raises(CogmapError, match="no frame 3"):
        frames.plot(3)
    empty = GrowthFrames()
    for save in (lambda: empty.save_gif(tmp_path / "map.gif"), lambda: empty.save_pngs(tmp_path)):
        with pytest.raises(CogmapError, match="none yet"):
            save()
    with pytest.raises(CogmapError, match="seen nothing yet"):
        empty.add(Agent(GRID, seed=0))

"""A body in MiniGrid: what it makes out, where it takes itself to be, how it gets from room to room."""

from __future__ import annotations

import base64
import io
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.body import Body, EmbodiedWorld, Eyes, MiniGridBody, embodied, load_embodied
from cogmap.experiments import explore, kidnap, navigate, run, walk
from cogmap.model import CogmapError
from cogmap.worlds import GRID, MAZES, WorldError
from cogmap.worlds.minigrid import Unsteady, paint, rooms_env
from command_line import cogmap

WAYS = ("right", "down", "left", "up")


def truth(world: EmbodiedWorld) -> dict[str, bool]:
    return {name: room is not None for name, room in world.maze.exits(world.place).items()}


def agrees(world: EmbodiedWorld, observation: dict[str, Any]) -> bool:
    told = dict(zip(GRID.names, observation["open"], strict=True))
    return all(told[way] in (None, true) for way, true in truth(world).items())


def test_pixels_and_symbols_say_the_same() -> None:
    env = rooms_env("4x4", least=3, most=7)
    seen, _ = env.reset(seed=0)
    eyes, rng = Eyes(), np.random.default_rng(0)
    for _ in range(60):
        symbols, pixels = eyes.look(seen["image"]), eyes.look(paint(env.symbols))
        assert (symbols.seen == pixels.seen).all()
        assert (symbols.log_likelihood == pixels.log_likelihood)[symbols.seen].all()
        seen, *_ = env.step(int(rng.choice([0, 1, 2, 2, 5])))


def test_noise_and_light_are_estimated() -> None:
    env, rng = rooms_env("3x3", view="rgb"), np.random.default_rng(0)
    seen, _ = env.reset(seed=0)
    true = Eyes().look(seen["image"])
    eyes = Eyes()
    blurred = np.clip(0.9 * seen["image"] + 30.0 * rng.standard_normal(seen["image"].shape), 0, 255)
    found = eyes.look(blurred.astype(np.uint8))
    assert (found.tile == true.tile)[true.seen].mean() > 0.95
    assert eyes.noise == pytest.approx(28.0, abs=6.0)
    assert eyes.gain == pytest.approx(0.92, abs=0.05)


@pytest.mark.parametrize("image", [np.zeros((7, 5, 3)), np.zeros(3), np.zeros((50, 50, 3)), np.zeros((56, 56))])
def test_what_is_no_view_is_refused(image: Any) -> None:
    with pytest.raises(CogmapError, match="body: an image of"):
        Eyes().look(image)


def test_it_goes_through_the_ways_it_is_told() -> None:
    world = embodied("3x3")
    world.reset(seed=4, options={"start": (1, 1)})
    assert isinstance(world.body, Body)
    assert world.observe()["sight"] == MAZES["3x3"].sights[1, 1]
    for action, room in (("up", (0, 1)), ("left", (0, 0)), ("down", (1, 0)), ("right", (1, 1))):
        seen, *_, info = world.step(GRID.names.index(action))
        assert info["position"] == room
        assert seen["outcome"] == "arrived"
        assert seen["sight"] == world.maze.sights[room]
        assert agrees(world, seen)


def test_a_wall_is_found_out_and_costs_little() -> None:
    world = embodied("3x3")
    world.reset(seed=1, options={"start": (0, 0)})
    before = world.low_level_steps
    seen, *_, info = world.step(GRID.names.index("up"))
    assert (info["position"], seen["outcome"]) == ((0, 0), "blocked")
    assert world.low_level_steps - before <= 2
    assert seen["open"] == [False, True, False, True, True]


def test_staying_looks_at_what_was_not_looked_at() -> None:
    world = embodied("4x4", glance=0)
    world.reset(seed=0, options={"start": (1, 1)})
    unseen = 0
    for action in (0, 3, 1, 1, 2, 0):
        world.step(action)
        unseen += None in world.observe()["open"]
        seen, *_ = world.step(GRID.names.index("stay"))
        assert dict(zip(GRID.names, seen["open"], strict=True)) == truth(world)
    assert unseen


def test_a_budget_ends_a_try() -> None:
    env = rooms_env("3x3")
    seen, _ = env.reset(seed=0, options={"start": (1, 1)})
    body = MiniGridBody(env)
    body.begin(seen)
    body.wake()
    assert body.cost(0) > 5
    tried = body.perform(0, budget=3)
    assert (tried.outcome, tried.steps) == ("unsure", 3)
    assert body.perform(0).outcome == "arrived"


def test_the_end_of_an_episode_ends_it() -> None:
    world = EmbodiedWorld(rooms_env("3x3", max_steps=12))
    world.reset(seed=0)
    _, _, _, truncated, info = world.step(0)
    _, _, _, truncated, info = world.step(1)
    assert truncated
    assert info["low_level_steps"] == 12


@pytest.mark.parametrize("name", ["3x3", "t_maze_alias"])
def test_rgb_and_symbols_lead_to_the_same_actions(name: str) -> None:
    walks = [walk(embodied(name, view=view), 3) for view in ("symbolic", "rgb")]
    assert walks[0].path == walks[1].path
    assert walks[0].run == walks[1].run
    assert [record.action for record in walks[0].walker.trace] == [record.action for record in walks[1].walker.trace]


def test_rows_count_low_level_steps() -> None:
    row = explore(embodied("3x3"), 1).to_dict()
    assert row["steps_to_complete"] is not None
    assert row["low_level_oracle"] <= row["low_level_steps"] <= 1.35 * row["low_level_oracle"]
    assert row["low_level_steps_to_see"] < 130
    assert row["tiles_seen"] > 0.9
    assert "low_level_steps" not in explore(MAZES["3x3"], 1).to_dict()


def test_rooms_of_all_sizes_under_noise() -> None:
    world = embodied("t_maze", view="rgb", least=4, most=6, noise={"pixels": 30.0, "gain": 0.1, "slips": 0.05})
    assert explore(world, 0).steps_to_complete is not None


def test_a_white_tile_is_a_goal_of_its_own() -> None:
    world = embodied("3x3", white=(2, 2))
    found = navigate(world, 1, goal="white", known=False)
    assert found.reached
    assert found.low_level_oracle is not None
    assert found.low_level_steps is not None
    assert found.low_level_steps >= found.low_level_oracle
    again = navigate(world, 1, goal="white")
    assert again.reached
    assert again.low_level_steps <= 2 * again.low_level_oracle


def test_a_silent_move_is_noticed_by_the_agent_above() -> None:
    moved = kidnap(embodied("3x3"), 2)
    assert (moved.recovered, moved.map_intact) == (True, True)
    assert moved.steps_to_recover == 0


def test_slips_are_noticed_and_learned() -> None:
    env = Unsteady(rooms_env("3x3"), slips=0.15)
    world = EmbodiedWorld(env)
    done = run(world, steps=12, seed=3)
    assert done.records
    assert world.rooms.tally.room == world.place
    assert 0.02 < world.body.slip < 0.4


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["minigrid:no_such"], "no world 'no_such'"),
        (["minigrid:3x3", "--view", "lidar"], "symbolic or rgb"),
        (["minigrid:3x3", "--tiles", "1"], "smaller rooms have no wall"),
        (["minigrid:3x3", "--tiles", "big"], "no size of rooms"),
        (["minigrid:3x3", "--noise", "pixels=10"], "needs pixels"),
        (["3x3", "--view", "rgb"], "for worlds of MiniGrid"),
        (["minigrid:5x5", "--sights", "distinct"], "17 colours"),
    ],
)
def test_bad_input_of_commands(arguments: list[str], said: str) -> None:
    result = cogmap("explore", *arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


def test_commands(tmp_path: Any) -> None:
    done = cogmap("explore", "minigrid:1x3", "--view", "rgb", "--runs", 2, "--json", tmp_path / "a.json")
    assert (done.exit_code, "low_level_steps" in (tmp_path / "a.json").read_text()) == (0, True)
    assert cogmap("navigate", "minigrid:1x3", "--goal", "white", "--unexplored").exit_code == 0
    assert cogmap("kidnap", "minigrid:t_maze", "--tiles", "4-6").exit_code == 0


def test_a_missing_extra_is_named_with_what_installs_it() -> None:
    code = (
        "import sys; sys.modules['minigrid'] = None\n"
        "from cogmap.experiments.cli import main; sys.argv = ['cogmap', 'explore', 'minigrid:3x3']; main()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 2
    assert "pip install 'cogmap[minigrid]'" in done.stderr
    assert done.stderr.count("\n") == 1


def test_pictures_have_the_parts_of_the_papers_figure(tmp_path: Path) -> None:
    from cogmap.views import Scene, explore_figure

    world = embodied("t_maze")
    run(world, steps=4, seed=0)
    image, path = world.scene(pixels=8)
    assert image.shape == (8 * world.rooms.height, 8 * world.rooms.width, 3)
    assert len(path) == world.low_level_steps + 1
    assert (np.abs(np.diff(path, axis=0)).sum(axis=1) <= 8).all()
    figure = explore_figure(world.chart, [world.place], scene=Scene(image, path))
    assert [ax.get_title() for ax in figure.axes] == ["path, from black to white", "a body's path, from black to white"]
    with pytest.raises(CogmapError, match="is no RGB"):
        Scene(image[..., 0], path)
    with pytest.raises(CogmapError, match="no x and y"):
        Scene(image, path[:, 0])
    file = tmp_path / "figure.svg"
    assert cogmap("explore", "minigrid:1x3", "--out", file).exit_code == 0
    assert file.stat().st_size > 10_000


def test_a_replay_shows_the_pixels_beside_the_map(tmp_path: Path) -> None:
    from cogmap.views import Recorder, Recording, replay_html
    from PIL import Image

    file = tmp_path / "walk.json"
    assert (
        cogmap("explore", "minigrid:1x3", "--view", "rgb", "--trace", file, "--out", tmp_path / "a.svg").exit_code == 0
    )
    recording = Recording.load(file)
    pictures = [frame["pixels"] for frame in recording.frames]
    shown = replay_html(recording)
    assert all(picture in shown for picture in pictures)
    first = np.asarray(Image.open(io.BytesIO(base64.b64decode(pictures[0].partition(",")[2]))))
    assert first.shape == (56, 56, 3)
    world = embodied("t_maze")
    agent, (seen, _) = Agent(world.motions, seed=0), world.reset(seed=0)
    agent.step(seen)
    recorder = Recorder()
    for wrong in (np.zeros((4, 4)), np.zeros((4, 4, 3))):
        with pytest.raises(CogmapError, match="no RGB"):
            recorder.add(agent, pixels=wrong)
    recorder.add(agent, pixels=world.pixels)
    kept = np.asarray(Image.open(io.BytesIO(base64.b64decode(recorder.recording().frames[0]["pixels"][22:]))))
    assert np.array_equal(kept, paint(world.rooms.symbols))
    damaged = recorder.recording().data
    damaged["frames"][0]["pixels"] = "https://example.org/a.png"
    recorder.save(file)
    with pytest.raises(CogmapError, match="pixels of frame 0"):
        Recording.load(file)


def test_halls_have_four_colours() -> None:
    world = load_embodied("4x5")
    assert (len(world.maze.rooms), set(world.maze.sights.values())) == (20, {0, 1, 2, 3})
    with pytest.raises(WorldError, match="cannot be given to a hall"):
        load_embodied("2x7", sights="ways")


def test_a_body_that_sees_badly_does_not_give_up() -> None:
    noise = {"pixels": 40.0, "gain": 0.1}
    assert explore(embodied("4x4_alias", view="rgb", noise=noise), 4).steps_to_complete is not None

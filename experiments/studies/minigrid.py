"""The study `minigrid`: from pixels to places, beside the authors' published figures."""

from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from functools import partial
from io import StringIO
from time import process_time
from typing import Any

import numpy as np

from ...agent import Agent, Settings
from ...baselines import TileFrontier
from ...body import COLOURS, load_embodied
from ...views import BLUE, GREY
from ...worlds import Maze, NoisyWorld, hall
from ...worlds import minigrid as mg
from .. import Record, explore, kidnap, mean, navigate, run_id
from ..low_level import TENTHS
from .figures import Figure, panels, plot_bars
from .intervals import wilson
from .study import Findings, Study
from .tables import Table, Value

AUTHORS: dict[str, float] = {"3x3": 0.93, "3x4": 0.94, "4x4": 0.91, "4x5": 0.81, "white": 0.89, "white, known": 0.86}
"""Shares of runs in which the authors' agent got there (de Tinguy et al., Entropy 2024)."""

NOISE = {"pixels": 40.0, "gain": 0.1, "slips": 0.2}
SIZES = ("3x3", "3x4", "4x4", "4x5")
ERRORS = {"miss": 0.05, "door": 0.02, "fail": 0.1}
IDS = {
    "MultiRoom-N6": "MiniGrid-MultiRoom-N6-v0",
    "FourRooms": "MiniGrid-FourRooms-v0",
    "BabyAI-GoTo": "BabyAI-GoTo-v0",
    "GoToObjMaze": "BabyAI-GoToObjMaze-v0",
    "LockedRoom": "MiniGrid-LockedRoom-v0",
    "KeyCorridorS3R3": "MiniGrid-KeyCorridorS3R3-v0",
    "DoorKey-8x8": "MiniGrid-DoorKey-8x8-v0",
    "UnlockPickup": "MiniGrid-UnlockPickup-v0",
}
MOST = 150  # upper steps after which a run has failed
UPPER = 15  # upper steps that are timed
ROOMS = "KeyCorridorS6R3, rooms"
MOVES = 40  # upper steps in which all of its rooms are to be entered
MAZES = ("3x3", "4x4_alias")
NOISY, ERRING = (tuple(f"{what}, {maze}" for maze in MAZES) for what in ("noise, rooms of 4 to 12", "errors"))
TIME, ALIKE, SIZED = "time", "RGB as symbolic", "rooms of 4 to 12"
CASES = (*SIZES, "white", "white, known", "kidnapped", ALIKE, SIZED, *NOISY, *ERRING, *IDS, ROOMS, TIME)
SEEN = 0.9
Task = tuple[str, int]  # case, seed


@dataclass(frozen=True, slots=True)
class BodyRun(Record):
    """One run of a body."""

    case: str
    seed: int
    done: bool  # nine tenths seen; goal reached; recovered with its map intact; map complete
    low_level_steps: int | None = field(default=None, metadata={"optional": True})  # until every room, or the goal
    low_level_oracle: int | None = field(default=None, metadata={"optional": True})  # the fewest
    low_level_steps_to_see: int | None = field(default=None, metadata={"optional": True})  # nine tenths of the tiles
    flat_to_see: int | None = field(default=None, metadata={"optional": True})  # of the nearest frontier over tiles
    eager_to_see: int | None = field(default=None, metadata={"optional": True})  # of one that chooses at every step
    bot_steps: int | None = field(default=None, metadata={"optional": True})  # of BabyAI's own bot, which sees all
    moves: int | None = field(default=None, metadata={"optional": True})  # of the upper level, in spite of errors
    moves_without: int | None = field(default=None, metadata={"optional": True})  # the same without errors
    ms_low: float | None = field(default=None, compare=False, metadata={"optional": True})  # a low step, RGB
    ms_upper: float | None = field(default=None, compare=False, metadata={"optional": True})  # a step of the agent


@dataclass(frozen=True)
class Bodies(Study[Task, BodyRun]):
    """From pixels to places: bodies in MiniGrid

    In rooms of MiniGrid, from a view of seven by seven tiles in pixels: in how many low-level steps has a body seen
    nine tenths of the tiles, entered every room, reached a white tile; does it find itself again after it was
    put elsewhere, turned, without a word; and what of errors, and of environments that nobody here wrote?
    """

    name = "minigrid"
    agents = 20
    notes = (
        "Rooms of 4 by 4 tiles, passages of 5, doors in the middle, offsets at random, four floor colours at random.",
        "The authors' shares are of more than 30 runs, within 18 steps a tile; no run here came near that.",
        "Flat frontier: nearest-frontier search over tiles, which walks to the tile that it chose.",
        "Eager frontier: the same, but it chooses anew at every step.",
        "White tile: halls of 3x4; known: explored before, then put elsewhere with a random heading, without a word.",
        "Noise: pixels 40 of 255, gain 10 %, slips 20 %.",
        "Errors: of open ways 5 % are missed, of all ways 2 % flipped, of moves 10 % fail silently; "
        "done is then: complete within twice the moves of the same seed without errors.",
        "MiniGrid's own by name: the mission fulfilled within the environment's steps.",
        "Time: done within 2 ms a low step (RGB, MiniGrid's own part included) and 5 ms a step of the agent.",
    )

    cases: tuple[str, ...] = CASES

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        return [(case, seed) for case in self.cases for seed in seeds]

    def run(self, task: Task, settings: Settings) -> BodyRun:
        case, seed = task
        if case.startswith("white"):
            world = load_embodied("3x4", view="rgb", white=True, seed=seed, turned=True)
            found = navigate(world, seed, goal="white", known=case != "white", settings=settings)
            return BodyRun(case, seed, found.reached, found.low_level_steps, found.low_level_oracle)
        if case == "kidnapped":
            moved = kidnap(load_embodied("3x4", view="rgb", seed=seed, turned=True), seed, settings=settings)
            return BodyRun(case, seed, moved.recovered and moved.map_intact is True)
        if case in IDS:
            found = run_id(IDS[case], seed, errand=True, settings=settings)
            bot = _bot(IDS[case], seed) if case in ("BabyAI-GoTo", "GoToObjMaze") else None
            return BodyRun(case, seed, found.reached, found.low_level_steps, bot_steps=bot)
        if case == ROOMS:
            return BodyRun(case, seed, *_rooms_entered(seed, settings))
        from ...body import embodied  # MiniGrid, which the other studies can do without

        if case == ALIKE:
            one, other = (explore(embodied("3x3", view=view), seed, settings=settings) for view in ("symbolic", "rgb"))
            return BodyRun(case, seed, one == other, other.low_level_steps, other.low_level_oracle)
        if case in ERRING:
            maze = embodied(case.partition(", ")[2])
            without = explore(maze, seed, settings=settings).steps_to_complete
            moves = explore(NoisyWorld(maze, **ERRORS), seed, settings=settings, max_steps=MOST).steps_to_complete
            there = moves is not None and without is not None and moves <= 2 * without
            return BodyRun(case, seed, there, moves=moves, moves_without=without)
        if case == TIME:
            low, upper = _times(embodied(_hall("3x4", seed), view="rgb"), seed, settings)
            return BodyRun(case, seed, low <= 2.0 and upper <= 5.0, ms_low=low, ms_upper=upper)
        if case in NOISY:
            world = embodied(case.rpartition(", ")[2], view="rgb", most=12, noise=NOISE)
        else:
            size, most = (case, 4) if case in SIZES else ("3x3", 12)
            world = embodied(_hall(size, seed), view="rgb", most=most)
        seen = explore(world, seed, settings=settings, max_steps=MOST)
        complete, share = seen.steps_to_complete is not None, seen.tiles_seen or 0.0
        there = share >= SEEN if case in SIZES else complete
        flat = [_flat(case, seed, eager=eager) for eager in (False, True)] if case in SIZES else [None, None]
        low = seen.low_level_steps, seen.low_level_oracle, seen.low_level_steps_to_see
        return BodyRun(case, seed, there, *low, *flat)

    def summarise(self, rows: Sequence[BodyRun]) -> Findings:
        table = [_row(case, [row for row in rows if row.case == case]) for case in self.cases]
        lines = ["  ".join(f"{key} {'-' if value is None else value}" for key, value in row.items()) for row in table]
        failed = [f"{row.case}, seed {row.seed}: not there" for row in rows if not row.done]
        caption = "Runs that got there, and low-level steps (means)."
        tables = [Table.of("minigrid_cases", table, caption)]
        json = {"runs": rows, "summary": table}
        return Findings(json, lines, {"minigrid_shares": partial(_shares, rows)}, tables, failed)


def _hall(size: str, seed: int) -> Maze:
    rows, columns = map(int, size.split("x"))
    made = hall(rows, columns, sights=COLOURS, rng=np.random.default_rng(seed))
    return Maze(size, dict(made.sights), made.walls)


def _flat(size: str, seed: int, *, eager: bool) -> int | None:
    """Steps until nearest-frontier search over tiles has seen nine tenths; None if it never has."""
    env, agent = mg.rooms_env(_hall(size, seed)), TileFrontier(eager=eager)
    (seen, _), ended = env.reset(seed=seed), False
    while TENTHS not in env.tally.shares and not ended:
        seen, _, _, ended, _ = env.step(agent.step(seen))
    return env.tally.shares.get(TENTHS)


def _row(case: str, runs: Sequence[BodyRun]) -> dict[str, Value]:
    both = [(run.low_level_steps, run.low_level_oracle) for run in runs if run.low_level_steps and run.low_level_oracle]
    least = sum(b for _, b in both)
    return {
        "case": case,
        "runs": len(runs),
        "done": sum(run.done for run in runs),
        "authors": AUTHORS.get(case),
        "steps to see 90 %": _rounded(mean(run.low_level_steps_to_see for run in runs)),
        "flat frontier": _rounded(mean(run.flat_to_see for run in runs)),
        "eager frontier": _rounded(mean(run.eager_to_see for run in runs)),
        "steps to all rooms or goal": None if not both else round(sum(a for a, _ in both) / len(both), 1),
        "over the fewest": round(sum(a for a, _ in both) / least, 3) if least else None,
        **_others(runs),
    }


def _others(runs: Sequence[BodyRun]) -> dict[str, Value]:
    """What only some of the cases have."""
    own = mean(run.low_level_steps for run in runs if run.bot_steps is not None)
    bot, without = mean(run.bot_steps for run in runs), mean(run.moves_without for run in runs)
    moves = mean(run.moves for run in runs)
    return {
        "steps": _rounded(mean(run.low_level_steps for run in runs if run.done)),
        "over BabyAI's bot": round(own / bot, 3) if own and bot else None,
        "moves over those without errors": round(moves / without, 2) if moves and without else None,
        "ms a low step": _rounded(mean(run.ms_low for run in runs)),
        "ms an upper step": _rounded(mean(run.ms_upper for run in runs)),
    }


def _bot(name: str, seed: int) -> int | None:
    """Steps of BabyAI's own bot; None where it fails."""
    import gymnasium as gym
    from minigrid.utils.baby_ai_bot import BabyAIBot

    env: Any = gym.make(name, disable_env_checker=True)
    with redirect_stdout(StringIO()):  # BabyAI tells of what it tried in vain
        env.reset(seed=seed)
    bot, steps, done, reward = BabyAIBot(env), 0, False, 0.0
    while not done:
        _, reward, terminated, truncated, _ = env.step(bot.replan())
        steps, done = steps + 1, terminated or truncated
    return steps if reward > 0 else None


def _rooms_entered(seed: int, settings: Settings) -> tuple[bool, int]:
    """Whether all rooms of KeyCorridorS6R3 were entered, the locked one too, and in how many low-level steps."""
    from ...body import RegisteredWorld

    world, inside = RegisteredWorld("MiniGrid-KeyCorridorS6R3-v0"), set[Any]()
    grid: Any = world.env.unwrapped
    act = world.env.step

    def step(action: Any) -> Any:
        done = act(action)
        room = grid.room_from_pos(*map(int, grid.agent_pos))
        inside.update([room.top] if room.pos_inside(*map(int, grid.agent_pos)) else [])
        return done

    world.env.step = step
    agent, (seen, _) = Agent(world.motions, settings=settings, seed=seed), world.reset(seed=seed)
    for _ in range(MOVES):
        seen, *_ = world.step(agent.step(seen))
        if len(inside) == grid.num_rows * grid.num_cols:
            return True, world.low_level_steps
    return False, world.low_level_steps


def _times(world: Any, seed: int, settings: Settings) -> tuple[float, float]:
    """Milliseconds of processor time that a low step and a step of the agent take, on average."""
    agent, (seen, _) = Agent(world.motions, settings=settings, seed=seed), world.reset(seed=seed)
    seen, *_ = world.step(agent.step(seen))  # what is imported and drawn up once counts for no step
    upper, low, begin = 0.0, 0.0, world.low_level_steps
    for _ in range(UPPER):
        start = process_time()
        action = agent.step(seen)
        middle = process_time()
        seen, *_ = world.step(action)
        upper, low = upper + middle - start, low + process_time() - middle
    return round(1e3 * low / (world.low_level_steps - begin), 3), round(1e3 * upper / UPPER, 3)


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 1)


def _shares(rows: Sequence[BodyRun]) -> Figure:
    figure, (ax,) = panels("Runs that got there", (1, 1), (12.0, 5.2))
    for at, case in enumerate(CASES):
        runs: list[Any] = [row for row in rows if row.case == case]
        if runs:
            plot_bars(ax, [at - 0.2], [wilson(sum(run.done for run in runs), len(runs))], width=0.38, color=BLUE)
        if case in AUTHORS:
            ax.bar([at + 0.2], [AUTHORS[case]], width=0.38, color=GREY)
    ax.set_xticks(range(len(CASES)), list(CASES), rotation=35, ha="right")
    ax.set_ylabel("share (95 % Wilson); grey: the authors")
    return figure

"""What a step costs, part by part, and from what: a model of the cost, fitted to some walks and tried on others.

    python benchmarks/cost_model.py
    python benchmarks/cost_model.py --json cost_model.json

`parts`: milliseconds a step of each part of the agent, 4x4, look-ahead 6. `model`: what each of `CAUSES` costs, by
least squares without negative costs, over walks with look-aheads 2 to 14, four generators, known and lost; each walk is
made some times, and the least counts. The error is that of other walks, the correlation that of logarithms.
`arithmetic`: how long the multiplications of one rollout would take at the speed of a large matrix product, and how
many calls of functions a step makes.
"""

from __future__ import annotations

import cProfile
import pstats
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from cogmap.agent import Agent, Settings
from cogmap.agent import agent as agent_module
from cogmap.agent.mapper import Mapper
from cogmap.agent.recognition import Recognition
from cogmap.inference.filter import FEW
from cogmap.planning import POLICIES, Choice, LocalModel, MapGuided, Planner
from cogmap.planning import planner as planner_module
from cogmap.planning.prefixes import Prefixes, prefixes_of
from cogmap.worlds import MazeEnv, labyrinth, load_world
from known import known_agent
from machine import arguments, positive, write_json
from numpy.typing import NDArray
from scipy.optimize import nnls

Row = dict[str, Any]
Floats = NDArray[np.float64]
PARTS: dict[str, tuple[Any, str]] = {
    "infer": (Agent, "_infer"),
    "hypotheses": (Recognition, "take_in"),
    "window": (Agent, "_remember"),
    "learn and grow": (Mapper, "learn"),
    "plan: tables": (planner_module, "local_model"),
    "plan: policies": (MapGuided, "make"),
    "plan: rollout": (planner_module, "evaluate"),
    "plan: choice": (Choice, "choose"),
    "record": (agent_module, "record_of"),
}
"""Each part of a step, and the function that does it."""


class Clocks:
    """Seconds spent in each part, while `with` it."""

    def __init__(self) -> None:
        self.spent = dict.fromkeys(PARTS, 0.0)
        self._were: list[tuple[Any, str, Any]] = []

    def __enter__(self) -> Clocks:
        for part, (owner, name) in PARTS.items():
            function = getattr(owner, name)
            self._were.append((owner, name, function))
            setattr(owner, name, self._timed(part, function))
        return self

    def __exit__(self, *error: object) -> None:
        for owner, name, function in self._were:
            setattr(owner, name, function)

    def _timed(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*given: Any, **options: Any) -> Any:
            begin = time.perf_counter()
            try:
                return function(*given, **options)
            finally:
                self.spent[part] += time.perf_counter() - begin

        return timed


@dataclass(frozen=True, slots=True)
class Walk:
    """An agent in a world, moved silently every so often (0: never)."""

    agent: Agent
    world: MazeEnv
    steps: int
    moved_every: int = 0

    def __iter__(self) -> Iterator[Agent]:
        rng, observation = np.random.default_rng(0), self.world.observe()
        for step in range(self.steps):
            if self.moved_every and step % self.moved_every == self.moved_every - 1:
                observation = self.world.displace(self.world.maze.rooms[int(rng.integers(len(self.world.maze.rooms)))])
            action = self.agent.step(observation)
            yield self.agent
            observation, *_ = self.world.step(action)


def exploring(
    seed: int, name: str = "4x4", steps: int = 60, *, policies: str = "map_guided", look_ahead: int = 6
) -> Walk:
    """A walk of an agent that knows nothing yet."""
    world = load_world(name)
    world.reset(seed=seed)
    planner, settings = Planner(policies=POLICIES[policies]()), Settings(look_ahead=look_ahead)
    return Walk(Agent(world.motions, planner=planner, settings=settings, seed=seed), world, steps)


def lost(seed: int, rooms: int = 3000) -> Walk:
    """A walk in a maze that is known, with silent moves."""
    rng = np.random.default_rng(seed)
    maze = labyrinth(rooms, loops=0.1, sights=30, rng=rng)
    world, start = MazeEnv(maze), maze.rooms[int(rng.integers(rooms))]
    world.reset(options={"start": start})
    return Walk(known_agent(maze, start), world, 60, moved_every=6)


def walks(seed: int) -> Iterator[Walk]:
    """Short and long look-aheads, few and many policies, certain and lost."""
    for look_ahead in (2, 4, 6, 10, 14):
        yield exploring(seed, look_ahead=look_ahead)
        yield exploring(seed, "tolman", look_ahead=look_ahead)
    for policies in ("self_avoiding", "l_shaped", "exhaustive"):
        for look_ahead in (3, 4, 5):
            yield exploring(seed, steps=25, look_ahead=look_ahead, policies=policies)
    yield lost(seed)


CAUSES = ("step", "level", "1000 places", "1000 expected visits", "move considered", "1000 candidates")
PLANNING, INFERENCE = (0, 1, 2, 3), (0, 4, 5)
"""What planning depends on, and what inference does (indices of `CAUSES`)."""


def causes(agent: Agent) -> list[float]:
    """How much there was of each of `CAUSES` at the last step."""
    model, map_, belief = agent.plan.model, agent.map, agent.belief
    visits = visits_of(model, prefixes_of(agent.plan.policies))
    visited = len(map_.visited_places)
    showing = len(map_.sights_sensed[0].candidates(map_.sights.index(agent.trace[-1].sight))[0])
    candidates = (showing if 2 * showing + FEW < visited else visited) if belief.examined else 0
    levels, places = agent.plan.policies.shape[1], len(model.places)
    return [1.0, levels, 1e-3 * places, 1e-3 * visits, float(belief.examined), 1e-3 * candidates]


def visits_of(model: LocalModel, tree: Prefixes) -> int:
    """Pairs of a prefix and a place that it may have visited."""
    belief = np.zeros((len(tree), len(model.places)))
    visited = np.zeros(belief.shape, dtype=np.bool_)
    belief[0] = model.belief
    for above, begin, end in tree.levels:
        parent = tree.parent[begin:end]
        belief[begin:end] = model.B.predicted(belief[above:begin], parent - above, tree.action[begin:end])
        visited[begin:end] = visited[parent] | (belief[begin:end] > 0.0)
    return int(visited.sum())


def observed(seed: int, times: int) -> tuple[Floats, Floats]:
    """`[n, C]` causes of each step, and `[n, 2]` milliseconds of planning and of inference, the least of some times."""
    found: list[list[float]] = []
    least: Floats | None = None
    for _ in range(times):
        found, took = _observed(seed)
        least = took if least is None else np.minimum(least, took)
    assert least is not None
    return np.array(found), least


def _observed(seed: int) -> tuple[list[list[float]], Floats]:
    found: list[list[float]] = []
    took: list[list[float]] = []
    for walk in walks(seed):
        with Clocks() as clocks:
            before = dict(clocks.spent)
            for agent in walk:
                spent = {part: clocks.spent[part] - before[part] for part in PARTS}
                before = dict(clocks.spent)
                planning = sum(seconds for part, seconds in spent.items() if part.startswith("plan"))
                found.append(causes(agent))
                took.append([1e3 * planning, 1e3 * (spent["infer"] + spent["hypotheses"])])
    return found, np.array(took)


def fitted(name: str, which: Sequence[int], at: int, known: tuple[Floats, Floats], new: tuple[Floats, Floats]) -> Row:
    """Coefficients from the first walks, and how well they tell what the others took."""
    X, y = known[0][:, which], known[1][:, at]
    coefficients, _ = nnls(X / y[:, None], np.ones(len(y)))  # errors count in proportion
    told, took = new[0][:, which] @ coefficients, new[1][:, at]
    error = np.abs(told - took) / took
    return {
        "what": name,
        "ms_each": {CAUSES[i]: round(float(c), 4) for i, c in zip(which, coefficients, strict=True)},
        "steps": len(took),
        "from_ms": float(took.min()),
        "to_ms": float(took.max()),
        "median_error": float(np.median(error)),
        "p90_error": float(np.percentile(error, 90)),
        "correlation": float(np.corrcoef(np.log(np.maximum(told, 1e-3)), np.log(took))[0, 1]),
    }


def parts(runs: int) -> list[Row]:
    """Milliseconds a step of each part."""
    for _ in exploring(99, steps=100):  # warm
        pass
    begin = time.perf_counter()
    with Clocks() as clocks:
        for seed in range(runs):
            for _ in exploring(seed, steps=100):
                pass
    every = (time.perf_counter() - begin) / runs * 10.0
    rows = [{"part": part, "ms": 10.0 * spent / runs} for part, spent in clocks.spent.items()]
    rows.append({"part": "all else, the world included", "ms": every - sum(row["ms"] for row in rows)})
    return [{**row, "share": row["ms"] / every} for row in rows]


def arithmetic(runs: int) -> Row:
    """Multiplications of a rollout, the time they would take, and the calls of a step."""
    many: list[float] = []
    for seed in range(runs):
        for agent in exploring(seed, steps=100):
            (outcomes, places), kinds = agent.plan.model.A.shape, len(agent.plan.model.motions)
            prefixes = len(prefixes_of(agent.plan.policies))
            many.append(prefixes * places * (kinds * places + outcomes + kinds + 8))
    profile = cProfile.Profile()
    profile.runcall(lambda: [agent.steps for seed in range(runs) for agent in exploring(seed, steps=100)])
    calls = pstats.Stats(profile).total_calls  # type: ignore[attr-defined]
    size = 512
    a = np.ones((size, size))
    a @ a
    begin = time.perf_counter()
    for _ in range(10):
        a @ a
    rate = 10 * size**3 / (time.perf_counter() - begin)
    return {
        "multiplications": float(np.mean(many)),
        "ms_at_full_speed": 1e3 * float(np.mean(many)) / rate,
        "calls_a_step": calls / (100 * runs),
    }


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = arguments(__doc__)
    parser.add_argument("--runs", type=positive, default=5)
    parser.add_argument("--times", type=positive, default=3, help="that each walk of the model is made")
    asked = parser.parse_args(given)
    result: Row = {"parts": parts(asked.runs), "arithmetic": arithmetic(asked.runs)}
    for row in result["parts"]:
        print(f"{row['part']:30} {row['ms']:6.3f} ms  {row['share']:4.0%}")
    print(*(f"{name} {value:.4g}" for name, value in result["arithmetic"].items()), sep="\n")
    known, new = (observed(seed, asked.times) for seed in (0, 1))
    result["model"] = [
        fitted("planning", PLANNING, 0, known, new),
        fitted("inference", INFERENCE, 1, known, new),
    ]
    for row in result["model"]:
        print(row)
    write_json(asked.json, result)


if __name__ == "__main__":
    main()

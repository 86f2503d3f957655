"""Steps that are broken off anywhere: the agent is as before the step or as after it, and walks on as its twin does.

    python benchmarks/interruptions.py
    python benchmarks/interruptions.py doubting parts --trials 3000 --seed 1 --json interruptions.json

Forms are an explorer, one that is moved now and then, one that errs in everything and is in doubt, one that is lost,
one that is told all that percepts can say, one without poses, one in the plane, one whose frame turns, and the paper's;
`parts` fails at a call of a part or an observation of somebody else instead, all of whose methods may fail. Each trial
breaks the next step of an agent off before a random line of the library (`parts`: at a random call), compares all that
the next steps depend on, and has it take `--on` steps beside a twin that was left alone. `EACH` trials, in forks of
the process, begin with the same agent, which then walks a random number of steps to the next ones.
"""

from __future__ import annotations

import copy
import os
import random
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from cogmap.agent import Agent, Settings, TurningAgent
from cogmap.model import Bearings, Features, NoPose, Plane, Sight, Ways
from cogmap.planning import Planner
from cogmap.worlds import GraphWorld, ListedWays, MazeEnv, NoisyWorld, hall, load_world
from machine import arguments, positive, write_json

from cogmap import UNSEEN

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
from failing import CLOCK, Failing, Observation, agent_of_somebody
from interrupts import content, lines_of, was_interrupted

Seen = dict[str, Any]
Walk = Iterator[tuple[Agent, Seen]]
LONGEST = 40

EACH = 10
"""Trials that begin with one agent."""


def walk(world: Any, agent: Agent, see: Callable[[Seen], Seen] = dict, *, moved: int = 0, seed: int = 0) -> Walk:
    """The agent before each step, and what it is about to see."""
    rng = np.random.default_rng(seed)
    observation, _ = world.reset(seed=seed)
    for step in range(1, 10**9):
        seen = see(observation)
        yield agent, seen
        observation = world.step(agent.step(seen))[0]
        if moved and step % moved == 0:
            rooms = world.unwrapped.maze.rooms
            observation = world.displace(rooms[int(rng.integers(len(rooms)))])


def explorer(seed: int) -> Walk:
    world = load_world("4x4_alias")
    return walk(world, Agent(world.motions, settings=Settings(look_ahead=2), seed=seed), seed=seed)


def moved(seed: int) -> Walk:
    world = load_world("3x3_alias")
    return walk(world, Agent(world.motions, settings=Settings(forgetting=0.05), seed=seed), moved=5, seed=seed)


def doubting(seed: int) -> Walk:
    world: Any = NoisyWorld(load_world("3x3_alias"), sight=0.1, door=0.1, slip=0.1, fail=0.1, moved=0.05)
    return walk(world, Agent(world.motions, settings=Settings(look_ahead=2), seed=seed), seed=seed)


def lost(seed: int) -> Walk:
    world = MazeEnv(hall(4, 5, sights=1, rng=np.random.default_rng(seed)))
    agent = Agent(world.motions, settings=Settings(look_ahead=2), seed=seed)
    return walk(world, agent, lambda seen: {**seen, "moved": agent.steps % 9 == 8}, seed=seed)


def told(seed: int) -> Walk:
    world, rng = load_world("3x3_alias"), np.random.default_rng(seed)
    sensors = [Sight(), Sight("smell"), Features("view", size=3), Ways()]
    agent, kinds = Agent(world.motions, sensors=sensors, seed=seed), rng.normal(size=(3, 3))

    def see(seen: Seen) -> Seen:
        number = int(seen["sight"])
        soft = {number: 0.7, (number + 1) % 5: 0.3} if rng.random() < 0.3 else number
        smell, said = "abc"[number % 3] if rng.random() < 0.7 else UNSEEN, {"cost": 2.0} if agent.steps else {}
        return {**seen, "sight": soft, "smell": smell, "view": kinds[number % 3] + 0.1 * rng.normal(size=3), **said}

    return walk(world, agent, see, seed=seed)


def without_poses(seed: int) -> Walk:
    world = load_world("3x3")
    return walk(world, Agent(world.motions, pose=NoPose(), seed=seed), seed=seed)


def plane(seed: int) -> Walk:
    graph, rng = nx.grid_2d_graph(3, 4), np.random.default_rng(seed)
    for number, node in enumerate(graph):
        graph.nodes[node].update(sight=number % 2, position=tuple(10.0 * np.array(node) + rng.uniform(-2, 2, 2)))
    world = ListedWays(GraphWorld.from_networkx(nx.convert_node_labels_to_integers(graph).to_directed()))
    sensors = [Sight(), Ways(learned=True), Bearings()]
    return walk(world, Agent(world.motions, sensors=sensors, pose=Plane(), seed=seed), seed=seed)


def turning(seed: int) -> Walk:
    world = load_world("3x3")
    agent = TurningAgent(world.motions, settings=Settings(look_ahead=2), seed=seed)
    return walk(world, agent, lambda seen: {**seen, "turn": 90 * (agent.steps % 7 == 6)}, moved=9, seed=seed)


def paper(seed: int) -> Walk:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, planner=Planner.paper(), settings=Settings.paper(look_ahead=3), seed=seed)
    return walk(world, agent, seed=seed)


def parts(seed: int) -> Walk:
    world, rng = load_world("3x3_alias"), np.random.default_rng(seed)

    def see(seen: Seen) -> Seen:
        return {**seen, "view": np.array([float(seen["sight"]), 1.0]) + 0.01 * rng.normal(size=2)}

    return walk(world, agent_of_somebody(seed), see, moved=11, seed=seed)


FORMS: dict[str, Callable[[int], Walk]] = {
    "explorer": explorer, "moved": moved, "doubting": doubting, "lost": lost, "told": told,
    "no poses": without_poses, "plane": plane, "turning": turning, "paper": paper, "parts": parts,
}  # fmt: skip


class Left:
    """What becomes of an agent in the next steps if it is left alone.

    Args:
        agent: is left as it is.
        seen: what it senses in all of them.
        calls: whether calls of parts of somebody else are counted, or lines.
        on: steps after the first.
    """

    def __init__(self, agent: Agent, seen: Seen, *, calls: bool, on: int) -> None:
        self.before, self._calls = _content(agent), calls
        counted = copy.deepcopy(agent)
        CLOCK.set(None)
        lines = 0 if calls else lines_of(lambda: counted.step(seen))
        if calls:
            counted.step(Observation(seen))
        self.places = CLOCK.calls if calls else lines
        twin = copy.deepcopy(agent)
        self.actions, self.after = [twin.step(seen)], _content(twin)
        self.actions += [twin.step(seen) for _ in range(on)]
        self.later = _content(twin)

    def verdict(self, torn: Agent, seen: Seen, at: int) -> str:
        """`before`, `after`, or what is wrong, of an agent whose step is broken off at a line or call."""
        found = "after"
        if self._broken_off(torn, seen, at) and _content(torn) == self.before:
            found = "before"
            if torn.step(seen) != self.actions[0]:
                return "goes on otherwise"
        elif _content(torn) != self.after:
            return "between"
        if [torn.step(seen) for _ in self.actions[1:]] != self.actions[1:]:
            return "walks on otherwise"
        return found if _content(torn) == self.later else "is another later"

    def _broken_off(self, agent: Agent, seen: Seen, at: int) -> bool:
        if not self._calls:
            return was_interrupted(lambda: agent.step(seen), at)
        CLOCK.set(at)
        try:
            agent.step(Observation(seen))
        except Failing:
            return True
        finally:
            CLOCK.set(None)
        return False


def forked(work: Callable[[], str]) -> str:
    """What a fork of this process answers; why it ended, where it answers nothing."""
    ours, theirs = os.pipe()
    child = os.fork()
    if not child:
        try:
            os.write(theirs, work().encode())
        except BaseException as error:
            os.write(theirs, f"failed: {type(error).__name__} {error}"[:200].encode())
        finally:
            os._exit(0)
    os.close(theirs)
    with os.fdopen(ours, "rb") as answers:
        said = answers.read().decode()
    _, status = os.waitpid(child, 0)
    return said or f"ended with {status}"


def _content(agent: Agent) -> Any:
    if not agent._recognising:
        header, arrays = agent.state()
        return header, {name: values.tobytes() for name, values in arrays.items()}
    return (*content(agent), agent.state()[0].get("turning"))


def main(given: Sequence[str] | None = None) -> int:
    """Break off, compare and print; 1 where an agent was left torn."""
    parser = arguments(__doc__, forms=FORMS)
    parser.add_argument("--trials", type=positive, default=50, help="of each form")
    parser.add_argument("--on", type=positive, default=2, help="steps that are walked on afterwards")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args(given)
    rows: list[dict[str, Any]] = []
    for form in asked.forms:
        rng, begun = random.Random(f"{form} {asked.seed}"), time.monotonic()
        found: dict[str, int] = {}
        walking, walked = FORMS[form](asked.seed), LONGEST
        for trial in range(0, asked.trials, EACH):
            if walked >= LONGEST:
                walking, walked = FORMS[form](asked.seed + trial), 0
            for _ in range(rng.randrange(LONGEST // 4)):
                next(walking)
                walked += 1
            agent, seen = next(walking)
            left = Left(agent, seen, calls=form == "parts", on=asked.on)
            for _ in range(min(EACH, asked.trials - trial)):
                at = rng.randrange(1, left.places + 1)
                result = forked(partial(left.verdict, agent, seen, at))
                found[result] = found.get(result, 0) + 1
        torn = asked.trials - found.get("before", 0) - found.get("after", 0)
        rows.append({"form": form, "trials": asked.trials, "torn": torn, "found": found})
        each = (time.monotonic() - begun) / asked.trials
        print(f"{form:10} torn {torn} of {asked.trials}  {found}  {each:.2f} s each", flush=True)
    write_json(asked.json, {"seed": asked.seed, "rows": rows})
    return int(any(row["torn"] for row in rows))


if __name__ == "__main__":
    sys.exit(main())

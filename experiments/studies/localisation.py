"""The paper's study of localisation: put at the foot of an aliased T, where does the agent think it is?"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...agent import Agent, Settings
from ...views import BLUE, GREEN, SKY, VERMILION, plot_belief
from ...worlds import MAZES, Label, MazeEnv, Position, shortest_path
from .. import Moment, Session, explored, mean, number, run, spread, std
from .figures import Figure, ImaginedPath, Look, imagined_paths, legend_below, panels, plot_line, plot_ways
from .intervals import Interval, bootstrap
from .study import Findings, Study, failed_seeds

MAZE = MAZES["t_maze_alias"]
FOOT: Position = (3, 2)
GOAL: Label = 0
WEIGHT = 3.0  # log preference of the goal, in nats
MOST = 40  # moves after which the agent has not found the goal
CANDIDATE = 0.1  # a place that holds as much of the belief is one where the agent may be
SHOWN = ("silent_doors", "told_sights")  # conditions of which the first agent is shown step by step
MOST_ROWS = 8


CONDITIONS: dict[str, Look] = {
    "silent_doors": {"color": BLUE, "marker": "o"},
    "silent_sights": {"color": SKY, "linestyle": "--", "marker": "s"},
    "told_doors": {"color": GREEN, "linestyle": ":", "marker": "^"},
    "told_sights": {"color": VERMILION, "linestyle": "-.", "marker": "D"},
}
"""What the agent has to go by, and the look of its line. Told: P(moved) = 1 at the first observation; or else it has
its prior alone. Doors: they are evidence of where it is. The paper's is told, by sights alone."""
_BY = {"doors": "sights and doors", "sights": "sights alone"}
TEXTS = {name: f"{'not ' * name.startswith('silent')}told, {_BY[name.partition('_')[2]]}" for name in CONDITIONS}


@dataclass(frozen=True, slots=True)
class Held:
    """How probable a visited place is held."""

    place: int
    room: Position  # that it stands for
    probability: float


@dataclass(frozen=True, slots=True)
class LocalisationStep:
    """One observation after the move."""

    room: Position  # where the agent is
    sight: Label  # what it sees there
    posterior: tuple[Held, ...]  # every visited place, by room
    entropy: float  # of Q(s), in nats
    certainty: float  # the greatest Q(s)
    certain: bool  # whether that is enough to learn
    right: bool  # whether the most probable place is the true one
    candidates: int  # places with `CANDIDATE` or more
    moved: float  # P(moved_t)
    first_action: dict[str, float]  # P(first action) by name
    paths: tuple[ImaginedPath, ...]  # what the policies imagine, the most probable path first


@dataclass(frozen=True, slots=True)
class Trial:
    """The way of one agent from the foot to the goal under one condition."""

    condition: str
    steps: tuple[LocalisationStep, ...]  # every observation after the move
    reached: bool  # whether it chose to stay at the goal
    steps_to_localise: int | None  # until it was certain of the true place, from 0; None if never
    steps_certain_but_wrong: int  # observations at which it was certain of another place
    map_intact: bool  # whether at the end every true transition was still believed at 0.6 or more
    first: str  # what it believed after the first sight: "right", "wrong" or, if not certain, "split"
    moves: int


@dataclass(frozen=True, slots=True)
class LocalisationRow:
    """One agent."""

    seed: int
    start: Position  # the room where it began to explore
    steps_to_explore: int | None  # None where it gave up, and was not moved
    expected: Position  # the room in which it would have been, had nobody moved it
    trials: tuple[Trial, ...]  # one a condition, from the same map and the same room


class Localisation(Study[int, LocalisationRow]):
    """Finding out where one is

    An agent that knows the aliased T maze is put at its foot, told of it or not, with or without doors as
    evidence. How soon does it know where it is, and does it reach its goal?
    """

    name = "localisation"
    notes = (
        "The paper's agent is told that it was moved and has no likelihood of doors: the condition told, sights alone.",
        "With sights alone the belief is split over rooms that look alike, as in the paper; doors tell them apart.",
    )

    def run(self, task: int, settings: Settings) -> LocalisationRow:
        """Let it explore, and put a copy of it at the foot of the T under each condition."""
        session = explored("localisation", MAZE, task, settings=settings)
        trials = () if session.steps is None else tuple(_trial(session, condition) for condition in CONDITIONS)
        return LocalisationRow(task, session.start, session.steps, session.place, trials)

    def summarise(self, rows: Sequence[LocalisationRow]) -> Findings:
        trials = {name: [t for row in rows for t in row.trials if t.condition == name] for name in CONDITIONS}
        conditions = {name: _summary(part) for name, part in trials.items()}
        goals = [room for room in MAZE.rooms if MAZE.sights[room] == GOAL]
        shortest = min(len(shortest_path(MAZE, FOOT, room)) - 1 for room in goals)
        done = sum(row.steps_to_explore is not None for row in rows)
        summary = {"agents": len(rows), "explored": done, "shortest": shortest, "conditions": conditions}
        protocol = {"moved_to": FOOT, "goal": GOAL, "weight": WEIGHT, "candidate": CANDIDATE, "max_moves": MOST}
        json = {"world": MAZE.name, "protocol": {**protocol, "conditions": TEXTS}, "rows": rows, "summary": summary}
        ways = {f"localisation_{name}": partial(_way, trials[name][0]) for name in SHOWN if trials[name]}
        failed = failed_seeds("did not explore the maze", rows, lambda row: row.steps_to_explore is None)
        for name, part in conditions.items():
            for what in ("localised", "reached", "map_intact"):
                if part[what] < part["trials"]:
                    failed.append(f"{name}: {what.replace('_', ' ')} {part[what]} of {part['trials']}")
        figures = {**ways, "localisation_by_step": partial(_by_step, trials)} if ways else {}
        return Findings(json, _lines(summary), figures, failed=failed)


def _trial(session: Session, condition: str) -> Trial:
    own, told = session.agent.settings, condition.startswith("told")
    floor = own.priors.door_floor if condition.endswith("doors") else 0.5  # every door as likely open as blocked
    world, agent = MazeEnv(MAZE), _with(session.agent, floor, 1.0 if told else own.filter.displacement)
    agent.prefer({GOAL: WEIGHT})
    steps: list[LocalisationStep] = []
    reached = False

    def note(moment: Moment) -> bool:
        nonlocal reached
        steps.append(_step(moment, session))
        reached = moment.observation["sight"] == GOAL and moment.action == world.motions.names.index("stay")
        return reached

    first = run(world, agent, steps=1, options={"start": FOOT}, watch=note)
    if told:
        agent = _with(agent, floor, own.filter.displacement)
    if not reached:
        run(world, agent, steps=MOST, begin=first.end, watch=note)
    found = next((t for t, step in enumerate(steps) if step.certain and step.right), None)
    wrong, intact = sum(step.certain and not step.right for step in steps), session.truth.learned(agent.map)
    first_held = "split" if not steps[0].certain else "right" if steps[0].right else "wrong"
    return Trial(condition, tuple(steps), reached, found, wrong, intact, first_held, len(steps) - 1)


def _with(agent: Agent, door_floor: float, displacement: float) -> Agent:
    """A copy of the agent that believes in doors and in being moved as told here."""
    header, arrays = agent.state()
    header["settings"]["priors"]["door_floor"] = door_floor
    header["settings"]["filter"]["displacement"] = displacement
    header["settings"]["hypotheses"] = None  # the map is known, and not in question
    return Agent.from_state(header, arrays)


def _step(moment: Moment, session: Session) -> LocalisationStep:
    agent: Any = moment.agent
    belief, map_, room = agent.belief, agent.map, moment.info["position"]
    q = np.array(list(belief.places.values()))
    places = [(place, map_.position(place)) for place in map_.visited_places.tolist()]
    rooms = [(place, (session.start[0] + at[0], session.start[1] + at[1])) for place, at in places if at is not None]
    held = [Held(place, of, belief.places.get(place, 0.0)) for place, of in sorted(rooms, key=lambda item: item[1])]
    return LocalisationStep(
        room=room,
        sight=MAZE.sights[room],
        posterior=tuple(held),
        entropy=max(0.0, float(-(q * np.log(q)).sum())),
        certainty=belief.certainty,
        certain=agent.certain,
        right=belief.place == session.truth.place(map_, room),
        candidates=int((q >= CANDIDATE).sum()),
        moved=belief.moved,
        first_action=dict(zip(map_.motions.names, agent.plan.action_probability.tolist(), strict=True)),
        paths=imagined_paths(agent.plan, map_, session.start),
    )


def _summary(trials: Sequence[Trial]) -> dict[str, Any]:
    """Counts and means; None where there are none."""
    found = [trial.steps_to_localise for trial in trials]
    return {
        "trials": len(trials),
        **{name: sum(trial.first == name for trial in trials) for name in ("split", "right", "wrong")},
        "mean_candidates_first": mean(trial.steps[0].candidates for trial in trials),
        "localised": len(trials) - found.count(None),
        "mean_steps_to_localise": mean(found),
        "std_steps_to_localise": std(found),
        "mean_steps_certain_but_wrong": mean(trial.steps_certain_but_wrong for trial in trials),
        "reached": sum(trial.reached for trial in trials),
        "map_intact": sum(trial.map_intact for trial in trials),
        "mean_moves": mean(trial.moves for trial in trials if trial.reached),
        **{f"{name}_by_step": by_step(trials, name) for name in ("entropy", "candidates")},
    }


def by_step(trials: Sequence[Trial], name: str) -> list[Interval]:
    """The mean of a figure at each step, with its interval; who is done keeps the last value."""
    longest = max((len(trial.steps) for trial in trials), default=0)
    steps = [[trial.steps[min(t, len(trial.steps) - 1)] for trial in trials] for t in range(longest)]
    means = [bootstrap([float(getattr(step, name)) for step in at]) for at in steps]
    return [interval for interval in means if interval is not None]


def _lines(summary: dict[str, Any]) -> list[str]:
    lines = [
        f"{summary['explored']} of {summary['agents']} agents explored {MAZE.name}; moved to {FOOT}, sight {GOAL} "
        f"preferred, {summary['shortest']} moves away"
    ]
    for condition, part in summary["conditions"].items():
        first = ", ".join(f"{part[name]} {name}" for name in ("split", "right", "wrong"))
        lines += [
            f"{TEXTS[condition]}{' (the paper)' if condition == 'told_sights' else ''}:",
            f"  after the first sight {first}; {number(part['mean_candidates_first'])} rooms to choose from (mean)",
            f"  certain of the right room after {spread(part, 'steps_to_localise')} steps "
            f"({part['localised']}/{part['trials']}), "
            f"certain but wrong at {number(part['mean_steps_certain_but_wrong'])}; "
            f"at the goal after {number(part['mean_moves'])} moves ({part['reached']}/{part['trials']}), "
            f"map intact {part['map_intact']}/{part['trials']}",
        ]
    return lines


def _way(trial: Trial) -> Figure:
    from matplotlib.figure import Figure

    steps = trial.steps[:MOST_ROWS]
    names = {room: f"{sight}\n{room[0]}, {room[1]}" for room, sight in MAZE.sights.items()}
    figure = Figure(figsize=(11.0, 2.35 * len(steps) + 0.9), layout="constrained")
    figure.suptitle(f"The first agent, moved to the foot of the T: {TEXTS[trial.condition]}", fontsize=13)
    halves: Any = figure.subfigures(1, 2, width_ratios=(1.6, 1.0))  # so that the mazes are not cut to the bars
    axes = [half.subplots(len(steps), 1, squeeze=False).ravel() for half in halves]
    for count, (step, bars, maze) in enumerate(zip(steps, *axes, strict=True)):
        belief = {names[held.room]: held.probability for held in step.posterior}
        rooms = f"{step.candidates} room{'s' * (step.candidates > 1)} with {CANDIDATE:.0%} or more"
        plot_belief(belief, true=names[step.room], threshold=Localisation.settings.certainty, ax=bars)
        bars.set_title(f"step {count}: sees {step.sight}; entropy {step.entropy:.2f} nats, {rooms}", fontsize=11)
        bars.set_ylabel("Q(s)")
        plot_ways(maze, MAZE, imagined=step.paths, way=[step.room])
    halves[0].supxlabel("sight and room of each place (▲: the true one)", fontsize=11)
    halves[1].supxlabel("imagined paths, darker: more probable (✕: the agent)", fontsize=11)
    return figure


def _by_step(trials: dict[str, list[Trial]]) -> Figure:
    from matplotlib.ticker import MaxNLocator

    count = len(trials["told_sights"])
    title = f"Mean over {count} agent{'s' * (count > 1)}, with 95 % intervals (bootstrap)"
    figure, axes = panels(title, (1, 2), (11.0, 4.6))
    labels = {"entropy": "entropy of Q(s) (nats)", "candidates": f"rooms with {CANDIDATE:.0%} or more"}
    for ax, (name, label) in zip(axes, labels.items(), strict=True):
        for index, (condition, look) in enumerate(CONDITIONS.items()):
            values = by_step(trials[condition], name)
            moves = [step + 0.05 * (index - 1.5) for step in range(len(values))]  # equal ones would hide one another
            plot_line(ax, moves, values, label=TEXTS[condition], markersize=5, **look)
        ax.set(xlabel="moves since it was put at the foot of the T", ylabel=label)
        ax.set_ylim(bottom=-0.04 * ax.get_ylim()[1])
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    legend_below(figure, axes[0], 4)
    return figure

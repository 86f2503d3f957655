"""The study `identity`: is a place recognised, on toruses, through portals, under noise, and without positions?"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, fields
from functools import partial
from itertools import count
from time import perf_counter
from typing import Any

import numpy as np

from ...agent import Agent, Settings
from ...views import BLUE, GREEN, VERMILION
from ...worlds import MAZES, MazeEnv, NoisyWorld, UnseenWays, distinguishable, hall, portal_hall, ring, torus
from .. import Ledger, Moment, Parts, Record, Session, Trail, Verdict, kept_rows, mean, set_out
from .figures import Figure, Look, legend_below, panels, plot_bars, plot_line, shares_axis
from .grid import LOOKS, NONE, Steps
from .intervals import Share, wilson
from .study import Findings, Kept
from .tables import Table, Value

FEW, MOST_BESIDE = 5, 600  # agents of each other kind at most, and steps of their walks: their trainings are slow
LATE = 200  # from this step on an agent should know where it is
SURE = 0.99
BINS = (0.5, 0.6, 0.7, 0.8, 0.9)  # lower ends of those of the reliability diagram
COUNTED = {"belongs": "it belongs to the true room", "right": "and is no new place in a known room"}
"""When a place counts as right."""
ALONG = "_along"  # behind the name of a graph that learns on the walks of `cogmap`
NAMES = {name: f"{LOOKS[name.removesuffix(ALONG)][0]}{', our walks' * name.endswith(ALONG)}" for name in (
    "cogmap", "cscg", "cscg_pose", f"cscg{ALONG}", f"cscg_pose{ALONG}"
)}  # fmt: skip
RATES = {"sight": "sight_misread", "door": "way_misread", "fail": "fails", "slip": "astray", "moved": "moved"}
"""What each kind of noise is called among the rates that an agent learns."""
DRAWN = ("torus", "portal", "moved", "all at once", "no positions")
"""Beginnings of cases: of the first of each, the first walk is drawn step by step."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One row of the table."""

    world: Callable[[int], Any]  # makes it, by seed
    steps: int  # that are walked
    held: str  # what is to hold of 20 agents
    noise: Mapping[str, float] = field(default_factory=dict[str, float])
    moves: int = 0  # silent ones, the first after 3 to 12 steps, the others 10 to 40 after the one before
    pose: str | None = None  # of the agent
    blind: bool = False  # no sensor tells which ways are open
    beside: bool = False  # clone-structured graphs are tried as well

    def made(self, seed: int) -> Any:
        """The world with all that goes wrong in it."""
        world = UnseenWays(self.world(seed)) if self.blind else self.world(seed)
        return NoisyWorld(world, **self.noise) if self.noise else world


def _maze(name: str, seed: int) -> Any:
    return MazeEnv(MAZES[name])


def _drawn(family: Callable[..., Any], seed: int) -> Any:
    """A world in which all places differ in behaviour, or nobody could tell them apart."""
    worlds = (family(seed=1000 * seed + number) for number in count())
    return next(world for world in worlds if distinguishable(world.chart))


def _hall(seed: int) -> Any:
    return MazeEnv(hall(6, 8, sights=4, rng=np.random.default_rng(seed)))


def _cases() -> dict[str, Case]:
    found: dict[str, Case] = {}

    def add(name: str, world: Callable[[int], Any], steps: int, held: str, **rest: Any) -> None:
        found[name] = Case(world=world, steps=steps, held=held, **rest)

    for n, by in ((3, 20), (4, 34), (5, 50)):
        six = partial(_drawn, partial(torus, n, n, sights=6))
        add(f"torus {n}x{n}", partial(_drawn, partial(torus, n, n)), 10 * n * n, f"20, from step {by}", beside=True)
        add(f"torus {n}x{n}, 6 labels", six, 5 * n * n, "20")
        if n > 3:
            add(f"torus {n}x{n}, mod 3", partial(_drawn, partial(torus, n, n, diagonal=3)), 10 * n * n, "19")
    add("portal in 4x4", partial(_drawn, partial(portal_hall, 4, 4)), 160, "20, from step 19", beside=True)
    add("3 portals in 5x5", partial(_drawn, partial(portal_hall, 5, 5, portals=3, sights=12)), 125, "20")
    add("ring of one-way ways", partial(_drawn, partial(ring, 6)), 30, "20")
    for name in ("3x3", "4x4", "4x4_alias", "donut", "tolman"):
        add(f"moved once, {name}", partial(_maze, name), 162, "20, half of them within 10 steps", moves=1)
    add("moved 3 times, 4x4", partial(_maze, "4x4"), 292, "19", moves=3)
    for kind, rate, held in (
        *(("fail", 0.1, "20"), ("fail", 0.3, "18"), ("slip", 0.1, "20"), ("slip", 0.3, "18")),
        *(("sight", 0.1, "20"), ("sight", 0.3, "20"), ("door", 0.05, "20"), ("door", 0.2, "20")),
    ):
        for name in ("4x4", "4x4_alias", "tolman"):
            add(f"{kind} {rate:g}, {name}", partial(_maze, name), 400, held, noise={kind: rate})
    everything = {"slip": 0.05, "sight": 0.05, "door": 0.05, "moved": 0.01}
    add("all at once, 4x4", partial(_maze, "4x4"), 400, "16; right in 97 % of late steps", noise=everything)
    for name, seen, blind, none in (
        *(("3x3", 15, 27, 40), ("3x3_alias", 15, 0, 120), ("4x4_alias", 30, 50, 250)),
        *(("t_maze_alias", 13, 0, 120), ("4x4", 0, 41, 0), ("tolman", 0, 100, 0)),
    ):
        world, without = partial(_maze, name), f"no positions, {name}"
        if seen:
            add(without, world, 150, f"20, from step {seen}", pose="none", beside=True)
        if none:
            add(f"{without}, no doors", world, 2 * none, f"20 within {none} steps", pose="none", blind=True)
        if blind:
            add(f"no doors, {name}", world, 3 * blind, f"20, from step {blind}", blind=True)
    add("hall 6x8, 4 sights", _hall, 240, "20", beside=True)
    return found


CASES = _cases()
Task = tuple[str, str, int]  # case, agent, seed


@dataclass(frozen=True, slots=True)
class IdentityRow(Record):
    """One walk. A map is exact if it is right and has as many places as the world, all of them visited.

    Where the agent is moved without a word it need only be right, which is said of the rooms that were visited.
    """

    case: str
    agent: str
    seed: int
    rooms: int  # of the world
    exact: bool  # at the end
    from_step: int | None  # from which on it was for good, counted from the last silent move
    places: int | None  # these four as in `ExploreRun`
    map_right: bool | None
    known: float | None
    certain_but_wrong: float | None
    right_late: float | None  # share of the steps from `LATE` on at which the most probable place was the true one
    sure: int  # steps at which its certainty was `SURE` or more
    sure_elsewhere: int  # and of these in a place that belongs to another room
    sure_wrong: int  # or in a new place, in a room that was visited before
    held: tuple[float, ...]  # by bin of `BINS`: steps with this certainty
    # and of these in a place that belongs to the true room: a place belongs to the room where it was visited most
    belongs: tuple[float, ...]
    right: tuple[float, ...]  # and that is no new place in a room that was visited before, either
    rates: dict[str, float]  # learned
    ms: float = field(compare=False)  # a step, judging included
    hypotheses: tuple[float, ...] = field(repr=False)  # by step: how many there are
    sizes: tuple[float, ...] = field(repr=False)  # places of the map
    certainty: tuple[float, ...] = field(repr=False)

    @property
    def key(self) -> Task:
        """Its task."""
        return self.case, self.agent, self.seed

    def figures(self) -> dict[str, Value]:
        """What stands in a table: all but what is told step by step."""
        values = {part.name: getattr(self, part.name) for part in fields(self)}
        single = {name: value for name, value in values.items() if not isinstance(value, tuple | dict)}
        return {**single, **{f"rate of {name}": value for name, value in self.rates.items()}}


class Watcher:
    """Looks on at a walk, and judges the map at every step."""

    def __init__(self, session: Session, *, whole: bool = True) -> None:
        self.trail, self.session, self.whole = Trail(), session, whole
        self.moments = list[Moment]()
        self.exact = list[bool]()
        # certainty, whether the place belongs to the true room, and whether it is the right place
        self.held = list[tuple[float, bool, bool]]()
        self.counted = list[tuple[float, float]]()  # hypotheses, and places of the map
        self.verdict: Verdict | None = None

    def __call__(self, moment: Moment) -> None:
        """Judge."""
        self.trail(moment)
        self.moments.append(moment)
        agent, session, rooms = moment.agent, self.session, self.trail.rooms
        if not isinstance(agent, Agent):
            path = [session.truth.number[room] for room in rooms]
            self.exact.append(session.truth.learned_by(agent, path))
            return
        chart = session.world.unwrapped.chart
        self.verdict = self.trail.verdict(agent, chart)
        whole = len(set(rooms)) == self.verdict.places == len(chart.places)
        self.exact.append(self.verdict.map_right and (whole or not self.whole))
        belongs = self.trail.room(agent, agent.belief.place) == rooms[-1]
        self.held.append((agent.belief.certainty, belongs, self.trail.right(agent)))
        self.counted.append((float(len(agent.hypotheses)), float(self.verdict.places)))

    def row(self, task: Task, moved_at: int, ms: float) -> IdentityRow:
        """What came of it."""
        agent = self.moments[-1].agent
        rates = agent.learned_rates if isinstance(agent, Agent) else ()
        exact, verdict, held = self.exact, self.verdict, self.held
        wrong = len(exact) - 1 - next((k for k, is_exact in enumerate(reversed(exact)) if not is_exact), len(exact))
        late, sure = [right for *_, right in held[LATE:]], [one for one in held if one[0] >= SURE]
        bins = [[one for one in held if low <= one[0] < low + 0.1 or low == BINS[-1] <= one[0]] for low in BINS]
        return IdentityRow(
            *task,
            rooms=len(self.session.truth.number),
            exact=exact[-1],
            from_step=max(wrong + 1 - moved_at, 0) if exact[-1] else None,
            places=None if verdict is None else verdict.places,
            map_right=None if verdict is None else verdict.map_right,
            known=None if verdict is None else round(verdict.known, 4),
            certain_but_wrong=None if verdict is None else round(self.trail.wrong / len(exact), 4),
            right_late=sum(late) / len(late) if late else None,
            sure=len(sure),
            sure_elsewhere=sum(not belongs for _, belongs, _ in sure),
            sure_wrong=sum(not right for *_, right in sure),
            held=tuple(float(len(part)) for part in bins),
            belongs=tuple(float(sum(belongs for _, belongs, _ in part)) for part in bins),
            right=tuple(float(sum(right for *_, right in part)) for part in bins),
            rates={rate.name: round(rate.mean, 4) for rate in rates},
            ms=round(ms, 3),
            hypotheses=tuple(number for number, _ in self.counted),
            sizes=tuple(places for _, places in self.counted),
            certainty=tuple(round(p, 4) for p, *_ in held),
        )


@dataclass(frozen=True)
class Identity(Kept[Task, IdentityRow]):
    """A place is what it is recognised as

    Does an agent build the right map, with as many places as there are rooms, where positions do not say which place
    is which: on toruses, through portals, after silent moves, under noise of every kind, without positions and without
    a sensor of ways? Beside it stand clone-structured graphs (CSCG), on walks of their own and on ours.
    """

    name = "identity"
    notes = (
        "No setting tells an agent what goes wrong; besides the pose nothing differs between the cases.",
        "A map is exact if it is right and has as many places as the world. CSCG is not asked how many places it has: "
        "it is exact once it believes every true transition. Where agents are moved it is once it is right for the "
        "rooms that were visited so far.",
    )
    file = "identity.jsonl"

    cases: tuple[str, ...] = tuple(CASES)
    beside: tuple[str, ...] = tuple(NAMES)[1:]
    most: int = 10**6  # steps of a walk

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        """Each case with our agent and every seed, and a few seeds with those beside it."""
        ours = [(case, "cogmap", seed) for case in self.cases for seed in seeds]
        others = [(case, agent) for case in self.cases if CASES[case].beside for agent in self.beside]
        return ours + [(*one, seed) for one in others for seed in seeds[:FEW]]

    def key(self, task: Task) -> Task:
        return task

    def made(
        self, tasks: Sequence[Task], settings: Settings, executor: Executor | None, ledger: Ledger | None
    ) -> Iterator[IdentityRow]:
        with_, run = {"settings": settings.to_dict(), "most": self.most}, partial(self.run, settings=settings)
        return kept_rows(run, {task: task for task in tasks}, IdentityRow.from_dict, ledger, executor, with_)

    def run(self, task: Task, settings: Settings) -> IdentityRow:
        name, agent, seed = task
        case, own = CASES[name], agent.removesuffix(ALONG)
        parts = Parts("cogmap", settings, pose=case.pose) if own != agent or own == "cogmap" else Parts(own)
        session = set_out(self.name, case.made(seed), seed, agent=parts)
        watcher, begin = Watcher(session, whole=not case.moves), perf_counter()
        steps = min(case.steps, self.most, *([] if agent == "cogmap" else [MOST_BESIDE]))
        moved_at = _walked(session, watcher, case.moves, steps)
        if own != agent:
            watcher = _along(watcher, Parts(own).make(session.world, np.random.SeedSequence(seed)))
        return watcher.row(task, moved_at, 1000.0 * (perf_counter() - begin) / (steps + 1))

    def summarise(self, rows: Sequence[IdentityRow]) -> Findings:
        groups: dict[tuple[str, str], list[IdentityRow]] = {}
        for row in rows:
            groups.setdefault((row.case, row.agent), []).append(row)
        summary = [_summary(*key, every) for key, every in groups.items()]
        ours = [row for row in rows if row.agent == "cogmap"]
        trust = [_trust(ours, number) for number in range(len(BINS))]
        noisy = [line for line in summary if line["agent"] == "cogmap" and len(CASES[line["case"]].noise) == 1]
        figures = {"identity_exact": partial(_exact, summary), "identity_certainty": partial(_certainty, trust)}
        figures |= {"identity_rates": partial(_rates, noisy)} if any(line["rate"] for line in noisy) else {}
        for name in DRAWN:
            if first := next((row for row in ours if row.case.startswith(name)), None):
                figures[f"identity_{name.replace(' ', '_')}"] = partial(_over_time, first)
        captions = ("Exact maps, by case and agent", "Share of right places, by certainty, all cases together")
        tables = [
            Table.of(self.name, [row.figures() for row in rows], "every run", shown=False),
            Table.of("identity_table", [_cells(line) for line in summary], captions[0]),
            Table.of(
                "identity_trust",
                [{**part, **{name: _share(part[name]) for name in COUNTED}} for part in trust],
                captions[1],
            ),
        ]
        sure, *wrong = (sum(getattr(row, name) for row in ours) for name in ("sure", "sure_elsewhere", "sure_wrong"))
        lines = [
            " ".join(f"{text!s:<{wide}}" for text, wide in zip(_cells(line).values(), WIDE, strict=True))
            for line in summary
        ]
        lines += [
            f"certainty {part['from']:.1f} to {part['to']:.1f}, {part['steps']} steps: "
            + ", ".join(f"{words} in {_share(part[name])}" for name, words in COUNTED.items())
            for part in trust
        ]
        lines += [f"sure at {SURE} in {sure} steps, and wrong in {wrong[0]} of them, or {wrong[1]} with new places"]
        protocol = {name: {"steps": CASES[name].steps, "noise": CASES[name].noise} for name in self.cases}
        json = {"protocol": protocol, "rows": [row.figures() for row in rows], "summary": summary, "trust": trust}
        failed = [
            f"{line['case']}: {line['runs'] - line['exact'].count} of {line['runs']} maps are not exact"
            for line in summary
            if line["agent"] == "cogmap" and line["exact"].count < line["runs"]
        ]
        return Findings(json, lines, figures, tables, failed)


WIDE = (29, 20, 24, 8, 22, 7, 6, 6, 12, 30)  # of the columns in a terminal


def _walked(session: Session, watcher: Watcher, moves: int, steps: int) -> int:
    """Walk, and be moved without a word now and then; the step of the last move, or 0."""
    step = 0
    for number in range(moves):
        walked = int(session.rng.integers(3, 13) if number == 0 else session.rng.integers(10, 41))
        session.run(walked, watcher)
        session.displace(elsewhere=True)
        step += walked
    session.run(max(steps + 1 - step, 1), watcher)
    return step


def _along(first: Watcher, walker: Any) -> Watcher:
    """Somebody else who senses what was sensed on a walk, and is told what was done."""
    other, taken = Watcher(first.session), dict[str, Any]()
    for moment, room in zip(first.moments, first.trail.rooms, strict=True):
        walker.step({**moment.observation, "position": room, **taken})
        other(Moment(moment.step, walker, moment.world, moment.observation, moment.info, moment.action))
        taken = {"taken": moment.action}
    return other


def _summary(case: str, agent: str, rows: Sequence[IdentityRow]) -> dict[str, Any]:
    there = [row.from_step for row in rows if row.from_step is not None]
    kind = next(iter(CASES[case].noise), None)
    rates = [row.rates[RATES[kind]] for row in rows if row.rates and kind is not None]
    return {
        "case": case,
        "agent": agent,
        "runs": len(rows),
        "exact": wilson(sum(row.exact for row in rows), len(rows)),
        "median_from_step": float(np.median(there)) if there else None,
        "from_step": Steps.of(there, 0) if there else None,
        "mean_places": mean(row.places for row in rows),
        "mean_right_late": mean(row.right_late for row in rows),
        "rate": mean(rates) if len(CASES[case].noise) == 1 else None,
        "ms": mean(row.ms for row in rows),
        "to_hold": CASES[case].held if agent == "cogmap" else "",
    }


def _cells(line: Mapping[str, Any]) -> dict[str, Value]:
    steps, median, places, late = (
        line[name] for name in ("from_step", "median_from_step", "mean_places", "mean_right_late")
    )
    rate = "" if line["rate"] is None else f"{line['rate']:.3f} ({next(iter(CASES[line['case']].noise.values())):g})"
    return {
        "case": line["case"],
        "agent": NAMES[line["agent"]],
        "exact [95 %]": _share(line["exact"]),
        "median from step": NONE if median is None else f"{median:g}",
        "mean [95 %]": NONE if steps is None else f"{steps.mean:.1f} [{steps.low:.1f}, {steps.high:.1f}]",
        "places": NONE if places is None else f"{places:.1f}",
        "right late": NONE if late is None else f"{late:.0%}",
        "ms": f"{line['ms']:.1f}",
        "rate learned (true)": rate,
        "to hold of 20": line["to_hold"],
    }


def _share(share: Share) -> str:
    return f"{share.count}/{share.of} [{share.low:.0%}, {share.high:.0%}]"


def _trust(rows: Sequence[IdentityRow], number: int) -> dict[str, Any]:
    """How often the place was right at a certainty."""
    steps, *right = (int(sum(getattr(row, name)[number] for row in rows)) for name in ("held", *COUNTED))
    shares = {name: wilson(count, steps) for name, count in zip(COUNTED, right, strict=True)}
    return {"from": BINS[number], "to": round(BINS[number] + 0.1, 1), "steps": steps, **shares}


def _exact(summary: Sequence[Mapping[str, Any]]) -> Figure:
    cases, agents = (list(dict.fromkeys(line[name] for line in summary)) for name in ("case", "agent"))
    figure, (ax,) = panels(
        "Exact maps: share of the agents, with 95 % intervals (Wilson)", (1, 1), (max(5, 0.33 * len(cases) + 2), 5.0)
    )
    for number, agent in enumerate(agents):
        found = {line["case"]: line["exact"] for line in summary if line["agent"] == agent}
        at = [cases.index(case) + (number + 0.5) * 0.84 / len(agents) - 0.42 for case in found]
        look: Look = {"color": LOOKS[agent.removesuffix(ALONG)][1], "alpha": 0.5 if agent.endswith(ALONG) else 1.0}
        plot_bars(ax, at, list(found.values()), width=0.8 / len(agents), label=NAMES[agent], **look)
    ax.set_xticks(range(len(cases)), cases, rotation=60, ha="right", fontsize=8)
    shares_axis(ax, "exact")
    legend_below(figure, ax, len(agents))
    return figure


def _certainty(trust: Sequence[Mapping[str, Any]]) -> Figure:
    figure, (ax,) = panels("How far certainty can be trusted (95 % intervals)", (1, 1), (5.0, 4.4))
    held = [part for part in trust if part["steps"]]
    ax.plot([0.5, 1.0], [0.5, 1.0], color="grey", linewidth=1.0, linestyle=":")
    for (name, words), colour in zip(COUNTED.items(), (BLUE, VERMILION), strict=True):
        at, shares = [part["from"] + 0.05 for part in held], [part[name] for part in held]
        plot_line(ax, at, shares, color=colour, marker="o", label=words)
    ax.set(xlabel="certainty of the place", xlim=(0.48, 1.02))
    shares_axis(ax, "right")
    ax.legend(frameon=False)
    return figure


def _rates(lines: Sequence[Mapping[str, Any]]) -> Figure:
    figure, (ax,) = panels("Rates learned, and the true ones", (1, 1), (6.5, 4.6))
    for number, kind in enumerate(RATES):
        found = [(CASES[line["case"]].noise.get(kind), line["rate"]) for line in lines]
        at = [(true, learned) for true, learned in found if true is not None and learned is not None]
        if at:
            ax.plot(*zip(*at, strict=True), "osD^v"[number], label=kind, color=f"C{number}")
    ax.plot([0.0, 0.32], [0.0, 0.32], color="grey", linewidth=1.0, linestyle=":")
    ax.set(xlabel="true", ylabel="learned")
    ax.legend(frameon=False)
    return figure


def _over_time(row: IdentityRow) -> Figure:
    figure, axes = panels(f"{row.case}, seed {row.seed}", (3, 1), (8.0, 5.4), sharex=True)
    parts = (
        ("places", row.sizes, BLUE),
        ("hypotheses", row.hypotheses, VERMILION),
        ("certainty", row.certainty, GREEN),
    )
    for ax, (name, values, colour) in zip(axes, parts, strict=True):
        ax.plot(values, color=colour, linewidth=1.4, drawstyle="steps-post")
        ax.set_ylabel(name)
        if row.from_step is not None and not CASES[row.case].moves:
            ax.axvline(row.from_step, color="grey", linewidth=1.0, linestyle=":")
    axes[0].axhline(row.rooms, color="grey", linewidth=1.0, linestyle="--", label="rooms of the world")
    axes[0].legend(frameon=False, fontsize=8)
    axes[-1].set_xlabel("step" if row.from_step is None else "step (dotted: from here on the map is exact)")
    return figure

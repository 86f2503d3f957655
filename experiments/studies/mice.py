"""The study `mice`: recorded animals in a labyrinth (Rosenberg et al. 2021), and what models say of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ...agent import Settings
from ...behaviour import MODELS, simulate
from .. import mean
from .intervals import bootstrap
from .mice_facts import Recorded, agent_trip, ends_of, explored, ground, recorded, trips_of
from .mice_figures import choices_figure, exploration_figure, flows_figure
from .mice_models import models_fitted, terms_judged
from .mice_recovery import recover
from .study import Findings, Study
from .tables import Table

Task = tuple[str, str, int]
Row = dict[str, Any]
BIASED = {"habit back": -1.25}
"""Of the biased walk: turning back is rarer than the other ways, as in the animals before they found the port."""
WALKERS = ("cogmap", "biased", "random")
OURS = "habit+cogmap"


@dataclass(frozen=True)
class Mice(Study[Task, Row]):
    """What would a mouse do?

    Twelve mice walked at will through a binary labyrinth of 64 ends (Rosenberg et al. 2021). How fast do they find the
    ends, against an agent with a map, a random walk and a biased one? How probable is each of their choices under
    models of habit, novelty and expected free energy, held out bout by bout? Do they go straight home, and to the
    water? And are parameters and models found again in simulated individuals?
    """

    name = "mice"
    agents = 5
    settings = Settings(look_ahead=3)
    notes = (
        "The recordings are no part of this project: COGMAP_RECORDINGS names the folder that has mouse_labyrinth.json "
        "and mice/. Without them the study runs on simulated individuals alone.",
        "A choice is a step from a place with three ways; choices before the first visit of the water port count, home "
        "is a place. Efficiency is 32 over the visits to ends until half of the 64 ends were found.",
        "Recovery: with forgetting, lapses and habits of known size, every model against every other; the winner is "
        "the simplest model that is no worse than the best but by chance (one-sided, one in twenty).",
        "Individuals are fitted around the group; the variants of the whole model have one set of parameters for all.",
    )

    walker_steps: int = 4000  # moves of a walker at most
    recovery_steps: int = 2500  # moves of a simulated individual

    def tasks(self, seeds: Sequence[int], settings: Settings) -> Sequence[Task]:
        """The recordings first, where there are any; then walkers and simulated individuals."""
        about = [] if recorded() is None else [("animals", "", 0), ("fit", "", 0), ("terms", "", 0)]
        walks = [("walk", name, seed) for name in WALKERS for seed in seeds]
        return [*about, *walks, *(("recover", name, seed) for name in MODELS for seed in seeds)]

    def run(self, task: Task, settings: Settings) -> Row:
        kind, name, seed = task
        found = recorded()
        if kind == "recover":
            return recover(name, seed, settings, steps=self.recovery_steps)
        if kind == "walk":
            return {"kind": kind, "who": name, "seed": seed, **_found(_walked(name, seed, settings, self.walker_steps))}
        assert found is not None  # or there was no such task
        parts = {"fit": models_fitted, "terms": terms_judged, "animals": _animals}
        return parts[kind](found, settings)

    def summarise(self, rows: Sequence[Row]) -> Findings:
        by = {
            kind: [row for row in rows if row["kind"] == kind]
            for kind in ("animals", "fit", "terms", "walk", "recover")
        }
        animals = by["animals"][0]["animals"] if by["animals"] else []
        curves = {name: [row["new"] for row in by["walk"] if row["who"] == name] for name in WALKERS}
        if animals:
            curves = {"animals": [one["new"] for one in animals], **curves, "fitted": by["fit"][0]["simulated"]}
        explored_rows = [{"who": who, **_efficiency(found)} for who, found in curves.items()]
        tables = [Table.of("mice_exploration", explored_rows, "Finding the ends: 32 / N32, mean over individuals")]
        lines = [f"{row['who']}: efficiency {row['efficiency']}" for row in explored_rows]
        json: Row = {"recordings": bool(animals), "exploration": explored_rows, "recovery": by["recover"]}
        figures: dict[str, Any] = {"mice_exploration": partial(exploration_figure, curves)}
        if not animals:
            lines.insert(0, "the recordings are not at hand (COGMAP_RECORDINGS): simulated individuals alone")
        for row in by["fit"]:
            made = row["result"]
            tables += _fit_tables(made)
            lines += [
                f"{m['name']}: {m['held_out_nats_per_choice']:.4f} nats a choice held out" for m in made["models"]
            ]
            json |= {"models": made["models"], "individuals": made["individuals"]}
            figures["mice_choices"] = partial(choices_figure, made)
            figures["mice_flows"] = partial(flows_figure, ground(), row["flows"])
        for row in by["terms"]:
            terms = [
                {"model": n, "parameters": row["parameters"][n], "held out": h} for n, h in row["held_out"].items()
            ]
            tables.append(Table.of("mice_terms", terms, "The whole model, less a term or with one more: nats a choice"))
            json["terms"] = terms
        if animals:
            trips = [{"individual": one["individual"], **one["trips"]} for one in animals if one["trips"]]
            tables.append(Table.of("mice_trips", trips, "After the first water: direct ways to the port and home"))
            json["trips"] = trips
        recovery, words = _recovery(by["recover"])
        return Findings(json, [*lines, *words], figures, tables=[*tables, recovery])


def _walked(name: str, seed: int, settings: Settings, most: int) -> list[int]:
    if name == "cogmap":
        return explored(seed, settings, most=most)
    model, given = (MODELS["habit"], BIASED) if name == "biased" else (MODELS["uniform"], {})
    return simulate(model, ground(), steps=most, parameters=given, seed=seed).places.tolist()


def _found(places: Sequence[int]) -> Row:
    ends = ends_of(places, ground())
    return {"new": ends.new, "steps_to_all": ends.steps_to_all}


def _animals(found: Recorded, settings: Settings) -> Row:
    """Exploration and trips of each animal, and the trips of an agent in its place."""
    rows: list[Row] = []
    for route, thirsty in zip(found.routes, found.thirsty, strict=True):
        trips, row = trips_of(route, found.ground), dict[str, Any]()
        if trips is not None:
            agent = agent_trip(route, found.ground, settings)
            port, home = trips.to_port, trips.home
            row = {
                "thirsty": thirsty,
                "to the port": port[0],
                "direct": port[1],
                "home": home[0],
                "direct home": home[1],
            }
            row |= {"agent to the port": agent[0], "agent home": agent[1]}
        rows.append({"individual": route.individual, "trips": row, **_found(route.places.tolist())})
    return {"kind": "animals", "animals": rows}


def _efficiency(curves: Sequence[Sequence[int]]) -> Row:
    halves = [next((i + 1 for i, found in enumerate(new) if found >= 32), None) for new in curves]
    reached = [half for half in halves if half is not None]
    interval = bootstrap([32 / half for half in reached]) if reached else None
    sure = {"low": interval.low, "high": interval.high} if interval else {"low": None, "high": None}
    share = None if interval is None else round(interval.value, 3)
    return {"individuals": len(halves), "half found": len(reached), "N32": mean(reached), "efficiency": share, **sure}


def _fit_tables(made: Row) -> list[Table]:
    heads = ("model", "parameters", "log likelihood", "BIC", "held out", "low", "high")
    group = [_cells(m["name"], m) for m in made["models"]]
    own = [
        [one["individual"], one["choices"], *(m["held_out_nats_per_choice"] for m in one["models"]), one["preferred"]]
        for one in made["individuals"]
    ]
    names = [m["name"] for m in made["models"]]
    better = sum(_held(one, OURS) < _held(one, "habit") for one in made["individuals"])
    caption = f"Nats a choice, held out; {OURS} beats habit for {better} of {len(own)}"
    return [
        Table("mice_models", heads, group, "Models of choice, all individuals: nats a choice held out, 95 % interval"),
        Table("mice_individuals", ("individual", "choices", *names, "preferred"), own, caption),
    ]


def _cells(name: str, model: Row) -> list[Any]:
    low, high = model["held_out_interval"] or (None, None)
    held = model["held_out_nats_per_choice"]
    return [name, len(model["parameters"]), model["log_likelihood"], model["bic"], held, low, high]


def _held(one: Row, name: str) -> float:
    return next(m["held_out_nats_per_choice"] for m in one["models"] if m["name"] == name)


def _recovery(rows: Sequence[Row]) -> tuple[Table, list[str]]:
    table: list[Row] = []
    for name in MODELS:
        own = [row for row in rows if row["model"] == name]
        within = [fine for row in own for fine in row["within"].values()]
        won = sum(row["preferred"] == name for row in own)
        table.append(
            {"model": name, "individuals": len(own), "won": won, "parameters": len(within), "within": sum(within)}
        )
    won, of = sum(row["won"] for row in table), len(rows)
    fine, many = (sum(row[key] for row in table) for key in ("within", "parameters"))
    words = [f"the right model won for {won} of {of}; {fine} of {many} parameters within two standard errors"]
    return Table.of("mice_recovery", table, "Simulated individuals: right model, parameters within two errors"), words

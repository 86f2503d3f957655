"""Agents with parts by name, as tests and recorded walks speak of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from cogmap.agent import Agent, Settings
from cogmap.model import GROWTHS, Growth, StaticGrowth
from cogmap.planning import CHOICES, POLICIES, MapGuided, Planner

NAMES = ("growth", "places", "policies", "beam", "choice", "explorer")


def growth_named(name: str, *, places: int = 40) -> Growth:
    return StaticGrowth(places) if name == "static" else GROWTHS[name]()


def parts_of(options: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The parts that some options name, and the options that are numbers."""
    beam, policies = options.get("beam"), POLICIES[options.get("policies", "map_guided")]()
    planner = Planner(
        policies=policies if beam is None else MapGuided(beam=beam), choice=CHOICES[options.get("choice", "outward")]()
    )
    planner = planner if options.get("explorer", True) else replace(planner, explorer=None)
    growth = growth_named(options.get("growth", "predicted"), places=options.get("places") or 40)
    return {"growth": growth, "planner": planner}, {name: value for name, value in options.items() if name not in NAMES}


def agent_with(motions: Any, *, seed: int = 0, **options: Any) -> Agent:
    """An agent with these parts and settings."""
    parts, numbers = parts_of(options)
    return Agent(motions, **parts, settings=Settings(**numbers), seed=seed)

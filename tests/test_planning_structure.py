"""Hypotheses about the map, told apart on purpose."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field, replace
from math import log

import numpy as np
import pytest
from cogmap.model import CogmapError, CognitiveMap
from cogmap.planning import (
    Exhaustive,
    MapGuided,
    Plan,
    Planner,
    Policies,
    Structure,
    StructureInformation,
    evaluate,
    evaluate_plain,
)
from local_models import LINE, random_model

BACK, ON, STAY = 0, 1, 2
PLAIN = StructureInformation(weight=1.0)


@dataclass
class Corridors:
    """Each hypothesis is a row of sights, and ends at both ends; `asked` counts the questions."""

    weights: Sequence[float]
    here: Sequence[Hashable]
    rows: Sequence[Sequence[Hashable]]
    seen: int = 10**6
    moves: Sequence[int] = (BACK, ON)
    asked: list[int] = field(default_factory=list[int])

    def ahead(self, h: int, place: Hashable, action: int) -> Hashable | None:
        self.asked.append(h)
        assert isinstance(place, int)
        after = place + (-1, 1, 0)[action]
        return None if after >= self.seen else min(max(after, 0), len(self.rows[h]) - 1)

    def expected(self, h: int, place: Hashable) -> Hashable:
        assert isinstance(place, int)
        return self.rows[h][place]


def differing(at: int, *, weights: Sequence[float] = (0.5, 0.5), rooms: int = 50, here: int = 20) -> Corridors:
    """Corridors that look alike but for the room `at`."""
    rows = [["grey"] * rooms for _ in weights]
    for h, row in enumerate(rows):
        row[at] = f"colour {h}"
    return Corridors(weights, [here] * len(weights), rows)


def corridor(rooms: int, *, unvisited: int | None = None) -> CognitiveMap:
    map_ = CognitiveMap(LINE)
    sight = map_.sensors["sight"].read("grey", step=0)
    for room in range(rooms):
        map_.new_place((room,), step=0)
    for room in range(rooms):
        for action, beyond in ((BACK, room - 1), (ON, room + 1)):
            map_.B_s.add(map_.row(room, action), beyond if 0 <= beyond < rooms else room, 30.0)
        if room != unvisited:
            map_.mark_visited(room)
            map_.A_o.add(room, sight, 30.0)
    return map_


def planned(hypotheses: Corridors | None, *, at: int = 20, unvisited: int | None = None) -> Plan:
    return Planner().plan(
        corridor(50, unvisited=unvisited),
        np.array([at]),
        np.ones(1),
        open_=(True, True, True),
        look_ahead=3,
        rng=np.random.default_rng(0),
        discount=0.95,
        structure=hypotheses,
    )


@pytest.mark.parametrize("at", [18, 21, 29, 42])
def test_when_all_is_visited_it_goes_where_it_will_know(at: int) -> None:
    plan = planned(differing(at))
    way = ["on"] * (at - 20) if at > 20 else ["back"] * (20 - at)
    assert plan.names[: len(way)] == way
    assert at in plan.places
    told = plan.expected_free_energy["structure"][plan.chosen]
    assert told == pytest.approx(10 * log(2) * plan.model.discount ** (abs(at - 20) - 1))
    assert planned(None).expected_free_energy["structure"].max() == 0.0


def test_what_is_open_is_told_before_what_is_new_and_what_is_nearly_sure_after() -> None:
    assert planned(differing(21), unvisited=18).names[0] == "on"
    assert planned(differing(21, weights=(0.995, 0.005)), unvisited=18).names[0] == "back"
    assert planned(differing(21), unvisited=22).names[:2] == ["on", "on"]


def test_each_difference_counts_once_and_staying_tells_nothing() -> None:
    three = Corridors((0.5, 0.25, 0.25), [1, 1, 1], ["aaab", "aaac", "aadc"])
    model = replace(random_model(0, motions=LINE), structure=Structure.of(three), discount=1.0, information_weight=1.0)
    walks = [[ON, BACK, ON], [ON, ON, BACK], [ON, ON, STAY], [STAY, STAY, ON], [BACK, BACK, BACK], [BACK, ON, ON]]
    told = evaluate(model, Policies(np.array(walks)), [PLAIN])["structure"]
    third, all_three = 0.75 * log(4 / 3) + 0.25 * log(4), 1.5 * log(2)
    assert told == pytest.approx([third, all_three, all_three, third, 0.0, third])
    heavy = evaluate(model, Policies(np.array(walks)), [StructureInformation(weight=4.0)])["structure"]
    assert heavy == pytest.approx(4.0 * told)


@pytest.mark.parametrize("seed", range(6))
def test_equals_the_plain_evaluation(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = [rng.integers(0, 3, 6).tolist() for _ in range(4)]
    hypotheses = Corridors(rng.dirichlet(np.ones(4)).tolist(), rng.integers(0, 6, 4).tolist(), rows, seen=5)
    model = replace(random_model(seed, motions=LINE), structure=Structure.of(hypotheses))
    policies = Exhaustive().make(model)
    ours = evaluate(model, policies)["structure"]
    assert ours.max() > 0.0 or model.information_weight == 0.0
    np.testing.assert_allclose(ours, evaluate_plain(model, policies)["structure"], atol=1e-9)
    longer = MapGuided().make(model)
    np.testing.assert_allclose(
        evaluate(model, longer)["structure"], evaluate_plain(model, longer)["structure"], atol=1e-9
    )


@pytest.mark.parametrize("weights", [(1.0,), (1.0, 0.0)])
def test_one_hypothesis_is_asked_nothing(weights: Sequence[float]) -> None:
    hypotheses = differing(21, weights=weights)
    plan = planned(hypotheses)
    assert plan.model.structure is None
    assert not hypotheses.asked
    assert plan.names == planned(None).names


def test_the_eight_heaviest_are_walked() -> None:
    hypotheses = differing(21, weights=[1.0, 0.0, *[2.0] * 8])
    structure = planned(hypotheses).model.structure
    assert structure is not None
    assert set(hypotheses.asked) == set(structure.kept) == set(range(2, 10))
    assert structure.entropy == pytest.approx(log(8))


def test_a_place_never_seen_differs_from_all_that_are_known() -> None:
    hypotheses = Corridors((0.5, 0.5), [1, 3], ["aaaaaaaa", "aaaaaaaa"], seen=4)
    structure = Structure.of(hypotheses)
    assert structure is not None
    apart = structure.walk(structure.start, ON)
    assert apart[0] == (2, None)
    assert structure.told(apart[1]) == pytest.approx(log(2))
    assert structure.walk(apart, ON)[0] == (3, None)


@pytest.mark.parametrize("weights", [(), (0.5,), (-0.1, 1.1), (np.nan, 1.0), (np.inf, 1.0), (0.0, 0.0)])
def test_weights_that_are_none_are_refused(weights: Sequence[float]) -> None:
    with pytest.raises(CogmapError, match="give each a finite number of 0 or more, not all 0"):
        planned(Corridors(weights, [20, 20], ["a" * 50] * 2))


@pytest.mark.parametrize("weight", [-1.0, np.inf, np.nan])
def test_a_weight_of_the_term_that_is_none_is_refused(weight: float) -> None:
    with pytest.raises(CogmapError, match="structure: weight is"):
        StructureInformation(weight=weight)

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from cogmap.agent import StepRecord
from cogmap.model import CogmapError
from cogmap.views import plot_certainty, plot_free_energy, plot_surprise, plot_terms
from matplotlib.axes import Axes
from matplotlib.container import BarContainer
from strolls import half_way, small, split


def line(ax: Axes, name: str) -> np.ndarray:
    (found,) = (part for part in ax.lines if part.get_label() == name)
    return np.asarray(found.get_ydata(), dtype=float)


def test_certainty_and_doubt_are_those_of_the_trace() -> None:
    trace = split().agent.trace
    ax = plot_certainty(trace, threshold=0.7)
    (outline,) = (patch for patch in ax.patches if patch.get_label() == "certainty")
    assert outline.get_data().values == pytest.approx([record.certainty for record in trace])  # type: ignore[attr-defined]
    assert line(ax, "doubt") == pytest.approx([record.doubt for record in trace])
    assert set(line(ax, "learns from 0.7")) == {0.7}
    low, high = ax.get_ylim()
    assert low < 0.0
    assert high > 1.0


def test_surprise_is_the_evidence_and_the_parts_of_free_energy_add_up_to_it() -> None:
    trace = split().agent.trace
    ax = plot_surprise(trace)
    surprise = line(ax, "surprise")
    assert surprise == pytest.approx([-record.evidence for record in trace])
    bars = [part for part in ax.containers if isinstance(part, BarContainer)]
    heights = [np.array([bar.get_height() for bar in part]) for part in bars]
    assert heights[0] + heights[1] == pytest.approx(surprise, abs=1e-9)
    assert ax.get_ylim()[1] > surprise.max()


@pytest.mark.parametrize("draw", [plot_free_energy, plot_certainty, plot_surprise])
def test_steps_at_which_it_was_moved_or_changed_its_mind_are_marked(draw) -> None:  # type: ignore[no-untyped-def]
    trace = list(split().agent.trace)
    trace[20] = replace(trace[20], revised=True)
    marks = {part.get_label(): list(part.get_xdata()) for part in draw(trace).lines if part.get_linestyle() == "None"}  # type: ignore[arg-type]
    assert marks == {"moved": [trace[-1].step], "revised": [trace[20].step]}
    quiet = draw(trace[:10])
    assert not [part for part in quiet.lines if part.get_linestyle() == "None"]


def test_terms_are_those_of_the_plan_and_add_up_to_G() -> None:
    plan = half_way().agent.plan
    ax = plot_terms(plan, most=6)
    G = plan.expected_free_energy.G
    shown = sorted(range(len(G)), key=lambda i: (round(float(G[i]), 9), i != plan.chosen))[:6]
    bars = {part.get_label(): np.array([bar.get_width() for bar in part]) for part in ax.containers}  # type: ignore[union-attr]
    names = {1.0: "", -1.0: "−"}
    for term in plan.expected_free_energy.terms:
        values, label = term.sign * plan.expected_free_energy[term.name][shown], names[term.sign] + term.label
        if label in bars:
            assert bars[label] == pytest.approx(values)
        else:
            assert values == pytest.approx(0.0, abs=1e-6)
    assert sum(bars.values()) == pytest.approx(G[shown], abs=1e-5)
    assert np.asarray(ax.collections[-1].get_offsets())[:, 0] == pytest.approx(G[shown])


def test_the_chosen_policy_is_marked_even_where_others_are_better() -> None:
    plan = split().agent.plan
    worst = int(plan.expected_free_energy.G.argmax())
    for chosen in (plan.chosen, worst):
        ax = plot_terms(replace(plan, chosen=chosen), most=3)
        names = ax.get_yticklabels()
        marked = [i for i, name in enumerate(names) if name.get_text().startswith("▶")]
        assert len(names) == 3
        assert marked == [0 if chosen == plan.chosen else 2]
        assert names[marked[0]].get_fontweight() == "bold"


def test_policies_have_short_names() -> None:
    plan = half_way().agent.plan
    for policy, name in (([0, 0, 1, 4], "2 up, down, stay"), ([0, 1] * 12, "up, down, up, down, up, down, up, …")):
        every = replace(plan, policies=np.tile(policy, (len(plan.policies), 1)))
        labels = {label.get_text().removeprefix("▶ ") for label in plot_terms(every).get_yticklabels()}
        assert labels == {name[:33] + "…" if len(name) > 34 else name}


def test_bad_input() -> None:
    trace: list[StepRecord] = []
    for draw in (plot_certainty, plot_surprise):
        with pytest.raises(CogmapError, match="trace is empty"):
            draw(trace)
    with pytest.raises(CogmapError, match="threshold is 7"):
        plot_certainty(small().agent.trace, threshold=7)
    with pytest.raises(CogmapError, match="most is 0"):
        plot_terms(small().agent.plan, most=0)

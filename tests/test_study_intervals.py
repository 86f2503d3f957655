"""Intervals of means, ratios and shares."""

from __future__ import annotations

import numpy as np
import pytest
from cogmap.experiments.studies import bootstrap, wilson
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st


def test_of_many_values_it_is_the_normal_approximation() -> None:
    values = np.random.default_rng(0).normal(3.0, 1.0, 400)
    mean = bootstrap(values.tolist())
    assert mean is not None
    assert mean.value == pytest.approx(values.mean())
    assert mean.high - mean.low == pytest.approx(2 * 1.96 * values.std() / 20, rel=0.1)
    assert mean.low < mean.value < mean.high
    assert mean.count == 400


def test_ratios_are_of_totals() -> None:
    same = bootstrap([2, 4, 6], [1, 2, 3])
    assert same is not None
    assert (same.value, same.low, same.high, same.count) == (2.0, 2.0, 2.0, 3)
    some = bootstrap([0, 2], [0, 1])  # a resample of the first alone has no ratio
    assert some is not None
    assert (some.value, some.low, some.high) == (2.0, 2.0, 2.0)


def test_of_one_value_and_of_none() -> None:
    one = bootstrap([7])
    assert one is not None
    assert (one.value, one.low, one.high, one.count) == (7.0, 7.0, 7.0, 1)
    assert bootstrap([]) is None
    assert bootstrap([1, 2], [0, 0]) is None


@hypothesis_settings(max_examples=30)
@given(st.lists(st.integers(0, 9), min_size=1, max_size=9))
def test_intervals_are_settled_by_the_values_alone(values: list[int]) -> None:
    interval = bootstrap(values)
    assert interval is not None
    assert interval == bootstrap(values)
    assert min(values) <= interval.low <= interval.value + 1e-9
    assert interval.value - 1e-9 <= interval.high <= max(values)
    rng = np.random.default_rng(0)  # by hand
    means = np.array(values)[rng.integers(len(values), size=(2000, len(values)))].mean(axis=1)
    assert (interval.low, interval.high) == pytest.approx(tuple(np.quantile(means, [0.025, 0.975])))


@hypothesis_settings(max_examples=60)
@given(of=st.integers(1, 300), data=st.data())
def test_wilson_is_where_the_score_test_stops_refusing(of: int, data: st.DataObject) -> None:
    share = wilson(count := data.draw(st.integers(0, of)), of)
    assert 0.0 <= share.low <= share.share <= share.high <= 1.0
    for end in {share.low, share.high} - {0.0, 1.0}:
        assert abs(share.share - end) == pytest.approx(1.959963984540054 * np.sqrt(end * (1.0 - end) / of), abs=1e-9)
    assert share.share == count / of


def test_nothing_is_known_of_no_runs() -> None:
    assert (wilson(0, 0).low, wilson(0, 0).high, wilson(0, 0).share) == (0.0, 1.0, 0.0)

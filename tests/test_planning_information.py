"""Dirichlet information against enumeration, integration and closed forms."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from cogmap.model import CogmapError, dirichlet_information
from cogmap.planning import Rollout
from hypothesis import given, settings
from hypothesis import strategies as st
from local_models import random_model
from scipy.integrate import quad
from scipy.special import digamma
from scipy.stats import beta

alphas = st.lists(st.floats(1e-3, 50.0), min_size=2, max_size=4)
wide = st.lists(st.floats(-9.0, 6.0).map(lambda x: 10.0**x), min_size=1, max_size=6)


def by_enumeration(alpha: list[float], n: int) -> float:
    """H[o_1..o_n] - n E[H[theta]], every sequence in turn."""
    entropy = 0.0
    for sequence in product(range(len(alpha)), repeat=n):
        counts, probability = list(alpha), 1.0
        for outcome in sequence:
            probability *= counts[outcome] / sum(counts)
            counts[outcome] += 1.0
        entropy -= probability * np.log(probability)
    mean = np.array(alpha) / sum(alpha)
    return entropy - n * float(mean @ (digamma(sum(alpha) + 1) - digamma(np.array(alpha) + 1)))


@settings(max_examples=30, deadline=None)
@given(alphas)
def test_equals_enumeration(alpha: list[float]) -> None:
    expected = [by_enumeration(alpha, n) for n in range(5)]
    np.testing.assert_allclose(dirichlet_information(alpha, 4), expected, atol=1e-10)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.5, 20.0), st.floats(0.5, 20.0), st.integers(1, 4))
def test_equals_integration(a: float, b: float, n: int) -> None:
    def conditional(theta: float) -> float:
        return -n * (theta * np.log(theta) + (1 - theta) * np.log1p(-theta)) * beta.pdf(theta, a, b)

    expected_entropy = quad(conditional, 0.0, 1.0, epsabs=1e-10)[0]
    marginal = by_enumeration([a, b], n) + n * float(
        digamma(a + b + 1) - (a * digamma(a + 1) + b * digamma(b + 1)) / (a + b)
    )
    assert dirichlet_information([a, b], n)[n] == pytest.approx(marginal - expected_entropy, abs=1e-6)


@settings(max_examples=30, deadline=None)
@given(wide)
def test_one_draw_is_the_closed_form(alpha: list[float]) -> None:
    a, total = np.array(alpha), sum(alpha)
    terms = a / total * (np.log(a / total) - digamma(a + 1) + digamma(total + 1))
    assert dirichlet_information(alpha, 1)[1] == pytest.approx(-terms.sum(), rel=1e-6, abs=1e-12)


@settings(max_examples=40, deadline=None)
@given(wide, st.integers(1, 12))
def test_grows_ever_more_slowly(alpha: list[float], steps: int) -> None:
    gains = np.diff(dirichlet_information(alpha, steps))
    assert (gains >= 0.0).all()
    assert (np.diff(gains) <= 1e-12).all()


@pytest.mark.parametrize("outcomes", [2, 10, 5000])
def test_tiny_concentrations_teach_all_at_the_first_draw(outcomes: int) -> None:
    information = dirichlet_information([1e-12], 6, multiplicity=[outcomes])
    np.testing.assert_allclose(information[1:], np.log(outcomes), rtol=1e-6)
    np.testing.assert_allclose(dirichlet_information(np.full(10, 1e-9), 3)[1:], np.log(10), rtol=1e-6)


@settings(max_examples=30, deadline=None)
@given(alphas, st.lists(st.integers(1, 6), min_size=4, max_size=4))
def test_multiplicity_is_repetition(alpha: list[float], copies: list[int]) -> None:
    copies = copies[: len(alpha)]
    repeated = dirichlet_information(np.repeat(alpha, copies), 5)
    np.testing.assert_allclose(dirichlet_information(alpha, 5, multiplicity=copies), repeated, atol=1e-12)


def test_zeros_contribute_nothing_and_rows_are_independent() -> None:
    table = dirichlet_information([[2.0, 0.0, 0.5], [1.0, 1.0, 1.0], [0.0, 4.0, 0.0]], 3)
    np.testing.assert_allclose(table[0], dirichlet_information([2.0, 0.5], 3), atol=1e-14)
    np.testing.assert_allclose(table[1], dirichlet_information([1.0], 3, multiplicity=[3]), atol=1e-14)
    np.testing.assert_allclose(table[2], 0.0, atol=1e-14)
    assert dirichlet_information(np.ones((2, 5, 3)), 0).shape == (2, 5, 1)


@pytest.mark.parametrize(
    ("alpha", "steps", "options", "message"),
    [
        ([-1.0, 2.0], 2, {}, "alpha"),
        ([np.nan, 2.0], 2, {}, "alpha"),
        ([0.0, 0.0], 2, {}, "no mass"),
        ([], 2, {}, "no outcomes"),
        ([1.0], -1, {}, "steps"),
        ([1.0, 1.0], 2, {"multiplicity": [-1.0, 2.0]}, "multiplicity"),
        ([1.0, 1.0], 2, {"multiplicity": [1.0, 2.0, 3.0]}, "does not fit"),
    ],
)
def test_bad_input(alpha: list[float], steps: int, options: dict[str, list[float]], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        dirichlet_information(alpha, steps, **options)


def chain(belief: np.ndarray) -> Rollout:
    """One policy, with these beliefs `[L, R]` after each of its steps."""
    steps, places = belief.shape
    before = np.arange(-1, steps).clip(0)
    levels = [(t, t + 1) for t in range(1, steps + 1)]
    model = random_model(0, places=places)
    return Rollout(model, before, np.zeros(steps + 1, dtype=np.int64), levels, np.vstack([np.zeros(places), belief]))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_collected_is_what_is_expected_of_visits_that_come_or_do_not(seed: int) -> None:
    rng = np.random.default_rng(seed)
    steps = int(rng.integers(1, 5))
    table = dirichlet_information(rng.random((3, 4)) + 0.01, steps)
    q, many = rng.random(3), rng.integers(1, steps + 1, 3)
    rolled = chain(np.where(np.arange(steps)[:, None] < many, q, 0.0))
    collected = rolled.collected(table)
    assert collected[-1] == pytest.approx(sum(q[s] * table[s, many[s]] for s in range(3)), abs=1e-12)
    assert collected[0] == 0.0


def test_collected_between_integers_beyond_the_table_and_of_nothing() -> None:
    table = np.array([[0.0, 4.0, 6.0]])
    found = chain(np.array([[1.0], [0.5], [0.0], [1.0], [1.0]])).collected(table)
    np.testing.assert_allclose(found, [0, 4, 5, 5, 6, 6])

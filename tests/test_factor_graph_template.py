"""Graphs that repeat in time: unrolled, and filtered for ever."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cogmap.inference import ImpossibleEvidence, Stream, infer
from cogmap.model import CogmapError, Template, before
from hypothesis import given, settings
from hypothesis import strategies as st


def weather(rng):
    """Two hidden variables that depend on each other's past, and one that is seen."""
    template = Template()
    template.variable("a", (0, 1, 2))
    template.variable("b", ("x", "y"))
    template.variable("o", (0, 1))
    template.factor("P", ["a"], rng.random(3), first=True, kind="prior")
    template.factor("Q", ["b"], rng.random(2), first=True)
    template.factor("R", ["b"], rng.random(2), first=False)
    template.factor("B", ["a", before("a"), before("b")], rng.random((3, 3, 2)))
    template.factor("C", ["b", "a", before("b")], rng.random((2, 3, 2)))
    template.factor("A", ["o", "a", "b"], rng.random((2, 3, 2)), kind="sight", equation="P(o | a, b)")
    return template


def test_unrolled_slices_have_times_and_their_own_factors():
    graph = weather(np.random.default_rng(0)).unroll(3, start=4)
    assert [v.name for v in graph.variables] == ["a4", "b4", "o4", "a5", "b5", "o5", "a6", "b6", "o6"]
    assert [v.time for v in graph.variables] == [4, 4, 4, 5, 5, 5, 6, 6, 6]
    labels = [factor.label for factor in graph.factors]
    assert labels[:3] == ["P(a4)", "Q(b4)", "A(o4, a4, b4)"]
    assert labels[3:7] == ["R(b5)", "B(a5, a4, b4)", "C(b5, a5, b4)", "A(o5, a5, b5)"]
    assert graph.factor_named("A(o5, a5, b5)").kind == "sight"


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000))
def test_filtering_is_inference_on_what_was_unrolled(seed):
    rng = np.random.default_rng(seed)
    template = weather(rng)
    stream = Stream(template)
    evidence = {}
    for t in range(5):
        given_ = {"o": int(rng.integers(2))} if rng.random() < 0.7 else {}
        if rng.random() < 0.3:
            given_["b"] = "x" if rng.random() < 0.5 else {"x": 0.3, "y": 0.9}
        evidence |= {f"{name}{t}": label for name, label in given_.items()}
        found, truth = stream.step(given_), infer(template.unroll(t + 1), evidence=evidence)
        assert stream.log_evidence == pytest.approx(truth.log_evidence, abs=1e-9)
        np.testing.assert_allclose(found.marginal("a"), truth.marginal(f"a{t}"), atol=1e-12)
        np.testing.assert_allclose(found.joint("b", "a"), truth.joint(f"b{t}", f"a{t}"), atol=1e-12)
        if t:
            np.testing.assert_allclose(found.joint("a", "a'"), truth.joint(f"a{t}", f"a{t - 1}"), atol=1e-12)
    assert stream.t == 5


def test_a_stream_loses_nothing_in_a_long_time():
    template = Template()
    template.variable("context", ("a", "b"))
    template.variable("cue", (0, 1))
    template.factor("P", ["context"], [0.5, 0.5], first=True)
    template.factor("stays", ["context", before("context")], np.eye(2))
    template.factor("A", ["cue", "context"], [[0.9, 0.1], [0.1, 0.9]])
    stream = Stream(template)
    for cue in [0] * 2000 + [1] * 2001:
        posterior = stream.step({"cue": cue})
    assert posterior.probability("context", "b") == pytest.approx(0.9, abs=1e-9)
    assert stream.log_evidence == pytest.approx(math.log(0.5) + 2000 * math.log(0.09), abs=1e-6)


def test_slices_that_are_independent_or_change_with_time():
    template = Template()
    template.variable("x", lambda t: range(t + 2))
    template.factor("f", ["x"], lambda t: np.arange(1.0, t + 3))
    stream = Stream(template)
    for t in range(4):
        posterior = stream.step()
        assert posterior.marginal("x")[-1] == pytest.approx((t + 2) / sum(range(1, t + 3)))
    assert stream.log_evidence == pytest.approx(math.log(3 * 6 * 10 * 15))
    assert template.unroll(4).variable_named("x3").domain == (0, 1, 2, 3, 4)
    assert template.interface == ()


def test_impossible_evidence_leaves_the_stream_where_it_is():
    template = Template()
    template.variable("x", (0, 1))
    template.factor("P", ["x"], [1.0, 0.0], first=True)
    template.factor("B", ["x", before("x")], np.eye(2))
    stream = Stream(template)
    stream.step()
    with pytest.raises(ImpossibleEvidence):
        stream.step({"x": 1})
    assert stream.t == 1
    assert stream.step({"x": 0}).probability("x", 0) == 1
    assert stream.log_evidence == pytest.approx(0)


def bad(act):
    template = weather(np.random.default_rng(0))
    act(template)


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda t: t.variable("a", (0, 1)), "taken"),
        (lambda t: t.variable("z", {0, 1}), "set"),
        (lambda t: t.variable("z", "ab"), "string"),
        (lambda t: t.factor("f", ["z"], [1]), "declare this variable first"),
        (lambda t: t.factor("f", [before("z")], [1]), "declare this variable first"),
        (lambda t: t.factor("f", "a", [1]), "list of variables"),
        (lambda t: t.factor("f", ["a", before("a")], np.eye(3), first=True), "before the first slice"),
        (lambda t: t.unroll(0), "1 or more"),
        (lambda t: (t.factor("f", ["a"], [1.0]), t.unroll(1)), "shape"),
        (lambda t: (t.variable("z'", (0, 1)), Stream(t)), "apostrophe"),
    ],
)
def test_bad_templates(act, message):
    with pytest.raises(CogmapError, match=message):
        bad(act)

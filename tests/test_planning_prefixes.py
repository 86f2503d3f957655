"""The prefix tree of policies, and what is kept of rows: against their definitions."""

from __future__ import annotations

import numpy as np
from cogmap.model.distinct import distinct
from cogmap.planning.local.rows import Rows
from cogmap.planning.prefixes import prefixes_of
from hypothesis import given, settings
from hypothesis import strategies as st


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 30), st.integers(1, 6), st.integers(1, 4))
def test_every_distinct_prefix_is_there_once(seed: int, policies: int, length: int, kinds: int) -> None:
    actions = np.random.default_rng(seed).integers(0, kinds, (policies, length))
    tree = prefixes_of(actions)
    wanted = {tuple(row[:t]) for row in actions.tolist() for t in range(length + 1)}
    assert len(tree) == len(wanted) == tree.level[-1]
    for policy, row in enumerate(actions.tolist()):
        at = 0
        for t, action in enumerate(row):
            node = int(tree.of[policy, t])
            above, begin, end = tree.levels[t]
            assert (tree.parent[node], tree.action[node]) == (at, action)
            assert above <= at < begin <= node < end
            at = node


@given(st.lists(st.integers(-3, 9), max_size=12))
def test_distinct_is_unique_with_its_inverse(values: list[int]) -> None:
    found, index = distinct(np.array(values, dtype=np.int64))
    wanted, inverse = np.unique(np.array(values, dtype=np.int64), return_inverse=True)
    np.testing.assert_array_equal(found, wanted)
    np.testing.assert_array_equal(index, inverse)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(["ask", "forget", "all"]), st.sets(st.integers(0, 40))), max_size=25))
def test_rows_are_worked_out_once_and_again_after_they_are_forgotten(ops: list[tuple[str, set[int]]]) -> None:
    truth: dict[int, int] = {}
    asked: list[int] = []

    def compute(rows: np.ndarray) -> tuple[np.ndarray, ...]:
        asked.extend(rows.tolist())
        return np.array([[truth[row], row] for row in rows.tolist()]), rows * 2

    kept = Rows(compute)
    known: set[int] = set()
    for step, (op, rows) in enumerate(ops):
        if op != "ask":
            kept.forget(None if op == "all" else sorted(rows))
            known -= known if op == "all" else rows
            continue
        wanted = np.array(sorted(rows), dtype=np.int64)
        truth.update(dict.fromkeys(rows - known, step))
        asked.clear()
        if len(wanted):
            first, second = (column[:-1] for column in kept.columns(wanted))
            assert first.tolist() == [[truth[row], row] for row in sorted(rows)]
            np.testing.assert_array_equal(second, wanted * 2)
        assert set(asked) == rows - known
        known |= rows


def test_rows_that_become_wider_are_worked_out_again() -> None:
    width = 1
    kept = Rows(lambda rows: (np.repeat(rows[:, None], width, axis=1),))
    assert kept.column(0, np.array([3, 1])).tolist() == [[3], [1]]
    width = 2
    assert kept.column(0, np.array([1])).tolist() == [[1]]  # nobody said that it had changed
    assert kept.column(0, np.array([1, 7])).tolist() == [[1, 1], [7, 7]]
    assert kept.column(0, np.array([3])).tolist() == [[3, 3]]

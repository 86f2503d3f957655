"""SparseDirichlet against a brute-force table that writes every count down."""

from __future__ import annotations

import numpy as np
import pytest
from cogmap.model import CogmapError, SparseDirichlet
from cogmap.model.dirichlet import EMPTY
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

CEILING = 20.0
amounts = st.floats(-12.0, 12.0)
shares = st.integers(0, 10**6)


class AgainstBruteForce(RuleBasedStateMachine):
    """The same random operations on the sparse table and on dictionaries."""

    @initialize(slots=st.integers(1, 3), background=st.sampled_from([0.0, 1e-9, 0.25]))
    def begin(self, slots: int, background: float) -> None:
        self.background = background
        self.size = 3
        self.slots = slots
        self.table = SparseDirichlet(slots=slots, background=background, outcomes=self.size)
        self.prior: list[dict[int, float]] = []
        self.evidence: list[dict[int, float]] = []

    def row(self, pick: int) -> int:
        return pick % len(self.prior)

    def key(self, pick: int) -> int:
        """An outcome; without a background, ELSEWHERE (-1) and numbers beyond the domain are outcomes too."""
        return pick % self.size if self.background else pick % 8 - 1

    @rule(rows=st.integers(1, 5))
    def append(self, rows: int) -> None:
        self.table.resize(len(self.prior) + rows)
        assert len(self.table) == len(self.prior) + rows
        for _ in range(rows):
            self.prior.append({})
            self.evidence.append({})

    @rule(more=st.integers(1, 3))
    def widen(self, more: int) -> None:
        self.size += more
        self.table.outcomes = self.size

    @rule(at=shares, of=shares, prior=st.floats(0.0, 3.0))
    def expect(self, at: int, of: int, prior: float) -> None:
        if self.prior:
            row, key = self.row(at), self.key(of)
            self.table.expect(row, key, prior)
            self.prior[row][key] = prior

    @rule(at=shares, of=shares, amount=amounts)
    def add(self, at: int, of: int, amount: float) -> None:
        if self.prior:
            row, key = self.row(at), self.key(of)
            before = self.evidence[row].get(key, 0.0)
            after = min(max(before + amount, 0.0), CEILING)
            assert self.table.add(row, key, amount, most=CEILING) == pytest.approx(after - before, abs=1e-12)
            self.evidence[row][key] = after

    @rule(at=shares, old=shares, new=shares)
    def rename(self, at: int, old: int, new: int) -> None:
        if not self.prior:
            return
        row, from_, to = self.row(at), self.key(old), self.key(new)
        if to in self.table.state()["keys"][row]:
            with pytest.raises(CogmapError, match="already"):
                self.table.rename(row, from_, to)
            return
        self.table.rename(row, from_, to)
        for counts in (self.prior[row], self.evidence[row]):
            counts[to] = counts.pop(from_, 0.0)

    @rule(rows=shares)
    def drop(self, rows: int) -> None:
        rows %= len(self.prior) + 1
        self.table.resize(rows)
        del self.prior[rows:], self.evidence[rows:]

    @rule(keep=st.floats(0.0, 1.0))
    def fade(self, keep: float) -> None:
        self.table.fade(keep)
        for faded in self.evidence:
            faded.update({key: value * keep for key, value in faded.items()})

    @rule()
    def save_and_restore(self) -> None:
        restored = SparseDirichlet(slots=self.slots, background=self.background, outcomes=self.size)
        restored.resize(len(self.table))
        restored.restore(self.table.state(), least=-1)
        self.table = restored

    def alpha(self, row: int, key: int) -> float:
        return self.background + self.prior[row].get(key, 0.0) + self.evidence[row].get(key, 0.0)

    def total(self, row: int) -> float:
        known = self.prior[row].keys() | self.evidence[row].keys()
        everything = known | set(range(self.size)) if self.background else known
        return sum(self.alpha(row, key) for key in everything)

    @invariant()
    def counts_are_the_same(self) -> None:
        if not hasattr(self, "table") or not self.prior:
            return
        assert len(self.table) == len(self.prior)
        rows = np.arange(len(self.prior))
        keys, alpha, others = self.table.concentration(rows)
        assert (alpha[keys == EMPTY] == 0.0).all()
        for row in rows.tolist():
            used = keys[row][keys[row] != EMPTY].tolist()
            assert len(set(used)) == len(used)
            for key, count in zip(keys[row].tolist(), alpha[row].tolist(), strict=True):
                if key != EMPTY:
                    assert count == pytest.approx(self.alpha(row, key), abs=1e-9)
                    assert count >= self.background + self.prior[row].get(key, 0.0) - 1e-12
            if self.background:
                assert others[row] == self.size - len(used)
            for key, value in self.evidence[row].items():
                assert self.table.evidence(row, key) == pytest.approx(value, abs=1e-9)
                assert 0.0 <= self.table.evidence(row, key) <= CEILING

    @invariant()
    def means_are_the_same(self) -> None:
        if not hasattr(self, "table") or not self.prior:
            return
        rows = np.arange(len(self.prior))
        dense = self.table.dense(self.size)
        assert dense.shape == (self.size + 1, len(rows))
        np.testing.assert_allclose(dense.sum(axis=0), 1.0, atol=1e-9)
        for row in rows.tolist():
            total = self.total(row)
            expected = [self.alpha(row, key) / total if total > 0.0 else 0.0 for key in range(self.size)]
            np.testing.assert_allclose(dense[:-1, row], expected, atol=1e-9)
            for key in range(self.size):
                assert self.table.probability(key, np.array([row]))[0] == pytest.approx(expected[key], abs=1e-9)
        keys = rows % self.size  # one outcome a row
        np.testing.assert_allclose(self.table.probability(keys, rows), dense[keys, rows], atol=1e-9)


AgainstBruteForce.TestCase.settings = settings(max_examples=25, stateful_step_count=25, deadline=None)
TestAgainstBruteForce = AgainstBruteForce.TestCase


def test_evidence_is_taken_no_further_than_to_the_prior() -> None:
    table = SparseDirichlet(slots=2)
    table.resize(1)
    table.expect(0, 3, 0.5)
    assert table.add(0, 3, 2.0) == 2.0
    assert table.add(0, 3, -7.0) == -2.0
    assert table.add(0, 3, -7.0) == 0.0
    _, alpha, _ = table.concentration(np.array([0]))
    assert alpha[0, 0] == 0.5


def test_evidence_stops_at_the_ceiling() -> None:
    table = SparseDirichlet(slots=1)
    table.resize(1)
    assert [table.add(0, 0, 7.0, most=10.0) for _ in range(3)] == [7.0, 3.0, 0.0]
    assert table.add(0, 0, 1.0, most=5.0) == 0.0  # what is above stays


def test_taking_away_what_was_never_there_takes_no_slot() -> None:
    table = SparseDirichlet(slots=1)
    table.resize(1)
    assert table.add(0, 5, -1.0) == 0.0
    assert table.add(0, 5, 0.0) == 0.0
    assert (table.state()["keys"] == EMPTY).all()


def test_a_row_without_counts_gives_everything_to_the_rest() -> None:
    table = SparseDirichlet(slots=1)
    table.resize(2)
    table.expect(1, 0, 1.0)
    np.testing.assert_array_equal(table.dense(2), [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_array_equal(table.probability(0, np.array([0, 1])), [0.0, 1.0])


def test_state_is_a_copy() -> None:
    table = SparseDirichlet(slots=1)
    table.resize(1)
    table.add(0, 0, 1.0)
    state = table.state()
    table.add(0, 0, 1.0)
    assert state["evidence"][0, 0] == 1.0
    other = SparseDirichlet(slots=1)
    other.resize(len(table))
    other.restore(state)
    other.add(0, 0, 5.0)
    assert state["evidence"][0, 0] == 1.0


def test_storage_grows_with_rows_and_outcomes() -> None:
    table = SparseDirichlet(slots=1)
    assert len(table) == table.nbytes == 0
    table.resize(100)
    for key in range(9):
        table.add(99, key, key + 1.0)
    assert [table.evidence(99, key) for key in range(9)] == [key + 1.0 for key in range(9)]
    assert table.evidence(0, 0) == 0.0
    assert table.nbytes == 100 * (16 * 32 + 8)


def test_rename_keeps_the_counts_and_refuses_a_taken_name() -> None:
    table = SparseDirichlet(slots=2)
    table.resize(1)
    table.expect(0, -1, 0.5)
    table.add(0, -1, 2.0)
    table.rename(0, -1, 4)
    assert table.evidence(0, 4) == 2.0
    assert table.evidence(0, -1) == 0.0
    table.add(0, 7, 1.0)
    with pytest.raises(CogmapError, match="outcome 7 of row 0"):
        table.rename(0, 4, 7)


def test_a_full_row_makes_room_for_a_prior_and_for_a_new_name() -> None:
    table = SparseDirichlet(slots=1)
    table.resize(1)
    table.expect(0, 0, 1.0)
    table.expect(0, 1, 2.0)  # the row had one slot
    table.rename(0, 5, 6)
    np.testing.assert_allclose(table.dense(7)[[0, 1, 6, 7], 0], [1 / 3, 2 / 3, 0.0, 0.0])

"""Domain, Column and Motions: what they hold and what they refuse."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np
import pytest
from cogmap.model import CogmapError, Domain, Motions
from cogmap.model.column import Column
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID

labels = st.one_of(st.none(), st.integers(), st.text(max_size=3), st.tuples(st.integers(0, 3), st.text(max_size=2)))


@given(st.lists(labels, max_size=30))
@settings(max_examples=50, deadline=None)
def test_a_domain_numbers_labels_as_they_are_met(met: list[Any]) -> None:
    domain = Domain("sights")
    numbers = [domain.add(label) for label in met]
    distinct = list(dict.fromkeys(met))
    assert list(domain) == distinct
    assert len(domain) == len(distinct)
    assert [domain[number] for number in numbers] == met
    assert [domain.index(label) for label in distinct] == list(range(len(distinct)))
    assert all(label in domain for label in distinct)


def test_a_domain_knows_what_it_never_met() -> None:
    domain = Domain("sights", ["a", None, (1, "b")])
    assert domain.find("c") is None
    assert "c" not in domain
    assert None in domain
    assert repr(domain) == "sights{'a', None, (1, 'b')}"
    with pytest.raises(CogmapError, match="'c' was never met; known are 'a', None"):
        domain.index("c")
    with pytest.raises(CogmapError, match="…"):
        Domain("many", range(20)).index(99)


@pytest.mark.parametrize("label", [[1], {"a": 1}, {1}, (1, [2]), np.zeros(2)])
def test_a_domain_refuses_what_is_not_hashable(label: Any) -> None:
    domain = Domain("sights")
    for ask in (domain.add, domain.find, domain.index, domain.__contains__):
        with pytest.raises(CogmapError, match=r"sights: .* is not hashable; label with str, int or tuple"):
            ask(label)
    assert len(domain) == 0


@given(st.lists(st.integers(-(2**62), 2**62), max_size=40), st.integers(0, 40))
@settings(max_examples=50, deadline=None)
def test_a_column_holds_what_was_appended(numbers: list[int], restored_at: int) -> None:
    column = Column("numbers", np.int64)
    for i, number in enumerate(numbers):
        if i == restored_at:
            saved = column.values.copy()
            column = Column("numbers", np.int64)
            column.resize(len(saved))
            column.restore({"values": saved})
        assert column.append(number) == i
    assert len(column) == len(numbers)
    assert column.values.tolist() == numbers


def test_a_column_has_rows_and_is_written_through_its_view() -> None:
    column = Column("rows", np.int8, width=3)
    for i in range(20):
        column.append(i)
    column.append([1, 2, 3])
    column.values[4, 1] = 99
    assert column.values.shape == (21, 3)
    assert column.values[4].tolist() == [4, 99, 4]
    assert column.values[20].tolist() == [1, 2, 3]
    copy = Column("rows", np.int8, width=3)
    copy.resize(len(column))
    copy.restore(column.state())
    copy.append(7)
    copy.values[0] = 1
    assert column.values[0].tolist() == [0, 0, 0]
    assert len(column) == 21


def test_motions_know_who_undoes_whom() -> None:
    motions = Motions.of(GRID)
    assert len(motions) == 5
    assert motions.inverse == (1, 0, 3, 2, 4)
    assert motions.stay == 4
    assert motions.move((2, 3), 0) == (1, 3)
    assert motions.undone((2, 3), 0) == (3, 3)
    assert Motions.of(load_world("3x3").motions) == motions
    assert Motions.of(motions) is motions


@given(st.integers(1, 4), st.lists(st.integers(-3, 3), min_size=8, max_size=8))
@settings(max_examples=50, deadline=None)
def test_motions_in_any_dimension_undo_each_other(n: int, numbers: list[int]) -> None:
    vectors = {tuple(numbers[i : i + n]) for i in range(0, 8 - n + 1, n)} | {(0,) * n}
    vectors |= {tuple(-x for x in vector) for vector in vectors}
    motions = Motions.of({f"m{i}": vector for i, vector in enumerate(sorted(vectors))})
    start = tuple(range(n))
    for action, inverse in enumerate(motions.inverse):
        assert motions.move(motions.move(start, action), inverse) == start
        assert motions.inverse[inverse] == action
        assert motions.move(motions.undone(start, action), action) == start
    assert motions.move(start, motions.stay) == start


BAD_MOTIONS: dict[str, tuple[Any, str]] = {
    "nothing": (None, "no set of motions"),
    "a number": (5, "no set of motions"),
    "a string": ("up", "no set of motions"),
    "no action": ({}, "at least one action"),
    "no inverse": ({"left": (-1,), "stay": (0,)}, "no inverse; add an action with \\(1,\\)"),
    "no stay": ({"left": (-1,), "right": (1,)}, "no action stays"),
    "two that stay": ({"stay": (0,), "wait": (0,)}, "same displacement"),
    "two alike": ({"a": (1,), "b": (1,), "c": (-1,), "stay": (0,)}, "same displacement"),
    "mixed lengths": ({"left": (-1,), "right": (1, 0), "stay": (0,)}, "differ in length"),
    "no dimension": ({"stay": ()}, "n >= 1"),
    "not a vector": ({"left": -1}, "no set of motions"),
    "words": ({"left": ("a",), "stay": (0,)}, "no set of motions"),
    "NaN": ({"left": (float("nan"),), "stay": (0,)}, "no set of motions"),
}


@pytest.mark.parametrize("name", BAD_MOTIONS)
def test_motions_refuse(name: str) -> None:
    spec, message = BAD_MOTIONS[name]
    with pytest.raises(CogmapError, match=message) as raised:
        Motions.of(spec)
    assert "\n" not in str(raised.value)


def test_motions_refuse_repeated_names_and_lists_that_do_not_match() -> None:
    with pytest.raises(CogmapError, match="names repeat"):
        Motions(("a", "a"), ((0,), (1,)))
    with pytest.raises(CogmapError, match="one displacement for each name"):
        Motions(("a",), ((0,), (1,)))


class Repeated:
    names = ("left", "right", "stay", "stay")
    displacements = ((-1,), (1,), (0,), (0,))


def test_motions_of_a_spec_refuse_repeated_names() -> None:
    with pytest.raises(CogmapError):
        Motions.of(Repeated())


def test_motions_refuse_fractions() -> None:
    with pytest.raises(CogmapError):
        Motions.of({"left": (-1.5,), "right": (1.5,), "stay": (0,)})


def test_motions_refuse_infinity() -> None:
    with pytest.raises(CogmapError):
        Motions.of({"left": (float("-inf"),), "right": (float("inf"),), "stay": (0,)})


@given(st.lists(st.one_of(st.integers(0, 4), st.text("ab", max_size=1), st.tuples(st.integers(0, 2)))))
def test_many_labels_at_once_are_the_same_as_one_by_one(labels: list[Hashable]) -> None:
    one_by_one, at_once = Domain("x"), Domain("x")
    for label in labels:
        one_by_one.add(label)
    at_once.extend(labels[:3])
    at_once.extend(labels[3:])
    assert list(at_once) == list(one_by_one)
    assert at_once.indices(labels) == [one_by_one.index(label) for label in labels]


def test_many_labels_at_once_are_checked() -> None:
    domain = Domain("x", "ab")
    with pytest.raises(CogmapError, match="not hashable"):
        Domain("x").extend(["a", []])  # type: ignore[list-item]
    with pytest.raises(CogmapError, match="'c' was never met"):
        domain.indices(["a", "c"])

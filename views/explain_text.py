"""Explanations as plain text and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from ..model import LabelledTable
from ..model.labels import shown
from ..model.markup import safe

if TYPE_CHECKING:
    from ..planning import Term
    from .explain import BelievedPlace, Explanation, Rejected, WeighedPolicy


def explanation_text(told: Explanation) -> str:
    """The whole explanation as lines of text."""
    parts = [
        *_belief(told),
        *_choice(told),
        "",
        _equation(told),
        str(_table(told)),
        "",
        *(f"why not {line}" for line in reasons(told)),
        f"first actions: {'; '.join(_first_actions(told))}",
        _preferences(told),
    ]
    return "\n".join(parts)


def explanation_html(told: Explanation) -> str:
    """The whole explanation as HTML."""
    head = "".join(f"<p>{safe(line)}</p>" for line in (*_belief(told), *_choice(told), _equation(told)))
    items = "".join(f"<li>{safe(line)}</li>" for line in reasons(told))
    foot = f"<p>first actions: {safe('; '.join(_first_actions(told)))}</p><p>{safe(_preferences(told))}</p>"
    return f"<div>{head}{_table(told).html()}<p>why not</p><ul>{items}</ul>{foot}</div>"


def _equation(told: Explanation) -> str:
    added, taken = ([_heading(term) for term in told.terms if term.sign == sign] for sign in (1.0, -1.0))
    return f"G = {' - '.join([' + '.join(added), *taken])}, in nats"


def _heading(term: Term) -> str:
    """A column of the table of policies."""
    return f"I {term.label.removesuffix(' information')}" if term.kind == "information" else term.label


def policy_words(actions: Sequence[str]) -> str:
    """Action names, those that repeat counted: `up x2, right, stay x3`."""
    runs = ((name, len(list(same))) for name, same in groupby(actions))
    return ", ".join(name if many == 1 else f"{name} x{many}" for name, many in runs)


def reasons(told: Explanation) -> list[str]:
    """What ruled out the rejected policies, those of the same fate on one line."""
    fates: dict[str, list[str]] = {}
    for lost in told.rejected:
        fates.setdefault(_reason(told, lost), []).append(policy_words(lost.policy.actions))
    return [f"{' / '.join(policies)}: {fate}" for fate, policies in fates.items()]


def _belief(told: Explanation) -> list[str]:
    first, *others = told.belief
    sure = f"certainty {told.certainty:.3f}, doubt {told.doubt:.3f}"
    lines = [f"step {told.step}: it believes to be in {_place(first)}; {sure}"]
    if others:
        lines.append("or in " + "; ".join(f"{_place(place)} ({place.probability:.3f})" for place in others))
    return lines


def _place(believed: BelievedPlace) -> str:
    at = "" if believed.position is None else f" at {believed.position}"
    looks = "" if believed.sight is None else f", which looks like {shown(believed.sight)}"
    return f"place {believed.place}{at}{looks}"


def _choice(told: Explanation) -> list[str]:
    cut = f"{told.cut} prefixes cut" if told.cut else "none cut"
    lines = [
        f"it weighed {told.considered} {'policy' if told.considered == 1 else 'policies'} of {told.length} steps "
        f"({told.generator}, {cut}) and chose ({told.how}, precision {told.precision:g})",
        f"  {policy_words(told.chosen.actions)}: G {_number(told.chosen.terms['G'])} nats, "
        f"P {told.chosen.probability:.3f}, ends {_end(told.chosen)}",
    ]
    if told.equals > 1:
        lines.append(f"  by lot among {told.equals} policies that are equally good")
    return lines


def _end(policy: WeighedPolicy) -> str:
    where = "somewhere never imagined" if policy.place is None else f"in place {policy.place}"
    return f"{where} ({policy.place_probability:.3f})"


def _table(told: Explanation) -> LabelledTable:
    """The chosen policy, the best ones and the rejected ones, in the order of G."""
    listed = {policy.index: policy for policy in (told.chosen, *told.best, *(lost.policy for lost in told.rejected))}
    ordered = sorted(listed.values(), key=lambda policy: (policy.terms["G"], policy.index != told.chosen.index))
    marks = (" *" if policy.index == told.chosen.index else "" for policy in ordered)
    index = tuple(policy_words(policy.actions) + mark for policy, mark in zip(ordered, marks, strict=True))
    shown = sorted(told.terms, key=lambda term: -term.sign)
    cells = [
        [policy.probability, policy.terms["G"], *(policy.terms[term.name] for term in shown)] for policy in ordered
    ]
    return LabelledTable(cells, index, ("P", "G", *map(_heading, shown)), "policy (* chosen)", digits=3)


def _reason(told: Explanation, lost: Rejected) -> str:
    if lost.term is None:
        return lost.words
    term = next(term for term in told.terms if term.name == lost.term)
    by, total = lost.worse[lost.term], f"{lost.difference:.3f} nats worse"
    if term.sign > 0.0:
        return f"{total}, most of all by its {term.meaning} ({by:.3f} more)"
    if lost.verdict == "later":
        return (
            f"{total}, most of all in {term.meaning}: it gets as much, but later, a longer way ({by:.3f} less for it)"
        )
    return f"{total}, most of all in {term.meaning} ({by:.3f} less)"


def _first_actions(told: Explanation) -> list[str]:
    parts: list[str] = []
    for first in told.actions:
        if first.best is None:
            why = "blocked" if first.blocked > 0.5 else "no policy begins with it"
            parts.append(f"{first.action} {why}")
        else:
            parts.append(f"{first.action} P {first.probability:.3f}, best G {_number(first.best)}")
    return parts


def _number(value: float) -> str:
    return f"{round(value, 3) + 0.0:.3f}"  # + 0.0: no -0.000


def _preferences(told: Explanation) -> str:
    wanted = [f"sight {shown(label)} {value:+g}" for label, value in told.sights]
    wanted += [f"place {place} {value:+g}" for place, value in told.places]
    collision = f"a collision costs {told.collision_cost:g} nats"
    if not wanted:
        return f"preferences: none, it explores; {collision}"
    return f"preferences, in nats: {', '.join(wanted)}; goal weight {told.goal_weight:g}; {collision}"

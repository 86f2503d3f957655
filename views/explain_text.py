"""Explanations as plain text and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from ..model import LabelledTable
from ..model.labels import shown
from ..model.markup import safe

if TYPE_CHECKING:
    from .explain import BelievedPlace, Explanation, Rejected, WeighedPolicy

HEADINGS = {
    "G": "G",
    "collision": "collision",
    "state_information": "I state",
    "sight_information": "I sight",
    "position_information": "I position",
    "transition_information": "I transition",
    "utility": "utility",
}
"""Columns of the table of policies."""

HOW = {
    "outward": "the least G, or nearly so and furthest out",
    "best": "the least G",
    "sampled": "drawn from P(policy)",
}
"""What the ways to choose mean."""

WORDS = {
    "collision": "risk of collision",
    "state_information": "information about where it is",
    "sight_information": "information about sights (A_o)",
    "position_information": "information about positions (A_p)",
    "transition_information": "information about transitions (B_s)",
    "utility": "utility",
}

EQUATION = "G = collision - I state - I sight - I position - I transition - utility, in nats"


def explanation_text(told: Explanation) -> str:
    """The whole explanation as lines of text."""
    parts = [
        *_belief(told),
        *_choice(told),
        "",
        EQUATION,
        str(_table(told)),
        "",
        *(f"why not {line}" for line in reasons(told)),
        f"first actions: {'; '.join(_first_actions(told))}",
        _preferences(told),
    ]
    return "\n".join(parts)


def explanation_html(told: Explanation) -> str:
    """The whole explanation as HTML."""
    head = "".join(f"<p>{safe(line)}</p>" for line in (*_belief(told), *_choice(told), EQUATION))
    items = "".join(f"<li>{safe(line)}</li>" for line in reasons(told))
    foot = f"<p>first actions: {safe('; '.join(_first_actions(told)))}</p><p>{safe(_preferences(told))}</p>"
    return f"<div>{head}{_table(told).html()}<p>why not</p><ul>{items}</ul>{foot}</div>"


def policy_words(actions: Sequence[str]) -> str:
    """Action names, those that repeat counted: `up x2, right, stay x3`."""
    runs = ((name, len(list(same))) for name, same in groupby(actions))
    return ", ".join(name if many == 1 else f"{name} x{many}" for name, many in runs)


def reasons(told: Explanation) -> list[str]:
    """What ruled out the rejected policies, those of the same fate on one line."""
    fates: dict[str, list[str]] = {}
    for lost in told.rejected:
        fates.setdefault(_reason(lost), []).append(policy_words(lost.policy.actions))
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
    how = HOW[told.choice]
    lines = [
        f"it weighed {told.considered} {'policy' if told.considered == 1 else 'policies'} of {told.length} steps "
        f"({told.generator}, {cut}) and chose ({how}, precision {told.precision:g})",
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
    cells = [[policy.probability, *(policy.terms[name] for name in HEADINGS)] for policy in ordered]
    return LabelledTable(cells, index, ("P", *HEADINGS.values()), "policy (* chosen)", digits=3)


def _reason(lost: Rejected) -> str:
    if lost.verdict == "lot":
        return "as good; the lot fell on another"
    if lost.verdict == "moves":
        return "as good, but it moves more, and where something is preferred those that move least come first"
    if lost.verdict == "outward":
        return "about as good, but while it only explores what leads further out comes first"
    if lost.verdict == "drawn":
        return f"no worse ({lost.difference:+.3f} nats), but the draw from P(policy) fell on another"
    word, by = WORDS[lost.term or ""], lost.worse[lost.term or ""]
    total = f"{lost.difference:.3f} nats worse"
    if lost.term == "collision":
        return f"{total}, most of all by its {word} ({by:.3f} more)"
    if lost.verdict == "later":
        return f"{total}, most of all in {word}: it gets as much, but later, a longer way ({by:.3f} less for it)"
    return f"{total}, most of all in {word} ({by:.3f} less)"


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

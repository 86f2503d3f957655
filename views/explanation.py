"""Why the agent did what it did, as numbers and in words."""

from collections.abc import Hashable
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import groupby
from typing import Any

from ..model import LabelledTable, encode, plain, safe, shown
from ..planning import Term
from .speaking import Spoken


@dataclass(frozen=True, slots=True)
class BelievedPlace:
    """A place that holds belief."""

    place: int
    position: tuple[int, ...] | None  # relative to the start
    senses: dict[str, Hashable]  # the most probable label of each sensor; empty where it was never visited
    probability: float  # Q(s)

    @property
    def sight(self) -> Hashable:
        """The most probable label of the first sensor, or None."""
        return next(iter(self.senses.values()), None)

    def __str__(self) -> str:
        at = "" if self.position is None else f" at {self.position}"
        several = ", ".join(f"{sensor} is {shown(label)}" for sensor, label in self.senses.items())
        looks = f", where {several}" if len(self.senses) > 1 else f", which looks like {shown(self.sight)}"
        return f"place {self.place}{at}{looks if self.senses else ''}"


@dataclass(frozen=True, slots=True)
class WeighedPolicy:
    """One of the policies of a plan."""

    index: int  # its row in `plan.policies`
    actions: tuple[str, ...]  # by name
    terms: dict[str, float]  # of G, and their sum under `G`, in nats: `plan.expected_free_energy.row(index)`
    probability: float  # P(policy)
    place: int | None  # where it most probably ends; None for somewhere never imagined
    place_probability: float  # how probable that is
    contributions: dict[str, float]  # the terms with the sign they have in G: they add up to it

    def __str__(self) -> str:
        runs = ((name, len(list(same))) for name, same in groupby(self.actions))
        return ", ".join(name if many == 1 else f"{name} x{many}" for name, many in runs)


@dataclass(frozen=True, slots=True)
class Rejected:
    """A good policy that was not chosen, and what spoke against it.

    `verdict` is `less` (it lost most in that term), `later` (it gets as much of that term, only later: a longer way),
    or what the way to choose says of a policy that is no worse, such as `lot`.
    """

    policy: WeighedPolicy
    worse: dict[str, float]  # for each term, how much more it adds to G than it does for the chosen policy, in nats
    term: str | None  # in which it lost most; None where it is as good as the chosen one, or better
    verdict: str
    words: str  # the verdict for people

    @property
    def difference(self) -> float:
        """G beyond that of the chosen policy, in nats."""
        return sum(self.worse.values())


@dataclass(frozen=True, slots=True)
class FirstAction:
    """What the plan made of one action as the first."""

    action: str
    blocked: float  # P(blocked) in the places that hold belief, as sensed
    policies: int  # how many of the policies begin with it
    probability: float  # the sum of their P(policy)
    best: float | None  # the least of their G, in nats; None where there are none

    def __str__(self) -> str:
        if self.best is None:
            return f"{self.action} {'blocked' if self.blocked > 0.5 else 'no policy begins with it'}"
        return f"{self.action} P {self.probability:.3f}, best G {_number(self.best)}"


@dataclass(frozen=True, slots=True)
class Explanation:
    """The explanation of an agent's last choice; `str` and `text` give it in words."""

    step: int  # the time step of the choice
    terms: tuple[Term, ...]  # of G
    belief: tuple[BelievedPlace, ...]  # the most probable places
    certainty: float  # Q of the first of them
    doubt: float  # probability that the belief went astray at an earlier step
    considered: int  # number of policies
    length: int  # their number of steps
    cut: int  # prefixes that the bound on the search left out
    generator: str  # of the policies
    choice: str  # the way to choose
    how: str  # what that means
    precision: float  # γ of P(policy)
    chosen: WeighedPolicy
    equals: int  # policies as good, the chosen one included, among which the lot was drawn (1 where none was)
    best: tuple[WeighedPolicy, ...]  # the policies of the least G, in its order
    rejected: tuple[Rejected, ...]  # those of them that were not chosen, and the best of those that were not as good
    actions: tuple[FirstAction, ...]  # what was made of each action as the first
    sights: tuple[tuple[Hashable, float], ...]  # preferred sights, log preferences in nats, before `goal_weight`
    places: tuple[tuple[int, float], ...]  # preferred places, likewise
    goal_weight: float  # weight of the preferences
    collision_cost: float  # what a collision costs, in nats
    spoken: tuple[Spoken, ...]  # what each sensor had to say of the first place, at the step of the choice
    sensors: tuple[tuple[str, Hashable, float], ...]  # preferred labels of other sensors than the first, likewise

    @property
    def text(self) -> str:
        """The explanation as plain text."""
        reasons = (f"why not {line}" for line in self._reasons())
        return "\n".join([*self._head(), str(self._table()), "", *reasons, *self._foot()])

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        told = (self._head(), self._foot())
        head, foot = ("".join(f"<p>{safe(line)}</p>" for line in lines if line) for lines in told)
        items = "".join(f"<li>{safe(line)}</li>" for line in self._reasons())
        return f"<div>{head}{self._table().html()}<p>why not</p><ul>{items}</ul>{foot}</div>"

    def to_dict(self) -> dict[str, Any]:
        """The explanation as plain JSON values. Raises CogmapError: a label cannot be written as JSON."""
        values, of_term = asdict(replace(self, terms=())), ("name", "label", "sign", "kind")
        values["terms"] = [{name: getattr(term, name) for name in of_term} for term in self.terms]
        json = partial(encode, where="explain")
        values["sights"] = [[json(plain(label)), value] for label, value in self.sights]
        values["sensors"] = [[sensor, json(plain(label)), value] for sensor, label, value in self.sensors]
        for voice, told in zip(self.spoken, values["spoken"], strict=True):
            told["sensed"], told["expected"] = json(plain(voice.sensed)), json(plain(voice.expected))
        for place, told in zip(self.belief, values["belief"], strict=True):
            told["senses"] = {sensor: json(plain(label)) for sensor, label in place.senses.items()}
            told["sight"] = json(plain(place.sight))
        return values

    def _head(self) -> list[str]:
        """Belief, choice, and what G is."""
        (first, *others), chosen, many = self.belief, self.chosen, self.considered
        cut = f"{self.cut} prefixes cut" if self.cut else "none cut"
        end = "somewhere never imagined" if chosen.place is None else f"in place {chosen.place}"
        added, taken = ([_heading(term) for term in self.terms if term.sign == sign] for sign in (1.0, -1.0))
        return [
            f"step {self.step}: it believes to be in {first}; certainty {self.certainty:.3f}, doubt {self.doubt:.3f}",
            *([f"  {'; '.join(map(str, self.spoken))}"] if self.spoken else []),
            *(["or in " + "; ".join(f"{place} ({place.probability:.3f})" for place in others)] if others else []),
            f"it weighed {many} {'policy' if many == 1 else 'policies'} of {self.length} steps "
            f"({self.generator}, {cut}) and chose ({self.how}, precision {self.precision:g})",
            f"  {chosen}: G {_number(chosen.terms['G'])} nats, P {chosen.probability:.3f}, "
            f"ends {end} ({chosen.place_probability:.3f})",
            *([f"  by lot among {self.equals} policies that are equally good"] if self.equals > 1 else []),
            "",
            f"G = {' - '.join([' + '.join(added), *taken])}, in nats",
        ]

    def _table(self) -> LabelledTable:
        """The chosen policy, the best ones and the rejected ones, in the order of G."""
        every = (self.chosen, *self.best, *(lost.policy for lost in self.rejected))
        listed = {policy.index: policy for policy in every}
        ordered = sorted(listed.values(), key=lambda policy: (policy.terms["G"], policy.index != self.chosen.index))
        index = tuple(f"{policy}{' *' if policy.index == self.chosen.index else ''}" for policy in ordered)
        terms = sorted(self.terms, key=lambda term: -term.sign)
        names = ["G", *(term.name for term in terms)]
        cells = [[policy.probability, *(policy.terms[name] for name in names)] for policy in ordered]
        return LabelledTable(cells, index, ("P", "G", *map(_heading, terms)), "policy (* chosen)", digits=3)

    def _reasons(self) -> list[str]:
        """What ruled out the rejected policies, those of the same fate on one line."""
        fates: dict[str, list[str]] = {}
        for lost in self.rejected:
            fates.setdefault(lost.words, []).append(str(lost.policy))
        return [f"{' / '.join(policies)}: {fate}" for fate, policies in fates.items()]

    def _foot(self) -> list[str]:
        """The first actions, and the preferences."""
        wanted = [f"sight {shown(label)} {value:+g}" for label, value in self.sights]
        wanted += [f"{sensor} {shown(label)} {value:+g}" for sensor, label, value in self.sensors]
        wanted += [f"place {place} {value:+g}" for place, value in self.places]
        hoped = f", in nats: {', '.join(wanted)}; goal weight {self.goal_weight:g}" if wanted else ": none, it explores"
        return [
            f"first actions: {'; '.join(map(str, self.actions))}",
            f"preferences{hoped}; a collision costs {self.collision_cost:g} nats",
        ]


def _heading(term: Term) -> str:
    """A column of the table of policies."""
    return f"I {term.label.removesuffix(' information')}" if term.kind == "information" else term.label


def _number(value: float) -> str:
    return f"{round(value, 3) + 0.0:.3f}"  # + 0.0: no -0.000

"""The backward pass: from P(x_i | S_i) of every bucket to its belief P(x_i, S_i), and what is read off beliefs."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...model import Factor, FloatArray, IntArray
from .buckets import Buckets, Pass, buckets, forward
from .ordering import elimination
from .solution import Solution
from .tables import Table


@dataclass(frozen=True, slots=True)
class BucketTree(Solution):
    """A tree of buckets in order of elimination; each is calibrated when it is asked for."""

    plan: Buckets  # the buckets
    given: dict[int, int]  # index of each node that was sliced out
    inputs: Sequence[Table]  # the tables of the problem
    log_evidence: float  # log Z
    # for each bucket, one axis a node: over / by is P(x_i | S_i); once it is calibrated, P(x_i, S_i | evidence)
    # stands in its place
    over: list[FloatArray]
    by: Sequence[FloatArray]  # for each bucket the sum of its `over`, as it was, over x_i
    memory: float  # bytes that a joint may take that needs an elimination of its own
    _calibrated: set[int] = field(default_factory=set[int], repr=False, compare=False)

    def joint(self, names: Sequence[str]) -> FloatArray:
        """P(names | evidence), one axis a name; eliminates the rest afresh where no bucket holds them all."""
        problem = self.plan.problem
        if len(names) == 1:
            ((node, mapping),) = problem.located(names)
            if node is not None and mapping is None:
                return self.nodes((node,))
        wanted = problem.nodes(names)
        return problem.expand(names, {wanted: self.nodes(wanted)})

    def nodes(self, wanted: tuple[int, ...]) -> FloatArray:
        """P(nodes | evidence), one axis a node."""
        free = tuple([i for i in wanted if i not in self.given]) if self.given else wanted
        joint = self._free(free) if free else np.ones(())
        if len(free) == len(wanted):
            return joint
        cards = self.plan.problem.cards
        whole = np.zeros([cards[i] for i in wanted])
        whole[tuple([self.given.get(i, slice(None)) for i in wanted])] = joint
        return whole

    def _free(self, wanted: tuple[int, ...]) -> FloatArray:
        # the first of them to leave: its bucket holds them all, or none does
        at = min([self.plan.place[i] for i in wanted])
        if set(wanted) <= set(self.plan.scopes[at]):
            return _marginal(self.belief(at), self.plan.scopes[at], wanted)
        problem = self.plan.problem
        order = elimination(problem, keep=wanted, known=self.given, memory=self.memory)
        fresh = buckets(problem, order, known=self.given, keep=wanted)
        message = forward(fresh, self.inputs, given=self.given, keep=len(wanted)).messages[-1]
        joint = np.exp(message.values) if message.logs else message.values
        return joint / joint.sum()

    def belief(self, at: int) -> FloatArray:
        """P(x_i, S_i) = P(S_i) over_i / by_i, from the last bucket on the way down to this one; 0 / 0 = 0."""
        if at in self._calibrated:
            return self.over[at]
        way = [at]
        while (parent := self.plan.parent(way[-1])) is not None and parent not in self._calibrated:
            way.append(parent)
        for here in reversed(way):
            scope, by = self.plan.scopes[here], self.by[here]
            if len(scope) > 1:
                parent = self.plan.place[scope[1]]
                above = _marginal(self.over[parent], self.plan.scopes[parent], scope[1:])
                ratio = np.divide(above, by, out=np.zeros(by.shape), where=by > 0)
            else:
                ratio = 1.0 / by
            self.over[here] = self.over[here] * ratio
            self._calibrated.add(here)
        return self.over[at]

    def entries(self, factor: Factor) -> tuple[IntArray, FloatArray] | None:
        return self.plan.problem.listed(factor, lambda node: self.nodes((node,)))

    def entropy(self) -> float:
        """H = Σ_i H(x_i, S_i) - H(S_i), in nats."""
        beliefs = [self.belief(at) for at in range(len(self.over))]
        return sum(entropy(belief) - entropy(belief.sum(axis=0)) for belief in beliefs)

    def sample(self, count: int, rng: np.random.Generator) -> IntArray:
        """`[variables, count]` indices of labels, drawn from the posterior: from the last bucket to the first."""
        drawn = np.zeros((len(self.plan.problem.cards), count), dtype=np.int64)
        for node, index in self.given.items():
            drawn[node] = index
        for scope, over in zip(reversed(self.plan.scopes), reversed(self.over), strict=True):
            weights = over[(slice(None), *[drawn[i] for i in scope[1:]])].reshape(len(over), -1)
            drawn[scope[0]] = draw(np.broadcast_to(weights, (len(over), count)), rng)
        return self.plan.problem.columns(drawn)


def tree_of(done: Pass, memory: float, *, root: bool = False) -> BucketTree:
    """The tree of a forward pass; the pass itself stays as it is.

    With `root` the last bucket, that of the nodes kept, has its belief already.
    """
    calibrated = {len(done.over) - 1} if root else set[int]()
    over = list(done.over)
    return BucketTree(done.buckets, dict(done.given), done.tables, done.log_scale, over, done.by, memory, calibrated)


def draw(weights: FloatArray, rng: np.random.Generator) -> IntArray:
    """`[n]` outcomes, each drawn from a column of `weights [outcomes, n]`, which need not be normalised."""
    up_to = np.cumsum(weights, axis=0)
    # the first whose sum is above: it has weight itself, and rounding never leads beyond the last
    return (up_to <= rng.random(weights.shape[1]) * up_to[-1] * (1.0 - 1e-15)).sum(axis=0)


def entropy(belief: FloatArray) -> float:
    """-Σ p log p, in nats."""
    positive = belief[belief > 0]
    return -float(positive @ np.log(positive))


def _marginal(belief: FloatArray, scope: Sequence[int], wanted: Sequence[int]) -> FloatArray:
    """Sum a belief over `scope` down to the axes `wanted`, in that order."""
    if len(scope) == len(wanted):
        summed, left = belief, list(scope)
    else:
        summed = np.add.reduce(belief, axis=tuple([axis for axis, i in enumerate(scope) if i not in wanted]))
        left = [i for i in scope if i in wanted]
    return summed if left == list(wanted) else summed.transpose([left.index(i) for i in wanted])

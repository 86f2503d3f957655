"""Filtering a template for ever: one slice after the other, in constant memory."""

import math

import numpy as np

from ..model import AllEvidence, CogmapError, FactorGraph, FloatArray, Template
from .evidence import given
from .exact import MEMORY, buckets, forward, plan_elimination, reduce
from .posterior import Posterior
from .query import infer

REACH = 600.0  # nats that one factor spans; a message that spans more is the product of several


class Stream:
    """A filter for a template: the posterior of the present slice, given all evidence so far.

    The past enters as a message over the variables that the next slice refers to, kept in logs.

    Attributes:
        template: the template.
        t: the slice that is next.
        memory: bytes that a step may take.

    Raises:
        CogmapError: a variable of the template has a name that ends with an apostrophe.

    Example: `stream = Stream(template); stream.step({"o": "red"}).marginal("s")`, again and again.
    """

    def __init__(self, template: Template, *, start: int = 0, memory: float = MEMORY) -> None:
        if any(name.endswith("'") for name in template.names):
            raise CogmapError("stream: a variable of the template has a name that ends with an apostrophe; rename it")
        self.template, self.t, self.memory = template, start, memory
        self._message: FloatArray | None = None
        self._log_scale = 0.0

    @property
    def log_evidence(self) -> float:
        """log P of all evidence so far."""
        return self._log_scale + (
            0.0 if self._message is None else float(np.logaddexp.reduce(self._message, axis=None))
        )

    def step(self, evidence: AllEvidence | None = None) -> Posterior:
        """Go on to the next slice.

        Args:
            evidence: about its variables, by their names in the template.

        Returns:
            The posterior over this slice and the step to it: the variables of the slice before have names that end
            with an apostrophe (`s'`). Its evidence is that of this step alone.

        Raises:
            ImpossibleEvidence: the evidence contradicts what is known; the stream stays where it is.
            CogmapError: what `infer` raises.
        """
        graph = self._graph()
        posterior = infer(graph, evidence=evidence, memory=self.memory)
        self._pass_on(graph.observe_all(evidence or {}))
        self.t += 1
        return posterior

    def _graph(self) -> FactorGraph:
        graph, template, message = FactorGraph(), self.template, self._message
        before = [f"{name}'" for name in template.interface]
        if message is not None and before:
            template.declare(graph, self.t - 1, lambda name: f"{name}'", only=template.interface)
            # a factor holds plain numbers: a message in logs is a product of roots of it
            finite = message[np.isfinite(message)]
            roots = max(math.ceil(-float(finite.min()) / REACH), 1)
            for at in range(roots):
                graph.factor(f"past{at}" if roots > 1 else "past", before, np.exp(message / roots), kind="prior")
        template.declare(graph, self.t, lambda name: name)
        first = message is None
        template.connect(graph, self.t, lambda name: name, lambda name: f"{name}'", first=first)
        return graph

    def _pass_on(self, graph: FactorGraph) -> None:
        """Sum out everything but the interface."""
        known, names = given(graph), self.template.interface
        problem = reduce(graph, known, plain=True)
        keep = problem.nodes(names)
        plan = plan_elimination(problem, keep=keep, memory=self.memory)
        done = forward(buckets(problem, plan, keep=keep), problem.tables, keep=len(keep))
        self._log_scale += done.log_scale + (done.messages[-1].offset if keep else 0.0)
        message = np.full([graph.variable_named(name).cardinality for name in names], -math.inf)
        where = tuple([known.fixed.get(graph.wiring.number[name], slice(None)) for name in names])
        message[where] = done.messages[-1].log_values() if keep else 0.0
        self._message = message

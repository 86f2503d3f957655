"""Forward and backward messages along a walk, by a tree of products rather than step by step."""

from itertools import pairwise

import numpy as np

from .model import Floats

SAFE = 1e-6  # with pseudocounts from here on, a product of 16 blocks cannot vanish
CHAIN = 12  # so many products and fewer are run through one by one: safe without rescaling, too


class Messages:
    """Workspace for the messages of walks of one length.

    Neighbouring blocks are multiplied in pairs, the products in pairs again, down to a short chain of products;
    messages run along that chain and then down the tree. So a few batched products do what T small ones did.
    Messages and products are rescaled on the way: only their directions mean something.

    Args:
        steps: T - 1, how many blocks there are.
        clones: c.
        pseudocount: of the model; the smaller, the more often products are rescaled.
    """

    def __init__(self, steps: int, clones: int, *, pseudocount: float) -> None:
        self._every = 4 if pseudocount >= SAFE else 1
        sizes = [steps]
        while sizes[-1] > CHAIN:
            sizes.append((sizes[-1] + 1) // 2)
        self.blocks: Floats = np.empty((steps, clones, clones))
        products = [self.blocks, *(np.empty((size, clones, clones)) for size in sizes[1:])]
        forward, backward = ([np.ones((size, clones)) for size in sizes] for _ in range(2))
        views = zip(products, products[1:], forward, forward[1:], backward, backward[1:], strict=False)
        self._levels = [
            _Level(*arrays, rescaled=number % self._every == 0 or number == len(sizes) - 1)
            for number, arrays in enumerate(views, start=1)
        ]
        self._forward, self._backward = forward[0], backward[0]
        self._top = list(zip(products[-1], forward[-1], backward[-1], strict=True))

    def run(self) -> tuple[Floats, Floats]:
        """`[T - 1, c]` forward message into, and backward message behind, each of `blocks`.

        Forward ones sum to 1. The start is uniform. The arrays are reused by the next run.
        """
        for level in self._levels:
            level.up()
        self._chain()
        for level in reversed(self._levels):
            level.down()
        self._forward /= self._forward.sum(axis=1, keepdims=True)
        return self._forward, self._backward

    def _chain(self) -> None:
        for (product, before, _), (_, after, _) in pairwise(self._top):
            np.dot(before, product, out=after)
            if self._every == 1:
                after /= after.max()
        for (product, _, after), (_, _, before) in pairwise(reversed(self._top)):
            np.dot(product, after, out=before)
            if self._every == 1:
                before /= before.max()


class _Level:
    """One level of the tree and the one above it, as views made once."""

    def __init__(
        self,
        below: Floats,
        above: Floats,
        into: Floats,
        into_above: Floats,
        behind: Floats,
        behind_above: Floats,
        *,
        rescaled: bool,
    ) -> None:
        pairs = len(below) // 2
        self._left, self._right, self._both = below[0 : 2 * pairs : 2], below[1::2], above[:pairs]
        self._odd, self._odd_above = below[2 * pairs :], above[pairs:]
        self._products = above.reshape(len(above), -1)
        self._rescaled, self._into_above, self._behind_above = rescaled, into_above, behind_above
        self._copies = [(into[0::2], into_above), (behind[1::2], behind_above[:pairs]), (behind[-1], behind_above[-1])]
        self._row, self._row_out = into_above[:pairs, None, :], into[1::2, None, :]
        self._column, self._column_out = behind_above[:pairs, :, None], behind[0 : 2 * pairs : 2, :, None]

    def up(self) -> None:
        np.matmul(self._left, self._right, out=self._both)
        self._odd_above[:] = self._odd
        if self._rescaled:
            self._products /= self._products.max(axis=1, keepdims=True)

    def down(self) -> None:
        if self._rescaled:
            self._into_above /= self._into_above.max(axis=1, keepdims=True)
            self._behind_above /= self._behind_above.max(axis=1, keepdims=True)
        for target, source in self._copies:
            target[:] = source
        np.matmul(self._row, self._left, out=self._row_out)
        np.matmul(self._right, self._column, out=self._column_out)

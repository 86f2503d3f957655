"""From a view to tiles: likelihoods of each, from pixels or from symbols."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError
from .vocabulary import vocabulary

DOUBT = 7.0  # nats by which the least likely tile is less likely than the most likely one: no look is surer than that
_QUIET = 3.0  # of 255: no camera is taken to be better
_PARTS = 4  # in which looks are compared: small products are not handed to threads, which others may keep waiting
_SPREAD = 0.75  # quantile of the tiles whose misfit tells the noise: some may be none that is known


@dataclass(frozen=True, slots=True)
class View:
    """One view, tile by tile, column by column from the left, each from the far end."""

    log_likelihood: NDArray[np.float64]  # `[n * n, K]` log P(what is seen | tile), the largest 0
    tile: NDArray[np.int64]  # `[n * n]` the most likely tile
    # `[n * n]` whether there is anything to see; false of the agent's own tile, on which it stands
    seen: NDArray[np.bool_]


class Eyes:
    """Recognises tiles. For pixels it estimates noise and brightness in every frame.

    Attributes:
        noise: standard deviation of the noise in pixels of the last frame, of 255; 0 of symbols.
        gain: by how much the last frame was brighter than tiles are.
    """

    def __init__(self) -> None:
        self._words, self.noise, self.gain = vocabulary(), 0.0, 1.0
        known = self._words.codes
        self._number = {tuple(code): i for i, code in enumerate(known.tolist())}

    def look(self, image: Any) -> View:
        """The tiles of an image: `[n, n, 3]` symbols, or pixels of n tiles a side.

        Raises:
            CogmapError: the image is neither.
        """
        image = np.asarray(image)
        if image.ndim != 3 or image.shape[0] != image.shape[1] or image.shape[2] != 3 or len(image) < 3:
            raise CogmapError(
                f"body: an image of shape {image.shape} is no view; give (7, 7, 3), or (56, 56, 3) in RGB"
            )
        if len(image) % 2 and len(image) < 21:
            return self._view(self._symbols(image), len(image))
        size = 7
        if len(image) % size:
            raise CogmapError(
                f"body: an image of {len(image)} pixels a side has not {size} tiles a side; use that view"
            )
        return self._view(self._pixels(image, size), size)

    def _view(self, log_likelihood: NDArray[np.float64], size: int) -> View:
        tile = log_likelihood.argmax(axis=1)
        seen = tile != 0
        seen[size // 2 * size + size - 1] = False
        return View(log_likelihood, tile, seen)

    def _symbols(self, image: NDArray[Any]) -> NDArray[np.float64]:
        """A tile that is in no list is not made out."""
        numbers = [self._number.get(tuple(code), 0) for code in image.reshape(-1, 3).tolist()]
        return _certain(numbers, len(self._words.codes))

    def _pixels(self, image: NDArray[Any], size: int) -> NDArray[np.float64]:
        pixels = len(image) // size
        looks = self._words.looks(pixels)
        tiles = image.reshape(size, pixels, size, pixels, 3).transpose(2, 0, 1, 3, 4).reshape(size * size, -1)
        here = size // 2 * size + size - 1  # the agent is drawn on its own tile
        exact = self._words.exact(pixels)
        numbers = [exact.get(tile.tobytes(), -1) for tile in tiles]
        numbers[here] = max(numbers[here], 0)
        if min(numbers) >= 0:  # no noise at all: there is no doubt
            self.noise, self.gain = 0.0, 1.0
            return _certain(numbers, len(looks))
        seen = tiles.astype(np.float64)
        squared, energy = (seen**2).sum(axis=1), (looks**2).sum(axis=1)
        likeness = np.concatenate([seen @ part.T for part in np.array_split(looks, _PARTS)], axis=1)
        misfit = squared[:, None] - 2.0 * likeness + energy
        best = misfit.argmin(axis=1)
        rows = np.delete(np.arange(len(best)), here)
        lit = energy[best[rows]].sum()
        self.gain = float(likeness[rows, best[rows]].sum() / lit) if lit else 1.0
        if abs(self.gain - 1.0) > 0.005:
            misfit = squared[:, None] - 2.0 * self.gain * likeness + self.gain**2 * energy
        least = misfit.min(axis=1)
        self.noise = float(np.sqrt(np.quantile(least[rows], _SPREAD) / looks.shape[1]))
        variance = max(self.noise, _QUIET) ** 2
        return np.maximum((least[:, None] - misfit) / (2.0 * variance), -DOUBT)


def _certain(numbers: list[int], count: int) -> NDArray[np.float64]:
    log_likelihood = np.full((len(numbers), count), -DOUBT)
    log_likelihood[np.arange(len(numbers)), numbers] = 0.0
    return log_likelihood

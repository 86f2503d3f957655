"""A world as it looks from above, with a path walked through its tiles."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError
from .axes import Axes


@dataclass(frozen=True, eq=False)
class Scene:
    """A picture of a world from above.

    Raises:
        CogmapError: the arrays have other shapes.
    """

    image: NDArray[np.uint8]  # `[height, width, 3]` RGB
    path: NDArray[np.float64]  # `[n, 2]` x and y of each step, in pixels

    def __post_init__(self) -> None:
        if self.image.ndim != 3 or self.image.shape[2] != 3:
            raise CogmapError(f"scene: an image of shape {self.image.shape} is no RGB; give (height, width, 3)")
        if self.path.ndim != 2 or self.path.shape[1] != 2:
            raise CogmapError(f"scene: a path of shape {self.path.shape} has no x and y; give (n, 2)")


def plot_scene(scene: Scene, *, title: str | None = None, ax: Axes | None = None) -> Axes:
    """The image, and the path from black to white upon it."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    ax = Figure().add_subplot() if ax is None else ax
    ax.imshow(scene.image, interpolation="nearest")
    ax.set_axis_off()
    if title is not None:
        ax.set_title(title)
    segments = np.stack([scene.path[:-1], scene.path[1:]], axis=1)
    shades = [str(shade) for shade in np.linspace(0.0, 1.0, max(len(segments), 1))]
    for colours, width in (("white", 4.0), ("black", 3.0), (shades, 2.0)):
        style: dict[str, Any] = {"colors": colours, "linewidths": width, "capstyle": "round"}
        ax.add_collection(LineCollection(list(segments), **style))
    return ax

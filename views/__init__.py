"""How it is shown: the maze, the map learned, and the energies, as matplotlib plots."""

from __future__ import annotations

from .colours import sight_colour
from .energy_plot import plot_expected_free_energy, plot_free_energy
from .figures import explore_figure
from .map_plot import plot_map
from .maze_plot import plot_maze

__all__ = [
    "explore_figure",
    "plot_expected_free_energy",
    "plot_free_energy",
    "plot_map",
    "plot_maze",
    "sight_colour",
]

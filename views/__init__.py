"""How it is shown: the maze, the map learned, beliefs, policies and energies, as matplotlib plots."""

from __future__ import annotations

from .belief_plot import plot_belief
from .colours import sight_colour
from .energy_plot import plot_expected_free_energy, plot_free_energy
from .figures import explore_figure
from .map_plot import plot_map
from .maze_plot import plot_maze
from .policy_plot import plot_policies

__all__ = [
    "explore_figure",
    "plot_belief",
    "plot_expected_free_energy",
    "plot_free_energy",
    "plot_map",
    "plot_maze",
    "plot_policies",
    "sight_colour",
]

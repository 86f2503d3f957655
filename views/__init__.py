"""How it is shown: the maze, the map learned, beliefs, policies and energies, as matplotlib plots."""

from __future__ import annotations

from .belief_map_plot import plot_belief_map
from .belief_plot import plot_belief, plot_belief_bars
from .certainty_plot import plot_certainty, plot_surprise
from .colours import ink_on, sight_colour
from .energy_plot import plot_expected_free_energy, plot_free_energy
from .explain import Explanation, explain
from .figures import explore_figure
from .graph_plot import plot_factor_graph
from .growth_frames import GrowthFrames
from .map_plot import plot_map
from .maze_plot import plot_maze
from .policy_plot import plot_policies, policy_paths
from .recording import Recorder, Recording
from .replay import replay_html
from .terms_plot import plot_terms

__all__ = [
    "Explanation",
    "GrowthFrames",
    "Recorder",
    "Recording",
    "explain",
    "explore_figure",
    "ink_on",
    "plot_belief",
    "plot_belief_bars",
    "plot_belief_map",
    "plot_certainty",
    "plot_expected_free_energy",
    "plot_factor_graph",
    "plot_free_energy",
    "plot_map",
    "plot_maze",
    "plot_policies",
    "plot_surprise",
    "plot_terms",
    "policy_paths",
    "replay_html",
    "sight_colour",
]

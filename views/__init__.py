"""How it is shown: the world, the map learned, beliefs, policies and energies, as plots, words and a page.

Every plot takes `title`, which goes above it, and `ax`, axes to draw on, new ones unless given; it returns the axes.
Pictures of a map take `chart`, the true map (`world.chart`, or a maze) to be drawn faintly beneath, and `start`, the
place of the chart, or row and column, that the agent takes as its origin.
"""

from .belief_plot import plot_belief, plot_belief_bars, plot_belief_map
from .explain import explain
from .explanation import Explanation
from .figures import explore_figure, world_figure
from .graph_plot import plot_factor_graph
from .growth_frames import GrowthFrames
from .map_picture import MapPicture
from .map_plot import plot_map
from .policy_plot import plot_policies, policy_paths
from .recording import Recorder, Recording
from .replay import replay_html
from .scene_plot import Scene, plot_scene
from .showing import Shown, show
from .terms_plot import plot_terms
from .theme import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    Theme,
    contrast,
    hexed,
    ink_on,
    sight_colour,
    theme_of,
)
from .time_plots import plot_certainty, plot_expected_free_energy, plot_free_energy, plot_surprise
from .world_plot import plot_world

__all__ = [
    "BLUE", "GREEN", "GREY", "ORANGE", "PURPLE", "SKY", "VERMILION", "Explanation", "GrowthFrames", "MapPicture",
    "Recorder", "Recording", "Scene", "Shown", "Theme", "contrast", "explain", "explore_figure", "hexed", "ink_on",
    "plot_belief", "plot_belief_bars", "plot_belief_map", "plot_certainty", "plot_expected_free_energy",
    "plot_factor_graph", "plot_free_energy", "plot_map", "plot_policies", "plot_scene", "plot_surprise", "plot_terms",
    "plot_world", "policy_paths", "replay_html", "show", "sight_colour", "theme_of", "world_figure",
]  # fmt: skip

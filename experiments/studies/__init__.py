"""The paper's studies, a file each, and what they share; a study of your own is one file more."""

from .buildings import Buildings
from .figures import legend_below, panels, plot_bars
from .intervals import Interval, Share, bootstrap, wilson
from .running import Options, Outcome, run_studies, run_study
from .study import EVERYTHING, Findings, Study, failed_seeds, studies, study_named
from .tables import Table

__all__ = [
    "EVERYTHING", "Buildings", "Findings", "Interval", "Options", "Outcome", "Share", "Study", "Table", "bootstrap",
    "failed_seeds", "legend_below", "panels", "plot_bars", "run_studies", "run_study", "studies", "study_named",
    "wilson",
]  # fmt: skip

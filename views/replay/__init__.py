"""The replay page: one HTML file that shows a recording step by step."""

from .page import replay_html

__all__ = ["replay_html"]

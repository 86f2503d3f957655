"""Worlds on graphs: places joined by ways of their own, from files of many kinds or from networkx."""

from .build import POSES
from .families import geometric, portal_hall, ring, torus
from .files import is_graph_file, read_graph
from .layout import Layout
from .world import GraphWorld

__all__ = ["POSES", "GraphWorld", "Layout", "geometric", "is_graph_file", "portal_hall", "read_graph", "ring", "torus"]

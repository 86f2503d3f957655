"""Where an agent lives: room mazes and graphs as Gymnasium environments, noise in them, and oracles."""

from . import minigrid
from .base import PlaceEnv
from .behaviour import behaviour, distinguishable
from .builtin import MAZES
from .colours import label_colour
from .cue_maze import NOTHING, REWARD, CueMaze, best_cue_action
from .drawing import draw
from .environment import MazeEnv
from .errors import WorldError
from .generate import comb, hall, office, random_maze, rings, spiral
from .graph import POSES, GraphWorld, Layout, geometric, is_graph_file, portal_hall, read_graph, ring, torus
from .labyrinth import labyrinth
from .load import load_world, register_worlds, world_of
from .maze import Door, Label, Maze, Position
from .motions import GRID, Motions
from .noise import NOISES, NoisyWorld
from .oracle import MOST_EXACT, MOST_TOUR, MOST_WALKED, covering_steps, covering_walk, frontier_walk, tour
from .part import ChartPart
from .protocol import CanClose, CanDisplace, Chart, HasChart, Observation, Place, World, offered, place_of
from .routes import BY, Routes, shortest_path, walk_length
from .text import format_maze, parse_maze
from .text_styles import FORMATS, read_maze
from .wrappers import ListedWays, StateWorld, UnseenWays, frozen_lake

__all__ = [
    "BY", "FORMATS", "GRID", "MAZES", "MOST_EXACT", "MOST_TOUR", "MOST_WALKED", "NOISES", "NOTHING", "POSES", "REWARD",
    "CanClose", "CanDisplace", "Chart", "ChartPart", "CueMaze", "Door", "GraphWorld", "HasChart", "Label", "Layout",
    "ListedWays", "Maze", "MazeEnv", "Motions", "NoisyWorld", "Observation", "Place", "PlaceEnv", "Position", "Routes",
    "StateWorld", "UnseenWays", "World", "WorldError", "behaviour", "best_cue_action", "comb", "covering_steps",
    "covering_walk", "distinguishable", "draw", "format_maze", "frontier_walk", "frozen_lake", "geometric", "hall",
    "is_graph_file", "label_colour", "labyrinth", "load_world", "minigrid", "offered", "office", "parse_maze",
    "place_of", "portal_hall", "random_maze", "read_graph", "read_maze", "register_worlds", "ring", "rings",
    "shortest_path", "spiral", "torus", "tour", "walk_length", "world_of",
]  # fmt: skip

register_worlds()

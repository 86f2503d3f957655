"""A maze as an image, with numpy alone."""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from .colours import label_colour
from .maze import Door, Maze, Position

Image = NDArray[np.uint8]

CELL = 40  # pixels a room, walls included
_WALL = 4  # thickness of a room's wall; two adjacent rooms have one each
_GAP = 12  # pixels from a room's corner to a door

_DARK, _LIGHT, _GROUND = (34, 34, 34), (255, 255, 255), (70, 70, 70)


def draw(
    maze: Maze,
    *,
    agent: Position | None = None,
    rooms: Collection[Position] = (),
    doors: Collection[Door] = (),
) -> Image:
    """The maze as uint8 (rows·40, columns·40, 3).

    Rooms have the colour of their label, doors are gaps in the dark walls. Closed rooms are striped,
    closed doors are walls with a white line. The agent is a white disc with a dark rim.
    """
    height, width = maze.shape
    image = np.full((height * CELL, width * CELL, 3), _GROUND, dtype=np.uint8)
    for room in maze.rooms:
        _draw_room(_cell(image, room), label_colour(maze.sights[room]), closed=room in rooms)
    for door in maze.doors:
        shut = door in doors or door[0] in rooms or door[1] in rooms
        _draw_door(image, door, maze, closed=shut)
    if agent is not None:
        _draw_agent(_cell(image, agent))
    return image


def _cell(image: Image, room: Position) -> Image:
    row, column = room
    return image[row * CELL : (row + 1) * CELL, column * CELL : (column + 1) * CELL]


def _draw_room(cell: Image, colour: tuple[int, int, int], *, closed: bool) -> None:
    cell[:] = _DARK
    floor = cell[_WALL:-_WALL, _WALL:-_WALL]
    floor[:] = colour
    if closed:
        row, column = np.indices(floor.shape[:2])
        floor[(row + column) % 8 < 4] = _DARK


def _draw_door(image: Image, door: Door, maze: Maze, *, closed: bool) -> None:
    (row, column), (other_row, _) = door
    along = slice(_GAP, CELL - _GAP)
    if row == other_row:
        image = image.transpose(1, 0, 2)  # a door to the right is a door downwards in the transposed image
        row, column = column, row
    edge = (row + 1) * CELL
    strip = image[edge - _WALL : edge + _WALL, column * CELL : (column + 1) * CELL]
    if closed:
        strip[_WALL - 1 : _WALL + 1, along] = _LIGHT
    else:
        strip[:_WALL, along] = label_colour(maze.sights[door[0]])
        strip[_WALL:, along] = label_colour(maze.sights[door[1]])


def _draw_agent(cell: Image) -> None:
    row, column = np.indices(cell.shape[:2])
    distance = np.hypot(row - (CELL - 1) / 2, column - (CELL - 1) / 2)
    cell[distance < CELL * 0.27] = _DARK
    cell[distance < CELL * 0.2] = _LIGHT

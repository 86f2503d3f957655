"""A map as text in a terminal."""

from rich.cells import cell_len, set_cell_size
from rich.style import Style
from rich.text import Text

from ...agent import Agent
from ...model import shown
from ...views import MapPicture, hexed, ink_on, sight_colour

WIDEST = 10  # signs of a place
LIKELY = 0.5  # ways that are less probable are not drawn
_OPEN, _ASCII = ("──", "│"), ("--", "|")
_FRAMES = {"here": ">{}<", "visited": " {} ", "imagined": "({})"}


def map_text(agent: Agent, width: int, *, unicode: bool = True) -> Text:
    """The map of an agent: each place with what it shows, (imagined), and >where it believes to be<.

    Maps on a lattice of one or two dimensions that are no wider than `width` signs are drawn as they lie; of others
    each place that was visited has a line, with where its ways lead.
    """
    picture = MapPicture.of(agent.map)
    whole = picture.located and not picture.measured and len(agent.map.motions.displacements[0]) <= 2
    text = _drawn(picture, agent.belief.place, width, unicode) if whole else None
    return text or _listed(picture, agent.belief.place)


def _drawn(picture: MapPicture, here: int, width: int, unicode: bool) -> Text | None:
    """The map as it lies; None where it is too wide."""
    drawn, signs = picture.drawn(), _OPEN if unicode else _ASCII
    labels = {place: shown(label, most=WIDEST) for place, label in drawn.labels.items()}
    at = {(round(row), round(column)): place for place, (row, column) in drawn.cells.items()}
    open_ = {frozenset((a, b)) for a, b, p in drawn.links if p >= LIKELY}
    cell = max((1, *map(cell_len, labels.values())))
    rows, columns = (range(min(part), max(part) + 1) for part in zip(*at, strict=True))
    if len(columns) * (cell + 4) > width:
        return None
    text = Text(no_wrap=True)
    for row in rows:
        for column in columns:
            place = at.get((row, column))
            text.append(*_place(place, labels, drawn.labels, here, cell))
            text.append(signs[0] if frozenset((place, at.get((row, column + 1)))) in open_ else "  ")
        text.append("\n")
        if row == rows[-1]:
            break
        below = (frozenset((at.get((row, column)), at.get((row + 1, column)))) for column in columns)
        text.append("".join((signs[1] if pair in open_ else " ").center(cell + 2) + "  " for pair in below).rstrip())
        text.append("\n")
    return text


def _place(place: int | None, words: dict[int, str], labels: object, here: int, cell: int) -> tuple[str, Style]:
    if place is None:
        return " " * (cell + 2), Style()
    kind = "here" if place == here else "visited" if place in words else "imagined"
    written = _FRAMES[kind].format(set_cell_size(words.get(place, ""), cell))
    if place not in words:
        return written, Style(dim=True)
    colour = sight_colour(labels[place])  # type: ignore[index]
    ink = "#000000" if ink_on(colour) == "black" else "#ffffff"
    return written, Style(color=ink, bgcolor=hexed(colour), bold=place == here)


def _listed(picture: MapPicture, here: int) -> Text:
    """A line a place that was visited: what it shows, and where its ways lead."""
    text, names, stay = Text(), picture.motions.names, picture.motions.stay
    for place, (_, visited, sight, _) in enumerate(picture.places):
        if not visited:
            continue
        leads = {
            names[action]: to
            for action in range(len(names))
            for to, q in (picture.rows.get((place, action), (0, ()))[1])
            if q >= LIKELY and to != place and action != stay
        }
        ways = ", ".join(f"{name} to {to}" for name, to in leads.items()) or "no way known"
        label = "" if sight is None else shown(picture.sights[sight], most=24)
        text.append(f"{'>' if place == here else ' '} place {place} shows {label}: {ways}\n")
    return text

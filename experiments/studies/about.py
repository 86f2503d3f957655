"""What each study asks, and where its figures differ from the published ones."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class About:
    """What a report says besides its figures.

    Attributes:
        title: of the report.
        asked: the question, and how the study goes about it.
        notes: where its figures differ from the published ones and why, and what to keep in mind.
    """

    title: str
    asked: str = ""
    notes: tuple[str, ...] = ()


_STARTS = "Run i has the seed S + i, which draws start and agent; every model sets out from the same starts."
_COUNTED = "A run that gave up is counted and named, never dropped; means over some runs only are marked."
_SIGHTS_AND_DOORS = (
    "cogmap senses the doors of its room and takes each open one as evidence of a transition, whether the place "
    "beyond is new or not; the authors' code does so for new places only, and must walk ways that ours need not."
)

ABOUT = {
    "exploration": About(
        "Steps to learn a maze",
        "How many moves does each model make until it believes every true transition of the maze (walls lead "
        "back, stay stays) at 0.6 or more? The paper's table: our agent beside four clone-structured graphs "
        "(CSCG), which see the sights of rooms alone or with the true position (pose), and navigate by Viterbi or"
        " at random. " + _STARTS,
        (
            _COUNTED,
            "The paper's means leave out the runs of CSCG that never learned, and do not say how many.",
            "Oracle: the exact shortest walk through all rooms from the same starts. The paper's 11 for the 3x3 "
            "mazes is a formula; the true minimum is 8 or 9 by the start.",
            _SIGHTS_AND_DOORS,
            "cogmap takes the best policy with seeded tie-breaks; the authors' code samples among near-equal ones.",
            "CSCG that navigates by Viterbi explores as its setting exploring says. With random, as in the authors' "
            "code, where nothing is preferred while it explores, it makes the same moves from the same seed as the "
            "random one, and both columns are alike; the paper's are, too.",
            "Where all rooms differ, sights alone tell a CSCG as much as sights and positions, and the walks are the "
            "same.",
            "CSCG senses no doors: it must try every move in every room, into walls as well, and random walks that do "
            "so take about as long as the paper reports if they never stay. Its random moves leave staying out, then, "
            "and what staying does is not asked of it; of cogmap it is.",
            "CSCG learns only when it is trained, every few moves: its steps come in multiples of that. A later "
            "training may spoil what an earlier one had right; what counts is the first that has everything right.",
        ),
    ),
    "rooms": About(
        "Steps until every room was entered",
        "How many moves does each model make until it has been in every room once? The paper's figure of room "
        "discovery, with nearest-frontier search and a random walk beside it. The paper claims: our agent "
        "discovers all rooms at least 30 % faster than CSCG. " + _STARTS,
        (
            _COUNTED,
            "The paper gives a figure without numbers; the only published numbers beside ours are of the authors'"
            " code.",
            "For cogmap a room counts once its map has it as visited.",
            "The random walk draws among the open doors. CSCG senses no doors: its random moves are drawn among "
            "all four, those into walls among them.",
        ),
    ),
    "growth": About(
        "Three ways to grow a map",
        "How many moves until every room was visited and every transition learned, by how the map grows? static "
        "knows the number of places from the start, observed adds a place once it was entered, predicted (ours) "
        "once a door to it was seen. After the paper's figure on internal map layouts. " + _STARTS,
        (
            _COUNTED,
            "The paper's figure has no numbers.",
            "Predicted growth needs the fewest moves where a maze has loops. In the T mazes, which are trees, no "
            "place is reached by two doors and imagining brings nothing; in the donut, one ring, all walk the "
            "shortest way.",
        ),
    ),
    "cost": About(
        "Seconds for a hundred steps",
        "How long do 100 forced exploring steps take in the 4x4 maze? The agent goes on when there is nothing "
        "left to explore. The paper's table of computation time; look-ahead 6.",
        (
            "Runs are timed in one process, one after the other, whatever --jobs or --dask say, and the models "
            "take turns.",
            "Each model walks a few steps untimed first, so that late imports are not counted; the world's part is.",
            "The paper's machine, maze and variant of CSCG are not known; its 48.35 s stand beside CSCG on sights"
            " alone.",
            "The authors' CSCG is compiled by numba, compilation left out. Ours is numpy, and ends a training as soon "
            "as an iteration gains less than the tolerance of its settings.",
        ),
    ),
    "localisation": About(
        "Finding out where one is",
        "An agent that knows the aliased T maze is put at its foot, told of it or not, with or without doors as "
        "evidence. How soon does it know where it is, and does it reach its goal?",
        (
            "The paper's agent is told that it was moved and has no likelihood of doors: the condition told, "
            "sights alone.",
            "With sights alone the belief is split over rooms that look alike, as in the paper; doors tell them apart.",
        ),
    ),
    "goals": About(
        "Steps to a goal",
        "How many moves to a preferred sight, against the exact shortest path: with a map, after a move without a"
        " word, and in an unknown maze, against nearest-frontier search?",
        (
            "A goal is reached when the agent chooses to stay on it; passing through does not count.",
            "The authors' agent is told that it was moved, its belief is reset; ours is not told.",
        ),
    ),
    "donut": About(
        "A way that was closed",
        "On its way round the donut the agent meets a room that has been closed since it explored. Does it turn "
        "back at once and take the long way round?",
        ("The paper shows one agent; here every agent is counted, and one is drawn.",),
    ),
    "tolman": About(
        "Tolman's maze in three blocks",
        "Three blocks of runs with one memory: no obstacle, room A closed, room B closed. Which of the three "
        "routes to the goal is taken?",
        (
            "The rooms A and B are inferred from the paper's figures. A closed B cuts route 2 as well, so the "
            "paper's 36 for route 2 with B closed must count attempts; here both are counted.",
            "The paper looks 14 steps ahead; the way round from the block at B takes 15.",
            "Agents fall into two or three walks each: intervals over single runs are too narrow.",
        ),
    ),
    "martinet": About(
        "Detours after forced training",
        "Forced runs, free runs, room A closed, then room B closed, after Martinet et al. (2011). Are the routes "
        "preferred in the order of their length that is left?",
        ("Half of the original's days of training, since nothing changes any more after the second.",),
    ),
    "insight": About(
        "Insight",
        "B is closed straight after training in the open maze. Once the block was met, is route 3 tried before "
        "route 2, which leads to the same block? After Tolman and Honzik (1930), with controls that learn by "
        "reward and have no map.",
        ("The figures of the rats are from a secondary source.",),
    ),
}


def about(study: str) -> About:
    """What the report of that study says; its name alone where nothing is written down."""
    return ABOUT.get(study, About(study))

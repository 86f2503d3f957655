"""What the golden walks are. Their recordings speak of exactly these: a walk that is changed is recorded anew."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .walking import Walk

BUILT_IN = {
    name: Walk(world=world, seed=seed, steps=steps)
    for world, steps in {
        "3x3": 20,
        "3x3_alias": 20,
        "4x4": 26,
        "4x4_alias": 26,
        "t_maze": 20,
        "t_maze_alias": 20,
        "donut": 24,
        "tolman": 36,
    }.items()
    for seed, name in enumerate((world, f"{world} from elsewhere", f"{world} from a third room"))
}

GROWTH = {
    "static, 9 places": Walk(world="3x3", steps=20, settings={"growth": "static", "places": 9}),
    "static, 16 places": Walk(world="4x4_alias", seed=1, steps=30, settings={"growth": "static", "places": 16}),
    "static, places to spare": Walk(world="donut", steps=30, settings={"growth": "static", "places": 20}),
    "static, moved": Walk(
        world="4x4",
        seed=2,
        steps=36,
        settings={"growth": "static", "places": 20},
        events=[(7, "displace", "known")],
    ),
    "observed": Walk(world="3x3_alias", steps=24, settings={"growth": "observed"}),
    "observed, 4x4": Walk(world="4x4", seed=1, steps=36, settings={"growth": "observed"}),
    "observed, tolman": Walk(world="tolman", steps=40, settings={"growth": "observed", "look_ahead": 8}),
    "observed, moved": Walk(
        world="4x4", seed=3, steps=36, settings={"growth": "observed"}, events=[(8, "displace", "known")]
    ),
}

POLICIES = {
    "exhaustive, 2 ahead": Walk(world="3x3_alias", steps=20, settings={"policies": "exhaustive", "look_ahead": 2}),
    "exhaustive, 3 ahead": Walk(world="t_maze", steps=24, settings={"policies": "exhaustive", "look_ahead": 3}),
    "exhaustive, 4 ahead": Walk(
        world="4x4_alias", seed=1, steps=24, settings={"policies": "exhaustive", "look_ahead": 4, "choice": "best"}
    ),
    "self-avoiding, 3 ahead": Walk(world="donut", steps=26, settings={"policies": "self_avoiding", "look_ahead": 3}),
    "self-avoiding, 6 ahead": Walk(
        world="4x4", steps=24, settings={"policies": "self_avoiding", "look_ahead": 6, "choice": "best"}
    ),
    "self-avoiding, to a goal": Walk(
        world="4x4_alias",
        seed=2,
        steps=30,
        settings={"policies": "self_avoiding", "look_ahead": 5},
        events=[(0, "prefer", {"sights": {4: 2.0}})],
    ),
    "l-shaped": Walk(world="donut", steps=26, settings={"policies": "l_shaped"}),
    "l-shaped, 14 ahead": Walk(world="tolman", steps=30, settings={"policies": "l_shaped", "look_ahead": 14}),
    "l-shaped, sampled": Walk(
        world="4x4", seed=1, steps=26, settings={"policies": "l_shaped", "look_ahead": 5, "choice": "sampled"}
    ),
}

CHOICES = {
    "best": Walk(world="4x4", steps=26, settings={"choice": "best"}),
    "best, tolman": Walk(world="tolman", seed=1, steps=36, settings={"choice": "best"}),
    "sampled": Walk(world="3x3_alias", steps=24, settings={"choice": "sampled"}),
    "sampled, imprecise": Walk(world="donut", steps=40, settings={"choice": "sampled", "precision": 1.0}),
    "sampled, even": Walk(
        world="4x4_alias", steps=40, settings={"choice": "sampled", "precision": 0.0, "look_ahead": 3}
    ),
}

LOOK_AHEAD = {
    "1 ahead": Walk(world="3x3", seed=1, steps=24, settings={"look_ahead": 1}),
    "2 ahead": Walk(world="4x4_alias", seed=1, steps=30, settings={"look_ahead": 2}),
    "2 ahead, tolman": Walk(world="tolman", seed=2, steps=44, settings={"look_ahead": 2}),
    "14 ahead": Walk(world="4x4", seed=2, steps=26, settings={"look_ahead": 14}),
    "14 ahead, tolman": Walk(world="tolman", start=(6, 2), steps=36, settings={"look_ahead": 14}),
    "narrow beam": Walk(world="hall", steps=36, settings={"look_ahead": 8, "beam": 4}),
}

MOVED = {
    "moved, known world": Walk(world="3x3_alias", seed=1, steps=36, events=[(20, "displace", "known")]),
    "moved, known 4x4": Walk(world="4x4", seed=1, steps=40, events=[(24, "displace", "known")]),
    "moved, known aliased 4x4": Walk(
        world="4x4_alias", start=(0, 0), steps=44, events=[(20, "displace", (1, 2)), (34, "displace", "known")]
    ),
    "moved, known tolman": Walk(
        world="tolman", start=(6, 2), steps=50, settings={"look_ahead": 8}, events=[(35, "displace", (3, 1))]
    ),
    "moved, known donut": Walk(world="donut", seed=2, steps=40, events=[(22, "displace", "known")]),
    **{
        f"moved early, {world}, seed {seed}": Walk(
            world=world, seed=seed, steps=steps, events=[(at, "displace", "known")]
        )
        for world, seed, at, steps in [
            ("3x3", 0, 4, 30),
            ("3x3", 2, 6, 30),
            ("4x4", 0, 6, 40),
            ("4x4", 2, 9, 40),
            ("4x4_alias", 1, 7, 40),
            ("donut", 0, 5, 36),
            ("donut", 1, 8, 36),
            ("tolman", 3, 12, 50),
        ]
    },
    **{
        f"moved into the unknown, {world}, seed {seed}": Walk(
            world=world, seed=seed, steps=steps, events=[(at, "displace", "unknown")]
        )
        for world, seed, at, steps in [
            ("3x3", 1, 3, 30),
            ("4x4", 1, 6, 44),
            ("4x4_alias", 0, 5, 44),
            ("t_maze", 0, 4, 30),
            ("donut", 3, 4, 36),
            ("tolman", 0, 9, 56),
        ]
    },
    "moved twice": Walk(world="4x4", seed=4, steps=48, events=[(5, "displace", "known"), (11, "displace", "unknown")]),
    "moved again and again": Walk(
        world="donut", seed=5, steps=48, events=[(at, "displace", "known") for at in (4, 9, 16, 25, 36)]
    ),
    "moved, to be examined": Walk(
        world="4x4_alias",
        seed=3,
        steps=40,
        settings={"filter": {"displacement": 1e-2, "slip": 1e-3}},
        events=[(8, "displace", "known"), (26, "displace", "known")],
    ),
    "never moved, it believes": Walk(
        world="4x4", seed=3, steps=36, settings={"filter": {"displacement": 0.0}}, events=[(18, "displace", "known")]
    ),
    "moved, nothing dropped": Walk(
        world="3x3_alias",
        seed=4,
        steps=36,
        settings={"filter": {"support": 0.0}},
        events=[(5, "displace", "known"), (22, "displace", "known")],
    ),
    "moved, much dropped": Walk(
        world="4x4_alias",
        seed=6,
        steps=36,
        settings={"filter": {"support": 0.05}},
        events=[(22, "displace", "known")],
    ),
    **{
        f"moved where all rooms look alike{knob}": Walk(
            world="hall_blank", seed=seed, steps=60, settings=settings, events=[(40, "displace", "known")]
        )
        for knob, seed, settings in [
            ("", 1, {}),
            (", gtsam", 1, {"engine": "gtsam"}),
            (", short window", 1, {"window": 2}),
            (", 1 start", 1, {"starts": 1}),
            (", 4 starts", 2, {"starts": 4}),
            (", nothing dropped", 1, {"filter": {"support": 0.0}}),
            (", best", 3, {"choice": "best", "look_ahead": 4}),
        ]
    },
}

CLOSED = {
    "a door closes and opens": Walk(
        world="4x4",
        start=(0, 0),
        steps=50,
        events=[
            (18, "close_door", (1, 1), (1, 2)),
            (18, "close_door", (2, 1), (2, 2)),
            (34, "open_door", (1, 1), (1, 2)),
            (34, "open_door", (2, 1), (2, 2)),
        ],
    ),
    "a room closes and opens": Walk(
        world="3x3", start=(0, 0), steps=44, events=[(11, "close_room", (1, 1)), (28, "open_room", (1, 1))]
    ),
    "a room closed at first": Walk(
        world="donut", start=(0, 0), steps=40, events=[(0, "close_room", (3, 2)), (20, "open_room", (3, 2))]
    ),
    "tolman blocked at A": Walk(
        world="tolman",
        start=(6, 2),
        steps=60,
        settings={"look_ahead": 13, "goal_weight": 2.0},
        events=[(28, "prefer", {"sights": {0: 3.0}}), (29, "close_room", (3, 2)), (46, "open_room", (3, 2))],
    ),
    "closed while it is elsewhere": Walk(
        world="4x4_alias",
        seed=1,
        start=(3, 3),
        steps=50,
        events=[(20, "close_room", (0, 1)), (22, "displace", "known"), (40, "open_room", (0, 1))],
    ),
    "a closed world of text rates": Walk(
        world="3x3_alias",
        start=(2, 2),
        steps=44,
        settings={"rates": "text"},
        events=[(11, "close_room", (0, 1)), (28, "open_room", (0, 1))],
    ),
    "a closed world that is forgotten": Walk(
        world="4x4",
        start=(0, 0),
        steps=50,
        settings={"forgetting": 0.05},
        events=[(18, "close_door", (1, 1), (1, 2)), (34, "open_door", (1, 1), (1, 2))],
    ),
}

GOALS = {
    "a sight": Walk(world="4x4", steps=30, events=[(0, "prefer", {"sights": {15: 3.0}})]),
    "a sight of several rooms": Walk(
        world="4x4_alias", seed=1, steps=40, events=[(18, "prefer", {"sights": {4: 3.0}})]
    ),
    "a place": Walk(
        world="4x4_alias", start=(0, 0), steps=40, events=[(17, "prefer", {"positions": {(3, 3): 4.0, (0, 3): 1.0}})]
    ),
    "a place never entered": Walk(
        world="4x4", start=(1, 1), steps=24, events=[(1, "prefer", {"positions": {(1, 0): 3.0}})]
    ),
    "all places never entered": Walk(
        world="tolman",
        seed=1,
        steps=40,
        events=[(at, "prefer", {"imagined": 2.0, "sights": {4: 1.0}}) for at in (2, 6, 10)],
    ),
    "a label never met": Walk(world="3x3_alias", steps=30, events=[(0, "prefer", {"sights": {"nowhere": 3.0}})]),
    "a label met late": Walk(world="house", seed=1, steps=36, events=[(0, "prefer", {"sights": {"attic": 4.0}})]),
    "a sight far away": Walk(
        world="tolman",
        start=(6, 2),
        steps=60,
        settings={"look_ahead": 3},
        events=[(32, "prefer", {"sights": {0: 3.0}}), (46, "prefer", {"sights": {7: 3.0, 13: -1.0}})],
    ),
    "a place far away": Walk(
        world="spiral",
        start=(0, 0),
        steps=60,
        settings={"look_ahead": 3},
        events=[(25, "prefer", {"positions": {(0, 0): 3.0}}), (52, "prefer", {"positions": {(2, 5): 3.0}})],
    ),
    "goal weight 2": Walk(
        world="tolman",
        start=(6, 2),
        steps=40,
        settings={"goal_weight": 2.0},
        events=[(3, "prefer", {"sights": {0: 2.0}})],
    ),
    "goal weight 0.2": Walk(
        world="donut", steps=30, settings={"goal_weight": 0.2}, events=[(4, "prefer", {"sights": {10: 3.0}})]
    ),
    "one goal, then another, then none": Walk(
        world="4x4",
        seed=2,
        steps=60,
        events=[
            (16, "prefer", {"sights": {0: 3.0}}),
            (30, "prefer", {"sights": {15: 3.0, 5: -1.0}}),
            (46, "prefer", {}),
        ],
    ),
    "what it shuns": Walk(world="3x3_alias", seed=1, steps=30, events=[(0, "prefer", {"sights": {3: -3.0, 0: -1.0}})]),
    "best way to a goal": Walk(
        world="donut", seed=1, steps=40, settings={"choice": "best"}, events=[(18, "prefer", {"sights": {0: 3.0}})]
    ),
    "drawn to a goal": Walk(
        world="donut", seed=1, steps=40, settings={"choice": "sampled"}, events=[(18, "prefer", {"sights": {0: 3.0}})]
    ),
    "moved on the way to a goal": Walk(
        world="4x4",
        start=(0, 0),
        steps=44,
        events=[(20, "prefer", {"positions": {(3, 3): 3.0}}), (22, "displace", "known"), (33, "displace", "known")],
    ),
    "moved early with a goal": Walk(
        world="4x4", seed=2, start=(1, 1), steps=40, events=[(5, "prefer", {"imagined": 2.0}), (9, "displace", "known")]
    ),
}

KNOBS = {
    "forgetting": Walk(world="3x3", seed=1, steps=40, settings={"forgetting": 0.02}),
    "forgetting much, moved": Walk(
        world="4x4_alias", seed=2, steps=44, settings={"forgetting": 0.2}, events=[(7, "displace", "known")]
    ),
    "text rates": Walk(world="4x4_alias", seed=2, steps=30, settings={"rates": "text"}),
    "text rates, moved": Walk(
        world="donut", seed=1, steps=36, settings={"rates": "text"}, events=[(8, "displace", "known")]
    ),
    "no discount": Walk(world="4x4", seed=1, steps=26, settings={"discount": 1.0}),
    "discount 0.6": Walk(world="tolman", seed=1, steps=36, settings={"discount": 0.6}),
    "information weight 0": Walk(
        world="4x4_alias",
        steps=36,
        settings={"information_weight": 0.0},
        events=[(6, "prefer", {"sights": {5: 2.0}})],
    ),
    "information weight 3": Walk(
        world="donut", steps=30, settings={"information_weight": 3.0}, events=[(0, "prefer", {"sights": {0: 2.0}})]
    ),
    "collisions cost 5": Walk(world="t_maze_alias", seed=1, steps=26, settings={"collision_cost": 5.0}),
    "collisions cost nothing": Walk(
        world="3x3_alias", seed=2, steps=26, settings={"collision_cost": 0.0, "policies": "exhaustive", "look_ahead": 3}
    ),
    "soon certain": Walk(
        world="4x4_alias", seed=3, steps=40, settings={"certainty": 0.4}, events=[(22, "displace", "known")]
    ),
    "late certain": Walk(
        world="4x4_alias", seed=3, steps=40, settings={"certainty": 0.95}, events=[(9, "displace", "known")]
    ),
    "other priors": Walk(
        world="4x4_alias",
        seed=4,
        steps=36,
        settings={"priors": {"sight": 1e-2, "position": 2.0, "transition": 0.05, "door_floor": 1e-3}},
        events=[(20, "displace", "known")],
    ),
    "a sight that is not there": Walk(world="4x4", seed=5, steps=40, events=[(7, "see", "ghost"), (20, "see", 3)]),
}

GENERATED = {
    "house": Walk(world="house", seed=1, steps=26),
    "random maze": Walk(world="random_12", steps=26),
    "random maze, 4 sights": Walk(world="random_25_alias", seed=1, steps=50, events=[(36, "displace", "known")]),
    "comb": Walk(world="comb", steps=44),
    "comb, 3 sights": Walk(world="comb_alias", seed=1, steps=40, settings={"look_ahead": 4}),
    "spiral": Walk(world="spiral", start=(0, 0), steps=30, events=[(9, "displace", "unknown")]),
    "rings": Walk(world="rings", steps=36),
    "rings, 4 sights": Walk(world="rings_alias", seed=1, steps=44, events=[(30, "displace", "known")]),
    "hall, 3 sights": Walk(world="hall", seed=2, steps=40),
    "hall, moved": Walk(world="hall", seed=3, steps=50, events=[(8, "displace", "known"), (32, "displace", "known")]),
    "labyrinth": Walk(world="labyrinth_100", steps=60),
    "labyrinth with loops": Walk(world="labyrinth_100_loops", seed=1, steps=60, settings={"look_ahead": 10}),
    "labyrinth, moved": Walk(
        world="labyrinth_100", seed=2, steps=60, events=[(15, "displace", "unknown"), (44, "displace", "known")]
    ),
}

OTHER_SPACES = {
    "a line": Walk(world="line", steps=30, events=[(20, "displace", "known")]),
    "a line, moved early": Walk(
        world="line",
        seed=3,
        start=(4,),
        steps=34,
        settings={"policies": "exhaustive", "look_ahead": 4},
        events=[(5, "displace", "known")],
    ),
    "a cube": Walk(world="cube", steps=30, settings={"look_ahead": 4}, events=[(24, "displace", "known")]),
    "a cube with holes": Walk(
        world="branch", seed=1, steps=40, settings={"look_ahead": 3, "policies": "self_avoiding", "choice": "best"}
    ),
    "a star": Walk(world="star", steps=30, settings={"look_ahead": 3}, events=[(7, "displace", "known")]),
}

GROUPS = (
    BUILT_IN,
    GROWTH,
    POLICIES,
    CHOICES,
    LOOK_AHEAD,
    MOVED,
    CLOSED,
    GOALS,
    KNOBS,
    GENERATED,
    OTHER_SPACES,
)
WALKS: Mapping[str, Walk] = {name: walk for group in GROUPS for name, walk in group.items()}
"""All walks, by name."""

RELOADED: Mapping[str, Sequence[int]] = {
    "moved early, donut, seed 1": (6, 14),
    "observed, moved": (10,),
    "a cube": (15, 25),
    "moved early, 4x4, seed 0": (5, 14),
    "static, moved": (9,),
    "4x4_alias": range(1, 26),
    "self-avoiding, to a goal": (12,),
    "sampled, imprecise": (11,),
    "moved where all rooms look alike": (42, 44),
    "moved where all rooms look alike, gtsam": (42,),
    "tolman blocked at A": (30,),
    "one goal, then another, then none": (20, 33, 50),
    "moved early with a goal": (7, 12),
    "forgetting much, moved": (12,),
    "other priors": (21,),
    "labyrinth with loops": (30,),
}
"""Walks, and steps before which their agents are saved and loaded: it makes no difference."""

FEW = (
    "3x3_alias",
    "t_maze",
    "tolman",
    "static, places to spare",
    "observed, moved",
    "exhaustive, 4 ahead",
    "self-avoiding, to a goal",
    "l-shaped, sampled",
    "best, tolman",
    "2 ahead, tolman",
    "moved early, donut, seed 1",
    "moved into the unknown, donut, seed 3",
    "moved where all rooms look alike, best",
    "a room closed at first",
    "a place never entered",
    "goal weight 2",
    "best way to a goal",
    "forgetting",
    "text rates, moved",
    "labyrinth, moved",
    "a cube with holes",
)
"""Walks of every kind, for every day and any machine.

Where ways are equally good, it may be the last bit of a sum that decides which of them the search of `map_guided`
keeps, and with that how probable the others are. Many walks meet such a case; these do not.
"""

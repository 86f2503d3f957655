"""A body in MiniGrid: seven by seven tiles of pixels, doors to open, and the agent above that maps the rooms.

Needs pip install 'cogmap[minigrid]'.
"""

from __future__ import annotations

from cogmap.body import embodied
from cogmap.experiments import Moment, walk


def watch(moment: Moment) -> None:
    seen, world = moment.observation, moment.world.unwrapped
    ways = [
        f"{name}{'' if is_open else '?'}"
        for name, is_open in zip(world.motions.names, seen["open"], strict=True)
        if is_open is not False
    ]
    print(f"{world.low_level_steps:4} low-level steps: floor {seen['sight']}, ways {' '.join(ways)}")


done = walk(embodied("3x3", view="rgb"), seed=2, watch=watch)
print(f"all {len(set(done.path))} rooms in {done.run.low_level_steps} steps, {done.run.low_level_oracle} at best")
print(done.walker.map)

"""A maze of your own, explored and drawn.

Write a row of labels a line, `.` where there is no room; a label may stand for several rooms. The picture shows the
maze with the path, the map half way, where hollow places are imagined, and what each step was worth. In a shell the
same takes no Python: put the text into `house.txt` and run `cogmap explore house.txt`.
"""

from __future__ import annotations

from cogmap.experiments import walk
from cogmap.views import explore_figure
from cogmap.worlds import covering_steps, parse_maze

HOUSE = """
    porch   hall   study  library
    kitchen hall   hall   library
    pantry  garden .      attic
    cellar  garden garden shed
"""

house = parse_maze(HOUSE, name="house")
half = walk(house, seed=1, max_steps=8)
agent = half.walker
explore_figure(house, half.path, map_=agent.map, trace=agent.trace).savefig("house.png")
print(f"half way: {agent.map}")

done = walk(house, seed=1)  # until every room was visited and every transition is believed
print(f"explored: {done.walker.map}")
print("the way:", " ".join(str(house.sights[room]) for room in done.path))
print(f"{len(done.path) - 1} steps; the shortest walk through all rooms has {covering_steps(house, done.path[0])}")

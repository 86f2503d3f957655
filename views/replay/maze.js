// The true maze, who is in it, and the way there.
const CELL = 40, TRAIL = 30;
let mazeBox = null, mazePicture = null;

function prepareMaze() {
  if (!R.maze) {
    $("maze-panel").remove();
    $("map-panel").classList.add("wide");
    return;
  }
  mazeBox = bounds(R.maze);
  const { rows, columns } = mazeBox;
  mazePicture = picture("maze", "The maze, as it is", [-4, -4, columns * CELL + 8, rows * CELL + 8]);
  const floors = shape("g"), names = shape("g", { class: "names" });
  for (const [row, column, look] of R.maze) {
    const [floor, name] = room(row, column, look);
    floors.append(floor);
    names.append(name);
  }
  mazePicture.svg.insertBefore(floors, mazePicture.layer);
  mazePicture.svg.append(names);
  $("maze-legend").textContent = "Colour and label: what is seen there. Line: the last steps; dotted: moved without a word."
    + (R.goals.length ? " Star: what it prefers." : "") + (F.some((f) => f.closed_rooms) ? " Hatched: closed." : "");
}

const mazeX = (column) => (column - mazeBox.left + 0.5) * CELL;
const mazeY = (row) => (row - mazeBox.top + 0.5) * CELL;

function room(row, column, look) {
  const [text, fill, ink] = R.looks[look];
  const x = mazeX(column) - CELL / 2, y = mazeY(row) - CELL / 2;
  const short = clipped(text, 8), goal = R.goals.includes(look);
  const size = fitting(short, goal ? 22 : 32, 11);
  const floor = shape("g", { class: "room" }, [
    shape("title", {}, `${tuple([row, column])}: ${text}`),
    shape("rect", { x: x + 0.5, y: y + 0.5, width: CELL - 1, height: CELL - 1, fill }),
  ]);
  const written = { fill: ink, stroke: fill, "stroke-width": 2.5, "paint-order": "stroke" };
  return [floor, shape("g", {}, [
    shape("text", { x: x + 4, y: y + 12, "font-size": size, ...written }, short),
    ...(goal ? [shape("text", { x: x + CELL - 14, y: y + 13, "font-size": 12, ...written }, "★")] : []),
  ])];
}

// Whether an action (or none) leads from one room to the other.
const steps = (a, b) => same(a, b) || R.motions.displacements.some((vector) => same(b, a.map((x, i) => x + vector[i])));

// The last moves, each with its two ends: walked ones keep to the right, so that there and back are two lines.
function moves(index) {
  const list = [];
  for (let i = Math.max(1, index - TRAIL + 1); i <= index; i++) {
    const [a, b] = [F[i - 1].at, F[i].at];
    if (!a || !b || same(a, b)) continue;
    const walked = steps(a, b), aside = walked ? 0.08 * CELL : 0;
    const right = [aside * Math.sign(a[0] - b[0]), aside * Math.sign(b[1] - a[1])]; // x and y
    list.push({ a, b, walked, right, width: 0.8 + 2 * (1 - (index - i) / TRAIL) });
  }
  return list;
}

// Where the lanes of two moves meet: at a corner in both, else each ends in its own.
function shift(move, other) {
  const corner = other && move.walked && other.walked && move.right[0] * other.right[0] + move.right[1] * other.right[1] === 0;
  return corner ? [move.right[0] + other.right[0], move.right[1] + other.right[1]] : move.right;
}

function trail(index) {
  const rims = [], lines = [], list = moves(index);
  list.forEach((move, i) => {
    const [sx, sy] = shift(move, list[i - 1]), [ex, ey] = shift(move, list[i + 1]);
    const ends = [[mazeX(move.a[1]) + sx, mazeY(move.a[0]) + sy], [mazeX(move.b[1]) + ex, mazeY(move.b[0]) + ey]];
    const next = list[i + 1];
    if (next && move.walked && next.walked && move.right[0] === -next.right[0] && move.right[1] === -next.right[1]) {
      ends.push([mazeX(next.a[1]) + next.right[0], mazeY(next.a[0]) + next.right[1]]);
    }
    const points = ends.map((end) => end.map((x) => x.toFixed(1)).join(",")).join(" ");
    rims.push(shape("polyline", { points, class: "rim", "stroke-width": (move.width + 2).toFixed(1) }));
    lines.push(shape("polyline", { points, class: move.walked ? "trail" : "trail jump", "stroke-width": move.width.toFixed(1) }));
  });
  return [...rims, ...lines];
}

function shut(frame) {
  const parts = [];
  for (const [row, column] of frame.closed_rooms || []) {
    const [x, y] = [mazeX(column), mazeY(row)], h = CELL / 2 - 3;
    parts.push(shape("rect", { x: x - h, y: y - h, width: 2 * h, height: 2 * h, class: "closed" }));
    for (const d of [-0.5, 0, 0.5]) {
      const [a, b] = [Math.max(-h, -h + 2 * h * d), Math.min(h, h + 2 * h * d)];
      for (const [name, width] of [["rim", 3.6], ["hatch", 2]]) {
        parts.push(shape("line", { x1: x + a, y1: y - b, x2: x + b, y2: y - a, class: name, "stroke-width": width }));
      }
    }
  }
  for (const [a, b] of frame.closed_doors || []) {
    const [x, y] = [(mazeX(a[1]) + mazeX(b[1])) / 2, (mazeY(a[0]) + mazeY(b[0])) / 2];
    const [w, h] = a[0] === b[0] ? [2.5, CELL / 2 - 4] : [CELL / 2 - 4, 2.5];
    parts.push(shape("rect", { x: x - w, y: y - h, width: 2 * w, height: 2 * h, class: "closed-door" }));
  }
  return parts;
}

function drawMaze(index) {
  if (!mazePicture) return;
  const frame = F[index], parts = [...shut(frame), ...trail(index)];
  if (frame.at) {
    const [x, y] = [mazeX(frame.at[1]), mazeY(frame.at[0])];
    parts.push(shape("circle", { cx: x, cy: y, r: 9, class: "agent", id: "agent", "data-room": frame.at.join(",") }));
    parts.push(shape("circle", { cx: x, cy: y, r: 3.5, class: "agent-dot" }));
  }
  mazePicture.layer.replaceChildren(...parts);
  mazePicture.about.textContent = `${plural(R.maze.length, "room")}.` + (frame.at ? ` The agent is in room ${tuple(frame.at)}.` : "")
    + (frame.closed_rooms ? ` Closed: ${frame.closed_rooms.map(tuple).join(", ")}.` : "");
}

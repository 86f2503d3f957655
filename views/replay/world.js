// The true world, who is in it, and the way there.
const CELL = 40, TRAIL = 30, ASIDE = 0.08 * CELL;
const lines = new Map(); // of each way, in both directions if it leads both ways
let worldBox = null, worldPicture = null;

const worldX = (column) => (column - worldBox.left + 0.5) * CELL;
const worldY = (row) => (row - worldBox.top + 0.5) * CELL;
const worldPoint = ([row, column]) => [worldX(column), worldY(row)];
const spotOf = (place) => worldPoint(R.world.places[place]);

function prepareWorld() {
  if (!R.world) {
    $("maze-panel").remove();
    $("map-panel").classList.add("wide");
    return;
  }
  worldBox = bounds(R.world.places);
  const { rows, columns } = worldBox, title = R.world.rooms ? "The maze, as it is" : "The world, as it is";
  worldPicture = picture("maze", title, [-4, -4, columns * CELL + 8, rows * CELL + 8]);
  $("maze-panel").querySelector("h2").textContent = title;
  for (const [a, b, oneWay, ...between] of R.world.ways) {
    const line = [spotOf(a), ...between.map(worldPoint), spotOf(b)];
    lines.set(a + "," + b, line);
    if (!oneWay) lines.set(b + "," + a, [...line].reverse());
  }
  const places = R.world.places.map(placeOfWorld);
  const still = shape("g", {}, [...(R.world.rooms ? [] : worldWays()), ...places.map(([floor]) => floor), ...walls()]);
  worldPicture.svg.insertBefore(still, worldPicture.layer);
  worldPicture.svg.append(shape("g", { class: "names" }, places.map(([, name]) => name)));
  $("maze-legend").textContent = "Colour and label: what is seen there. Line: the last steps; dotted: moved without a word."
    + (R.goals.length ? " Star: what it prefers." : "") + (F.some((f) => f.closed_rooms) ? " Hatched: closed." : "");
}

// A room on a grid is a square, any other place a circle; its label is drawn over the trail.
function placeOfWorld([row, column, look], place) {
  const [text, fill, ink] = R.looks[look], [x, y] = worldPoint([row, column]);
  const rooms = R.world.rooms, goal = R.goals.includes(look), star = (x, y) => ({ x, y, "font-size": 12 });
  const written = { fill: ink, stroke: fill, "stroke-width": 2.5, "paint-order": "stroke" };
  const short = clipped(text, rooms ? 8 : 6), h = CELL / 2;
  const floor = shape("g", { class: rooms ? "room" : null }, [
    shape("title", {}, `${said(R.places[place])}: ${text}`),
    rooms ? shape("rect", { x: x - h + 0.5, y: y - h + 0.5, width: CELL - 1, height: CELL - 1, fill })
      : shape("circle", { cx: x, cy: y, r: RADIUS, fill, class: "place" }),
  ]);
  const name = rooms ? shape("text", { x: x - h + 4, y: y - h + 12, "font-size": fitting(short, goal ? 22 : 32, 11), ...written }, short)
    : label(x, y, short, { "font-size": fitting(short, 16, 10), ...written });
  const at = rooms ? star(x + h - 14, y - h + 13) : star(x + 7, y - 7);
  return [floor, shape("g", {}, [name, ...(goal ? [shape("text", { ...at, ...written }, "★")] : [])])];
}

const dotted = (points) => points.map((point) => point.map((x) => x.toFixed(1)).join(",")).join(" ");

// Ways between places that are no rooms; of those that lead one way the half that leaves.
function worldWays() {
  return R.world.ways.map(([a, b, oneWay]) => {
    const line = lines.get(a + "," + b), half = line.slice(0, (line.length >> 1) + 1);
    if (line.length === 2) half[1] = [(line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2];
    return shape("polyline", { points: dotted(oneWay ? half : line), class: "world-way" });
  });
}

function walls() {
  return R.world.walls.map(([top, left, bottom, right]) =>
    shape("line", { x1: worldX(left), y1: worldY(top), x2: worldX(right), y2: worldY(bottom), class: "barrier" }));
}

// The last moves as straight pieces: walked ones keep to the right, so that there and back are two lines.
function moves(index) {
  const list = [];
  for (let i = Math.max(1, index - TRAIL + 1); i <= index; i++) {
    const [a, b] = [F[i - 1].at, F[i].at];
    if (a == null || b == null || a === b) continue;
    const walked = lines.has(a + "," + b), line = walked ? lines.get(a + "," + b) : [spotOf(a), spotOf(b)];
    for (let k = 1; k < line.length; k++) {
      const [dx, dy] = [line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]], far = Math.hypot(dx, dy) || 1;
      const right = walked ? [(-ASIDE * dy) / far, (ASIDE * dx) / far] : [0, 0];
      list.push({ from: line[k - 1], to: line[k], walked, right, width: 0.8 + 2 * (1 - (index - i) / TRAIL) });
    }
  }
  return list;
}

// Of two moves: 1 straight on, 0 a right angle, -1 back again; null where they do not belong together.
const turn = (a, b) => (a && b && a.walked && b.walked ? (a.right[0] * b.right[0] + a.right[1] * b.right[1]) / ASIDE ** 2 : null);

// Where the lanes of two moves meet: at a corner in both, else each ends in its own.
function shift(move, other) {
  const angle = turn(move, other);
  if (angle == null || angle < -0.5) return move.right;
  return [(move.right[0] + other.right[0]) / (1 + angle), (move.right[1] + other.right[1]) / (1 + angle)];
}

const plus = (a, b) => [a[0] + b[0], a[1] + b[1]];

function trail(index) {
  const rims = [], drawn = [], list = moves(index);
  list.forEach((move, i) => {
    const next = list[i + 1], angle = turn(move, next);
    const ends = [plus(move.from, shift(move, list[i - 1])), plus(move.to, shift(move, next))];
    if (angle != null && angle < -0.5) ends.push(plus(next.from, next.right));
    const points = dotted(ends);
    rims.push(shape("polyline", { points, class: "rim", "stroke-width": (move.width + 2).toFixed(1) }));
    drawn.push(shape("polyline", { points, class: move.walked ? "trail" : "trail jump", "stroke-width": move.width.toFixed(1) }));
  });
  return [...rims, ...drawn];
}

function shut(frame) {
  const parts = [];
  for (const place of frame.closed_rooms || []) {
    const [x, y] = spotOf(place), h = R.world.rooms ? CELL / 2 - 3 : RADIUS;
    parts.push(shape("rect", { x: x - h, y: y - h, width: 2 * h, height: 2 * h, class: "closed" }));
    for (const d of [-0.5, 0, 0.5]) {
      const [a, b] = [Math.max(-h, -h + 2 * h * d), Math.min(h, h + 2 * h * d)];
      for (const [name, width] of [["rim", 3.6], ["hatch", 2]]) {
        parts.push(shape("line", { x1: x + a, y1: y - b, x2: x + b, y2: y - a, class: name, "stroke-width": width }));
      }
    }
  }
  for (const door of frame.closed_doors || []) {
    const [[ax, ay], [bx, by]] = door.map(spotOf), h = R.world.rooms ? CELL / 2 - 4 : RADIUS;
    const across = `translate(${(ax + bx) / 2} ${(ay + by) / 2}) rotate(${(180 / Math.PI) * Math.atan2(by - ay, bx - ax)})`;
    parts.push(shape("rect", { x: -2.5, y: -h, width: 5, height: 2 * h, transform: across, class: "closed-door" }));
  }
  return parts;
}

// What a body sees: there is no such panel in a world without one.
function preparePixels() {
  if (!F.some((frame) => frame.pixels)) $("pixels-panel").remove();
  else if (R.world) $("map-panel").classList.add("wide");
}

function drawPixels(frame) {
  const picture = $("pixels");
  if (!picture) return;
  if (frame.pixels) picture.src = frame.pixels;
  else picture.removeAttribute("src");
}

function drawWorld(index) {
  if (!worldPicture) return;
  const frame = F[index], parts = [...shut(frame), ...trail(index)], name = (place) => said(R.places[place]);
  if (frame.at != null) {
    const [x, y] = spotOf(frame.at);
    parts.push(shape("circle", { cx: x, cy: y, r: 9, class: "agent", id: "agent", "data-room": name(frame.at) }));
    parts.push(shape("circle", { cx: x, cy: y, r: 3.5, class: "agent-dot" }));
  }
  worldPicture.layer.replaceChildren(...parts);
  const what = R.world.rooms ? "room" : "place";
  worldPicture.about.textContent = `${plural(R.world.places.length, what)}.` + (frame.at == null ? "" : ` The agent is in ${what} ${name(frame.at)}.`)
    + (frame.closed_rooms ? ` Closed: ${frame.closed_rooms.map(name).join(", ")}.` : "");
}

// The map as it is believed: places, ways between them, the belief, and the paths that are imagined.
const LEAST = 0.05, RADIUS = 10;
let mapBox = null, mapPicture = null, mapCell = 0;

function prepareMap() {
  const cells = R.layout || [];
  for (const frame of R.layout ? [] : F) for (const [, position] of frame.map.places || []) if (position) cells.push(flat(position));
  mapBox = bounds(cells);
  mapPicture = picture("map", "The map, as it is believed", [-4, -4, mapBox.columns * CELL + 8, mapBox.rows * CELL + 8]);
}

// How many pixels a cell is wide: small texts are left out. Asked for once a layout, since it makes the browser lay out.
function measureMap() {
  const { clientWidth, clientHeight } = mapPicture.svg;
  mapCell = CELL * Math.min(clientWidth / (mapBox.columns * CELL + 8), clientHeight / (mapBox.rows * CELL + 8));
}

const centre = ([row, column]) => [(column - mapBox.left + 0.5) * CELL, (row - mapBox.top + 0.5) * CELL];

function waysAndWalls() {
  const ways = [], walls = [];
  for (const { place, action, known, pairs } of map.ways.values()) {
    const here = map.places[place].position;
    if (!here || action === R.motions.stay) continue;
    const [x, y] = centre(here), vector = R.layout ? null : R.motions.displacements[action], [down, right] = vector ? flat(vector) : [0, 0];
    for (const [there, p] of pairs) {
      if (p < LEAST) continue;
      if (there === place && vector) {
        const [cx, cy] = [x + 0.42 * CELL * right, y + 0.42 * CELL * down];
        const [wx, wy] = [0.22 * CELL * Math.sign(down), 0.22 * CELL * Math.sign(right)];
        const line = { x1: cx - wx, y1: cy - wy, x2: cx + wx, y2: cy + wy };
        walls.push(shape("line", { ...line, class: `wall ${known}`, "stroke-width": 1 + 3 * p, opacity: (0.25 + 0.75 * p).toFixed(2) }));
      } else if (there !== place && map.places[there] && map.places[there].position) {
        const [ex, ey] = centre(map.places[there].position);
        const line = { x1: x, y1: y, x2: (x + ex) / 2, y2: (y + ey) / 2 };
        ways.push(shape("line", { ...line, class: `way ${known}`, "stroke-width": (0.8 + 3.2 * p).toFixed(2), opacity: (0.15 + 0.85 * p).toFixed(2) }));
      }
    }
  }
  return [...ways, ...walls];
}

function placeMarks(index) {
  const parts = [], size = mapCell;
  map.places.forEach(({ position, visited, look: seen_, p, since }, place) => {
    if (!position) return;
    const [x, y] = centre(position);
    const fresh = since === index ? " fresh" : "";
    const look = visited && seen_ != null ? R.looks[seen_] : null;
    const marks = [shape("title", {}, placeName(place) + (look ? `: ${look[0]} (${percent(p)})` : ", imagined"))];
    marks.push(shape("circle", { cx: x, cy: y, r: RADIUS, fill: look && look[1], class: (look ? "place" : "place hollow") + fresh }));
    if (look && size >= 20) {
      const short = clipped(look[0], 6);
      marks.push(label(x, y, short, { "font-size": fitting(short, 16, 10), fill: look[2] }));
    }
    if (size >= 38) marks.push(shape("text", { x: x + 13, y: y - 11, class: "tag" }, String(place)));
    parts.push(shape("g", {}, marks));
  });
  return parts;
}

function halos(frame) {
  return frame.belief.filter(([place]) => map.places[place].position).map(([place, q]) => {
    const [x, y] = centre(map.places[place].position);
    return shape("circle", { cx: x, cy: y, r: RADIUS + 3.5, class: "halo", "stroke-width": (1 + 4 * q).toFixed(2), opacity: (0.2 + 0.8 * q).toFixed(2), "data-place": place });
  });
}

// The corners of an imagined path, until it leaves what has a position.
function corners(path) {
  const points = [];
  for (const place of path) {
    const known = map.places[place];
    if (!known || !known.position) break;
    points.push(centre(known.position));
  }
  return points;
}

// Each way as dark as it is probable that it will be walked, over the policies that are kept.
function imaginedPaths(plan) {
  const shares = new Map(), ends = new Map();
  plan.paths.forEach((path, i) => {
    const points = corners(path), mine = new Set();
    for (let k = 1; k < points.length; k++) {
      const ends_ = [points[k - 1].join(" "), points[k].join(" ")].sort();
      if (ends_[0] !== ends_[1]) mine.add(ends_.join(" "));
    }
    for (const way of mine) shares.set(way, (shares.get(way) || 0) + plan.P[i]);
    if (points.length) {
      const end = points[points.length - 1].join(" ");
      ends.set(end, (ends.get(end) || 0) + plan.P[i]);
    }
  });
  const drawn = [...shares].filter(([, p]) => p >= 0.01).sort((a, b) => a[1] - b[1]);
  const parts = drawn.map(([way, p]) => {
    const [x1, y1, x2, y2] = way.split(" ");
    return shape("line", { x1, y1, x2, y2, class: "imagined-path", opacity: (0.12 + 0.8 * Math.min(p, 1)).toFixed(2) });
  });
  for (const [end, p] of ends) {
    const [cx, cy] = end.split(" ");
    if (p >= 0.01) parts.push(shape("circle", { cx, cy, r: 14.5, class: "imagined-end", opacity: (0.12 + 0.8 * Math.min(p, 1)).toFixed(2) }));
  }
  const points = corners(plan.paths[plan.chosen]);
  const line = { points: points.map((p) => p.join(",")).join(" ") };
  if (points.length > 1) parts.push(shape("polyline", { ...line, class: "chosen-path under" }), shape("polyline", { ...line, class: "chosen-path" }));
  return parts;
}

function drawMap(index) {
  const frame = mapAt(index) && F[index];
  mapPicture.layer.replaceChildren(...waysAndWalls(), ...imaginedPaths(frame.plan), ...halos(frame), ...placeMarks(index));
  const visited = map.places.filter((place) => place.visited).length;
  const lost = map.places.filter((place) => !place.position).length;
  const about = `${plural(map.places.length, "place")}, ${visited} visited.` + (lost ? ` ${lost} without a position.` : "");
  mapPicture.about.textContent = `${about} ${believed(frame)}`;
  $("map-legend").textContent = `${about} Hollow: imagined. Faint lines: weak links; dashed: imagined. Bars: ways believed blocked. Ring: belief. `
    + "Broad lines: imagined paths, as dark as probable; thin: the chosen one.";
}

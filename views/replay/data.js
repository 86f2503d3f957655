// The recording, and the map after each of its steps.
const R = JSON.parse($("recording").textContent);
const F = R.frames;
const ACTIONS = R.motions.names;
const ARROWS = ACTIONS.map((name, action) => arrow(R.motions.displacements[action], name));

function arrow(vector, name) {
  const [down, right] = vector ? flat(vector) : [9, 9];
  if (Math.abs(down) + Math.abs(right) === 0) return "·";
  if (Math.abs(down) + Math.abs(right) > 1) return name.slice(0, 1);
  return down < 0 ? "↑" : down > 0 ? "↓" : right < 0 ? "←" : "→";
}

// A label as the file has it: plain values, and tuples as {"tuple": [...]}.
function said(value) {
  if (value && typeof value === "object") return `(${value.tuple.map(said).join(", ")})`;
  return typeof value === "number" ? minus(String(value)) : String(value);
}

// Maps: changed in place from step to step; a copy is kept every so often, to go back to.
const EVERY = 25;
const kept = [];
const map = { at: -1, places: [], ways: new Map() };

function change(delta) {
  if (delta.size !== undefined && delta.size < map.places.length) {
    map.places.length = delta.size;
    for (const key of map.ways.keys()) if (Math.floor(key / ACTIONS.length) >= delta.size) map.ways.delete(key);
  }
  for (const [place, position, visited, sight, p] of delta.places || []) {
    const since = map.places[place] ? map.places[place].since : map.at;
    const cell = R.layout ? R.layout[place] : position && flat(position);
    map.places[place] = { position: cell, exact: position, visited, look: sight == null ? null : R.sights[sight], p, since };
  }
  for (const [place, action, known, ...ways] of delta.ways || []) {
    const pairs = [];
    for (let i = 0; i < ways.length; i += 2) pairs.push([ways[i], ways[i + 1]]);
    map.ways.set(place * ACTIONS.length + action, { place, action, known: R.known[known], pairs });
  }
}

function mapAt(index) {
  const from = Math.floor(index / EVERY);
  if (map.at > index || (map.at < index - EVERY && kept[from])) {
    const copy = kept[from] || { at: -1, places: [], ways: new Map() };
    Object.assign(map, { at: copy.at, places: copy.places.slice(), ways: new Map(copy.ways) });
  }
  while (map.at < index) {
    map.at += 1;
    change(F[map.at].map);
    if (map.at % EVERY === 0) kept[map.at / EVERY] = { at: map.at, places: map.places.slice(), ways: new Map(map.ways) };
  }
  return map;
}

// Where the agent is in truth, in its own coordinates; null where that is not known.
const vector = (place) => (place && place.tuple && place.tuple.every((x) => typeof x === "number") ? place.tuple : null);
function truth(frame) {
  const [here, origin] = [frame.at, R.origin].map((place) => (place == null ? null : vector(R.places[place])));
  return here && origin && here.map((x, i) => x - origin[i]);
}
const same = (a, b) => a.length === b.length && a.every((x, i) => x === b[i]);

// All cells of the map at any step: the picture keeps its scale.
function bounds(cells) {
  const rows = cells.map((c) => c[0]), columns = cells.map((c) => c[1]);
  const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);
  const most = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
  if (!cells.length) return { top: 0, left: 0, rows: 1, columns: 1 };
  return { top: least(rows), left: least(columns), rows: most(rows) - least(rows) + 1, columns: most(columns) - least(columns) + 1 };
}

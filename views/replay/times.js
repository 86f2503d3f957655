// Free energy, certainty and the size of the map over time, with a mark at the present step.
const STRIP = 62, GAP = 26, LEFT = 44, RIGHT = 10;
let timesPicture = null, timesWidth = 0;

const sizes = [];
function measureMaps() {
  const visited = [];
  for (let i = 0; i < F.length; i++) {
    const delta = F[i].map;
    if (delta.size !== undefined) visited.length = delta.size;
    for (const [place, , seen_] of delta.places || []) visited[place] = seen_;
    let many = 0;
    for (const flag of visited) many += flag ? 1 : 0;
    sizes.push([visited.length, many]);
  }
}

const timeX = (i) => LEFT + (F.length === 1 ? 0.5 : i / (F.length - 1)) * (timesWidth - LEFT - RIGHT);

function strip(at, name, lines, { low = 0, high, unit = "" }) {
  const top = at * (STRIP + GAP) + 20;
  const y = (value) => top + STRIP - ((value - low) / (high - low || 1)) * STRIP;
  const parts = [
    shape("text", { x: LEFT, y: top - 7, class: "strip-name" }, name),
    shape("line", { x1: LEFT, x2: timesWidth - RIGHT, y1: y(low), y2: y(low), class: "axis" }),
    shape("text", { x: LEFT - 6, y: y(high) + 4, class: "tick" }, minus(String(high)) + unit),
    shape("text", { x: LEFT - 6, y: y(low) + 4, class: "tick" }, minus(String(low))),
  ];
  for (const [values, kind] of lines) {
    const points = values.map((value, i) => `${timeX(i).toFixed(1)},${y(Math.min(value, high)).toFixed(1)}`).join(" ");
    parts.push(values.length > 1 ? shape("polyline", { points, class: "line " + kind })
      : shape("circle", { cx: timeX(0), cy: y(values[0]), r: 2.5, class: "dot " + kind }));
  }
  return parts;
}

const ceiling = (values, least) => {
  const top = values.reduce((a, b) => Math.max(a, b), least);
  return top > 10 ? Math.ceil(top) : Math.ceil(top * 10) / 10;
};

function layTimes() {
  timesWidth = Math.max($("times").clientWidth, 240);
  const height = 3 * (STRIP + GAP) + 22;
  timesPicture = picture("times", "Free energy, certainty and size of the map over time", [0, 0, timesWidth, height]);
  const energy = F.map((f) => f.free_energy), complexity = F.map((f) => f.complexity);
  const still = shape("g", {}, [
    ...strip(0, "F = surprise (line), complexity (dashed), nats", [[complexity, "second"], [energy, "first"]], { low: Math.min(0, Math.floor(Math.min(...energy))), high: ceiling(energy, 1) }),
    ...strip(1, "certainty (line), doubt (dotted)", [[F.map((f) => f.doubt), "third"], [F.map((f) => f.certainty), "first"]], { high: 1 }),
    ...strip(2, "places: all (dashed), visited (line)", [[sizes.map((s) => s[0]), "second"], [sizes.map((s) => s[1]), "first"]], { high: Math.max(...sizes.map((s) => s[0]), 1) }),
    shape("text", { x: timeX(0), y: height - 6, class: "tick begin" }, String(F[0].step)),
    ...(F.length > 1 ? [shape("text", { x: timeX(F.length - 1), y: height - 6, class: "tick" }, "step " + F[F.length - 1].step)] : []),
  ]);
  timesPicture.svg.insertBefore(still, timesPicture.layer);
  timesPicture.svg.addEventListener("pointerdown", (event) => jump(event));
  timesPicture.svg.addEventListener("pointermove", (event) => event.buttons && jump(event));
}

function jump(event) {
  const box = timesPicture.svg.getBoundingClientRect();
  const x = ((event.clientX - box.left) / box.width) * timesWidth;
  go(Math.round(((x - LEFT) / (timesWidth - LEFT - RIGHT)) * (F.length - 1)));
}

function drawTimes(index) {
  const x = timeX(index), frame = F[index];
  timesPicture.layer.replaceChildren(
    shape("line", { x1: x, x2: x, y1: 14, y2: 3 * (STRIP + GAP), class: "cursor", id: "cursor" }),
  );
  timesPicture.about.textContent = `At step ${frame.step}: F ${number(frame.free_energy)} nats, certainty ${number(frame.certainty)}, `
    + `doubt ${number(frame.doubt)}, ${plural(sizes[index][0], "place")}, ${sizes[index][1]} visited.`;
}

// The factor graph of the window, laid out in time: observed variables grey, latent ones white, factors square.
const WIDEST = 124, NARROWEST = 108, ROW = 110, MARGIN = 56;
const WORDS = { s: "place", p: "position", o: "sight", c: "doors", moved: "whether it was put elsewhere" };
const variables = new Map(), factors = [], tops = [], spots = new Map();
let windowPicture = null, windowWidth = 0, column = WIDEST, windowHeight = 0;

function readWindows() {
  const latest = new Map();
  F.forEach((frame, i) => {
    for (const [name, time, ...seen_] of frame.window.variables) variables.set(name, { name, time, observed: seen_.length > 0, seen: seen_[0] });
    for (const [name, kind, ...scope] of frame.window.factors) factors.push({ name, kind, scope });
    for (const [name, top, p] of frame.window.tops) {
      if (!latest.has(name)) latest.set(name, []);
      latest.get(name).push([i, top, p]);
    }
  });
  for (const factor of factors) factor.time = Math.max(...factor.scope.map((name) => variables.get(name).time));
  factors.sort((a, b) => a.time - b.time);
  tops.push(latest);
  readKinds();
}

const ofKind = (name) => name.replace(/\d+$/, "");

// Where each kind of variable stands in the column of its step: those that last in rows, what is observed below them,
// what decides on a transition, such as `moved`, between two columns.
function readKinds() {
  const lasting = new Set(), observed = new Set(), others = new Set();
  for (const factor of factors) {
    const kinds = factor.scope.map(ofKind);
    factor.lasting = kinds.length > 1 && kinds[0] === kinds[1];
    if (factor.lasting) lasting.add(kinds[0]);
  }
  for (const { name, observed: seen_ } of variables.values()) {
    const kind = ofKind(name);
    if (seen_) observed.add(kind);
    else if (!lasting.has(kind)) others.add(kind);
  }
  if (!lasting.size) for (const kind of others) if (kind !== "moved" && lasting.add(kind)) others.delete(kind); // one step alone
  const rows = [...lasting].sort((a, b) => "ps".indexOf(a) - "ps".indexOf(b)), below = 40 + ROW * (Math.max(rows.length, 2) - 1) + 78;
  rows.forEach((kind, i) => spots.set(kind, { aside: 0, y: 40 + i * ROW }));
  for (const kind of others) spots.set(kind, { aside: null, y: 40 + ROW / 2 });
  [...observed].forEach((kind, i, all) => spots.set(kind, { aside: all.length === 1 ? 0 : i % 2 ? 22 : -22, y: below + 56 * (i >> 1), up: i > 1 ? 29 : 36, observed: true }));
  windowHeight = below + 56 * Math.max((observed.size - 1) >> 1, 0) + 28;
}

// What was believed of a variable at a step: the last that was told up to then.
function topAt(name, index) {
  const told = tops[0].get(name) || [];
  for (let k = told.length - 1; k >= 0; k--) if (told[k][0] <= index) return told[k];
  return null;
}

const between = (kind) => spots.get(kind).aside == null;

function spot(name, x) {
  const { aside, y } = spots.get(ofKind(name));
  return [x + (aside ?? -column / 2), y];
}

function factorSpot(factor, places) {
  const points = factor.scope.map((name) => places.get(name)), [[x, y]] = points, first = ofKind(factor.scope[0]);
  const mean = (i) => points.reduce((sum, point) => sum + point[i], 0) / points.length;
  if (factor.lasting) return [x - column / 2, y];
  if (points.length === 1 && between(first)) return [x + 40, y];
  if (spots.get(first).observed) return [x, y - spots.get(first).up];
  return [mean(0), mean(1)];
}

const openWays = (seen_) => {
  const ways = seen_.map((is, action) => (is >= 0.5 && action !== R.motions.stay ? ARROWS[action] : "")).join("");
  return ways || "none";
};

const isWay = (is) => is === null || typeof is === "boolean" || typeof is === "number"; // staying is always true

function variableText(variable, index) {
  const ways = variable.observed && variable.seen && variable.seen.tuple;
  if (ways && ways.length && ways.every(isWay) && ways.some((is) => is === true)) return openWays(ways);
  if (variable.observed) return clipped(said(variable.seen), 7);
  const top = topAt(variable.name, index);
  if (!top) return "";
  return typeof top[1] === "boolean" ? (top[1] ? "yes" : "no") : said(top[1]).replace(/[ ()]/g, "");
}

// Its probability, where it is not all but certain.
function odds(variable, index) {
  const top = variable.observed ? null : topAt(variable.name, index);
  return top && top[2] < 0.995 ? number(top[2]) : "";
}

function factorName({ name, scope, lasting }, x, y) {
  const first = ofKind(scope[0]), { aside, observed, y: row } = spots.get(first);
  if (lasting || (scope.length === 1 && between(first))) return shape("text", { x, y: y + (lasting && row > 40 ? 17 : -9), class: "factor-name middle" }, name);
  if (observed && aside < 0) return shape("text", { x: x - 8, y: y + 4, class: "factor-name end" }, clipped(name, 4));
  return shape("text", { x: x + (observed ? 8 : 6), y: y + (observed ? 4 : -6), class: "factor-name" }, observed ? clipped(name, 4) : name);
}

function layWindow() {
  windowWidth = Math.max($("window").clientWidth, 240);
  windowPicture = picture("window", "The factor graph of the window", [0, 0, windowWidth, windowHeight]);
}

// The variables and factors of the last `most` steps of the window.
function windowAt(index, most) {
  const frame = F[index], { since } = frame.window;
  const active = factors.filter((f) => f.time <= frame.step && (f.kind === "prior" ? f.time === since : f.time > since));
  const first = Math.max(since, frame.step - most + 1);
  const shown = active.filter((f) => f.scope.every((name) => variables.get(name).time >= first)
    && !(f.time === first && f.scope.length === 1 && between(ofKind(f.scope[0])))); // what it acts on is not shown
  return { since, first, shown, names: [...new Set(shown.flatMap((f) => f.scope))] };
}

function drawWindow(index) {
  const across = windowWidth - 2 * MARGIN;
  column = Math.min(Math.max(across / Math.max(F[index].step - F[index].window.since, 1), NARROWEST), WIDEST);
  const room = Math.max(2, Math.floor(across / column + 1e-6) + 1);
  const { since, first, shown, names } = windowAt(index, room);
  const frame = F[index], places = new Map();
  const span = (frame.step - first) * column, offset = Math.max((windowWidth - span) / 2, MARGIN);
  for (const name of names) places.set(name, spot(name, offset + (variables.get(name).time - first) * column));
  const lines = [], marks = [];
  for (const factor of shown) {
    const [x, y] = factorSpot(factor, places);
    for (const name of factor.scope) {
      const [vx, vy] = places.get(name);
      lines.push(shape("line", { x1: x, y1: y, x2: vx, y2: vy, class: "edge" }));
    }
    marks.push(shape("g", {}, [
      shape("title", {}, `${factor.name}(${factor.scope.join(", ")}): ${factor.kind}`),
      shape("rect", { x: x - 4, y: y - 4, width: 8, height: 8, class: "factor " + factor.kind }),
      factorName(factor, x, y),
    ]));
  }
  for (const name of names) {
    const variable = variables.get(name), [x, y] = places.get(name), small = between(ofKind(name));
    const value = clipped(variableText(variable, index), 8);
    marks.push(shape("g", { class: "variable" + (variable.observed ? " observed" : ""), "data-variable": name }, [
      shape("title", {}, `${name}: ${variableText(variable, index)} ${odds(variable, index)}`),
      small ? shape("rect", { x: x - 28, y: y - 14, width: 56, height: 28, rx: 14 }) : shape("circle", { cx: x, cy: y, r: 19 }),
      label(x, y - 5, name, { class: "variable-name", "font-size": fitting(name, small ? 46 : 34, 9.5) }),
      label(x, y + 6, value, { "font-size": fitting(value, small ? 50 : 35, 9.5) }),
      shape("text", { x: small ? x - 27 : x + 17, y: y - (small ? 18 : 15), class: "variable-odds" }, odds(variable, index)),
    ]));
  }
  windowPicture.layer.replaceChildren(...lines, ...marks);
  windowPicture.about.textContent = `Steps ${first} to ${frame.step}: ${plural(names.length, "variable")} and ${plural(shown.length, "factor")}.`;
  $("window-legend").textContent = `Steps ${since} to ${frame.step}${first > since ? `, from ${first} on shown here` : ""}. White: latent, with the most probable value; `
    + `grey: observed. ${[...spots.keys()].filter((kind) => WORDS[kind]).map((kind) => `${kind}: ${WORDS[kind]}`).join(", ")}.`;
}

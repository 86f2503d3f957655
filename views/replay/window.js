// The factor graph of the window, laid out in time: observed variables grey, latent ones white, factors square.
const WIDEST = 124, NARROWEST = 108, ROWS = { p: 40, s: 150, moved: 95, o: 228, c: 228 }, GRAPH = 256, MARGIN = 56;
const variables = new Map(), factors = [], tops = [];
let windowPicture = null, windowWidth = 0, column = WIDEST;

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
}

// What was believed of a variable at a step: the last that was told up to then.
function topAt(name, index) {
  const told = tops[0].get(name) || [];
  for (let k = told.length - 1; k >= 0; k--) if (told[k][0] <= index) return told[k];
  return null;
}

const ofKind = (name) => name.replace(/\d+$/, "");

function spot(name, x) {
  const kind = ofKind(name);
  const aside = kind === "o" ? -22 : kind === "c" ? 22 : kind === "moved" ? -column / 2 : 0;
  return [x + aside, ROWS[kind] ?? ROWS.s];
}

function factorSpot(factor, places) {
  const points = factor.scope.map((name) => places.get(name));
  const mean = (i) => points.reduce((sum, point) => sum + point[i], 0) / points.length;
  const [x, y] = points[0];
  if (factor.kind === "transition" || factor.kind === "motion") return [x - column / 2, y];
  if (factor.kind === "displacement") return [x + 40, y];
  if (factor.kind === "sight" || factor.kind === "walls") return [x, y - 36];
  return [mean(0), mean(1)];
}

const openWays = (seen_) => {
  const ways = seen_.tuple.map((is, action) => (is && action !== R.motions.stay ? ARROWS[action] : "")).join("");
  return ways || "none";
};

function variableText(variable, index) {
  if (variable.observed) return ofKind(variable.name) === "c" && variable.seen.tuple ? openWays(variable.seen) : clipped(said(variable.seen), 7);
  const top = topAt(variable.name, index);
  if (!top) return "";
  return typeof top[1] === "boolean" ? (top[1] ? "yes" : "no") : said(top[1]).replace(/[ ()]/g, "");
}

// Its probability, where it is not all but certain.
function odds(variable, index) {
  const top = variable.observed ? null : topAt(variable.name, index);
  return top && top[2] < 0.995 ? number(top[2]) : "";
}

function factorName({ name, kind }, x, y) {
  const above = { motion: -9, displacement: -9, transition: 17 }[kind];
  if (above) return shape("text", { x, y: y + above, class: "factor-name middle" }, name);
  if (kind === "sight") return shape("text", { x: x - 8, y: y + 4, class: "factor-name end" }, name);
  return shape("text", { x: x + (kind === "walls" ? 8 : 6), y: y + (kind === "walls" ? 4 : -6), class: "factor-name" }, name);
}

function layWindow() {
  windowWidth = Math.max($("window").clientWidth, 240);
  windowPicture = picture("window", "The factor graph of the window", [0, 0, windowWidth, GRAPH]);
}

// The variables and factors of the last `most` steps of the window.
function windowAt(index, most) {
  const frame = F[index], { since } = frame.window;
  const active = factors.filter((f) => f.time <= frame.step && (f.kind === "prior" ? f.time === since : f.time > since));
  const first = Math.max(since, frame.step - most + 1);
  const shown = active.filter((f) => f.scope.every((name) => variables.get(name).time >= first)
    && !(f.kind === "displacement" && f.time === first)); // what it acts on is not shown
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
    const variable = variables.get(name), [x, y] = places.get(name), small = ofKind(name) === "moved";
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
    + "grey: observed. s: place, p: position, o: sight, c: doors, moved: whether it was put elsewhere.";
}

// A step in words.
// "up 2×, left, up"
function route(policy) {
  const runs = [];
  for (const action of policy) {
    const last = runs[runs.length - 1];
    if (last && last[0] === action) last[1] += 1;
    else runs.push([action, 1]);
  }
  return runs.map(([action, n]) => ACTIONS[action] + (n > 1 ? ` ${n}×` : "")).join(", ");
}

function placeName(place) {
  const { exact } = map.places[place];
  return `place ${place}${exact ? " at " + tuple(exact) : ", which has no position yet"}`;
}

function seen(frame) {
  const open = ACTIONS.filter((_, action) => frame.open && frame.open[action] >= 0.5 && action !== R.motions.stay);
  const ways = frame.open ? `; ${open.length ? "open: " + open.join(", ") : "no way is open"}` : "";
  const labels = Object.entries(frame.seen).map(([sensor, seen_]) => [sensor, clipped(R.looks[seen_][0], 40)]);
  const what = labels.length === 1 ? `sees ${labels[0][1]}` : `senses ${labels.map((pair) => pair.join(" ")).join(", ")}`;
  return `Step ${frame.step}. It ${labels.length ? what : "sees nothing"}${ways}.`;
}

// Which sensor spoke for the place that is believed in, and what was expected of it there.
function spoke(frame) {
  const told = Object.entries(frame.spoke || {}).map(([sensor, [nats, expected]]) => {
    if (nats === null) return `${sensor} saw nothing`;
    const wanted = sensor === "open" || expected === null ? "" : ` (expected ${expected})`;
    if (Math.abs(nats) < 5e-4) return `${sensor}${wanted} told nothing of it`;
    return `${sensor}${wanted} ${nats > 0 ? "for" : "against"} it by ${number(Math.abs(nats))} nats`;
  });
  return told.length ? `Of that place spoke: ${told.join("; ")}.` : "";
}

function believed(frame) {
  const [[place, q], second] = frame.belief;
  const { exact } = map.places[place], real = truth(frame);
  let where = `It takes itself to be in ${placeName(place)} (${percent(q)})`;
  if (!frame.certain && second) where += `, or in ${placeName(second[0])} (${percent(second[1])})`;
  if (real && exact) where += same(real, exact) ? ", and is right" : `; in truth it is at ${tuple(real)}`;
  else if (!real && frame.at != null) where += `; in truth it is at ${said(R.places[frame.at])}`;
  if (!frame.certain) where += "; too uncertain to learn";
  return where + ".";
}

function changed(frame) {
  const parts = [];
  const revised = frame.revised || (frame.retracted ?? null) !== null;
  if (frame.moved >= 0.5) parts.push("It finds that it was moved.");
  else if (revised) parts.push("It changes its mind about the map, or about where it is.");
  const count = (kind) => frame.grown.filter((event) => event[0] === kind).length;
  const grown = [["place", "place"], ["sight", "sight"]].map(([kind, what]) => [count(kind), what]).filter(([n]) => n);
  if (grown.length) parts.push(`New to it: ${grown.map(([n, what]) => plural(n, what)).join(" and ")}.`);
  return parts.join(" ");
}

function chosen(frame) {
  const plan = frame.plan, terms = plan.terms[plan.chosen];
  const better = terms.map((x, i) => -R.terms[i].sign * (x - plan.mean[i]));
  const best = better.reduce((top, x, i) => (x > better[top] ? i : top), 0), term = R.terms[best];
  const least = plan.G[plan.chosen] - plan.G[0] <= 0.002;
  const among = !least ? "not quite the best" : plan.ties > 1 ? `one of ${plan.ties} equally good` : "the best";
  const why = better[best] > 0.005
    ? `most of all for ${term.sign > 0 ? "less" : "its"} ${term.meaning} (${number(better[best])} nats better than the average policy)`
    : "none promises more than another";
  const rank = plan.considered > 1 ? `${among} of ${plan.considered} policies: ${why}` : "the only policy";
  return `It chooses ${ACTIONS[plan.action]}, first of ${route(plan.policies[plan.chosen])}; ${rank}.`;
}

function drawWords(frame) {
  const texts = [seen(frame), believed(frame), spoke(frame), changed(frame), chosen(frame)].filter(Boolean);
  $("words").replaceChildren(...texts.map((text) => el("p", {}, text)));
}

// The best policies: P(policy), actions, and G term by term.
const SHOWN = 10;
let tableOpen = false;

const signed = (terms) => terms.map((x, i) => R.terms[i].sign * x);

// Terms that lower G to the left of zero, terms that raise it to the right, on one scale for all.
function termBar(terms, scale) {
  const parts = [shape("rect", { x: 0, y: 0, width: 100, height: 10, class: "ground" })];
  let left = scale.zero, right = scale.zero;
  signed(terms).forEach((x, i) => {
    const width = Math.abs(x) * scale.unit;
    if (width < 0.05) return;
    if (x < 0) left -= width;
    parts.push(shape("rect", { x: x < 0 ? left : right, y: 1, width, height: 8, fill: R.terms[i].colour, class: "term" }));
    if (x > 0) right += width;
  });
  parts.push(shape("line", { x1: scale.zero, x2: scale.zero, y1: 0, y2: 10, class: "zero" }));
  return shape("svg", { viewBox: "0 0 100 10", preserveAspectRatio: "none", class: "bar", "aria-hidden": "true" }, parts);
}

function scaleOf(rows) {
  const sum = (terms, side) => signed(terms).filter((x) => x * side > 0).reduce((a, x) => a + Math.abs(x), 0);
  const low = Math.max(...rows.map((terms) => sum(terms, -1)), 1e-9), high = Math.max(...rows.map((terms) => sum(terms, 1)));
  const unit = 100 / (low + high);
  return { unit, zero: low * unit };
}

function policyRows(plan) {
  const shown = plan.G.map((_, i) => i).filter((i) => i < SHOWN || i === plan.chosen);
  const scale = scaleOf(shown.map((i) => plan.terms[i]));
  const arrows = (policy) => policy.map((action) => ARROWS[action]).join(ARROWS.every((a) => a.length === 1) ? "" : " ");
  return shown.map((i) => el("li", { class: i === plan.chosen ? "chosen" : null }, [
    el("span", { class: "hidden" }, `${i === plan.chosen ? "Chosen: " : ""}${route(plan.policies[i])}, probability `),
    el("span", { class: "value" }, percent(plan.P[i])),
    el("span", { class: "arrows", "aria-hidden": "true", title: route(plan.policies[i]) }, arrows(plan.policies[i])),
    termBar(plan.terms[i], scale),
    el("span", { class: "value" }, [el("span", { class: "unit" }, "G "), number(plan.G[i])]),
  ]));
}

function termLegend(plan) {
  const terms = signed(plan.terms[plan.chosen]);
  return el("ul", { class: "terms" }, R.terms.map((term, i) => el("li", {}, [
    shape("svg", { viewBox: "0 0 10 10", class: "swatch", "aria-hidden": "true" }, shape("rect", { width: 10, height: 10, fill: term.colour, class: "term" })),
    el("span", { class: "name" }, term.label),
    el("span", { class: "value" }, number(terms[i])),
  ])));
}

function numbers(plan) {
  const head = el("tr", {}, ["policy", "P", "G", ...R.terms.map((term) => term.label)].map((name) => el("th", { scope: "col" }, name)));
  const rows = plan.policies.map((policy, i) => el("tr", { class: i === plan.chosen ? "chosen" : null }, [
    el("th", { scope: "row" }, route(policy)),
    ...[number(plan.P[i], 4), number(plan.G[i], 3), ...signed(plan.terms[i]).map((x) => number(x, 3))].map((x) => el("td", {}, x)),
  ]));
  return el("table", {}, [el("thead", {}, head), el("tbody", {}, rows)]);
}

let detailsBody = null;

function preparePolicies() {
  const details = el("details", {}, el("summary", {}, "All numbers of the best policies"));
  detailsBody = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "All numbers of the best policies" });
  details.append(detailsBody);
  details.addEventListener("toggle", () => {
    tableOpen = details.open;
    if (tableOpen) detailsBody.replaceChildren(numbers(F[now].plan));
  });
  $("policies").replaceChildren(el("div", { id: "policy-list" }), details);
}

function drawPolicies(frame) {
  const plan = frame.plan;
  const cut = plan.cut ? `, ${plan.cut} prefixes cut` : "";
  $("policy-list").replaceChildren(
    el("p", { class: "legend" }, `${plan.considered === 1 ? "1 policy" : plan.considered + " policies"} considered${cut}; P(policy), and what G is made of:`),
    el("ol", { class: "policies" }, policyRows(plan)),
    el("p", { class: "legend" }, `G of the chosen one is ${number(plan.G[plan.chosen])} nats, the sum of (negative is good):`),
    termLegend(plan),
  );
  if (tableOpen) detailsBody.replaceChildren(numbers(plan));
}

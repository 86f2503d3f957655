// The belief over places as bars.
function drawBelief(frame) {
  const rows = frame.belief.map(([place, q]) => {
    const { look: seen_, visited } = map.places[place];
    const look = visited && seen_ != null ? R.looks[seen_] : null;
    return [placeName(place), q, look];
  });
  if (frame.rest > 0.0005) rows.push(["all others", frame.rest, null]);
  const list = el("ul", { class: "bars" }, rows.map(([name, q, look]) => {
    const chip = shape("svg", { viewBox: "0 0 20 20", class: "chip", "aria-hidden": "true" }, [
      shape("circle", { cx: 10, cy: 10, r: 8.5, fill: look && look[1], class: look ? "place" : "place hollow" }),
      ...(look ? [label(10, 10, clipped(look[0], 3), { "font-size": fitting(clipped(look[0], 3), 13, 10), fill: look[2] })] : []),
    ]);
    const bar = shape("svg", { viewBox: "0 0 100 10", preserveAspectRatio: "none", class: "bar", "aria-hidden": "true" }, [
      shape("rect", { x: 0, y: 0, width: 100, height: 10, class: "ground" }),
      shape("rect", { x: 0, y: 0, width: 100 * q, height: 10, class: "fill" }),
      shape("line", { x1: 100 * R.threshold, x2: 100 * R.threshold, y1: 0, y2: 10, class: "threshold" }),
    ]);
    return el("li", {}, [chip, el("span", { class: "name" }, name), bar, el("span", { class: "value" }, number(q, 3))]);
  }));
  const facts = [["certainty", frame.certainty], ["doubt", frame.doubt], ["moved", frame.moved]];
  const more = [["F = surprise", frame.free_energy], ["complexity", frame.complexity], ["accuracy", frame.accuracy]];
  const table = el("dl", { class: "facts" }, [
    ...facts.map(([name, x]) => el("div", {}, [el("dt", {}, name), el("dd", {}, number(x, 3))])),
    ...more.map(([name, x]) => el("div", {}, [el("dt", {}, name), el("dd", {}, number(x) + " nats")])),
  ]);
  const note = el("p", { class: "legend" }, `It learns while one place holds ${number(R.threshold, 2)} or more (the mark in the bars).`);
  $("belief").replaceChildren(list, table, note);
}

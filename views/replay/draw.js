// Small helpers: elements, SVG, numbers as text. Labels only ever become text nodes or attributes of pictures.
const SVG = "http://www.w3.org/2000/svg";
const $ = (id) => document.getElementById(id);

function put(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) if (value != null) node.setAttribute(name, value);
  for (const child of [].concat(children ?? [])) node.append(child);
  return node;
}
const el = (tag, attributes, children) => put(document.createElement(tag), attributes, children);
const shape = (tag, attributes, children) => put(document.createElementNS(SVG, tag), attributes, children);
const label = (x, y, text, attributes) =>
  shape("text", { x, y, "text-anchor": "middle", "dominant-baseline": "central", ...attributes }, String(text));

// A picture that a screen reader can name: title and description stay, `layer` is drawn anew.
function picture(id, title, box) {
  const name = shape("title", { id: id + "-title" }, title);
  const about = shape("desc", { id: id + "-desc" });
  const layer = shape("g");
  const svg = shape("svg", {
    viewBox: box && box.join(" "), role: "img", id: id + "-svg",
    "aria-labelledby": id + "-title", "aria-describedby": id + "-desc",
  }, [name, about, layer]);
  $(id).replaceChildren(svg);
  return { svg, layer, about };
}

const minus = (text) => text.replace("-", "−");
const number = (x, digits = 2) => minus((Math.abs(x) < 0.5 * 10 ** -digits ? 0 : x).toFixed(digits));
const percent = (p) => (p > 0 && p < 0.01 ? "<1\u00a0%" : p < 1 && p > 0.99 ? ">99\u00a0%" : Math.round(100 * p) + "\u00a0%");
const plural = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
const clipped = (text, most) => (Array.from(text).length > most ? Array.from(text).slice(0, most - 1).join("") + "…" : text);
const flat = (position) => (position.length === 1 ? [0, position[0]] : position);
const tuple = (values) => `(${values.map((x) => minus(String(x))).join(",\u00a0")})`;

// Font size at which a text fits into a box, in units of the picture.
const pen = document.createElement("canvas").getContext("2d"), widths = new Map();
pen.font = "600 100px system-ui, sans-serif"; // as bold as names are
function fitting(text, width, height) {
  if (!widths.has(text)) widths.set(text, Math.max(pen.measureText(text).width / 100, 0.62));
  return Math.min(height, width / widths.get(text));
}

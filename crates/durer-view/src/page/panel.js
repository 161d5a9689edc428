// The panel of a pixel: what its ray meets, in words, numbers and a drawing. The rest of the page uses showPixel and showFailure.
"use strict";
const { showPixel, showFailure } = (() => {

const SVG = "http://www.w3.org/2000/svg";

function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

function draw(name, attributes, ...children) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

function swatch(hex) {
  const element = make("span", { class: "swatch" });
  element.style.background = hex;
  return element;
}

const number = x => x === null || x === undefined ? "infinite" : String(x);
const short = x => String(Number(x.toPrecision(5)));
const vector = v => `<${v.map(number).join(", ")}>`;
const shortly = v => `<${v.map(short).join(", ")}>`;
const WAYS = { "-1": "entering", "0": "grazing", "1": "leaving" };

function showFailure(box, message) {
  box.replaceChildren(make("pre", { class: "error", role: "alert" }, message));
}

function showPixel(box, answer) {
  const parts = [headline(answer)];
  if (answer.source) parts.push(make("h2", {}, `${answer.source.file}, line ${answer.source.line}`), source(answer.source));
  if (answer.hit) parts.push(make("h2", {}, "First hit"), facts(answer));
  parts.push(make("h2", {}, "Along the ray"), along(answer));
  if (answer.crossings.length > 0) parts.push(table(answer));
  if (answer.tree) parts.push(make("h2", {}, "Where the colour comes from"), tree(answer.tree));
  parts.push(make("h2", {}, "Every step of the search"));
  parts.push(make("pre", { class: "words", tabindex: "0", "aria-label": "Every step of the search" }, answer.words));
  box.replaceChildren(...parts);
}

function headline({ hit, tree, pixel }) {
  const line = make("p", { class: "seen", role: "status" });
  if (tree) line.append(swatch(tree.colour.hex));
  const what = hit ? `${surface(hit)} of object ${hit.object}` : "The ray meets nothing";
  line.append(make("span", {}, hit ? what.charAt(0).toUpperCase() + what.slice(1) : what,
    make("span", { class: "hint" }, ` at pixel ${pixel[0]}, ${pixel[1]}`)));
  return line;
}

// The type's name as words: "AxisBox" is "axis box".
const surface = hit => hit.surface ?? "surface";

function source({ line, column, length, first, lines }) {
  const code = make("pre", { class: "code" });
  lines.forEach((text, i) => {
    const row = make("span", { class: "row" }, make("span", { class: "number" }, String(first + i)));
    if (first + i === line) {
      row.classList.add("at");
      const characters = [...text], start = column - 1;
      row.append(characters.slice(0, start).join(""),
        make("span", { class: "word" }, characters.slice(start, start + length).join("")),
        characters.slice(start + length).join(""));
    } else row.append(text);
    code.append(row);
  });
  return code;
}

function facts({ hit, ray }) {
  const rows = [
    ["t", number(hit.t)],
    ["bracket", `[${number(hit.lo)}, ${number(hit.hi)}]`],
    ["width", `${short(hit.hi - hit.lo)} (${((hit.hi - hit.lo) * ray.length).toExponential(2)} in space)`],
    ["distance", number(hit.t * ray.length)],
    ["position", vector(hit.position)],
    ["its bound", vector(hit.bound.map(x => Number(x.toPrecision(3))))],
    ["normal", vector(hit.normal)],
  ];
  if (String(hit.normal) !== String(hit.shading)) rows.push(["shading", vector(hit.shading)]);
  rows.push(["uv", `${hit.uv[0]}, ${hit.uv[1]}`],
    ["crossing", `${WAYS[hit.sign]}, ${hit.kind}, face ${hit.face}`],
    ["primitive", `${hit.primitive}${hit.instance ? `, instance ${hit.instance}` : ""}`]);
  return make("dl", {}, ...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
}

// The ray to scale: crossings as strokes, stretches inside solids as bars.
function along({ crossings, spans, ray, more }) {
  const ends = [...crossings.map(c => c.t), ...spans.flatMap(s => [s.from, s.to])].filter(t => t !== null && t > 0);
  if (ends.length === 0) return make("p", { class: "hint" }, "It crosses no surface.");
  const far = Math.max(...ends), near = Math.min(...ends.concat(spans.map(s => s.from)));
  // A long empty way before the first crossing is cut, so that what follows can be seen.
  const cut = far > 0 && near > 0.6 * far ? near - (far - near) * 0.25 - far * 1e-9 : 0;
  const width = 400, left = 6, right = 10;
  const at = t => left + (t === null ? width - left : Math.min((t - cut) / ((far - cut) * 1.08) * (width - left - right), width - left));
  const svg = draw("svg", {
    class: "along", viewBox: `0 0 ${width} 82`, role: "img",
    "aria-label": `${crossings.length} crossings and ${spans.length} stretches inside solids, from t = ${short(near)} to ${short(far)}`,
  });
  for (const s of spans) {
    const x = at(s.from), end = at(s.to);
    svg.append(draw("rect", { class: "span", x, y: 18, width: Math.max(end - x, 0.8), height: 18, rx: 2 }));
  }
  svg.append(draw("line", { class: "axis", x1: left, x2: width, y1: 27, y2: 27, "stroke-dasharray": cut ? "3 4" : "none" }));
  svg.append(draw("circle", { cx: left, cy: 27, r: cut ? 0 : 3, fill: "currentColor" }));
  let lastLabel = -100;
  crossings.forEach((c, i) => {
    const x = at(c.t), kind = c.sign < 0 ? "enter" : c.sign > 0 ? "leave" : "graze";
    const stroke = draw("line", { class: `${kind}${i === 0 ? " first" : ""}`, x1: x, x2: x, y1: 13, y2: 41 });
    stroke.append(draw("title", {}, `t = ${c.t} in [${c.lo}, ${c.hi}], object ${c.object}, ${WAYS[c.sign]}`));
    svg.append(stroke);
    if (x - lastLabel > 58) {
      svg.append(draw("text", { x, y: 56, "text-anchor": x < 24 ? "start" : x > width - 24 ? "end" : "middle" }, short(c.t)));
      lastLabel = x;
    }
  });
  svg.append(draw("text", { x: width, y: 77, "text-anchor": "end" }, `t, in units of ${short(ray.length)}`));
  if (cut) svg.append(draw("text", { x: 0, y: 77 }, `begins at t = ${short(cut)}`));
  else svg.append(draw("text", { x: 0, y: 77 }, "camera"));
  const box = make("div", {}, svg);
  if (more) box.append(make("p", { class: "hint" }, "There are more crossings than are listed."));
  return box;
}

function table({ crossings, spans }) {
  const head = ["t", "width", "", "object", "primitive", "line"];
  const rows = crossings.slice(0, 200).map(c => [
    number(c.t), (c.hi - c.lo).toExponential(1), WAYS[c.sign] + (c.kind === "simple" ? "" : `, ${c.kind}`),
    c.object, c.primitive, c.line ?? "",
  ]);
  const cells = (kind, row) => row.map(x => make(kind, kind === "th" ? { scope: "col" } : {}, String(x)));
  const list = make("table", {}, make("thead", {}, make("tr", {}, ...cells("th", head))),
    make("tbody", {}, ...rows.map(row => make("tr", {}, ...cells("td", row)))));
  const inside = spans.map(s => `${short(s.from)} to ${s.to === null ? "infinity" : short(s.to)}`);
  const box = make("details", {}, make("summary", {}, `${crossings.length} crossing${crossings.length === 1 ? "" : "s"}`),
    make("div", { class: "table", tabindex: "0" }, list));
  if (inside.length > 0) box.append(make("p", { class: "hint" }, `Inside solids for t from ${inside.slice(0, 40).join("; ")}.`));
  return box;
}

// The tree of rays: each with what it adds to the pixel.
function tree({ rays, more, colour }) {
  const nodes = rays.map(ray => ({ ray, children: [] }));
  const roots = [];
  for (const node of nodes) (node.ray.parent === null ? roots : nodes[node.ray.parent].children).push(node);
  const amount = c => make("span", { class: "amount" }, c.rgb.map(x => x.toFixed(4)).join(" "));
  const item = ({ ray, children }) => {
    const met = ray.hit
      ? ` meets object ${ray.hit.object}${ray.hit.line ? ` (line ${ray.hit.line})` : ""} after ${short(ray.hit.distance)}`
      : " sees the background";
    const li = make("li", {}, swatch(ray.total.hex), ` ${ray.kind}`, make("span", { class: "what" }, met), " ", amount(ray.total));
    const below = [];
    if (ray.hit && (children.length > 0 || ray.shadows.length > 0)) {
      below.push(make("li", {}, swatch(ray.own.hex), make("span", { class: "what" }, " the surface's own light "), amount(ray.own)));
    }
    for (const s of ray.shadows) {
      const full = s.unblocked.rgb.reduce((a, b) => a + Math.abs(b), 0), got = s.arrived.rgb.reduce((a, b) => a + Math.abs(b), 0);
      const how = got === 0 ? "blocked" : got < full * 0.9999 ? "partly blocked" : "free";
      below.push(make("li", {}, swatch(s.arrived.hex),
        make("span", { class: "what" }, ` shadow ray to light ${s.light} at ${shortly(s.target)}: ${how} `), amount(s.arrived)));
    }
    below.push(...children.map(item));
    if (below.length > 0) li.append(make("ul", {}, ...below));
    return li;
  };
  const box = make("div", {}, make("ul", { class: "rays" }, ...roots.map(item)));
  box.append(make("p", { class: "hint" }, "The numbers are red, green and blue as added to the pixel, which has ", amount(colour), "."));
  if (more) box.append(make("p", { class: "hint" }, "There are more rays than are shown."));
  return box;
}

return { showPixel, showFailure };
})();

// The page of `durer view`: the picture, the camera and the views. The panel of a pixel is in panel.js.
"use strict";

const $ = id => document.getElementById(id);
const canvas = $("canvas"), picture = $("picture");
const context = canvas.getContext("2d", { alpha: false });
let image = null;         // the pixels as they are shown
let state = null;         // the last state of the server
let chosen = null;        // the pixel that is marked
const covered = new Set(); // the tiles that have come, until there is a whole picture
let latest = 0;           // the newest generation that this page asked for

// What tests measure: when each generation was asked for, when its first pixels came,
// and when each of its passes was on the screen; and when the first whole picture was.
const timings = window.durerTimings = { asked: {}, tiles: {}, pass: {} };

// ---- from the server --------------------------------------------------------------------------

function follow() {
  const events = new EventSource("events");
  events.addEventListener("state", event => take(() => show(JSON.parse(event.data))));
  events.addEventListener("tiles", event => take(() => paint(event.data)));
  events.onerror = () => {
    say("not connected: the program has ended, or the scene is open in too many windows");
    // A refused stream is not tried again by the browser.
    if (events.readyState === EventSource.CLOSED) setTimeout(follow, 2000);
  };
}

// Messages are taken in order. After a coarse picture the others wait until it is on the screen.
const messages = [];
let held = false;

function take(message) {
  messages.push(message);
  while (!held && messages.length > 0) messages.shift()();
}

function hold(shown) {
  const go = () => {
    if (!held) return;
    held = false;
    while (!held && messages.length > 0) messages.shift()();
  };
  held = true;
  requestAnimationFrame(() => { shown(); setTimeout(go); });
  // A hidden page has no frames.
  setTimeout(go, 100);
}

function show(next) {
  const before = state;
  state = next;
  if (!before || canvas.width !== next.width || canvas.height !== next.height) {
    canvas.width = next.width;
    canvas.height = next.height;
    $("pixel-x").max = next.width - 1;
    $("pixel-y").max = next.height - 1;
    image = context.createImageData(next.width, next.height);
    image.data.fill(255);
  }
  $("name").textContent = next.name;
  $("name").dataset.reads = next.reads;
  document.title = `${next.name} - durer`;
  $("channel").value = next.channel;
  const view = $("channel").selectedOptions[0]?.textContent;
  picture.setAttribute("aria-label", view === "picture" ? `Picture of ${next.name}` : `Picture of ${next.name}: ${view}`);
  if (![...$("aa").options].some(option => option.value === next.aa)) $("aa").add(new Option(next.aa, next.aa));
  $("aa").value = next.aa;
  $("reset").disabled = !next.moved;
  $("camera").textContent = next.camera;
  const { generation, pass, last, ms } = next.painted;
  const current = generation === next.generation;
  const finished = current && last;
  for (const id of ["png", "exr"]) $(id).disabled = !finished;
  if (current) {
    const key = `${generation}/${pass}`;
    // The browser shows the pixels with its next frame.
    if (!(key in timings.pass)) {
      timings.pass[key] = null;
      (pass === 1 ? hold : requestAnimationFrame)(() => { timings.pass[key] = performance.now(); });
    }
    if (generation >= latest) arrived();
  }
  if (next.error) say("the changed scene has an error; this is the last good picture");
  else if (finished) say(`${next.width} x ${next.height}, ${time(ms)}`);
  else say(current && pass >= 3 ? "smoothing edges" : "rendering");
  $("progress").style.width = `${current ? [2, 12, 45, 75, 100][last ? 4 : pass] : 2}%`;
  $("progress").style.opacity = finished ? 0 : 0.8;
  text($("error"), next.error);
  text($("warnings"), next.warnings.join("\n"));
  $("warnings-box").hidden = next.warnings.length === 0;
  $("warnings-box").firstElementChild.textContent = `Warnings (${next.warnings.length})`;
  legend(next);
  if (before && before.reads !== next.reads && chosen) explain(chosen.x, chosen.y);
}

function paint(message) {
  const space = message.indexOf(" ");
  const generation = Number(message.slice(0, space));
  const text = atob(message.slice(space + 1));
  if (text === "") return;
  const byte = i => text.charCodeAt(i);
  const out = new Uint32Array(image.data.buffer);
  const little = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;
  let x0 = Infinity, y0 = Infinity, x1 = 0, y1 = 0;
  for (let i = 0; i < text.length;) {
    const x = byte(i) | byte(i + 1) << 8, y = byte(i + 2) | byte(i + 3) << 8;
    const w = byte(i + 4), h = byte(i + 5), sx = byte(i + 6), sy = byte(i + 7);
    i += 8;
    if (!("picture" in timings)) covered.add(y << 16 | x);
    for (let v = 0; v < h; v += sy) {
      for (let u = 0; u < w; u += sx) {
        const r = byte(i), g = byte(i + 1), b = byte(i + 2);
        i += 3;
        const pixel = little ? 0xff000000 | b << 16 | g << 8 | r : r << 24 | g << 16 | b << 8 | 0xff;
        const right = Math.min(u + sx, w), low = Math.min(v + sy, h);
        for (let yy = v; yy < low; yy++) {
          const row = (y + yy) * canvas.width + x;
          out.fill(pixel, row + u, row + right);
        }
      }
    }
    x0 = Math.min(x0, x); y0 = Math.min(y0, y);
    x1 = Math.max(x1, x + w); y1 = Math.max(y1, y + h);
  }
  context.putImageData(image, 0, 0, x0, y0, x1 - x0, y1 - y0);
  timings.tiles[generation] ??= performance.now();
  if (covered.size === Math.ceil(canvas.width / 32) * Math.ceil(canvas.height / 32) && !("picture" in timings)) {
    timings.picture = null;
    hold(() => { timings.picture = performance.now(); });
  }
}

const time = ms => ms < 1000 ? `${Math.round(ms)} ms` : `${(ms / 1000).toFixed(1)} s`;

function say(what) {
  if ($("status").textContent !== what) $("status").textContent = what;
}

function text(element, what) {
  element.hidden = !what;
  if (element.textContent !== (what ?? "")) element.textContent = what ?? "";
}

const LEGENDS = {
  depth: s => ["near", s[0], s[1], "far: distance of the first hit"],
  normal: () => ["red, green and blue are x, y and z of the normal"],
  object: () => ["one colour for each object of the scene"],
  uv: () => ["red is u, green is v"],
  bound: s => ["", `1e${s[0].toFixed(1)}`, `1e${s[1].toFixed(1)}`, "length of the bracket around the first hit"],
  steps: s => ["", s[0], s[1], "boxes entered and surfaces tested on the way to the first hit"],
  inside: s => ["", s[0], s[1], "separate stretches of the ray inside solids"],
};
const VIRIDIS = "linear-gradient(90deg,#440154,#472c7a,#3b518b,#2c718e,#21908d,#27ad81,#5cc863,#aadc32,#fde725)";

function legend({ channel, scale }) {
  const make = LEGENDS[channel], box = $("legend");
  box.hidden = !make || channel !== "normal" && channel !== "object" && channel !== "uv" && !scale;
  if (box.hidden) return;
  const parts = make(scale);
  if (parts.length === 1) { box.textContent = parts[0]; return; }
  const [before, low, high, after] = parts;
  const ramp = document.createElement("span");
  ramp.className = "ramp";
  ramp.style.background = channel === "depth" ? "linear-gradient(90deg,#f5f5f5,#282828)" : VIRIDIS;
  box.replaceChildren(`${before} ${short(low)}`, ramp, `${short(high)} ${after}`);
}

const short = x => typeof x === "number" ? String(Number(x.toPrecision(4))) : x;

// ---- to the server ----------------------------------------------------------------------------

async function post(path, body) {
  const asked = performance.now();
  const answer = await fetch(path, { method: "POST", body: JSON.stringify(body) });
  if (!answer.ok) return say(await answer.text());
  const { generation } = await answer.json();
  timings.asked[generation] = asked;
  latest = Math.max(latest, generation);
  return generation;
}

// While the first pixels of a move are on their way, further moves are added up. So every move is
// seen, however fast the mouse is.
let waiting = null, busy = false, patience = 0;

function move(what) {
  if (waiting && waiting.move === what.move && what.move !== "look") {
    if (what.move === "zoom") waiting.by *= what.by;
    else if (what.move !== "reset") { waiting.x += what.x; waiting.y += what.y; }
  } else {
    if (waiting) flush();
    waiting = what;
  }
  if (!busy) flush();
}

async function flush() {
  const what = waiting;
  if (!what) return;
  waiting = null;
  busy = true;
  clearTimeout(patience);
  patience = setTimeout(arrived, 400);
  if (await post("move", what) === undefined) arrived();
}

function arrived() {
  if (!busy) return;
  clearTimeout(patience);
  busy = false;
  if (waiting) requestAnimationFrame(() => busy || flush());
}

// ---- mouse, touch and keys --------------------------------------------------------------------

const fingers = new Map();
let moved = 0, clicks = 0;

const place = event => {
  const box = canvas.getBoundingClientRect();
  return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
};
const inside = n => Math.max(0, n);
const pixelAt = p => ({
  x: inside(Math.min(state.width - 1, Math.floor(p.x * state.width))),
  y: inside(Math.min(state.height - 1, Math.floor(p.y * state.height))),
});
const TURN = 3.2; // radians for a drag across the picture

picture.addEventListener("pointerdown", event => {
  if (!state) return;
  picture.setPointerCapture(event.pointerId);
  picture.focus({ preventScroll: true });
  if (fingers.size === 0) moved = 0;
  fingers.set(event.pointerId, { ...place(event), shift: event.shiftKey || event.button === 2 || event.button === 1 });
  event.preventDefault();
});

picture.addEventListener("pointermove", event => {
  const finger = fingers.get(event.pointerId);
  if (!finger) return;
  const now = place(event), dx = now.x - finger.x, dy = now.y - finger.y;
  const box = canvas.getBoundingClientRect();
  moved += Math.hypot(dx * box.width, dy * box.height);
  if (moved < 4) return;
  picture.classList.add("turning");
  if (fingers.size === 2) {
    const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
    const apart = p => Math.hypot((p.x - other.x) * box.width, (p.y - other.y) * box.height);
    const by = apart(finger) / Math.max(apart(now), 1);
    if (Math.abs(by - 1) > 0.002) move({ move: "zoom", by: Math.min(2, Math.max(0.5, by)) });
    move({ move: "pan", x: dx / 2, y: dy / 2 });
  } else if (finger.shift) move({ move: "pan", x: dx, y: dy });
  else move({ move: "orbit", x: dx * TURN, y: -dy * TURN * state.height / state.width });
  Object.assign(finger, now);
});

for (const kind of ["pointerup", "pointercancel"]) picture.addEventListener(kind, event => {
  const finger = fingers.get(event.pointerId);
  fingers.delete(event.pointerId);
  if (fingers.size === 0) picture.classList.remove("turning");
  if (!finger || kind === "pointercancel" || moved >= 4 || finger.shift) return;
  const p = pixelAt(place(event));
  // A double click looks at the point, and does not explain it.
  clearTimeout(clicks);
  clicks = setTimeout(() => explain(p.x, p.y), 230);
});

picture.addEventListener("dblclick", event => {
  clearTimeout(clicks);
  move({ move: "look", ...pixelAt(place(event)) });
});
picture.addEventListener("contextmenu", event => event.preventDefault());
picture.addEventListener("wheel", event => {
  event.preventDefault();
  const lines = event.deltaMode === 1 ? event.deltaY * 16 : event.deltaY;
  move({ move: "zoom", by: Math.exp(Math.max(-240, Math.min(240, lines)) * 0.0015) });
}, { passive: false });

picture.addEventListener("keydown", event => {
  if (!state || event.ctrlKey || event.metaKey || event.altKey) return;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const letters = { a: [-1, 0], d: [1, 0], w: [0, -1], s: [0, 1] };
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const p = chosen ?? { x: state.width >> 1, y: state.height >> 1 };
  if (arrows[key]) {
    const [x, y] = arrows[key];
    if (event.shiftKey) move({ move: "pan", x: x * 0.04, y: y * 0.04 });
    else move({ move: "orbit", x: x * 0.1, y: -y * 0.1 });
  } else if (letters[key]) {
    const by = event.shiftKey ? 10 : 1;
    mark(p.x + letters[key][0] * by, p.y + letters[key][1] * by);
    say(`pixel ${chosen.x}, ${chosen.y}`);
  } else if (key === "+" || key === "=") move({ move: "zoom", by: 0.85 });
  else if (key === "-") move({ move: "zoom", by: 1 / 0.85 });
  else if (key === "r") move({ move: "reset" });
  else if (key === "l") move({ move: "look", ...p });
  else if (key === "Enter" || key === " ") explain(p.x, p.y);
  else if (/^[1-8]$/.test(key)) post("show", { name: $("channel").options[key - 1].value });
  else return;
  event.preventDefault();
});

// ---- the panel of a pixel ---------------------------------------------------------------------

function mark(x, y) {
  chosen = { x: inside(Math.min(state.width - 1, x)), y: inside(Math.min(state.height - 1, y)) };
  $("pixel-x").value = chosen.x;
  $("pixel-y").value = chosen.y;
  $("marker").style.left = `${(chosen.x + 0.5) / state.width * 100}%`;
  $("marker").style.top = `${(chosen.y + 0.5) / state.height * 100}%`;
  $("marker").hidden = false;
}

let question = 0;
async function explain(x, y) {
  mark(x, y);
  const mine = ++question;
  $("panel").setAttribute("aria-busy", "true");
  try {
    const answer = await fetch(`pixel?x=${chosen.x}&y=${chosen.y}`);
    if (mine !== question) return;
    if (answer.ok) showPixel($("answer"), await answer.json());
    else showFailure($("answer"), await answer.text());
  } catch {
    showFailure($("answer"), "the program does not answer");
  } finally {
    if (mine === question) $("panel").setAttribute("aria-busy", "false");
  }
}

$("pixel-form").addEventListener("submit", event => {
  event.preventDefault();
  if (state) explain(Number($("pixel-x").value), Number($("pixel-y").value));
});

// ---- buttons ----------------------------------------------------------------------------------

$("channel").addEventListener("change", () => post("show", { name: $("channel").value }));
$("aa").addEventListener("change", () => post("aa", { name: $("aa").value }));
$("reset").addEventListener("click", () => move({ move: "reset" }));
$("copy").addEventListener("click", async () => {
  try {
    await navigator.clipboard.writeText($("camera").textContent);
    say("the camera is on the clipboard");
  } catch {
    getSelection().selectAllChildren($("camera"));
    say("the camera is selected: copy it with the keyboard");
  }
});
for (const ending of ["png", "exr"]) $(ending).addEventListener("click", async () => {
  let file;
  if (ending === "png" && state.channel !== "picture") file = await new Promise(done => canvas.toBlob(done));
  else {
    const answer = await fetch(`picture.${ending}`);
    if (!answer.ok) return say(await answer.text());
    file = await answer.blob();
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  const view = state.channel === "picture" ? "" : `-${state.channel}`;
  link.download = `${state.name.replace(/\.[^.]*$/, "")}${view}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
});

// The picture so far has come with the page.
const soFar = JSON.parse($("so-far").textContent);
show(soFar.state);
paint(soFar.tiles);
follow();

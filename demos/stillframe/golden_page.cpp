// The page's three languages stand in three literals; the data comes between them.

#include "demos/stillframe/golden_page.h"

namespace still::command {
namespace {

constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Golden pictures that differ</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 0; color: #1c2126; background: #fff; }
header, footer, #sheet { padding: 0.5em 1em; }
h1 { font-size: 1.3em; margin: 0.2em 0; }
h2 { font-size: 1.15em; margin: 0.2em 0; overflow-wrap: anywhere; }
p { margin: 0.3em 0; max-width: 60em; }
code { background: #eef1f4; padding: 0.1em 0.3em; overflow-wrap: anywhere; }
nav, #controls { display: flex; flex-wrap: wrap; gap: 0.3em; margin: 0.4em 0; align-items: center; }
button { font: inherit; padding: 0.3em 0.7em; border: 1px solid #9aa4ae; border-radius: 4px;
  background: #fff; color: inherit; cursor: pointer; }
button[aria-pressed="true"], button[aria-current="true"] { background: #14181c; color: #fff; }
button:focus-visible, input:focus-visible { outline: 3px solid #0a58ca; outline-offset: 1px; }
button:disabled { opacity: 0.4; cursor: default; }
u { text-underline-offset: 0.15em; }
#frame { overflow: auto; max-height: 74vh; background: #2a2f35; border: 1px solid #14181c; }
#picture { position: relative; margin: 0 auto; }
#picture img { position: absolute; left: 0; top: 0; width: 100%; height: 100%;
  image-rendering: pixelated; }
#picture div { position: absolute; box-sizing: border-box; border: 1px solid #ffb000;
  pointer-events: none; }
#picture div.first { border: 2px solid #ff3df2; box-shadow: 0 0 0 1px #000; }
#shown { font-weight: 600; min-width: 6em; }
#slider { flex: 1 1 12em; max-width: 30em; }
kbd { font: inherit; background: #eef1f4; padding: 0 0.3em; border-radius: 3px; }
</style>
</head>
<body>
<header>
<h1 id="summary"></h1>
<p id="accept"></p>
<nav id="cases" aria-label="Cases"></nav>
</header>
<section id="sheet">
<h2 id="name"></h2>
<p id="message"></p>
<div id="controls">
<button data-mode="flicker"><u>F</u>licker</button>
<button data-mode="expected"><u>E</u>xpected</button>
<button data-mode="actual"><u>A</u>ctual</button>
<button data-mode="diff"><u>D</u>iff</button>
<button data-mode="slider"><u>S</u>lider</button>
<input id="slider" type="range" min="0" max="100" value="50" aria-label="Left of it expected">
<button id="outlines"><u>T</u>iles</button>
<button id="zoom"><u>Z</u>oom <span>×1</span></button>
<span id="shown" role="status"></span>
</div>
<div id="frame" tabindex="0" aria-label="Picture"><div id="picture"></div></div>
</section>
<footer>
<p><kbd>F</kbd> flicker twice a second, <kbd>Space</kbd> swap by hand, <kbd>E</kbd> <kbd>A</kbd>
<kbd>D</kbd> <kbd>S</kbd> expected, actual, diff, slider (<kbd>←</kbd> <kbd>→</kbd> move it),
<kbd>T</kbd> tiles of the first stage that differs, the first one in magenta, <kbd>Z</kbd> zoom,
<kbd>J</kbd> <kbd>K</kbd> next and previous case. In the diff, equal pixels are dim, and the more red
turns yellow the larger is the difference.</p>
</footer>
<script>
"use strict";
const golden = )html";

constexpr const char* kSheet = R"html(;
const $ = selector => document.querySelector(selector);
const make = (tag, parent, text) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
};
const zooms = [1, 2, 4, 8];
const state = {index: 0, mode: "expected", swapped: false, outlines: true, zoom: 1};
const current = () => golden.cases[state.index];
const images = {};

/// Places the pictures of a case on top of each other; draw() chooses which one is seen.
function show(index) {
  state.index = index;
  const one = current();
  $("#name").textContent = one.name;
  $("#message").textContent = one.message.slice(one.name.length + 2);
  $("#picture").textContent = "";
  for (const key of ["expected", "actual", "diff"]) {
    images[key] = null;
    if (one.pictures[key]) {
      images[key] = make("img", $("#picture"));
      images[key].src = one.pictures[key];
      images[key].alt = key + " picture of " + one.name;
    }
  }
  (one.rectangles || []).forEach((r, i) => {
    const outline = make("div", $("#picture"));
    outline.className = i === 0 ? "first" : "";
    outline.dataset.at = JSON.stringify(r);
  });
  const both = images.expected && images.actual;
  if (!both) state.mode = "actual";
  for (const button of document.querySelectorAll("[data-mode]")) {
    button.disabled = button.dataset.mode !== "actual" && !both || !images.actual;
  }
  $("#frame").hidden = $("#controls").hidden = !images.actual;
  [...$("#cases").children].forEach((button, i) =>
    button.setAttribute("aria-current", i === index));
  draw();
  toFirst();
}

/// Scrolls to the first pixel that differs, or to the first tile.
function toFirst() {
  const one = current(), frame = $("#frame");
  const tile = (one.rectangles || [])[0];
  const at = one.first_pixel || (tile ? [tile[0] + tile[2] / 2, tile[1] + tile[3] / 2] : [0, 0]);
  frame.scrollLeft = at[0] * state.zoom - frame.clientWidth / 2;
  frame.scrollTop = at[1] * state.zoom - frame.clientHeight / 2;
}
)html";

constexpr const char* kControls = R"html(
function draw() {
  const one = current();
  const picture = $("#picture");
  picture.style.width = (one.width || 0) * state.zoom + "px";
  picture.style.height = (one.height || 0) * state.zoom + "px";
  const share = Number($("#slider").value);
  const seen = state.mode === "flicker" ? (state.swapped ? "actual" : "expected") : state.mode;
  for (const [key, image] of Object.entries(images)) {
    if (!image) continue;
    const whole = key === seen || (seen === "slider" && key === "expected");
    image.style.visibility = whole || (seen === "slider" && key === "actual") ? "visible" : "hidden";
    image.style.clipPath = seen === "slider" && key === "actual" ? `inset(0 0 0 ${share}%)` : "";
  }
  for (const outline of picture.querySelectorAll("div")) {
    const [x, y, width, height] = JSON.parse(outline.dataset.at).map(v => v * state.zoom);
    outline.style.cssText =
      `left:${x}px;top:${y}px;width:${width}px;height:${height}px;` +
      `visibility:${state.outlines ? "visible" : "hidden"}`;
  }
  for (const button of document.querySelectorAll("[data-mode]")) {
    button.setAttribute("aria-pressed", button.dataset.mode === state.mode);
  }
  $("#outlines").setAttribute("aria-pressed", state.outlines);
  $("#zoom span").textContent = "×" + state.zoom;
  $("#slider").disabled = state.mode !== "slider";
  $("#shown").textContent = seen === "slider" ? "expected | actual" : seen;
  // Told to screen readers on request only, not twice a second.
  $("#shown").setAttribute("aria-live", state.mode === "flicker" ? "off" : "polite");
}

function setMode(mode) {
  const button = $(`[data-mode="${mode}"]`);
  if (button.disabled) return;
  state.mode = mode;
  draw();
}

function swap() {
  if (!images.expected || !images.actual) return;
  state.swapped = state.mode === "flicker" ? !state.swapped : state.mode === "expected";
  state.mode = state.swapped ? "actual" : "expected";
  draw();
}

function zoom() {
  state.zoom = zooms[(zooms.indexOf(state.zoom) + 1) % zooms.length];
  draw();
  toFirst();
}

function step(by) {
  show((state.index + by + golden.cases.length) % golden.cases.length);
}

function slide(by) {
  $("#slider").value = Number($("#slider").value) + by;
  setMode("slider");
}

const keys = {
  f: () => setMode("flicker"), e: () => setMode("expected"), a: () => setMode("actual"),
  d: () => setMode("diff"), s: () => setMode("slider"), z: zoom, j: () => step(1),
  k: () => step(-1), t: () => { state.outlines = !state.outlines; draw(); }, " ": swap,
};
document.onkeydown = event => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const own = event.target.id === "slider";
  if (!own && state.mode === "slider" && event.key.startsWith("Arrow")) {
    if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      slide(event.key === "ArrowLeft" ? -2 : 2);
      event.preventDefault();
    }
    return;
  }
  const action = keys[event.key.toLowerCase()];
  if (!action || (event.key === " " && event.target.tagName === "BUTTON")) return;
  event.preventDefault();
  action();
};
for (const button of document.querySelectorAll("[data-mode]")) {
  button.onclick = () => setMode(button.dataset.mode);
}
$("#slider").oninput = draw;
$("#outlines").onclick = keys.t;
$("#zoom").onclick = zoom;
$("#summary").textContent = `${golden.cases.length} of ${golden.compared} cases are not as recorded`;
if (golden.accept) {
  $("#accept").textContent = "Accept with ";
  make("code", $("#accept"), golden.accept);
}
golden.cases.forEach((one, i) => {
  make("button", $("#cases"), one.name).onclick = () => show(i);
});
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) state.mode = "flicker";
setInterval(() => {
  if (state.mode !== "flicker") return;
  state.swapped = !state.swapped;
  draw();
}, 500);
show(0);
</script>
</body>
</html>
)html";

}  // namespace

std::string goldenPageAround(const std::string& data) {
    return kHead + data + kSheet + kControls;
}

}  // namespace still::command

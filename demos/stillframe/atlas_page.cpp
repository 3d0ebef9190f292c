// The page's three languages stand in three literals; the data comes between them.

#include "demos/stillframe/atlas_page.h"

namespace still::command {
namespace {

constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Failure atlas</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 0; color: #1c2126; background: #fff; }
header, footer { padding: 0.6em 1em; max-width: 60em; }
h1 { font-size: 1.35em; margin: 0.2em 0; }
h2 { font-size: 1.1em; margin: 0 2.5em 0.2em 0; }
p { margin: 0.3em 0; }
select { font: inherit; padding: 0.25em; max-width: 100%; }
#map { overflow: auto; max-height: 82vh; border-top: 1px solid #ccd2d8; }
table { border-collapse: separate; border-spacing: 1px; }
thead th { position: sticky; top: 0; z-index: 2; background: #fff; vertical-align: bottom;
  padding: 0.3em 0.1em; font-weight: 600; writing-mode: vertical-rl; transform: rotate(180deg);
  text-align: left; }
thead th:first-child { z-index: 3; writing-mode: horizontal-tb; transform: none; left: 0;
  padding-left: 0.5em; }
tbody th { position: sticky; left: 0; z-index: 1; background: #fff; text-align: left;
  font-weight: 600; padding: 0 0.5em; white-space: nowrap; border-right: 1px solid #ccd2d8; }
tbody th small { font-weight: 400; color: #5a646e; }
td { padding: 0; }
td button { font: 13px/1 system-ui, sans-serif; font-variant-numeric: tabular-nums; border: 0;
  width: 4.7em; height: 2.3em; padding: 0; cursor: pointer; color: #14181c; border-radius: 0; }
td button.best { font-weight: 700; outline: 2px solid #14181c; outline-offset: -2px; }
td button:focus-visible { outline: 3px solid #0a58ca; }
@media (max-width: 600px) {
  tbody th { white-space: normal; max-width: 7.5em; font-size: 0.85em; line-height: 1.15; }
  tbody th small { display: block; }
}
#sheet { position: fixed; left: 0; right: 0; bottom: 0; z-index: 9; background: #fff;
  border-top: 2px solid #14181c; box-shadow: 0 -4px 18px #0003; padding: 0.7em 1em;
  max-height: 78vh; overflow: auto; }
#sheet[hidden] { display: none; }
#close { position: absolute; right: 0.5em; top: 0.5em; font: 1.3em/1 sans-serif; width: 2em;
  height: 2em; border: 0; background: #eef1f4; cursor: pointer; }
#details { display: flex; flex-wrap: wrap; gap: 0.4em 1.6em; align-items: flex-start; }
#crops { display: flex; flex-wrap: wrap; gap: 4px; }
figure { margin: 0; }
figure div { image-rendering: pixelated; background-repeat: no-repeat; }
figcaption { font-size: 0.85em; color: #5a646e; }
#numbers { display: grid; grid-template-columns: auto auto; gap: 0 0.8em; font-size: 0.9em; }
#numbers dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; }
svg text { font: 11px system-ui, sans-serif; fill: #5a646e; }
</style>
</head>
<body>
<header>
<h1>Failure atlas</h1>
<p id="about"></p>
<p><label>Measure <select id="metric"></select></label></p>
</header>
<div id="map"><table><thead></thead><tbody></tbody></table></div>
<footer>
<p>Each row has its own colours, from its best cell to its worst; the best one is framed. Touch a cell
to see where it fails most. Error pictures show the difference four times as bright.</p>
</footer>
<section id="sheet" hidden aria-live="polite">
<button id="close" aria-label="Close">×</button>
<h2></h2><p id="failure"></p>
<div id="details"><div><div id="crops"></div><p id="place"></p></div><dl id="numbers"></dl>
<div id="plot"></div></div>
</section>
<script>
"use strict";
const atlas = )html";

constexpr const char* kTable = R"html(;
const metrics = {
  own: {text: "the one that exposes each failure"},
  psnr: {text: "PSNR, dB", digits: 2, better: v => v},
  ssim: {text: "SSIM", digits: 4, better: v => v},
  flip: {text: "FLIP", digits: 4, better: v => -v},
  flicker: {text: "flicker", digits: 4, better: v => -v},
  ghost_area: {text: "ghost area, % of the picture", digits: 3, scale: 100, better: v => -v},
  recovery_frames: {text: "frames to recover from an event", digits: 0, better: v => -v},
  sharpness: {text: "sharpness, 1 is the reference's", digits: 3, better: v => -Math.abs(v - 1)},
  residual: {text: "left of the past 3 frames after an event, %", digits: 1, scale: 100,
    better: v => -Math.abs(v)},
  trail: {text: "trail, of 255", digits: 1, better: v => -v},
  ms: {text: "milliseconds a frame, one thread", digits: 2, better: v => -v},
};
const $ = selector => document.querySelector(selector);
const make = (tag, parent, text) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
};
const caseOf = Object.fromEntries(atlas.cases.map(c => [c.name, c]));
const rows = [];
for (const result of atlas.results) {
  const last = rows[rows.length - 1];
  if (last && last.scene === result.scene && last.segment === result.segment) {
    last.cells.push(result);
  } else {
    rows.push({scene: result.scene, segment: result.segment, cells: [result]});
  }
}
const shown = (name, value) => value === null || value === undefined ? "–"
  : (value * (metrics[name].scale || 1)).toFixed(metrics[name].digits);

/// 0 is the worst, 1 the best: orange over pale yellow to blue, for all kinds of eyes.
function colour(share) {
  const stops = [[238, 140, 80], [250, 236, 190], [124, 190, 226]];
  const low = share < 0.5 ? 0 : 1;
  const t = share * 2 - low;
  const mix = stops[low].map((v, i) => Math.round(v + (stops[low + 1][i] - v) * t));
  return `rgb(${mix.join(",")})`;
}

function fill() {
  const body = $("tbody");
  body.textContent = "";
  for (const row of rows) {
    const own = caseOf[row.scene].measure;
    let name = $("#metric").value === "own" ? own : $("#metric").value;
    if (!metrics[name] || ($("#metric").value === "own" &&
        row.cells.every(c => c[name] === null))) name = "psnr";
    const tr = make("tr", body);
    const head = make("th", tr, row.scene + " ");
    make("small", head, row.segment + ($("#metric").value === "own" ? " · " + name : ""));
    const scores = row.cells.map(c => c[name] === null ? null : metrics[name].better(c[name]));
    const known = scores.filter(s => s !== null);
    const worst = Math.min(...known), best = Math.max(...known);
    row.cells.forEach((cell, i) => {
      const button = make("button", make("td", tr), shown(name, cell[name]));
      const share = best > worst ? (scores[i] - worst) / (best - worst) : 1;
      button.style.background = scores[i] === null ? "#eef1f4" : colour(share);
      if (scores[i] !== null && scores[i] === best) button.className = "best";
      button.title = `${row.scene} / ${row.segment} / ${cell.preset}`;
      button.onclick = () => show(row, cell);
    });
  }
}
)html";

constexpr const char* kSheet = R"html(
function showCrops(cell) {
  const crops = $("#crops");
  crops.textContent = "";
  const image = new Image();
  image.onload = () => {
    const width = image.width / 3 * 4, height = image.height * 4;
    [cell.preset, "reference", "error"].forEach((name, i) => {
      const figure = make("figure", crops);
      const part = make("div", figure);
      part.style.cssText = `width:${width}px;height:${height}px;` +
        `background-image:url(${cell.crop});background-size:${3 * width}px ${height}px;` +
        `background-position:${-i * width}px 0`;
      make("figcaption", figure, name);
    });
  };
  image.src = cell.crop;
  const [frame, x, y] = cell.crop_at;
  $("#place").textContent = `Largest error: frame ${frame}, at ${x}, ${y}`;
}

/// Error of each frame: this cell dark, the row's other cells pale.
function showPlot(row, cell) {
  const W = 320, H = 150, L = 34, B = 18, T = 8;
  const top = Math.max(1e-9, ...row.cells.flatMap(c => c.rms));
  const numbers = cell.number;
  const first = numbers[0], last = numbers[numbers.length - 1];
  const px = n => L + (last > first ? (n - first) / (last - first) : 0.5) * (W - L - 6);
  const py = v => T + (1 - v / top) * (H - B - T);
  const line = (c, style) => {
    const points = c.rms.map((v, i) => `${px(c.number[i]).toFixed(1)},${py(v).toFixed(1)}`);
    return `<polyline points="${points.join(" ")}" fill="none" ${style}/>` +
      (points.length === 1 ? `<circle cx="${px(first)}" cy="${py(c.rms[0])}" r="3" ${style}/>` : "");
  };
  const event = caseOf[row.scene].event;
  const mark = event !== null && event >= first && event <= last
    ? `<line x1="${px(event)}" x2="${px(event)}" y1="${T}" y2="${H - B}" stroke="#c2410c"
       stroke-dasharray="3 3"/>` : "";
  $("#plot").innerHTML = `<svg viewBox="0 0 ${W} ${H}" width="${W}" height="${H}" role="img"
    aria-label="Error of each frame"><line x1="${L}" x2="${W}" y1="${H - B}" y2="${H - B}"
    stroke="#9aa4ae"/><text x="${L - 4}" y="${T + 8}" text-anchor="end">${top.toFixed(1)}</text>
    <text x="${L - 4}" y="${H - B}" text-anchor="end">0</text>
    <text x="${px(first)}" y="${H - 4}">${first}</text>
    <text x="${W - 6}" y="${H - 4}" text-anchor="end">frame ${last}</text>${mark}` +
    row.cells.filter(c => c !== cell).map(c => line(c, 'stroke="#d3d9df"')).join("") +
    line(cell, 'stroke="#0a58ca" stroke-width="2"') +
    `<text x="${W / 2}" y="${T + 8}" text-anchor="middle">rms error, of 255</text></svg>`;
}

function show(row, cell) {
  $("#sheet h2").textContent = `${row.scene} / ${row.segment} / ${cell.preset}`;
  $("#failure").textContent = caseOf[row.scene].failure;
  const numbers = $("#numbers");
  numbers.textContent = "";
  for (const name of Object.keys(metrics).slice(1)) {
    make("dt", numbers, metrics[name].text);
    make("dd", numbers, shown(name, cell[name]));
  }
  showCrops(cell);
  showPlot(row, cell);
  $("#sheet").hidden = false;
}

$("#about").textContent = `Ways for temporal methods to fail, at ${atlas.width}×${atlas.height}, ` +
  "measured against supersampled references.";
const headings = make("tr", $("thead"));
make("th", headings, "case, segment");
for (const mode of atlas.modes) make("th", headings, mode);
for (const name of Object.keys(metrics)) {
  make("option", $("#metric"), metrics[name].text).value = name;
}
$("#metric").onchange = fill;
$("#close").onclick = () => { $("#sheet").hidden = true; };
document.onkeydown = event => { if (event.key === "Escape") $("#sheet").hidden = true; };
fill();
</script>
</body>
</html>
)html";

}  // namespace

std::string atlasPage(const AtlasReport& report) {
    return kHead + atlasPageData(report) + kTable + kSheet;
}

}  // namespace still::command

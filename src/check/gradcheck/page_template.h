// SPDX-License-Identifier: MIT
// The page that gradcheckPage() fills in: no network, light and dark, wide and narrow.
#pragma once

#include <string_view>

namespace h2mc {

// Stands where the report goes.
inline constexpr std::string_view kGradcheckData = "@REPORT@";

inline constexpr std::string_view kGradcheckPage = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>h2mc gradcheck</title>
<style>
:root {
  color-scheme: light dark;
  --page: #f7f7f5; --card: #ffffff; --ink: #17171a; --soft: #5d5d63; --line: #dcdcd8;
  --one: #2a6fd0; --two: #d9700f; --limit: #8a8a90; --good: #16803c; --bad: #c62f2f; --bad-back: #fbe9e7;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #141416; --card: #1d1d20; --ink: #ececee; --soft: #a2a2aa; --line: #36363b;
    --one: #6ea8f5; --two: #f0a04b; --limit: #85858d; --good: #5ac47c; --bad: #f2827a; --bad-back: #3a2020;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 24px 16px 48px; }
h1 { font-size: 22px; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 17px; margin: 32px 0 8px; }
p { margin: 4px 0; color: var(--soft); }
.verdict { font-weight: 600; }
.good { color: var(--good); } .bad { color: var(--bad); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 10px; margin: 18px 0; }
.tile, .card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px 14px; }
.tile b { display: block; font-size: 22px; font-weight: 600; }
.tile span { color: var(--soft); font-size: 13px; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 420px), 1fr)); gap: 12px; }
.card h3 { font-size: 14px; margin: 0 0 6px; }
svg { display: block; width: 100%; height: auto; }
svg text { fill: var(--soft); font: 11px system-ui, sans-serif; }
.grid { stroke: var(--line); } .limit { stroke: var(--limit); stroke-dasharray: 5 4; }
.key { display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: 12px; color: var(--soft); margin-bottom: 4px; }
.key i { display: inline-block; width: 12px; height: 12px; border-radius: 2px; margin-right: 5px;
  vertical-align: -2px; }
.key i.dash { height: 0; border-top: 2px dashed var(--limit); width: 16px; border-radius: 0; vertical-align: 4px; }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; }
th { color: var(--soft); font-weight: 500; }
tr > :first-child { text-align: left; position: sticky; left: 0; background: var(--card); }
tbody tr { border-top: 1px solid var(--line); }
td.bad { background: var(--bad-back); font-weight: 600; }
tr.all { font-weight: 600; }
code { display: block; overflow-x: auto; padding: 8px; margin-top: 8px; border: 1px solid var(--line);
  border-radius: 6px; font: 12px ui-monospace, monospace; white-space: pre; }
details > summary { cursor: pointer; color: var(--soft); font-size: 13px; }
</style>
</head>
<body>
<main id="main"></main>
<script type="application/json" id="report">@REPORT@</script>
<script>
"use strict";
const R = JSON.parse(document.getElementById("report").textContent);
const main = document.getElementById("main");
const safe = s => String(s).replace(/[&<>"]/g, c => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"}[c]));
const small = x => x === null ? "–" : x === 0 ? "0" : x.toExponential(1);
const whole = x => x.toLocaleString("en");
const add = html => main.insertAdjacentHTML("beforeend", html);

function head() {
  const T = R.total, bad = R.pathsOutOfTolerance;
  const share = T.entriesJudged + T.entriesNotJudged;
  const tile = (n, what, cls = "") => `<div class="tile"><b class="${cls}">${n}</b><span>${what}</span></div>`;
  const name = R.scene.split("/").pop();
  document.title = `h2mc gradcheck: ${name}`;
  add(`<h1>Derivatives of ${safe(name)}</h1>
    <p>${T.paths} paths of up to ${R.maxDepth} edges, seed ${R.seed}, h2mc ${safe(R.programVersion || "")}.
    Tolerance ${small(R.tolerance)} in double, ${small(R.floatTolerance)} in float.</p>
    <p class="verdict ${bad ? "bad" : "good"}">${bad
      ? whole(bad) + (bad === 1 ? " path is" : " paths are") + " out of tolerance"
      : "No path is out of tolerance"}${R.interrupted ? "; interrupted" : ""}</p>
    <div class="tiles">` +
    tile(whole(T.judged), "paths judged in every entry") +
    tile(share ? (100 * T.entriesJudged / share).toFixed(1) + " %" : "–", "entries judged") +
    tile(whole(T.kinkNearby), "kink nearby") + tile(whole(T.differenceNoise), "difference noise") +
    tile(whole(T.notFinite), "not finite", T.notFinite ? "bad" : "") +
    tile(whole(bad), "out of tolerance", bad ? "bad" : "") + "</div>");
}

const key = (items, dash) => `<div class="key">` +
  items.map(([name, color]) => `<span><i style="background:var(--${color})"></i>${name}</span>`).join("") +
  (dash ? `<span><i class="dash"></i>${dash}</span>` : "") + "</div>";

// What lies beyond the line, for histogram number k: all paths in double, then the float forms.
function beyond(h, k) {
  if (k === 0) return "";
  const f = R.total.forms[R.forms[k - 1].name];
  const said = f.outOfTolerance ? `, ${whole(f.outOfTolerance)} of them out of tolerance` : "";
  return f.rounding + f.outOfTolerance === 0 ? "None is beyond the tolerance."
    : `Beyond the tolerance: ${whole(f.rounding + f.outOfTolerance)}${said}. ${whole(f.rounding)} by rounding: ` +
      `glossy vertices magnify the last digit of a path's numbers, until the float derivative is right for a path a ` +
      `few such digits away and not for this one. Derivatives in double of paths that near differ as much, or the ` +
      `differences of sixteen neighbours cancel, or the target itself is off or ends there. What none of these ` +
      `explains is out of tolerance.`;
}

function histogram(h, k) {
  const W = 460, H = 210, L = 40, B = 30, n = h.gradient.length, top = 10;
  const most = Math.max(1, ...h.gradient, ...h.hessian), w = (W - L - 8) / n;
  const y = c => H - B - (H - B - top) * c / most;
  let s = "";
  for (const part of [0, 0.5, 1]) {
    const at = y(most * part);
    s += `<line class="grid" x1="${L}" x2="${W - 8}" y1="${at}" y2="${at}"/>
      <text x="${L - 6}" y="${at + 4}" text-anchor="end">${Math.round(most * part)}</text>`;
  }
  h.gradient.forEach((_, k) => {
    const x = L + k * w, range = `1e${h.first + k} to 1e${h.first + k + 1}`;
    [["gradient", "one"], ["hessian", "two"]].forEach(([name, color], m) => {
      const c = h[name][k];
      if (c) s += `<rect x="${x + 1 + m * (w / 2 - 0.5)}" y="${y(c)}" width="${w / 2 - 1.5}" height="${H - B - y(c)}"
        rx="1.5" fill="var(--${color})"><title>${name}: ${c} paths, ${range}</title></rect>`;
    });
    if (k % 3 === 2) s += `<text x="${x}" y="${H - B + 16}" text-anchor="middle">1e${h.first + k}</text>`;
  });
  const limit = L + (Math.log10(h.tolerance) - h.first) * w;
  s += `<line class="limit" x1="${limit}" x2="${limit}" y1="${top}" y2="${H - B}"/>`;
  return `<div class="card"><h3>${safe(h.title)}</h3>` + key([["gradient", "one"], ["Hessian", "two"]], "tolerance") +
    `<svg viewBox="0 0 ${W} ${H}" role="img" aria-label="${safe(h.title)}">${s}</svg>
    <p>Paths by their largest relative error. ${beyond(h, k)}</p></div>`;
}

function tables() {
  const cell = (n, bad) => `<td class="${bad && n ? "bad" : ""}">${whole(n)}</td>`;
  const spread = e => `<td>${small(e.median)}</td><td>${small(e.worst)}</td>`;
  const form = f => spread(f.gradient) + spread(f.hessian) + cell(f.rounding) + cell(f.notFinite) +
    cell(f.outOfTolerance, true);
  const names = R.forms.map(f => f.name);
  const row = (r, cls = "") => `<tr class="${cls}"><td>${safe(r.name)}</td>` + cell(r.paths) + cell(r.judged) +
    cell(r.kinkNearby) + cell(r.differenceNoise) + cell(r.notFinite, true) + cell(r.outOfTolerance, true) +
    spread(r.gradient) + spread(r.hessian) + names.map(n => form(r.forms[n])).join("") + "</tr>";
  const two = "<th>median</th><th>worst</th>";
  const headings = title => `<thead><tr><th></th><th colspan="6">double against differences</th>
    <th colspan="2">gradient</th><th colspan="2">Hessian</th>` +
    names.map(n => `<th colspan="2">float (${safe(n)}): gradient</th><th colspan="2">Hessian</th>` +
      `<th colspan="3"></th>`).join("") +
    `</tr><tr><th>${safe(title)}</th><th>paths</th><th>judged</th><th>kink</th><th>noise</th><th>not finite</th>
    <th>out of tol.</th>${two}${two}` +
    names.map(() => `${two}${two}<th>rounding</th><th>not finite</th><th>out of tol.</th>`).join("") + "</tr></thead>";
  for (const g of R.groups)
    add(`<h2>By ${safe(g.title)}</h2><div class="scroll"><table>${headings("")}<tbody>` +
      g.rows.map(r => row(r)).join("") + row({...R.total, name: "all"}, "all") + "</tbody></table></div>");
}

function sweepPlot(w) {
  const s = w.sweep;
  if (!s) return "<p>No room for a step.</p>";
  const W = 460, H = 230, L = 46, B = 34, top = 8;
  const shown = s.points.filter(p => p[1] !== null || p[2] !== null);
  const values = shown.flatMap(p => [p[1], p[2]]).filter(v => v !== null && v > 0);
  if (!shown.length || !values.length) return "<p>Every step is without error or without a value.</p>";
  const log = Math.log10, low = Math.floor(log(Math.min(...values, R.tolerance))),
    high = Math.ceil(log(Math.max(...values, R.tolerance)));
  const steps = s.points.map(p => log(p[0])), left = Math.min(...steps), right = Math.max(...steps);
  const x = h => L + (W - L - 10) * (log(h) - left) / (right - left || 1);
  const y = v => top + (H - B - top) * (high - Math.max(log(v), low)) / (high - low || 1);
  let out = "";
  const every = Math.max(1, Math.ceil((high - low) / 7));
  for (let e = low; e <= high; e += every)
    out += `<line class="grid" x1="${L}" x2="${W - 10}" y1="${y(10 ** e)}" y2="${y(10 ** e)}"/>
      <text x="${L - 6}" y="${y(10 ** e) + 4}" text-anchor="end">1e${e}</text>`;
  for (let e = Math.ceil(left); e <= right; e += 2)
    out += `<text x="${x(10 ** e)}" y="${H - B + 16}" text-anchor="middle">1e${e}</text>`;
  out += `<text x="${(L + W) / 2}" y="${H - 4}" text-anchor="middle">step</text>
    <line class="limit" x1="${L}" x2="${W - 10}" y1="${y(R.tolerance)}" y2="${y(R.tolerance)}"/>`;
  [[1, "one"], [2, "two"]].forEach(([k, color]) => {
    let path = "", dots = "", pen = "M";
    for (const p of s.points) {
      if (p[k] === null) { pen = "M"; continue; }
      const at = `${x(p[0]).toFixed(1)} ${y(Math.max(p[k], 1e-300)).toFixed(1)}`;
      path += pen + at; pen = "L";
      dots += `<circle cx="${x(p[0]).toFixed(1)}" cy="${y(Math.max(p[k], 1e-300)).toFixed(1)}" r="2.6"
        fill="var(--${color})"><title>step ${small(p[0])}: ${small(p[k])}</title></circle>`;
    }
    out += `<path d="${path}" fill="none" stroke="var(--${color})" stroke-width="2"/>${dots}`;
  });
  const entry = s.entry.length === 1 ? `g[${s.entry[0]}]` : `H[${s.entry[0]},${s.entry[1]}]`;
  return `<p>${entry}: ${safe(s.verdict)}. Exact ${s.exact.toPrecision(8)}, difference
    ${s.difference === null ? "–" : s.difference.toPrecision(8)}, relative error ${small(s.relativeError)}</p>` +
    key([["central difference", "one"], ["extrapolated", "two"]], "tolerance") +
    `<svg viewBox="0 0 ${W} ${H}" role="img" aria-label="error against step">${out}</svg>`;
}

function worst() {
  add(`<h2>Paths to look at</h2><p>Failures first, then the largest errors. The plots show how far the difference
    quotient of the entry with the largest error is from the exact derivative, relative, against the step.</p>
    <div class="plots">` + R.worst.map(w => {
    const bad = w.verdict === "out of tolerance" || Object.values(w.forms).some(f => f.verdict === "out of tolerance");
    const forms = Object.entries(w.forms).map(([n, f]) =>
      `<p>float, ${safe(n)}: ${safe(f.verdict)}; gradient ${small(f.gradient)}, ` +
      `Hessian ${small(f.hessian)}</p>`).join("");
    return `<div class="card"><h3 class="${bad ? "bad" : ""}">(${w.s},${w.t}) ${safe(w.name)}</h3>
      <p>${safe(w.bsdfs.join(", ") || "no BSDF")}; ${safe(w.light)}</p>
      <p>double: ${safe(w.verdict)}; gradient ${small(w.gradientError)}, Hessian ${small(w.hessianError)}</p>${forms}
      ${sweepPlot(w)}<details><summary>look at it alone</summary>
      <code>h2mc gradcheck ${safe(R.scene)} --replay "${safe(w.replay)}"</code></details></div>`;
  }).join("") + "</div>");
}

head();
add(`<h2>Errors</h2><div class="plots">${R.histograms.map(histogram).join("")}</div>`);
worst();
tables();
</script>
</body>
</html>
)html";

}  // namespace h2mc

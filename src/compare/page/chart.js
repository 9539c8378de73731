// SPDX-License-Identifier: MIT
// Curves in the plane of logarithms.

// 1, 2, 5 times powers of ten within [low, high]; only the powers where there are many.
function logTicks(low, high) {
  const ticks = [], decades = Math.log10(high / low);
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
    for (const m of decades > 3 ? [1] : decades > 1.3 ? [1, 3] : [1, 2, 3, 4, 5, 7]) {
      const v = m * 10 ** e;
      if (v >= low * 0.999 && v <= high * 1.001) ticks.push(v);
    }
  return ticks;
}

// x: "seconds" | "perPixel". compact: for the overview of all scenes.
function drawChart(figure, scene, metric, x, title, compact) {
  const narrow = innerWidth < 700;  // so that its letters can be read there
  const W = compact ? 300 : narrow ? 380 : 600, H = compact ? 210 : narrow ? 300 : 380;
  const left = compact ? 46 : 60, right = 12, top = compact ? 24 : 28, bottom = compact ? 24 : 42;
  const series = [];
  scene.methods.forEach((method, index) => {
    const curve = method.curves[metric]
      .map((p) => ({ x: number(p[x]), y: number(p.error.value), low: number(p.band.low), high: number(p.band.high) }))
      .filter((p) => p.x > 0 && p.y > 0 && Number.isFinite(p.y));
    const dots = method.repeats.flatMap((r) => r.points.map((p) => ({ x: p[x], y: number(p.errors[metric]) })))
      .filter((p) => p.x > 0 && p.y > 0 && Number.isFinite(p.y));
    if (curve.length) series.push({ index, name: method.name, curve, dots });
  });
  figure.replaceChildren();
  const drawing = svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": title });
  drawing.append(svg("text", { class: "title", x: left, y: 16 }, title));
  figure.append(drawing);
  if (!series.length) {
    drawing.append(svg("text", { x: left, y: H / 2 }, "nothing to draw"));
    return;
  }
  const all = series.flatMap((s) => [...s.curve, ...s.dots]);
  const range = (key) => {
    let low = Math.min(...all.map((p) => p[key])), high = Math.max(...all.map((p) => p[key]));
    const margin = Math.max(Math.log(high / low) * 0.07, 0.06);
    return [low * Math.exp(-margin), high * Math.exp(margin)];
  };
  const [x0, x1] = range("x"), [y0, y1] = range("y");
  const px = (v) => left + ((W - left - right) * Math.log(v / x0)) / Math.log(x1 / x0);
  const py = (v) => H - bottom - ((H - top - bottom) * Math.log(v / y0)) / Math.log(y1 / y0);
  const inside = (y) => Math.min(Math.max(y, y0 / 10), y1 * 10);  // what the clip then cuts

  const clip = `clip-${figure.id || "c"}-${x}-${Math.random().toString(36).slice(2)}`;
  drawing.append(svg("clipPath", { id: clip },
    svg("rect", { x: left, y: top, width: W - left - right, height: H - top - bottom })));
  let lastLabel = -Infinity;
  for (const v of logTicks(x0, x1)) {
    drawing.append(svg("line", { class: "grid", x1: px(v), x2: px(v), y1: top, y2: H - bottom }));
    if (px(v) - lastLabel < 34) continue;
    drawing.append(svg("text", { x: px(v), y: H - bottom + 15, "text-anchor": "middle" }, short(v)));
    lastLabel = px(v);
  }
  for (const v of logTicks(y0, y1)) {
    drawing.append(svg("line", { class: "grid", x1: left, x2: W - right, y1: py(v), y2: py(v) }));
    drawing.append(svg("text", { x: left - 6, y: py(v) + 4, "text-anchor": "end" }, short(v)));
  }
  drawing.append(svg("rect", { class: "frame", x: left, y: top, width: W - left - right, height: H - top - bottom }));
  if (!compact) {
    const unit = x === "seconds" ? "seconds" : "mutations (path, bdpt: samples) a pixel";
    drawing.append(svg("text", { x: (left + W - right) / 2, y: H - 6, "text-anchor": "middle" }, unit));
  }

  const layer = svg("g", { "clip-path": `url(#${clip})` });
  drawing.append(layer);
  for (const s of series) {
    const banded = s.curve.filter((p) => p.low > 0 && Number.isFinite(p.high));
    if (banded.length > 1) {
      const path = [...banded.map((p) => [p.x, p.high]), ...banded.slice().reverse().map((p) => [p.x, p.low])]
        .map(([a, b]) => `${px(a).toFixed(1)},${py(inside(b)).toFixed(1)}`).join(" ");
      layer.append(svg("polygon", { points: path, style: `fill:${color(s.index)};opacity:0.13` }));
    } else if (banded.length === 1) {
      const p = banded[0];
      layer.append(svg("line", { x1: px(p.x), x2: px(p.x), y1: py(inside(p.low)), y2: py(inside(p.high)),
        style: `stroke:${color(s.index)};opacity:0.4` }));
    }
  }
  const summary = scene.summaries.find((m) => m.metric === metric && m.timed === (x === "seconds"));
  for (const s of series) {
    const fit = summary && summary.methods[s.index];
    const p = fit ? number(fit.p.value) : NaN, logC = fit ? number(fit.logC) : NaN;
    if (!compact && Number.isFinite(p) && Number.isFinite(logC) && s.curve.length > 2) {
      const at = (t) => inside(Math.exp(logC - p * Math.log(t)));
      layer.append(svg("line", { x1: px(x0), y1: py(at(x0)), x2: px(x1), y2: py(at(x1)),
        style: `stroke:${color(s.index)};stroke-dasharray:4 4;opacity:0.55` }));
    }
    for (const d of s.dots) layer.append(svg("circle",
      { cx: px(d.x), cy: py(d.y), r: 1.8, style: `fill:${color(s.index)};opacity:0.35` }));
    layer.append(svg("polyline", {
      points: s.curve.map((q) => `${px(q.x).toFixed(1)},${py(q.y).toFixed(1)}`).join(" "),
      style: `fill:none;stroke:${color(s.index)};stroke-width:2`,
    }));
    for (const q of s.curve) {
      const dot = svg("circle", { cx: px(q.x), cy: py(q.y), r: compact ? 2.5 : 4, style: `fill:${color(s.index)}` });
      dot.append(svg("title", {},
        `${s.name}: ${short(q.y, 4)} at ${short(q.x, 4)}${x === "seconds" ? " s" : " a pixel"}`));
      layer.append(dot);
    }
  }
  if (!compact) legend(drawing, series, { left, right: W - right, top, bottom: H - bottom }, px, py);
}

// In the corner that holds fewer points.
function legend(drawing, series, box, px, py) {
  const rows = series.length, height = 17 * rows + 8;
  const width = 34 + 7 * Math.max(...series.map((s) => Math.min(s.name.length, 34)));
  const corners = [[box.right - width - 6, box.top + 6], [box.left + 6, box.bottom - height - 6],
    [box.left + 6, box.top + 6], [box.right - width - 6, box.bottom - height - 6]];
  const hits = corners.map(([x, y]) => series.flatMap((s) => s.curve)
    .filter((p) => px(p.x) > x - 8 && px(p.x) < x + width + 8 && py(p.y) > y - 8 && py(p.y) < y + height + 8).length);
  const [x, y] = corners[hits.indexOf(Math.min(...hits))];
  const group = svg("g");
  group.append(svg("rect", { x, y, width, height, rx: 4, style: "fill:var(--panel);stroke:var(--line);opacity:0.9" }));
  series.forEach((s, i) => {
    group.append(svg("rect", { x: x + 8, y: y + 8 + 17 * i, width: 12, height: 4, rx: 2, transform: "translate(0 2)",
      style: `fill:${color(s.index)}` }));
    const name = s.name.length > 34 ? s.name.slice(0, 33) + "…" : s.name;
    group.append(svg("text", { x: x + 27, y: y + 16 + 17 * i, style: "fill:var(--text)" }, name));
  });
  drawing.append(group);
}

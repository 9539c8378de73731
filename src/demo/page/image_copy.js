// SPDX-License-Identifier: MIT
// Pictures, walks and the trade-off between step size and acceptance.
const data = JSON.parse(byId("data").textContent);

function pictureCanvas(pixels) {
  const canvas = element("canvas", { width: data.width, height: data.height });
  const context = canvas.getContext("2d"), text = atob(pixels);
  const image = context.createImageData(data.width, data.height);
  for (let i = 0, o = 0; i < text.length; i += 3, o += 4) {
    for (let c = 0; c < 3; ++c) image.data[o + c] = text.charCodeAt(i + c);
    image.data[o + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

// The chain's first states over a darkened picture.
function walkCanvas(method) {
  const scale = 4, canvas = element("canvas", { width: scale * data.width, height: scale * data.height });
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.globalAlpha = 0.45;
  context.drawImage(pictureCanvas(data.reference), 0, 0, canvas.width, canvas.height);
  context.globalAlpha = 0.5;
  context.strokeStyle = "#ffd24a";
  context.lineWidth = 1.2;
  context.beginPath();
  method.walk.forEach(([x, y], i) => context[i ? "lineTo" : "moveTo"](x * canvas.width, y * canvas.height));
  context.stroke();
  context.globalAlpha = 1;
  context.fillStyle = "#fff";
  for (const [x, y] of method.walk) {
    context.beginPath();
    context.arc(x * canvas.width, y * canvas.height, 1.8, 0, 7);
    context.fill();
  }
  return canvas;
}

const percent = (v) => `${short(100 * v)} %`;
const figureOf = (canvas, ...text) => element("figure", {}, canvas, ...text);

// Which of two errors is the smaller one, in words; what one chain each can't tell apart is said to be level.
function against(isotropic, hamiltonian) {
  const ratio = isotropic / hamiltonian, figures = `relmse ${short(hamiltonian)} and ${short(isotropic)}`;
  if (ratio > 1.1)
    return `Hessian-Hamiltonian proposals have ${short(ratio)} times less error than isotropic ones (${figures})`;
  if (ratio < 1 / 1.1)
    return `Hessian-Hamiltonian proposals have ${short(1 / ratio)} times the error of isotropic ones (${figures})`;
  return `Hessian-Hamiltonian and isotropic proposals are level (${figures})`;
}

function sayVerdict(level) {
  const named = (name) => data.methods.find((m) => m.name === name);
  const mixed = named("mixed"), own = named("Hessian-Hamiltonian"), at = mixed.levels[level].perPixel;
  const unit = at === 1 ? "mutation" : "mutations";
  byId("verdict").textContent = `On this picture, at ${at} ${unit} a pixel, with steps ` +
    `of ${short(mixed.sigma)} and a prior of ${short(own.sigma)}, ` +
    `${against(mixed.levels[level].relmse, own.levels[level].relmse)}.`;
}

function saySweepVerdict() {
  const best = (points) => points.reduce((a, b) => (b.relmse < a.relmse ? b : a));
  const isotropic = best(data.sweep.isotropic), hamiltonian = best(data.sweep.hamiltonian);
  byId("sweep-verdict").textContent = `With the best size of each, ${short(isotropic.sigma)} and ` +
    `${short(hamiltonian.sigma)}, ${against(isotropic.relmse, hamiltonian.relmse)}, mutation for mutation; one with ` +
    `derivatives takes longer.`;
}

function drawOverview(level) {
  sayVerdict(level);
  byId("overview").replaceChildren(
    ...data.methods.map((m) => figureOf(pictureCanvas(m.levels[level].pixels), element("b", {}, m.name),
      ` relmse ${short(m.levels[level].relmse)}`)),
    figureOf(pictureCanvas(data.reference), element("b", {}, "the picture")));
}

function drawSweep(figure, title, key, logarithmic) {
  const W = 600, H = 320, left = 56, right = 14, top = 28, bottom = 40;
  const curves = [["isotropic steps", data.sweep.isotropic, 1], ["Hessian-Hamiltonian", data.sweep.hamiltonian, 0]];
  const all = curves.flatMap(([, points]) => points.map((p) => p[key]));
  const x0 = data.sweep.isotropic[0].sigma, x1 = data.sweep.isotropic[data.sweep.isotropic.length - 1].sigma;
  const y0 = logarithmic ? Math.min(...all) * 0.85 : 0, y1 = logarithmic ? Math.max(...all) * 1.15 : 1;
  const px = (v) => left + ((W - left - right) * Math.log(v / x0)) / Math.log(x1 / x0);
  const py = (v) => H - bottom - (H - top - bottom) * (logarithmic ? Math.log(v / y0) / Math.log(y1 / y0) : v);
  const drawing = svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": title });
  drawing.append(svg("text", { class: "title", x: left, y: 16 }, title));
  for (const v of logTicks(x0, x1)) {
    drawing.append(svg("line", { class: "grid", x1: px(v), x2: px(v), y1: top, y2: H - bottom }));
    drawing.append(svg("text", { x: px(v), y: H - bottom + 15, "text-anchor": "middle" }, short(v)));
  }
  for (const v of logarithmic ? logTicks(y0, y1) : [0, 0.25, 0.5, 0.75, 1]) {
    drawing.append(svg("line", { class: "grid", x1: left, x2: W - right, y1: py(v), y2: py(v) }));
    drawing.append(svg("text", { x: left - 6, y: py(v) + 4, "text-anchor": "end" },
      logarithmic ? short(v) : percent(v)));
  }
  drawing.append(svg("rect", { class: "frame", x: left, y: top, width: W - left - right, height: H - top - bottom }));
  drawing.append(svg("text", { x: (left + W - right) / 2, y: H - 6, "text-anchor": "middle" },
    "step size sigma, of the picture's edges"));
  curves.forEach(([name, points, index], i) => {
    const style = `stroke:${color(index)};fill:none;stroke-width:2`;
    drawing.append(svg("polyline", { points: points.map((p) => `${px(p.sigma)},${py(p[key])}`).join(" "), style }));
    for (const p of points) {
      const dot = svg("circle", { cx: px(p.sigma), cy: py(p[key]), r: 4, style: `fill:${color(index)}` });
      dot.append(svg("title", {}, `${name}, sigma ${short(p.sigma)}: ${short(p[key])}`));
      drawing.append(dot);
    }
    const y = H - bottom - 26 + 17 * i;
    drawing.append(svg("rect", { x: left + 10, y: y - 8, width: 12, height: 4, rx: 2, style: `fill:${color(index)}` }));
    drawing.append(svg("text", { x: left + 28, y: y - 2, style: "fill:var(--text)" }, name));
  });
  figure.replaceChildren(drawing);
}

byId("about").textContent = `${data.name}, ${data.width} × ${data.height} pixels; one chain for each method`;
const levels = data.methods[0].levels;
byId("level").replaceChildren(...levels.map((l, i) => element("option", { value: String(i) }, String(l.perPixel))));
byId("level").value = String(levels.length - 2);
byId("level").addEventListener("change", (e) => drawOverview(Number(e.target.value)));
drawOverview(levels.length - 2);
byId("methods").replaceChildren(...data.methods.map((m) => {
  const parts = [];
  if (m.largeShare < 1) parts.push(`sigma ${short(m.sigma)}`);
  if (m.largeShare > 0 && m.largeShare < 1) parts.push(`${percent(m.largeShare)} large`);
  parts.push(`${percent(m.levels[m.levels.length - 1].acceptance)} of the ` +
    `${m.largeShare < 1 ? "small " : ""}mutations accepted`);
  return element("section", {}, element("h2", {}, m.name),
    element("p", { class: "hint" }, `${m.text} (${parts.join(", ")})`),
    element("div", { class: "row" },
      ...m.levels.map((l) => figureOf(pictureCanvas(l.pixels), element("b", {}, `${l.perPixel} a pixel`),
        ` relmse ${short(l.relmse)}`)),
      figureOf(walkCanvas(m), element("b", {}, `the first ${m.walk.length} states`))));
}));
drawSweep(byId("acceptance"), "Acceptance of small mutations", "acceptance", false);
drawSweep(byId("error"), `Error (relmse) at ${data.sweepPerPixel} mutations a pixel`, "relmse", true);
byId("sweep-text").textContent = `Each with ${percent(data.largeShare)} large mutations. Tiny steps are nearly ` +
  `always accepted and go nowhere; huge ones are nearly always rejected. For Hessian-Hamiltonian proposals sigma is ` +
  `only the prior's: where the luminance is curved they are narrower of their own accord, across edges more than ` +
  `along them. In two dimensions little can be gained by that: a round step ` +
  `of the right size is as good, and there is one right size. A path has four to thirty coordinates, in which the ` +
  `target is narrow in one or two directions and flat in the others: there no round step is right (h2mc inspect).`;
saySweepVerdict();

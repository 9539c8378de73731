// SPDX-License-Identifier: MIT
// The page's controls, and what they show.
const state = { pair: 0, view: "wide", decades: 4, topology: true, cursor: null };
const percent = (v) => `${short(100 * v)} %`;
const plots = [];  // what is redrawn: { canvas, draw }

const KIND_TEXT = {
  large: "Starts afresh, wherever the state is. Seldom accepted where the target is large, but the only way to " +
    "somewhere quite different.",
  lens: "Moves the film position, follows narrow lobes, and reconnects as soon as it can: a move along what leaves " +
    "the path intact, by its geometry.",
  isotropic: "The same small step in all coordinates. Where the target is narrow in only one direction, nearly all " +
    "of them miss it.",
  "hamiltonian": !model.available
    ? "There are no derivatives at this path: drawn from the prior, a round Gaussian."
    : "Drawn from the Gaussian that gradient and Hessian give: short where the target is curved, as long as the " +
      "prior allows where it is flat.",
};

// What a coordinate decides, by the layout of primary samples: the camera's come first.
function meaning(name) {
  if (name === "time") return "time";
  const { s, t, vertices } = data.path, k = Number(name.slice(1)) >> 1, camera = t >= 2 ? t - 1 : 0;
  if (k < camera) return k === 0 ? "film position" : `scattering at vertex ${k}, ${vertices[k]}`;
  const light = k - camera;
  if (s === 1) return "point on the light";
  if (light < 2) return `the ray that leaves the light, ${light ? "last" : "first"} two numbers`;
  const vertex = vertices.length - light;
  return `scattering at vertex ${vertex}, ${vertices[vertex]}`;
}

function pairText(pair) {
  const rank = (name) => {
    const k = Number(name.slice(1));
    return k === model.eigen.length ? "weakest" : ["strongest", "second", "third", "fourth"][k - 1] || `${k}th`;
  };
  const named = pair.x[0] === "e" ? [rank(pair.x), rank(pair.y)] : [meaning(pair.x), meaning(pair.y)];
  return `${pair.x}, ${pair.y}: ${[...new Set(named)].join(" and ")}`;
}

function filmPicture() {
  const { width, height, pixels } = data.film, canvas = element("canvas", { width, height });
  const context = canvas.getContext("2d"), image = context.createImageData(width, height), bytes = bytesOf(pixels);
  for (let i = 0; i < width * height; ++i) {
    for (let c = 0; c < 3; ++c) image.data[4 * i + c] = bytes[3 * i + c];
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}
const picture = filmPicture();

function describePath() {
  const path = data.path, [x, y] = data.pixel;
  document.title = `h2mc inspect: ${data.scene}, pixel ${x},${y}`;
  byId("title").textContent = `A path through pixel ${x}, ${y} of ${data.scene}`;
  byId("about").textContent =
    `${data.width} × ${data.height} pixels; ${data.integrator}; seed ${data.seed}; h2mc ${data.programVersion}`;
  byId("dimension").textContent = String(model.dimension);
  // The edge by which the two subpaths are joined; with s = 0 the camera's own path has hit the light.
  byId("vertices").replaceChildren(...path.vertices.map((name, i) =>
    element("li", { class: path.s > 0 && i === path.t ? "joined" : "" }, name)));
  const search = path.search, origin = {
    ridge: `of 32 paths that were drawn in proportion to the target, the one around which it is most of a ridge`,
    chain: `a state of a chain that was confined to the ` +
      `pixel, ${search.mutations} mutations after its start (${percent(search.accepted)} of them accepted)`,
    largest: "the largest target of all paths that were met there",
    given: "given by --replay",
  }[path.choice];
  const ends = path.s === 0 ? "traced from the camera alone"
    : `${path.s} ${path.s === 1 ? "vertex" : "vertices"} from the light and ${path.t} from the camera, ` +
      `joined along the dashed edge`;
  byId("path-text").textContent = `${path.edges} edges; ${ends} (s = ${path.s}, t = ${path.t}). ` +
    `Target ${short(path.target)}. Chosen: ${origin}.`;
  byId("replay").textContent = path.text;
  byId("film-text").textContent = "+ where the path is on the film.";
}

function chosenPair() {
  return data.pairs[state.pair];
}

// The value under the cursor, in words.
function readout() {
  const pair = chosenPair(), slice = sliceOf(pair, state.view), cursor = state.cursor || { x: 0, y: 0 };
  const n = slice.resolution, cell = (v, half) => Math.min(Math.max(Math.floor((n * (v / half + 1)) / 2), 0), n - 1);
  const i = (n - 1 - cell(cursor.y, slice.halfY)) * n + cell(cursor.x, slice.halfX), kind = slice.kinds[i];
  const found = kind === CELL.dark ? "no light" : kind === CELL.outside ? "outside of the primary space"
    : `target ${short(Math.exp(slice.values[i]))} times that of the path` +
      ["", "", ", on another triangle", ", another shape, lobe or light"][kind];
  const quadratic = model.available
    ? `; quadratic ${short(Math.exp(quadraticIn(directionOf(pair.x), directionOf(pair.y))(cursor.x, cursor.y)))}` : "";
  byId("readout").textContent = `${pair.x} ${short(cursor.x)}, ${pair.y} ${short(cursor.y)}: ${found}${quadratic}`;
}

// What the plots of a plane share; made anew only when it changes.
let shared = {};
function sceneOf(index, view, decades) {
  const key = `${index} ${view} ${decades}`;
  if (shared.key === key) return shared;
  const pair = data.pairs[index], slice = sliceOf(pair, view), x = directionOf(pair.x), y = directionOf(pair.y);
  const options = { decades, strength: 1 }, gaussian = gaussianIn(x, y);
  shared = {
    key, pair, slice, x, y,
    bright: targetImage(slice, options),
    dim: targetImage(slice, { ...options, strength: 0.6 }),
    quadratic: model.available && quadraticImage(slice, options, quadraticIn(x, y)),
    ellipses: (context, frame) => { if (model.available) drawGaussian(context, frame, gaussian); },
    points: new Map(data.kinds.map((kind) => [kind, projected(kind, x, y)])),
  };
  return shared;
}

function redraw() {
  const scene = sceneOf(state.pair, state.view, state.decades), { pair, slice } = scene;
  for (const plot of plots) plot.draw(scene);

  for (const button of byId("view").children)
    button.setAttribute("aria-pressed", String(button.dataset.view === state.view));
  byId("pair").value = String(state.pair);
  byId("decades").value = String(state.decades);
  byId("decades-text").textContent = `${state.decades} decade${state.decades > 1 ? "s" : ""}`;
  byId("view-text").textContent = (state.view === "wide"
    ? `Wide: both edges are ${short(2 * slice.halfX)} long, isotropic steps have a standard deviation ` +
      `of ${short(model.sigma)}.`
    : `Close up: each edge has a scale of its own, about eight standard deviations of the Gaussian along it.`) +
    " All other coordinates are those of the path, which is the +.";
  byId("ramp-labels").replaceChildren(...[0, 0.5, 1].map((t) =>
    element("span", {}, short(Math.exp(slice.brightest) * 10 ** ((t - 1) * state.decades), 2).replace(".0e", "e"))));
  for (const row of byId("eigen").querySelectorAll("tbody tr"))
    row.className = [pair.x, pair.y].includes(row.dataset.name) ? "shown" : "";
  readout();
}

function movable(canvas) {
  canvas.tabIndex = 0;
  const moveTo = (cursor) => {
    state.cursor = cursor;
    redraw();
  };
  canvas.addEventListener("pointermove", (e) => {
    const slice = sliceOf(chosenPair(), state.view), box = canvas.getBoundingClientRect();
    const frame = frameOf(box.width, slice);
    const x = frame.x(e.clientX - box.left), y = frame.y(e.clientY - box.top);
    moveTo(Math.abs(x) <= slice.halfX && Math.abs(y) <= slice.halfY ? { x, y } : null);
  });
  canvas.addEventListener("pointerleave", () => moveTo(null));
  canvas.addEventListener("keydown", (e) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
    if (!step) return;
    e.preventDefault();
    const slice = sliceOf(chosenPair(), state.view), at = state.cursor || { x: 0, y: 0 };
    const length = (e.shiftKey ? 20 : 2) / slice.resolution;
    const moved = (v, k, half) => Math.min(Math.max(v + k * length * half, -half), half);
    moveTo({ x: moved(at.x, step[0], slice.halfX), y: moved(at.y, step[1], slice.halfY) });
  });
}

function addPlot(parent, title, note, text, draw) {
  const canvas = element("canvas", { role: "img", "aria-label": title });
  parent.append(element("figure", {},
    element("figcaption", {}, element("b", {}, title, element("span", {}, note)), text), canvas));
  plots.push({ canvas, draw: (scene) => draw(canvas, scene) });
  return canvas;
}

function makeLandscapes() {
  const area = byId("landscapes");
  movable(addPlot(area, "The target", "",
    "What is really there, by tracing each neighbour: ridges, edges of shadows, other triangles.",
    (canvas, s) => drawPlot(canvas, s.pair, s.slice, s.bright, () => {}, state.cursor, state.topology)));
  if (model.available) {
    movable(addPlot(area, "Its quadratic approximation", "",
      "What gradient and Hessian at the path know of it, with the Gaussian that Hamiltonian dynamics on it gives.",
      (canvas, s) => drawPlot(canvas, s.pair, s.slice, s.quadratic, s.ellipses, state.cursor, false)));
  } else {
    area.append(element("p", { class: "hint" }, `There is no quadratic approximation at this ` +
      `path: ${model.reason}. The chain takes steps from the prior instead.`));
  }
}

function makeKinds() {
  byId("proposals-text").textContent = `${data.kinds.length ? data.kinds[0].count : 0} proposals of each kind from ` +
    `this path, over the target in the plane above. They differ from the path in all coordinates, and only their ` +
    `projection is drawn: one that lies on the ridge here may miss it in another plane.`;
  for (const kind of data.kinds) {
    const note = ` · ${percent(kind.acceptance)} accepted`;
    if (kind.name === "large") {
      const points = [];
      for (let k = 0; k < kind.count; ++k)
        if (kind.filmAt[2 * k] >= 0)
          points.push({ x: kind.filmAt[2 * k], y: kind.filmAt[2 * k + 1], accepted: kind.accepted[k] });
      addPlot(byId("kinds"), kind.name, note,
        `${KIND_TEXT.large} Drawn on the film: ${kind.otherTechnique} of them went to other techniques, ` +
        `${kind.count - points.length} found nothing.`,
        (canvas) => drawFilm(canvas, points, picture));
      continue;
    }
    const text = element("span", {});
    movable(addPlot(byId("kinds"), kind.name, note, text, (canvas, s) => {
      const points = s.points.get(kind);
      const beyond = points.filter((p) => Math.abs(p.x) > s.slice.halfX || Math.abs(p.y) > s.slice.halfY).length;
      text.textContent = `${KIND_TEXT[kind.name] || ""} ${kind.dark} found no light` +
        (beyond ? `; ${beyond} lie beyond the plot.` : ".");
      drawPlot(canvas, s.pair, s.slice, s.dim, (context, frame) => {
        if (kind.name === "hamiltonian") s.ellipses(context, frame);
        for (const wanted of [0, 1])
          for (const p of points) if (p.accepted === wanted) drawPoint(context, frame.px(p.x), frame.py(p.y), wanted);
      }, state.cursor, state.topology);
    }));
  }
}

function makeTables() {
  const cells = (tag, values) => values.map((v) => element(tag, {}, v));
  const shown = data.kinds.filter((kind) => kind.name !== "large");
  byId("eigen-text").textContent = model.available
    ? "By the size of the eigenvalue. Length: 1 / √|eigenvalue|, over which the curvature alone changes the target " +
      "by a factor of √e. Deviation and drift: of the Hamiltonian Gaussian along it. Jumps: how far the accepted " +
      "proposals of each mutation get along it."
    : `Not available: ${model.reason}.`;
  if (model.available) {
    byId("eigen").replaceChildren(
      element("thead", {},
        element("tr", {}, ...cells("th",
          ["", "eigenvalue", "length", "slope", "deviation", "drift", ...shown.map((k) => `${k.name} jump`)]))),
      element("tbody", {}, ...model.eigen.map((e, i) => element("tr", { "data-name": e.name },
        ...cells("td", [e.name, short(e.value), short(1 / Math.sqrt(Math.abs(e.value))), short(e.slope),
          short(e.deviation), short(e.mean), ...shown.map((k) => short(k.jumpAlong[i]))])))));
    labelCells(byId("eigen"));
  }
  byId("mutations").replaceChildren(
    element("thead", {},
      element("tr", {}, ...cells("th",
        ["mutation", "proposals", "acceptance", "jump", "jump on the film, pixels", "no light", "elsewhere"]))),
    element("tbody", {}, ...data.kinds.map((k) => element("tr", {},
      ...cells("td", [k.name, String(k.count), percent(k.acceptance), short(k.jump), short(k.filmJump), String(k.dark),
        String(k.otherTechnique)])))));
  labelCells(byId("mutations"));
}

function makeLegend() {
  byId("ramp").style.background = `linear-gradient(90deg, ${RAMP.map((c) => `rgb(${c.join()})`).join()})`;
  const entries = [["dark", "no light: something is in the way, or the path leaves"],
    ["outside", "outside of the primary space"],
    ["other", "another shape, lobe or light begins (faint: another triangle): what the derivative can't see"],
    ["accepted", "accepted"], ["rejected", "rejected"]];
  if (model.available) entries.push(["gaussian", "the Gaussian, one and two standard deviations"]);
  byId("legend").replaceChildren(...entries.map(([name, text]) =>
    element("li", {}, element("span", { class: `swatch ${name}` }), text)));
}

function makeControls() {
  const change = (values) => {
    Object.assign(state, values);
    if ("pair" in values || "view" in values) state.cursor = null;
    redraw();
  };
  byId("pair").replaceChildren(...data.pairs.map((pair, i) => element("option", { value: String(i) }, pairText(pair))));
  byId("pair").addEventListener("change", (e) => change({ pair: Number(e.target.value) }));
  for (const button of byId("view").children)
    button.addEventListener("click", () => change({ view: button.dataset.view }));
  byId("decades").addEventListener("input", (e) => change({ decades: Number(e.target.value) }));
  byId("topology").addEventListener("change", (e) => change({ topology: e.target.checked }));
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT") return;
    const count = data.pairs.length;
    if (e.key === "[") change({ pair: (state.pair + count - 1) % count });
    else if (e.key === "]") change({ pair: (state.pair + 1) % count });
    else if (e.key === "w") change({ view: "wide" });
    else if (e.key === "c") change({ view: "close" });
  });
  window.addEventListener("resize", redraw);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

describePath();
plots.push({ draw: () => drawFilm(byId("film"), [], picture) });
byId("film").setAttribute("aria-label", "the film, with the path's place on it");
makeLandscapes();
makeKinds();
makeTables();
makeLegend();
makeControls();
redraw();

// SPDX-License-Identifier: MIT
// What is chosen, and what follows from it.
const data = JSON.parse(byId("data").textContent);
byId("data").remove();
const decoded = new Map();  // "scene/picture/mark" -> Float32Array
const state = {
  scene: 0, metric: data.metrics[0].name, timed: data.plan.timed,
  mode: "one", show: "color", picture: 0, last: 0, right: -1, mark: null, exposure: 0, gamma: 2.2,
};
const REFERENCE = -1;
const insets = data.scenes.map((s) => s.insets);  // rectangles, at first where the methods differ most
const exposures = data.scenes.map(() => null);
const brightness = new Map();  // of the scenes' references
const scene = () => data.scenes[state.scene];
const viewer = new Viewer(byId("views"), showValues, addInset);

// --- Pictures ------------------------------------------------------------------------------------

// The embedded images of a method, [{mark, point}].
const embedded = (method) => (method.repeats[0] ? method.repeats[0].points.filter((p) => p.pixels) : []);

// The point whose picture is shown: the one nearest to the chosen mark.
function pointOf(index) {
  const points = embedded(scene().methods[index]);
  if (!points.length) return null;
  if (state.mark === null) return points[points.length - 1];
  const distance = (p) => Math.abs(Math.log(p.mark / state.mark));
  return points.reduce((a, b) => (distance(b) < distance(a) ? b : a));
}

function values(index) {
  const point = index === REFERENCE ? null : pointOf(index);
  const pixels = index === REFERENCE ? scene().reference.pixels : point && point.pixels;
  if (!pixels) return null;
  const key = `${state.scene}/${index}/${point ? point.mark : ""}`;
  if (!decoded.has(key)) decoded.set(key, decodePixels(pixels));
  return decoded.get(key);
}

// A canvas with the picture as it is to be seen.
const developed = new Map();
function canvasOf(index) {
  const v = values(index);
  if (!v) return null;
  const point = index === REFERENCE ? null : pointOf(index);
  const key = `${index}/${point ? point.mark : ""}`;
  const show = index === REFERENCE ? "color" : state.show;
  const wanted = `${state.scene} ${show} ${state.exposure} ${state.gamma}`;
  let entry = developed.get(key);
  if (!entry) developed.set(key, (entry = { canvas: element("canvas"), made: "" }));
  if (entry.made !== wanted) {
    entry.canvas.width = scene().width;
    entry.canvas.height = scene().height;
    develop(entry.canvas, v, values(REFERENCE), show, state.exposure, state.gamma);
    entry.made = wanted;
  }
  return entry.canvas;
}

const nameOf = (index) => (index === REFERENCE ? "reference" : scene().methods[index].name);
const pictures = () => scene().methods.map((_, i) => i).filter((i) => values(i));

// The error of the very image that is shown.
function valueText(index) {
  const point = index === REFERENCE ? null : pointOf(index);
  if (!point) return "";
  return `${state.metric} ${short(point.errors[state.metric], 4)}, ${short(point.seconds)} s`;
}

function viewOf(index) {
  const canvas = canvasOf(index);
  return canvas && { caption: nameOf(index), value: valueText(index), layers: [canvas] };
}

function drawPictures() {
  const list = pictures();
  byId("pictures").hidden = !list.length;
  if (!list.length) return;
  if (state.picture !== REFERENCE && !list.includes(state.picture)) state.picture = list[0];
  let views;
  if (state.mode === "side") {
    views = [...list, REFERENCE].map(viewOf);
  } else if (state.mode === "slider") {
    views = [{
      caption: `${nameOf(state.picture)} | ${nameOf(state.right)}`,
      value: [valueText(state.picture), valueText(state.right)].filter(Boolean).join(" | "),
      layers: [canvasOf(state.picture), canvasOf(state.right)],
    }];
  } else {
    views = [viewOf(state.picture)];
  }
  const narrow = innerWidth < 700;
  const columns = views.length === 1 ? 1
    : narrow ? Math.min(2, views.length)
    : views.length === 4 ? 2 : Math.min(3, views.length);
  byId("views").style.maxWidth = views.length === 1
    ? `${Math.max(scene().width, Math.round((innerHeight * 0.75 * scene().width) / scene().height))}px` : "";
  viewer.show(views.filter(Boolean), scene().width, scene().height, columns);
  drawChips(list);
  drawInsets();
}

function drawChips(list) {
  byId("chips").replaceChildren(...[...list, REFERENCE].map((index) => {
    const chip = element("button",
      { "data-picture": String(index), "aria-pressed": String(state.mode !== "side" && index === state.picture) });
    if (index !== REFERENCE) chip.append(element("span", { class: "key", style: `background:${color(index)}` }));
    chip.append(nameOf(index) + " ", element("kbd", {}, index === REFERENCE ? "r" : String(index + 1)));
    chip.addEventListener("click", () => choosePicture(index));
    return chip;
  }));
}

function choosePicture(index) {
  if (index !== REFERENCE && !pictures().includes(index)) return;
  if (state.picture !== REFERENCE) state.last = state.picture;
  state.picture = index;
  if (state.mode === "side") state.mode = "one";
  update();
}

// --- Values under the cursor ---------------------------------------------------------------------

// Those of the last pixel pointed at stay, so that nothing below moves; at first the middle's.
let cursor = null;
function showValues(at) {
  const table = byId("readout");
  if (!values(REFERENCE)) return;
  cursor = at = at || cursor || { x: scene().width >> 1, y: scene().height >> 1 };
  const k = 3 * (at.y * scene().width + at.x);
  const reference = values(REFERENCE);
  const offset = 0.01 * brightness.get(state.scene);
  const rows = [...pictures(), REFERENCE].map((index) => {
    const v = values(index), y = luminanceAt(v, k), r = luminanceAt(reference, k);
    const cells = [0, 1, 2].map((c) => element("td", { "data-value": String(v[k + c]) }, short(v[k + c], 4)));
    const error = index === REFERENCE ? ""
      : `${y >= r ? "+" : "−"}${short((100 * Math.abs(y - r)) / (Math.abs(r) + offset), 3)} %`;
    const name = element("td", { class: "text" });
    if (index !== REFERENCE) name.append(element("span", { class: "key", style: `background:${color(index)}` }));
    name.append(nameOf(index));
    return element("tr", { class: index === state.picture ? "chosen" : "", "data-picture": String(index) },
      name, ...cells, element("td", {}, short(y, 4)), element("td", {}, error));
  });
  table.replaceChildren(
    element("thead", {},
      element("tr", {}, element("th", { class: "text", "data-x": String(at.x), "data-y": String(at.y) },
        `pixel ${at.x}, ${at.y}`),
      ...["red", "green", "blue", "luminance", "to reference"].map((t) => element("th", {}, t)))),
    element("tbody", {}, ...rows));
  labelCells(table);
}

// --- Insets --------------------------------------------------------------------------------------

function addInset(rectangle) {
  insets[state.scene].unshift(rectangle);
  setPicking(false);
  drawInsets();
}

function drawInsets() {
  const list = pictures();
  const columns = list.length + 1;
  const size = Math.max(96, Math.min(230, Math.floor((byId("insets").clientWidth - 30) / columns) - 6));
  byId("insets").replaceChildren(...insets[state.scene].map((r) => {
    const row = element("div", { class: "inset" });
    for (const index of [...list, REFERENCE]) {
      const canvas = element("canvas",
        { width: size * devicePixelRatio, height: Math.round((size * devicePixelRatio * r.height) / r.width) });
      canvas.style.width = `${size}px`;
      const context = canvas.getContext("2d");
      context.imageSmoothingEnabled = false;
      context.drawImage(canvasOf(index), r.x, r.y, r.width, r.height, 0, 0, canvas.width, canvas.height);
      canvas.title = `${nameOf(index)}, pixels ${r.x}, ${r.y} to ${r.x + r.width}, ${r.y + r.height}; ` +
        `click: look there`;
      canvas.addEventListener("click", () => {
        viewer.scale = Math.min(scene().width / r.width, scene().height / r.height);
        viewer.x = (r.x + r.width / 2) / scene().width;
        viewer.y = (r.y + r.height / 2) / scene().height;
        choosePicture(index);
      });
      row.append(element("figure", {}, canvas, nameOf(index)));
    }
    const remove = element("button", { class: "remove", title: "remove this row" }, "×");
    remove.addEventListener("click", () => {
      insets[state.scene] = insets[state.scene].filter((other) => other !== r);
      drawInsets();
    });
    row.append(remove);
    return row;
  }));
}

function setPicking(on) {
  viewer.picking = on;
  byId("pick").setAttribute("aria-pressed", String(on));
}

// --- The whole page ------------------------------------------------------------------------------

function drawCurves() {
  const s = scene();
  drawChart(byId("chart-time"), s, state.metric, "seconds", `${s.name}: ${state.metric} against time`, false);
  drawChart(byId("chart-work"), s, state.metric, "perPixel", `${s.name}: ${state.metric} against ${work(s)}`, false);
  const others = data.scenes.length > 1 ? data.scenes : [];
  byId("all-scenes").replaceChildren(...others.map((other, i) => {
    const figure = element("figure", { title: `show ${other.name}` });
    drawChart(figure, other, state.metric, "seconds", other.name, true);
    figure.addEventListener("click", () => chooseScene(i));
    return figure;
  }));
}

function chooseScene(index) {
  state.scene = (index + data.scenes.length) % data.scenes.length;
  developed.clear();
  cursor = null;
  viewer.reset();
  prepareScene();
  update();
}

// The controls that depend on the scene.
function prepareScene() {
  const list = pictures();
  if (!list.length) return;
  if (exposures[state.scene] === null) exposures[state.scene] = pleasantExposure(values(REFERENCE));
  state.exposure = exposures[state.scene];
  brightness.set(state.scene, meanLuminance(values(REFERENCE)));
  byId("right").replaceChildren(...[REFERENCE, ...list].map((i) => element("option", { value: String(i) }, nameOf(i))));
  if (state.right !== REFERENCE && !list.includes(state.right)) state.right = REFERENCE;
  const marks = [...new Set(list.flatMap((i) => embedded(scene().methods[i]).map((p) => p.mark)))]
    .sort((a, b) => a - b);
  const unit = data.plan.timed ? "s" : "a pixel";
  byId("mark").replaceChildren(...marks.map((m) => element("option", { value: String(m) }, `${short(m)} ${unit}`)));
  if (!marks.includes(state.mark)) state.mark = null;
  byId("mark").value = String(state.mark ?? marks[marks.length - 1]);
  byId("mark-label").hidden = marks.length < 2;
}

function update() {
  const press = (group, key, value) =>
    document.querySelectorAll(`#${group} button`).forEach((b) =>
      b.setAttribute("aria-pressed", String(b.dataset[key] === value)));
  document.querySelectorAll("#scenes button").forEach((b, i) =>
    b.setAttribute("aria-selected", String(i === state.scene)));
  press("mode", "mode", state.mode);
  press("show", "show", state.show);
  byId("metric").value = state.metric;
  byId("axis").value = state.timed ? "time" : "work";
  byId("metric-text").textContent = data.metrics.find((m) => m.name === state.metric).description;
  byId("reference-text").textContent = referenceText(data, scene());
  byId("exposure").value = state.exposure;
  byId("exposure-out").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure.toFixed(1)}`;
  byId("gamma").value = state.gamma;
  byId("gamma-out").textContent = state.gamma.toFixed(1);
  byId("right").value = String(state.right);
  byId("right-label").hidden = state.mode !== "slider";
  drawRanking(byId("ranking"), data, scene(), state.metric, state.timed);
  drawCurves();
  drawPictures();
  showValues(cursor);
}

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || ["SELECT", "INPUT"].includes(event.target.tagName)
    && event.key.startsWith("Arrow")) return;
  const key = event.key;
  if (key >= "1" && key <= "9") choosePicture(Number(key) - 1);
  else if (key === "r") choosePicture(state.picture === REFERENCE ? state.last : REFERENCE);
  else if (key === "ArrowRight") chooseScene(state.scene + 1);
  else if (key === "ArrowLeft") chooseScene(state.scene - 1);
  else if (key === "e") {
    state.show = { color: "relative", relative: "signed", signed: "color" }[state.show];
    update();
  }
  else if (key === "m") { state.mode = { one: "side", side: "slider", slider: "one" }[state.mode]; update(); }
  else if (key === "i") setPicking(!viewer.picking);
  else if (key === "Escape") setPicking(false);
  else if (key === "+" || key === "=") viewer.zoom(1.5);
  else if (key === "-") viewer.zoom(1 / 1.5);
  else if (key === "0") { viewer.reset(); viewer.draw(); }
  else return;
  event.preventDefault();
}

function start() {
  const marks = data.plan.marks.map((m) => short(m)).join(", ");
  byId("about").textContent =
    `${data.machine}, ${data.plan.threads} threads; ${data.plan.repeats} repeats, images at ${marks} ` +
    `${data.plan.timed ? "s" : "mutations or samples a pixel"}; h2mc ${data.programVersion}`;
  byId("bands").textContent = data.plan.repeats < 2 ? "" : data.plan.bandsAreRanges
    ? "bands: from the better to the worse one (the 95 % interval of two would cover the plot); "
    : "bands: its 95 % interval; ";
  if (data.scenes.length > 1)
    byId("scenes").replaceChildren(...data.scenes.map((s, i) => {
      const tab = element("button", { role: "tab" }, s.name);
      tab.addEventListener("click", () => chooseScene(i));
      return tab;
    }));
  byId("metric").replaceChildren(...data.metrics.map((m) => element("option", {}, m.name)));
  byId("metric").addEventListener("change", (e) => { state.metric = e.target.value; update(); });
  byId("axis").addEventListener("change", (e) => { state.timed = e.target.value === "time"; update(); });
  document.querySelectorAll("#mode button").forEach((b) =>
    b.addEventListener("click", () => { state.mode = b.dataset.mode; update(); }));
  document.querySelectorAll("#show button").forEach((b) =>
    b.addEventListener("click", () => { state.show = b.dataset.show; update(); }));
  byId("exposure").addEventListener("input", (e) => {
    state.exposure = exposures[state.scene] = Number(e.target.value);
    update();
  });
  byId("gamma").addEventListener("input", (e) => { state.gamma = Number(e.target.value); update(); });
  byId("right").addEventListener("change", (e) => { state.right = Number(e.target.value); update(); });
  byId("mark").addEventListener("change", (e) => { state.mark = Number(e.target.value); update(); });
  byId("zoom-in").addEventListener("click", () => viewer.zoom(1.5));
  byId("zoom-out").addEventListener("click", () => viewer.zoom(1 / 1.5));
  byId("fit").addEventListener("click", () => { viewer.reset(); viewer.draw(); });
  byId("pick").addEventListener("click", () => setPicking(!viewer.picking));
  document.addEventListener("keydown", onKey);
  const all = data.scenes.some((s) => s.methods.some((m) => embedded(m).length > 1));
  byId("embedded-text").textContent = `Errors are of luminance, relative to the reference (plus 1 % of its mean): ` +
    `from 0.001, dark, to 1, pale; signed: red where brighter, blue where darker. The pictures are the first ` +
    `repeat's, ${all ? "at every mark" : "at the last mark"}, as half floats (three digits).`;
  prepareScene();
  update();
  let wide = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== wide) { wide = innerWidth; update(); } });
}
start();

// SPDX-License-Identifier: MIT
// Asks the program for news, and shows them.
const data = JSON.parse(byId("data").textContent);
byId("data").remove();
const state = { show: "color", exposure: 0, gamma: 2.2, exposed: false };
let news = null;       // what the program has said last
let pixels = null;     // Float32Array of RGB
let noisy = null;      // the pixels, brighter by their estimated error
let deviation = null;  // standard error of each pixel's luminance
let cursor = null;
let failures = 0;
const picture = element("canvas");
const viewer = new Viewer(byId("views"), showValues, () => {});

// "12.3 s", "4:05", "1:02:03"
function duration(seconds) {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 59.95) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds), two = (v) => String(v).padStart(2, "0");
  return whole < 3600 ? `${Math.floor(whole / 60)}:${two(whole % 60)}`
    : `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

function withPrefix(v) {
  if (!Number.isFinite(v)) return "–";
  const [factor, prefix] = v < 999.5 ? [1, ""] : v < 999.5e3 ? [1e3, " k"] : v < 999.5e6 ? [1e6, " M"] : [1e9, " G"];
  return String(Number((v / factor).toPrecision(3))) + prefix;
}

// --- The picture ---------------------------------------------------------------------------------

// The root of the mean square of the estimates around each pixel: a single one is as uncertain as they can be.
function smoothed(errors, width, height) {
  const reach = 2, rows = new Float32Array(errors.length), result = new Float32Array(errors.length);
  const along = (from, to, count, length, step, next, f) => {
    for (let line = 0; line < count; ++line)
      for (let i = 0; i < length; ++i) {
        let sum = 0, n = 0;
        for (let j = Math.max(0, i - reach); j <= Math.min(length - 1, i + reach); ++j, ++n)
          sum += from(line * next + j * step);
        to[line * next + i * step] = f(sum / n);
      }
  };
  along((k) => errors[k] * errors[k], rows, height, width, 1, width, (v) => v);
  along((k) => rows[k], result, width, height, width, 1, Math.sqrt);
  return result;
}

function takePictures(answer) {
  pixels = decodePixels(answer.pixels);
  deviation = noisy = null;
  if (answer.error) {
    deviation = smoothed(decodePixels(answer.error), answer.width, answer.height);
    noisy = pixels.map((v, i) => v + deviation[Math.floor(i / 3)]);
  }
  if (!state.exposed) state.exposure = pleasantExposure(pixels);
}

function drawPicture() {
  byId("picture").hidden = !pixels;
  if (!pixels) return;
  const { width, height } = news;
  picture.width = width;
  picture.height = height;
  byId("show").hidden = !noisy;
  const show = noisy ? state.show : "color";
  develop(picture, show === "color" ? pixels : noisy, pixels, show, state.exposure, state.gamma);
  byId("views").style.maxWidth = `${Math.max(width, Math.round((innerHeight * 0.75 * width) / height))}px`;
  const of = news.over ? "" : `after ${duration(news.pictureSeconds)}`;
  viewer.show([{ caption: show === "color" ? data.image : "estimated error", value: of, layers: [picture] }],
    width, height, 1);
  showValues(cursor);
}

// Of the last pixel pointed at; at first the middle's.
function showValues(at) {
  if (!pixels) return;
  cursor = at = at || cursor || { x: news.width >> 1, y: news.height >> 1 };
  const i = at.y * news.width + at.x, k = 3 * i, y = luminanceAt(pixels, k);
  const names = ["red", "green", "blue", "luminance"], values = [pixels[k], pixels[k + 1], pixels[k + 2], y];
  if (deviation) {
    names.push("± estimated");
    values.push(deviation[i]);
  }
  byId("readout").replaceChildren(
    element("b", { "data-x": String(at.x), "data-y": String(at.y) }, `pixel ${at.x}, ${at.y}`),
    ...values.map((v, c) => element("span", { "data-value": String(v) }, `${names[c]} ${short(v, 4)}`)));
}

// --- Numbers -------------------------------------------------------------------------------------

function standing() {
  if (failures > 2) return news && news.over ? standingOver() : "The program does not answer any more";
  if (!news) return "Waiting for the program";
  if (news.over) return standingOver();
  if (news.stopping) return "Stopping: the image is written";
  return news.number ? "Rendering" : "Preparing: there is no picture yet";
}
function standingOver() {
  if (!news.written) return "Over; the image could not be written";
  return news.interrupted ? `Stopped; what there was is in ${data.image}` : `Done: ${data.image}`;
}

function drawNumbers() {
  byId("h-progress").textContent = standing();
  if (!news) return;
  const fraction = news.over && !news.interrupted ? 1 : news.fraction || 0;
  byId("fraction").value = fraction;
  const left = data.secondsGiven > 0 ? data.secondsGiven - news.seconds
    : fraction > 0 ? (news.seconds * (1 - fraction)) / fraction : NaN;
  byId("left").textContent = news.over || failures > 2 ? ""
    : `${Math.floor(100 * fraction)} %${Number.isFinite(left) ? `, ${duration(Math.max(left, 0))} left` : ""}`;
  const rows = [["time", duration(news.seconds)]];
  if (news.rate > 0) rows.push(["rate", `${withPrefix(news.rate)} ${news.unit}/s`]);
  if (news.number) {
    const aPixel = news.samples / (news.width * news.height);
    rows.push([news.sampleUnit, `${withPrefix(news.samples)}, ${short(aPixel)} a pixel`]);
    rows.push(["mean luminance", `${short(news.meanLuminance, 6)} ± ${short(news.meanLuminanceError, 2)}`]);
    if (news.notFinite > 0) rows.push(["not finite", String(news.notFinite)]);
  }
  byId("numbers").replaceChildren(...rows.map(([name, value]) =>
    element("tr", {}, element("th", { class: "text" }, name), element("td", { class: "text" }, value))));
  const kinds = (news.acceptance || []).filter((kind) => kind.proposed > 0);
  byId("acceptance").replaceChildren(...(kinds.length ? [
    element("thead", {}, element("tr", {}, element("th", { class: "text" }, "mutation"),
      element("th", {}, "acceptance"), element("th", {}, "proposed"))),
    element("tbody", {}, ...kinds.map((kind) => element("tr", {}, element("td", { class: "text" }, kind.name),
      element("td", {}, `${(100 * kind.acceptance).toFixed(1)} %`),
      element("td", {}, withPrefix(kind.proposed)))))] : []));
}

function update() {
  document.querySelectorAll("#show button").forEach((b) =>
    b.setAttribute("aria-pressed", String(b.dataset.show === state.show)));
  byId("exposure").value = state.exposure;
  byId("exposure-out").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure.toFixed(1)}`;
  byId("gamma").value = state.gamma;
  byId("gamma-out").textContent = state.gamma.toFixed(1);
  const stop = byId("stop");
  stop.disabled = !news || news.over || news.stopping || failures > 2;
  stop.textContent = news && news.stopping && !news.over ? "stopping" : "stop";
  drawNumbers();
  drawPicture();
}

// --- News ----------------------------------------------------------------------------------------

async function ask() {
  try {
    const answer = await (await fetch(`state?seen=${news ? news.number : 0}`)).json();
    failures = 0;
    news = answer;
    if (answer.pixels) takePictures(answer);
  } catch {
    ++failures;
  }
  update();
  if (!(news && news.over)) setTimeout(ask, failures > 2 ? 5000 : 1000);
}

async function stop() {
  byId("stop").disabled = true;
  try {
    await fetch("stop", { method: "POST", headers: { "X-H2mc": "stop" } });
    if (news) news.stopping = true;
  } catch { /* it is over already, or the next question finds out */ }
  update();
}

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === "e" && noisy) { state.show = state.show === "color" ? "relative" : "color"; update(); }
  else if (event.key === "+" || event.key === "=") viewer.zoom(1.5);
  else if (event.key === "-") viewer.zoom(1 / 1.5);
  else if (event.key === "0") { viewer.reset(); viewer.draw(); }
  else return;
  event.preventDefault();
}

function start() {
  document.title = `${data.image} – h2mc`;
  byId("name").textContent = data.scene.split("/").pop();
  byId("name").title = data.scene;
  byId("about").textContent = `${data.integrator}, seed ${data.seed}, ` +
    `${data.threads} thread${data.threads === 1 ? "" : "s"}; h2mc ${data.programVersion}`;
  byId("about").title = data.options.split(",").join("\n");
  byId("options").textContent = data.options.split(",").join(", ");
  document.querySelectorAll("#show button").forEach((b) =>
    b.addEventListener("click", () => { state.show = b.dataset.show; update(); }));
  byId("exposure").addEventListener("input", (e) => {
    state.exposure = Number(e.target.value);
    state.exposed = true;
    update();
  });
  byId("gamma").addEventListener("input", (e) => { state.gamma = Number(e.target.value); update(); });
  byId("zoom-in").addEventListener("click", () => viewer.zoom(1.5));
  byId("zoom-out").addEventListener("click", () => viewer.zoom(1 / 1.5));
  byId("fit").addEventListener("click", () => { viewer.reset(); viewer.draw(); });
  byId("stop").addEventListener("click", stop);
  document.addEventListener("keydown", onKey);
  let wide = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== wide) { wide = innerWidth; update(); } });
  update();
  ask();
}
start();

// SPDX-License-Identifier: MIT
// The ranking, and what is said about reference and metric.

const work = (scene) =>
  (scene.methods.every((m) => m.repeats.every((r) => r.points.every((p) => p.sampleUnit === "samples")))
  ? "samples" : "mutations");

function drawRanking(table, data, scene, metric, timed) {
  const summary = scene.summaries.find((s) => s.metric === metric && s.timed === timed);
  const at = timed ? `${short(summary.position)} s` : `${short(summary.position)} ${work(scene)} a pixel`;
  const head = element("tr", {},
    element("th", { class: "text" }, "method"), element("th", {}, "rank"), element("th", {}, `${metric} at ${at}`),
    element("th", {}, "slope p"), element("th", {}, "× error of best"),
    element("th", {}, timed ? "× time to its error" : "× work to its error"),
    element("th", {}, "mean / reference"), element("th", {}, "bias² (relmse)"),
      element("th", { class: "text" }, "verdict"));
  const withInterval = (e) => element("td", {}, short(e.value), element("small", {}, interval(e)));
  const rows = summary.order.map((i) => {
    const m = summary.methods[i], bias = scene.methods[i].bias;
    const name = element("td", { class: "text" }, element("span", { class: "key", style: `background:${color(i)}` }),
      m.name);
    if (scene.methods[i].external) name.append(element("small", {}, "external"));
    const options = Object.entries(scene.methods[i].options).map(([k, v]) => `${k} = ${v}`).join("\n");
    if (options) name.title = options;
    const error = withInterval(m.error);
    error.setAttribute("data-value", number(m.error.value));
    if (m.byFit) error.append(element("small", {}, "by fit"));
    const biasText = element("td", {}, short(bias.squaredBias, 2));
    if (number(bias.standardError) > 0) biasText.append(element("small", {}, `± ${short(bias.standardError, 2)}`));
    biasText.title = `mean image of all repeats: relmse ${short(bias.meanImageError)}; variance alone and the ` +
      `reference's own error would leave ${short(bias.varianceAlone)}`;
    const verdict = element("td", { class: "text" });
    verdict.append(element("span", { class: m.verdict === "best" ? "best-word" : "" }, m.verdict));
    if (!Number.isNaN(number(m.pValue))) verdict.append(element("small", {}, `p = ${short(m.pValue, 2)}`));
    if (bias.brightnessOff) verdict.append(" ", element("span", { class: "bad-word" }, "brightness off"));
    if (bias.shows) verdict.append(" ", element("span", { class: "bad-word" }, "bias shows"));
    return element("tr", { class: i === summary.best ? "best" : "", "data-method": String(i) },
      name, element("td", {}, m.rank ? String(m.rank) : "–"), error, withInterval(m.p), withInterval(m.errorRatio),
      withInterval(m.timeRatio), withInterval(bias.meanRatio), biasText, verdict);
  });
  table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...rows));
  labelCells(table);
}

function referenceText(data, scene) {
  const r = scene.reference, own = number(r.relmse);
  let text = `Reference: ${r.origin}.`;
  text += own > 0 ? ` Its own relmse: ${short(own, 2)}.`
    : " Its own error is not known: it counts as error of every method, and as bias.";
  if (!r.goodEnough) text += " That is more than a tenth of the smallest error compared: small errors are " +
    "overestimated.";
  return `${text} Ranks: Welch's test on the logarithms of the errors, Holm-adjusted over all pairs; 95 % intervals ` +
    `by Student's t over ${data.plan.repeats} repeats.`;
}

// SPDX-License-Identifier: MIT
// What the program has computed, decoded.
const data = JSON.parse(byId("data").textContent);
const model = data.model;

function bytesOf(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}
const floatsOf = (text) => new Float32Array(bytesOf(text).buffer);

function halfValue(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
  return sign * (exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24);
}

const CELL = { dark: 0, same: 1, primitive: 2, topology: 3, outside: 4 };

// Slices are large: each is decoded when it is first looked at.
function sliceOf(pair, view) {
  const slice = pair[view];
  if (!slice.values) {
    const bits = new Uint16Array(bytesOf(slice.logRatio).buffer);
    slice.values = Float32Array.from(bits, halfValue);
    slice.kinds = bytesOf(slice.cells);
    // The brightest neighbour sets the scale.
    slice.brightest = 0;
    for (let i = 0; i < slice.values.length; ++i)
      if (slice.kinds[i] !== CELL.dark && slice.kinds[i] !== CELL.outside)
        slice.brightest = Math.max(slice.brightest, slice.values[i]);
  }
  return slice;
}

const eigenByName = new Map(model.eigen.map((e) => [e.name, e]));
function directionOf(name) {
  if (eigenByName.has(name)) return eigenByName.get(name).vector;
  return model.coordinateNames.map((n) => (n === name ? 1 : 0));
}
const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);

// The quadratic approximation of log(target / target here) in a plane: a polynomial in two variables.
function quadraticIn(x, y) {
  const q = { x: 0, y: 0, xx: 0, xy: 0, yy: 0 };
  for (const e of model.eigen) {
    const a = dot(e.vector, x), b = dot(e.vector, y);
    q.x += e.slope * a;
    q.y += e.slope * b;
    q.xx += 0.5 * e.value * a * a;
    q.xy += e.value * a * b;
    q.yy += 0.5 * e.value * b * b;
  }
  return (u, v) => q.x * u + q.y * v + q.xx * u * u + q.xy * u * v + q.yy * v * v;
}

// The Hamiltonian Gaussian's projection: its mean, and the map from the circle to its deviations.
function gaussianIn(x, y) {
  const g = { x: 0, y: 0 };
  let xx = 0, xy = 0, yy = 0;
  for (const e of model.eigen) {
    const a = dot(e.vector, x), b = dot(e.vector, y), variance = e.deviation * e.deviation;
    xx += a * a * variance;
    xy += a * b * variance;
    yy += b * b * variance;
    g.x += a * e.mean;
    g.y += b * e.mean;
  }
  g.a = Math.sqrt(xx);
  g.b = g.a > 0 ? xy / g.a : 0;
  g.c = Math.sqrt(Math.max(yy - g.b * g.b, 0));
  return g;
}

for (const kind of data.kinds) {
  kind.filmAt = floatsOf(kind.film);
  kind.offsetAt = floatsOf(kind.offsets);
  kind.probability = floatsOf(kind.acceptances);
}
function projected(kind, x, y) {
  const n = model.dimension, points = [];
  for (let k = 0; k < kind.count; ++k) {
    let u = 0, v = 0;
    for (let i = 0; i < n; ++i) {
      u += kind.offsetAt[k * n + i] * x[i];
      v += kind.offsetAt[k * n + i] * y[i];
    }
    if (!Number.isNaN(u)) points.push({ x: u, y: v, accepted: kind.accepted[k], probability: kind.probability[k] });
  }
  return points;
}

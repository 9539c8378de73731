// SPDX-License-Identifier: MIT
// Pictures: from half floats in base64 to numbers, and from numbers to what is shown.
const halfValues = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    let v = exponent === 0 ? mantissa * 2 ** -24 : (1 + mantissa / 1024) * 2 ** (exponent - 15);
    if (exponent === 31) v = mantissa ? NaN : Infinity;
    table[bits] = bits & 0x8000 ? -v : v;
  }
  return table;
})();

// {exponent, data} -> Float32Array of RGB, row by row from the top.
function decodePixels(pixels) {
  const text = atob(pixels.data), scale = 2 ** pixels.exponent;
  const values = new Float32Array(text.length / 2);
  for (let i = 0; i < values.length; ++i)
    values[i] = scale * halfValues[text.charCodeAt(2 * i) | (text.charCodeAt(2 * i + 1) << 8)];
  return values;
}

const luminanceAt = (v, i) => 0.212671 * v[i] + 0.71516 * v[i + 1] + 0.072169 * v[i + 2];

function meanLuminance(values) {
  let sum = 0;
  for (let i = 0; i < values.length; i += 3) sum += luminanceAt(values, i);
  return sum / (values.length / 3);
}

// Black, purple, red, orange, pale yellow; and for signed errors black to blue or red.
const heatStops = [[0, 0, 13], [89, 13, 128], [217, 51, 77], [255, 153, 26], [255, 255, 191]];
function heat(t) {
  const at = Math.min(Math.max(t, 0), 1) * 4, i = Math.min(Math.floor(at), 3), f = at - i;
  return heatStops[i].map((v, c) => v + f * (heatStops[i + 1][c] - v));
}
function signed(e) {
  const s = Math.sqrt(Math.min(Math.abs(e), 1));
  const first = 255 * Math.min(1.6 * s, 1), second = 255 * Math.max(0, 2.5 * s - 1.5);
  return e > 0 ? [first, second, 0] : [0, second, first];
}

// Draws a picture, or its error against the reference, into a canvas of its size.
// show: "color" | "relative" | "signed". Errors are of luminance, (a - r) / (r + 0.01 mean of r);
// relative ones logarithmic from 0.001 (dark) to 1 (bright).
function develop(canvas, values, reference, show, exposure, gamma) {
  const context = canvas.getContext("2d"), image = context.createImageData(canvas.width, canvas.height);
  const out = image.data;
  if (show === "color") {
    const steps = 16384, table = new Uint8ClampedArray(steps + 1);
    for (let i = 0; i <= steps; ++i) table[i] = Math.round(255 * (i / steps) ** (1 / gamma));
    const factor = steps * 2 ** exposure;
    for (let i = 0, o = 0; i < values.length; i += 3, o += 4) {
      for (let c = 0; c < 3; ++c) {
        const v = values[i + c] * factor;
        out[o + c] = v > 0 ? table[v < steps ? v | 0 : steps] : 0;
      }
      out[o + 3] = 255;
    }
  } else {
    const offset = 0.01 * meanLuminance(reference);
    for (let i = 0, o = 0; i < values.length; i += 3, o += 4) {
      const r = luminanceAt(reference, i), d = luminanceAt(values, i) - r;
      const e = d === 0 ? 0 : d / (Math.abs(r) + offset);
      const rgb = !Number.isFinite(e) ? [255, 0, 255]
        : show === "signed" ? signed(e) : heat(1 + Math.log10(Math.max(Math.abs(e), 1e-4)) / 3);
      for (let c = 0; c < 3; ++c) out[o + c] = rgb[c];
      out[o + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
}

// An exposure, in stops, that brings the mean of the logarithms near to a middle grey.
function pleasantExposure(values) {
  let sum = 0, count = 0;
  for (let i = 0; i < values.length; i += 3) {
    const y = luminanceAt(values, i);
    if (y > 0 && Number.isFinite(y)) { sum += Math.log2(y); ++count; }
  }
  return count ? Math.round(10 * Math.min(Math.max(Math.log2(0.18) - sum / count, -10), 10)) / 10 : 0;
}

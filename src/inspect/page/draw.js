// SPDX-License-Identifier: MIT
// Plots on canvases, in the page's colours.
const RAMP = [[15, 16, 48], [65, 33, 122], [146, 48, 127], [219, 79, 98], [251, 155, 92], [253, 243, 192]];
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function rampColor(t) {
  const position = Math.min(Math.max(t, 0), 1) * (RAMP.length - 1), k = Math.min(Math.floor(position), RAMP.length - 2);
  return RAMP[k].map((v, c) => v + (RAMP[k + 1][c] - v) * (position - k));
}

// The canvas at the screen's resolution; height by the width.
function prepared(canvas, heightOf) {
  const scale = window.devicePixelRatio || 1, width = canvas.clientWidth || 320, height = heightOf(width);
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  canvas.style.height = `${height}px`;
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  context.font = "12px system-ui, sans-serif";
  return { context, width, height };
}

const MARGIN = { left: 62, right: 8, top: 4, bottom: 40 };

// Where a slice's plane is on a canvas of this width.
function frameOf(width, slice) {
  const size = width - MARGIN.left - MARGIN.right;
  return {
    size,
    px: (x) => MARGIN.left + size * (0.5 + (0.5 * x) / slice.halfX),
    py: (y) => MARGIN.top + size * (0.5 - (0.5 * y) / slice.halfY),
    x: (px) => slice.halfX * (2 * ((px - MARGIN.left) / size) - 1),
    y: (py) => slice.halfY * (1 - 2 * ((py - MARGIN.top) / size)),
  };
}

function shade(slice, options, valueAt) {
  const n = slice.resolution, canvas = element("canvas", { width: n, height: n });
  const context = canvas.getContext("2d"), image = context.createImageData(n, n);
  const span = options.decades * Math.LN10;
  for (let row = 0, i = 0; row < n; ++row)
    for (let column = 0; column < n; ++column, ++i) {
      const { value, kind } = valueAt(column, row, i);
      let rgb = rampColor(1 + (value - slice.brightest) / span);
      if (kind === CELL.dark) rgb = Math.floor((column + row) / 3) % 2 ? [108, 111, 117] : [91, 94, 100];
      else if (kind === CELL.outside) rgb = [201, 204, 209];
      for (let c = 0; c < 3; ++c) image.data[4 * i + c] = options.strength * rgb[c] + (1 - options.strength) * 16;
      image.data[4 * i + 3] = 255;
    }
  context.putImageData(image, 0, 0);
  return canvas;
}

const targetImage = (slice, options) =>
  shade(slice, options, (column, row, i) => ({ value: slice.values[i], kind: slice.kinds[i] }));
function quadraticImage(slice, options, quadratic) {
  const n = slice.resolution, at = (k) => (2 * k + 1) / n - 1;
  return shade(slice, options, (column, row) =>
    ({ value: quadratic(slice.halfX * at(column), -slice.halfY * at(row)), kind: CELL.same }));
}

// Lines between cells of different topology.
function drawTopology(context, slice, frame) {
  const n = slice.resolution, cell = frame.size / n;
  const lit = (kind) => kind >= CELL.same && kind <= CELL.topology;
  const edge = (i, j) => {
    const a = slice.kinds[i], b = slice.kinds[j];
    return a !== b && lit(a) && lit(b) ? (a === CELL.topology || b === CELL.topology ? 2 : 1) : 0;
  };
  for (const [strength, style] of [[1, "#ffffff44"], [2, "#ffffffd0"]]) {
    context.beginPath();
    for (let row = 0; row < n; ++row)
      for (let column = 0; column < n; ++column) {
        const i = row * n + column, x = MARGIN.left + column * cell, y = MARGIN.top + row * cell;
        if (column + 1 < n && edge(i, i + 1) === strength) {
          context.moveTo(x + cell, y);
          context.lineTo(x + cell, y + cell);
        }
        if (row + 1 < n && edge(i, i + n) === strength) {
          context.moveTo(x, y + cell);
          context.lineTo(x + cell, y + cell);
        }
      }
    context.strokeStyle = style;
    context.lineWidth = 1;
    context.stroke();
  }
}

function roundBelow(v) {
  const power = 10 ** Math.floor(Math.log10(v));
  return power * (v >= 5 * power ? 5 : v >= 2 * power ? 2 : 1);
}

function drawAxes(context, slice, frame, pair) {
  const bottom = MARGIN.top + frame.size;
  context.strokeStyle = css("--line");
  context.lineWidth = 1;
  context.strokeRect(MARGIN.left, MARGIN.top, frame.size, frame.size);
  context.fillStyle = css("--dim");
  const stepX = roundBelow(slice.halfX * 0.8), stepY = roundBelow(slice.halfY * 0.8);
  for (const k of [-1, 0, 1]) {
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillText(short(k * stepX, 1), frame.px(k * stepX), bottom + 6);
    context.fillRect(frame.px(k * stepX) - 0.5, bottom, 1, 4);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillText(short(k * stepY, 1), MARGIN.left - 7, frame.py(k * stepY));
    context.fillRect(MARGIN.left - 4, frame.py(k * stepY) - 0.5, 4, 1);
  }
  context.fillStyle = css("--text");
  context.textAlign = "center";
  context.textBaseline = "bottom";
  context.fillText(`along ${pair.x}`, MARGIN.left + frame.size / 2, bottom + MARGIN.bottom - 2);
  context.save();
  context.translate(11, MARGIN.top + frame.size / 2);
  context.rotate(-Math.PI / 2);
  context.textBaseline = "middle";
  context.fillText(`along ${pair.y}`, 0, 0);
  context.restore();
}

function drawGaussian(context, frame, g) {
  context.lineWidth = 1.4;
  for (const radius of [1, 2]) {
    context.beginPath();
    for (let k = 0; k <= 96; ++k) {
      const c = radius * Math.cos((2 * Math.PI * k) / 96), s = radius * Math.sin((2 * Math.PI * k) / 96);
      context.lineTo(frame.px(g.x + g.a * c), frame.py(g.y + g.b * c + g.c * s));
    }
    context.strokeStyle = css("--gaussian");
    context.stroke();
  }
}

function drawPoint(context, x, y, accepted) {
  if (accepted) {
    context.beginPath();
    context.arc(x, y, 2.8, 0, 7);
    context.fillStyle = css("--accepted");
    context.fill();
    context.lineWidth = 0.8;
    context.strokeStyle = "#101014";
    context.stroke();
    return;
  }
  for (const [width, style] of [[2.6, "#101014a0"], [1.1, "#ffffffc0"]]) {
    context.beginPath();
    context.moveTo(x - 2.6, y - 2.6);
    context.lineTo(x + 2.6, y + 2.6);
    context.moveTo(x - 2.6, y + 2.6);
    context.lineTo(x + 2.6, y - 2.6);
    context.lineWidth = width;
    context.strokeStyle = style;
    context.stroke();
  }
}

function drawCross(context, x, y, reach = 7) {
  for (const [width, style] of [[4, "#101014"], [1.8, "#ffffff"]]) {
    context.beginPath();
    context.moveTo(x - reach, y);
    context.lineTo(x + reach, y);
    context.moveTo(x, y - reach);
    context.lineTo(x, y + reach);
    context.lineWidth = width;
    context.strokeStyle = style;
    context.stroke();
  }
}

// One plot: the slice as an image, what lies on it, axes, and the cursor.
function drawPlot(canvas, pair, slice, image, overlay, cursor, topology) {
  const { context, width } = prepared(canvas, (w) => w - MARGIN.left - MARGIN.right + MARGIN.top + MARGIN.bottom);
  const frame = frameOf(width, slice);
  context.save();
  context.beginPath();
  context.rect(MARGIN.left, MARGIN.top, frame.size, frame.size);
  context.clip();
  context.imageSmoothingEnabled = false;
  context.drawImage(image, MARGIN.left, MARGIN.top, frame.size, frame.size);
  if (topology) drawTopology(context, slice, frame);
  overlay(context, frame);
  drawCross(context, frame.px(0), frame.py(0));
  if (cursor) {
    context.strokeStyle = "#ffffffb0";
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(frame.px(cursor.x), MARGIN.top);
    context.lineTo(frame.px(cursor.x), MARGIN.top + frame.size);
    context.moveTo(MARGIN.left, frame.py(cursor.y));
    context.lineTo(MARGIN.left + frame.size, frame.py(cursor.y));
    context.stroke();
  }
  context.restore();
  drawAxes(context, slice, frame, pair);
}

// The film with the places that points came to.
function drawFilm(canvas, points, picture) {
  const { context, width, height } = prepared(canvas, (w) => Math.round((w * data.height) / data.width));
  context.imageSmoothingEnabled = true;
  context.drawImage(picture, 0, 0, width, height);
  if (points.length) {
    context.fillStyle = "#10101480";
    context.fillRect(0, 0, width, height);
  }
  for (const wanted of [0, 1])
    for (const p of points) if (p.accepted === wanted) drawPoint(context, p.x * width, p.y * height, wanted);
  drawCross(context, data.path.filmX * width, data.path.filmY * height, 9);
}

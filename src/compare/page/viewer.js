// SPDX-License-Identifier: MIT
// Pictures that move together.

class Viewer {
  // onCursor(x, y) with the pixel pointed at, or null; onInset(rectangle) when one was drawn.
  constructor(container, onCursor, onInset) {
    this.container = container;
    this.onCursor = onCursor;
    this.onInset = onInset;
    this.views = [];
    this.pointers = new Map();
    this.split = 0.5;
    this.picking = false;
    this.reset();
    new ResizeObserver(() => this.draw()).observe(container);
  }

  // scale 1: the whole width is seen; (x, y): the picture's point in the view's centre, in [0, 1].
  reset() { this.scale = 1; this.x = 0.5; this.y = 0.5; }

  // views: [{caption, value, layers: [canvas] or [left, right]}], all pictures width x height.
  show(views, width, height, columns) {
    this.width = width;
    this.height = height;
    this.container.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
    if (this.views.length !== views.length) {
      this.views = views.map(() => this.makeView());
      this.container.replaceChildren(...this.views.map((v) => v.figure));
    }
    views.forEach((view, i) => {
      const own = this.views[i];
      own.layers = view.layers;
      own.canvas.setAttribute("aria-label", view.caption);
      own.caption.replaceChildren(element("b", {}, view.caption), element("span", {}, view.value));
    });
    this.draw();
  }

  makeView() {
    const canvas = element("canvas"), caption = element("figcaption");
    const view = { canvas, caption, figure: element("figure", { class: "view" }, canvas, caption), layers: [] };
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom(Math.exp(-e.deltaY * 0.0022), this.at(canvas, e));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (e) => this.down(view, e));
    canvas.addEventListener("pointermove", (e) => this.move(view, e));
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (e) => this.up(view, e));
    canvas.addEventListener("pointerleave", () => { if (!this.pointers.size) this.onCursor(null); });
    canvas.addEventListener("dblclick", () => { this.reset(); this.draw(); });
    return view;
  }

  // Where an event is: in the view, [0, 1]^2, and in the picture.
  at(canvas, event) {
    const box = canvas.getBoundingClientRect();
    const u = (event.clientX - box.left) / box.width, v = (event.clientY - box.top) / box.height;
    return { u, v, x: this.x + (u - 0.5) / this.scale, y: this.y + (v - 0.5) / this.scale };
  }

  zoom(factor, at = { u: 0.5, v: 0.5, x: this.x, y: this.y }) {
    this.scale = Math.min(Math.max(this.scale * factor, 1), this.width / 6);
    this.x = at.x - (at.u - 0.5) / this.scale;
    this.y = at.y - (at.v - 0.5) / this.scale;
    this.draw();
  }

  keepInside() {
    const half = 0.5 / this.scale;
    this.x = Math.min(Math.max(this.x, half), 1 - half);
    this.y = Math.min(Math.max(this.y, half), 1 - half);
  }

  down(view, event) {
    const at = this.at(view.canvas, event);
    this.pointers.set(event.pointerId, at);
    try { view.canvas.setPointerCapture(event.pointerId); } catch { /* a pointer that is gone */ }
    this.action = this.picking || event.shiftKey ? "pick"
      : view.layers.length === 2 && Math.abs(at.u - this.split) < 0.04 ? "split" : "pan";
    this.start = at;
    this.pixel(at);
    event.preventDefault();
  }

  move(view, event) {
    const at = this.at(view.canvas, event), before = this.pointers.get(event.pointerId);
    if (!before) {
      view.canvas.style.cursor = view.layers.length === 2 && Math.abs(at.u - this.split) < 0.04 ? "ew-resize"
        : "crosshair";
      this.pixel(at);
      return;
    }
    if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const distance = (a, b) => Math.hypot(a.u - b.u, a.v - b.v) || 1e-3;
      this.pointers.set(event.pointerId, at);
      this.zoom(distance(at, other) / distance(before, other), at);
      return;
    }
    this.pointers.set(event.pointerId, at);
    if (this.action === "split") {
      this.split = Math.min(Math.max(at.u, 0), 1);
      this.draw();
    } else if (this.action === "pick") {
      this.draw();
      this.views.forEach((v) => this.outline(v.canvas, this.rectangle(this.start, at)));
    } else if (this.scale > 1) {
      this.x -= (at.u - before.u) / this.scale;
      this.y -= (at.v - before.v) / this.scale;
      this.draw();
      this.pointers.set(event.pointerId, this.at(view.canvas, event));
    }
    this.pixel(this.at(view.canvas, event));
  }

  up(view, event) {
    const at = this.pointers.get(event.pointerId);
    this.pointers.delete(event.pointerId);
    if (this.action === "pick" && at) {
      const r = this.rectangle(this.start, this.at(view.canvas, event));
      if (r.width >= 4 && r.height >= 4) this.onInset(r);
      this.draw();
    }
    this.action = null;
  }

  rectangle(a, b) {
    const clamp = (v, size) => Math.min(Math.max(Math.round(v * size), 0), size);
    const x0 = clamp(Math.min(a.x, b.x), this.width), x1 = clamp(Math.max(a.x, b.x), this.width);
    const y0 = clamp(Math.min(a.y, b.y), this.height), y1 = clamp(Math.max(a.y, b.y), this.height);
    return { x: x0, y: y0, width: x1 - x0, height: y1 - y0 };
  }

  pixel(at) {
    const x = Math.floor(at.x * this.width), y = Math.floor(at.y * this.height);
    this.onCursor(x >= 0 && y >= 0 && x < this.width && y < this.height ? { x, y } : null);
  }

  draw() {
    if (!this.width) return;
    this.keepInside();
    for (const view of this.views) {
      const canvas = view.canvas, context = canvas.getContext("2d");
      const w = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
      const h = Math.max(1, Math.round((w * this.height) / this.width));
      if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
      canvas.style.aspectRatio = `${this.width} / ${this.height}`;
      canvas.classList.toggle("zoomed", this.scale > 1);
      const pixel = (w * this.scale) / this.width;  // of the picture, on the screen
      context.imageSmoothingEnabled = pixel < 1;
      context.clearRect(0, 0, w, h);
      const left = w / 2 - this.x * this.width * pixel, top = h / 2 - this.y * this.height * pixel;
      view.layers.forEach((layer, i) => {
        context.save();
        if (i === 1) {
          context.beginPath();
          context.rect(this.split * w, 0, w, h);
          context.clip();
        }
        context.drawImage(layer, left, top, this.width * pixel, this.height * pixel);
        context.restore();
      });
      if (view.layers.length === 2) {
        context.fillStyle = "#fff";
        context.fillRect(this.split * w - devicePixelRatio, 0, 2 * devicePixelRatio, h);
        context.beginPath();
        context.arc(this.split * w, h / 2, 9 * devicePixelRatio, 0, 7);
        context.fill();
      }
    }
  }

  // A frame around a rectangle of the picture.
  outline(canvas, r) {
    const context = canvas.getContext("2d"), pixel = (canvas.width * this.scale) / this.width;
    context.strokeStyle = "#fff";
    context.lineWidth = 2 * devicePixelRatio;
    context.strokeRect(canvas.width / 2 + (r.x - this.x * this.width) * pixel,
      canvas.height / 2 + (r.y - this.y * this.height) * pixel, r.width * pixel, r.height * pixel);
  }
}

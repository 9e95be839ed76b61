// The picture: a camera and what it sees. In the plane it looks straight down and moves; in
// space it goes round. Everything is drawn on a plain canvas, the farthest first.

const COLOURS = 7;
/** Points of a path: more are not seen. */
const PATH = 1500;

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** The largest length of one digit that does not exceed another length. */
function round(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((digit) => digit * power).find((nice) => nice <= length) ?? power;
}

class View {
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.scene = scene;
    this.pen = canvas.getContext("2d");
    this.trails = true;
    this.paint();
    this.whole();
  }

  /** Takes the colours from the style sheet. */
  paint() {
    this.ink = {};
    for (const name of ["ground", "quiet", "rule", "grid", "edge", "joint", "shadow", "ink"]) this.ink[name] = colour(name);
    this.ink.bodies = Array.from({ length: COLOURS }, (_, i) => colour(`c${i}`));
  }

  /** Shows all that ever happens. */
  whole() {
    this.scene.measure();
    this.turn = { azimuth: (-62 * Math.PI) / 180, elevation: (20 * Math.PI) / 180 };
    this.zoom = 1;
    this.target = [...this.scene.middle];
  }

  /** Fits the canvas to its place on the page, and the scene to the canvas. */
  fit() {
    const detail = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (this.canvas.width !== Math.round(width * detail) || this.canvas.height !== Math.round(height * detail)) {
      this.canvas.width = Math.round(width * detail);
      this.canvas.height = Math.round(height * detail);
    }
    this.pen.setTransform(detail, 0, 0, detail, 0, 0);
    [this.width, this.height] = [width, height];
    this.axes();
    const { low, high, middle, size } = this.scene;
    let [across, up] = [0.25 * size, 0.25 * size];
    for (let corner = 0; corner < 8; corner += 1) {
      const point = low.map((x, axis) => ((corner >> axis) & 1 ? high[axis] : x) - middle[axis]);
      across = Math.max(across, 2 * Math.abs(dot(point, this.right)));
      up = Math.max(up, 2 * Math.abs(dot(point, this.up)));
    }
    const margin = this.scene.spatial ? 1.3 : 1.22;
    this.scale = (this.zoom * Math.min(width / across, height / up)) / margin;
    this.thick = Math.min(16, Math.max(3.5, 0.02 * size * this.scale));
  }

  axes() {
    if (!this.scene.spatial) {
      [this.right, this.up, this.toward] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
      return;
    }
    const [s, c] = [Math.sin(this.turn.azimuth), Math.cos(this.turn.azimuth)];
    const [se, ce] = [Math.sin(this.turn.elevation), Math.cos(this.turn.elevation)];
    this.right = [-s, c, 0];
    this.up = [-se * c, -se * s, ce];
    this.toward = [ce * c, ce * s, se];
  }

  /** Where a point is on the canvas, how near, and how large what is there appears. */
  project(x, y, z) {
    const v = [x - this.target[0], y - this.target[1], z - this.target[2]];
    const depth = dot(v, this.toward);
    const distance = 3.5 * this.scene.size;
    const near = this.scene.spatial ? distance / Math.max(0.05 * distance, distance - depth) : 1;
    return [
      this.width / 2 + this.scale * near * dot(v, this.right),
      this.height / 2 - this.scale * near * dot(v, this.up),
      depth,
      near,
    ];
  }

  /** Draws the scene at a time. */
  draw(t) {
    this.fit();
    const { pen } = this;
    pen.clearRect(0, 0, this.width, this.height);
    pen.lineCap = pen.lineJoin = "round";
    const frame = this.scene.at(t);
    if (this.scene.spatial) this.floor(frame);
    if (this.trails) this.trace(t);
    const items = this.items(frame);
    if (this.scene.spatial) items.sort((a, b) => a.depth - b.depth);
    for (const item of items) item.draw();
    if (this.scene.spatial) this.triad();
    else this.ruler();
  }

  /** The points of a shape on the canvas; none if one of them is not there. */
  points(frame, { points, offset }) {
    const found = [];
    for (let i = 0; i < points; i += 1) {
      const [x, y, z] = frame.subarray(offset + 3 * i, offset + 3 * i + 3);
      if (!(Math.abs(x) < 1e15 && Math.abs(y) < 1e15 && Math.abs(z) < 1e15)) return [];
      const [px, py, depth, near] = this.project(x, y, z);
      found.push({ px, py, depth, near, place: offset + 3 * i });
    }
    return found;
  }

  /** All that is drawn, each with how near it is. */
  items(frame) {
    const items = [];
    const joints = [];
    const grounds = [];
    let body = 0;
    for (const shape of this.scene.shapes) {
      const points = this.points(frame, shape);
      if (shape.kind === "line") {
        for (let i = 0; i + 1 < Math.max(points.length, shape.points); i += 1) {
          const rests = this.scene.fixed.has(shape.offset + 3 * i) && this.scene.fixed.has(shape.offset + 3 * i + 3);
          const ink = rests ? this.ink.quiet : this.ink.bodies[body % COLOURS];
          if (!rests) body += 1;
          if (points.length > 0) items.push(this.rod(points[i], points[i + 1], ink));
        }
        joints.push(...points.filter((point) => !this.scene.fixed.has(point.place)));
        grounds.push(...points.filter((point) => this.scene.fixed.has(point.place)));
      } else if (shape.kind === "polygon") {
        const rests = Array.from({ length: shape.points }, (_, i) => shape.offset + 3 * i).every((place) => this.scene.fixed.has(place));
        const ink = rests ? this.ink.quiet : this.ink.bodies[body % COLOURS];
        if (!rests) body += 1;
        if (points.length > 0) items.push(this.plate(points, ink));
      } else if (shape.kind === "circle" && points.length > 0) {
        items.push(this.ball(points[0], Math.abs(frame[shape.offset + 3]), this.ink.bodies[body % COLOURS]));
      } else if (shape.kind === "trace" && this.trails && points.length > 0) {
        items.push(this.dot(points[0]));
      }
    }
    // In the plane what rests lies behind, joints lie in front.
    return [...once(grounds).map((point) => this.ground(point)), ...items, ...once([...joints, ...grounds]).map((point) => this.joint(point))];
  }

  rod(a, b, ink) {
    return {
      depth: (a.depth + b.depth) / 2,
      draw: () => {
        const thick = (this.thick * (a.near + b.near)) / 2;
        for (const [width, style] of [[thick + 2, this.ink.edge], [thick, ink]]) this.stroke([a, b], width, style);
      },
    };
  }

  plate(points, ink) {
    return {
      depth: points.reduce((sum, point) => sum + point.depth, 0) / points.length,
      draw: () => {
        this.path(points, true);
        this.pen.fillStyle = ink;
        this.pen.globalAlpha = 0.35;
        this.pen.fill();
        this.pen.globalAlpha = 1;
        this.pen.lineWidth = 0.5 * this.thick;
        this.pen.strokeStyle = ink;
        this.pen.stroke();
      },
    };
  }

  ball(at, radius, ink) {
    const { pen } = this;
    const size = Math.max(2, radius * this.scale * at.near);
    return {
      depth: at.depth + (size < 2 * this.thick ? 0.02 * this.scene.size : 0),
      draw: () => {
        if (!(size < 1e5)) return;
        pen.beginPath();
        pen.arc(at.px, at.py, size, 0, 2 * Math.PI);
        const wheel = size > 4 * this.thick && !this.scene.spatial;
        pen.globalAlpha = wheel ? 0.18 : 1;
        pen.fillStyle = ink;
        pen.fill();
        pen.globalAlpha = 1;
        pen.lineWidth = wheel ? 0.5 * this.thick : 1;
        pen.strokeStyle = wheel ? ink : this.ink.edge;
        pen.stroke();
      },
    };
  }

  joint(at) {
    return {
      depth: at.depth + 0.012 * this.scene.size,
      draw: () => this.disc(at, 0.36 * this.thick * at.near, this.ink.joint, this.ink.edge),
    };
  }

  dot(at) {
    return { depth: at.depth + 0.03 * this.scene.size, draw: () => this.disc(at, 3, this.ink.edge, this.ink.ground) };
  }

  /** The sign of a bearing on the ground: a triangle on a hatched line; in space a foot. */
  ground(at) {
    const { pen } = this;
    const size = 1.7 * this.thick;
    return {
      depth: at.depth - 0.01 * this.scene.size,
      draw: () => {
        if (this.scene.spatial) {
          this.disc(at, 0.85 * this.thick * at.near, this.ink.quiet, this.ink.edge);
          return;
        }
        const base = at.py + 1.5 * size;
        pen.lineWidth = 1.3;
        pen.strokeStyle = this.ink.edge;
        pen.fillStyle = this.ink.ground;
        pen.beginPath();
        pen.moveTo(at.px, at.py);
        pen.lineTo(at.px - size, base);
        pen.lineTo(at.px + size, base);
        pen.closePath();
        pen.fill();
        pen.stroke();
        pen.beginPath();
        pen.moveTo(at.px - 1.5 * size, base);
        pen.lineTo(at.px + 1.5 * size, base);
        for (let i = -1.5; i < 1.5; i += 0.5) {
          pen.moveTo(at.px + (i + 0.5) * size, base);
          pen.lineTo(at.px + i * size, base + 0.5 * size);
        }
        pen.stroke();
      },
    };
  }

  disc(at, size, fill, edge) {
    const { pen } = this;
    pen.beginPath();
    pen.arc(at.px, at.py, size, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
    pen.lineWidth = 1.2;
    pen.strokeStyle = edge;
    pen.stroke();
  }

  path(points, closed = false) {
    this.pen.beginPath();
    points.forEach(({ px, py }, i) => (i === 0 ? this.pen.moveTo(px, py) : this.pen.lineTo(px, py)));
    if (closed) this.pen.closePath();
  }

  stroke(points, width, style) {
    this.path(points);
    this.pen.lineWidth = width;
    this.pen.strokeStyle = style;
    this.pen.stroke();
  }

  /** Paths of points: what has been, and faintly what will be. */
  trace(t) {
    const { scene } = this;
    const now = before(scene.times, t);
    let place = 0;
    for (const shape of scene.shapes.filter(({ kind }) => kind === "trace")) {
      const at = (frame) => this.points(scene.frames.subarray(frame * scene.stride, (frame + 1) * scene.stride), shape);
      const ink = this.ink.bodies[(place + 3) % COLOURS];
      place += 1;
      const all = scene.times.length;
      const step = Math.ceil(all / PATH);
      const past = Array.from({ length: Math.floor(now / step) + 1 }, (_, i) => at(i * step)).flat();
      past.push(...at(now), ...this.points(scene.at(t), shape));
      const future = Array.from({ length: Math.ceil((all - now) / step) }, (_, i) => at(now + i * step)).flat();
      this.pen.globalAlpha = 0.22;
      this.stroke(future, 1.5, ink);
      this.pen.globalAlpha = 0.9;
      this.stroke(past, 1.8, ink);
      this.pen.globalAlpha = 1;
    }
  }

  /** The floor below everything, with the shadows on it. */
  floor(frame) {
    const { low, high, size } = this.scene;
    const level = low[2] - 0.03 * size;
    const step = round(size / 5);
    const edge = (axis, end) => (end < 0 ? Math.floor((low[axis] - 0.15 * size) / step) : Math.ceil((high[axis] + 0.15 * size) / step));
    const line = (from, to) => {
      const ends = [from, to].map(([x, y]) => this.project(x * step, y * step, level));
      this.stroke(ends.map(([px, py]) => ({ px, py })), 1, this.ink.grid);
    };
    for (let x = edge(0, -1); x <= edge(0, 1); x += 1) line([x, edge(1, -1)], [x, edge(1, 1)]);
    for (let y = edge(1, -1); y <= edge(1, 1); y += 1) line([edge(0, -1), y], [edge(0, 1), y]);
    for (const { kind, points, offset } of this.scene.shapes) {
      if (kind !== "line" && kind !== "polygon") continue;
      const shadow = [];
      for (let i = 0; i < points; i += 1) {
        const [px, py] = this.project(frame[offset + 3 * i], frame[offset + 3 * i + 1], level);
        if (Math.abs(px) < 1e6 && Math.abs(py) < 1e6) shadow.push({ px, py });
      }
      if (kind === "line") this.stroke(shadow, this.thick, this.ink.shadow);
      else {
        this.path(shadow, true);
        this.pen.fillStyle = this.ink.shadow;
        this.pen.fill();
      }
    }
  }

  /** The directions of the axes. */
  triad() {
    const [x, y, length] = [44, this.height - 40, 26];
    this.pen.font = "12px system-ui, sans-serif";
    this.pen.textAlign = "center";
    this.pen.textBaseline = "middle";
    ["x", "y", "z"].forEach((name, axis) => {
      const [dx, dy] = [this.right[axis], -this.up[axis]];
      this.stroke([{ px: x, py: y }, { px: x + length * dx, py: y + length * dy }], 1.6, this.ink.quiet);
      this.pen.fillStyle = this.ink.quiet;
      this.pen.fillText(name, x + (length + 9) * dx, y + (length + 9) * dy);
    });
  }

  /** A length to compare with. */
  ruler() {
    const metres = round(110 / this.scale);
    const [x, y, length] = [16, this.height - 16, metres * this.scale];
    const ends = [[x, y - 5], [x, y], [x + length, y], [x + length, y - 5]];
    this.stroke(ends.map(([px, py]) => ({ px, py })), 1.4, this.ink.quiet);
    this.pen.font = "12px system-ui, sans-serif";
    this.pen.textAlign = "left";
    this.pen.textBaseline = "bottom";
    this.pen.fillStyle = this.ink.quiet;
    this.pen.fillText(`${Number(metres.toPrecision(1))} m`, x + 5, y - 5);
  }

  /** Moves what is seen by pixels. */
  pan(dx, dy) {
    this.target = this.target.map((x, axis) => x - (dx * this.right[axis] - dy * this.up[axis]) / this.scale);
  }

  /** Goes round by pixels. */
  orbit(dx, dy) {
    this.turn.azimuth -= 0.008 * dx;
    this.turn.elevation = Math.min(1.55, Math.max(-1.55, this.turn.elevation + 0.008 * dy));
  }

  /** Zooms about a point of the canvas, which stays where it is. */
  zoomAt(factor, x, y) {
    const next = Math.min(200, Math.max(0.05, this.zoom * factor));
    const gained = next / this.zoom;
    const [dx, dy] = [x - this.width / 2, y - this.height / 2];
    this.pan(dx * (1 - 1 / gained) * -1, dy * (1 - 1 / gained) * -1);
    this.zoom = next;
  }
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Points of the canvas without those that are at the same place as one before. */
function once(points) {
  const kept = new Map(points.map((point) => [`${point.px.toFixed(1)} ${point.py.toFixed(1)} ${point.depth.toFixed(6)}`, point]));
  return [...kept.values()];
}

/** Lets pointers and keys move the camera. `changed` draws. */
function steer(view, changed) {
  const { canvas } = view;
  const held = new Map();
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, place(event));
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    const was = held.get(event.pointerId);
    if (!was) return;
    const now = place(event);
    const [dx, dy] = [now[0] - was[0], now[1] - was[1]];
    const other = [...held].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (point) => Math.max(10, Math.hypot(point[0] - other[0], point[1] - other[1]));
      view.zoomAt(apart(now) / apart(was), other[0], other[1]);
    } else if (view.scene.spatial && event.buttons === 1 && !event.shiftKey) view.orbit(dx, dy);
    else view.pan(dx, dy);
    held.set(event.pointerId, now);
    changed();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      view.zoomAt(Math.exp(-0.0015 * event.deltaY), ...place(event));
      changed();
    },
    { passive: false },
  );
}

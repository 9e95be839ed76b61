// The frames of the moving picture: where everything is at a time.

/** The numbers of base 64. */
function numbers(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Kind(bytes.buffer);
}

/** The index of the last of some ascending times that is not later than `t`. */
function before(times, t) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

class Scene {
  constructor(data) {
    this.times = numbers(data.times, Float64Array);
    this.frames = numbers(data.frames, Float32Array);
    this.spatial = data.spatial;
    let offset = 0;
    this.shapes = data.shapes.map(({ kind, points }) => {
      const shape = { kind, points, offset };
      offset += 3 * points + (kind === "circle" ? 1 : 0);
      return shape;
    });
    this.stride = offset;
    this.measure();
    this.findGround();
  }

  /** Takes another motion of the same shapes. The visible box grows if it has to; the scale
   * of lines and joints stays, so that a longer link looks longer. */
  take({ times, frames }) {
    const before = [this.low, this.high];
    [this.times, this.frames] = [times, frames];
    this.measure();
    const [low, high] = [this.low, this.high];
    this.bound(
      low.map((x, axis) => Math.min(x, before[0][axis])),
      high.map((x, axis) => Math.max(x, before[1][axis])),
    );
    this.findGround();
  }

  /** The numbers at a time, between two frames on the straight line between them. */
  at(t) {
    const i = before(this.times, t);
    const here = this.frames.subarray(i * this.stride, (i + 1) * this.stride);
    if (i + 1 >= this.times.length || t <= this.times[i]) return here;
    const part = (t - this.times[i]) / (this.times[i + 1] - this.times[i]);
    const next = this.frames.subarray((i + 1) * this.stride, (i + 2) * this.stride);
    return here.map((x, k) => x + part * (next[k] - x));
  }

  /** The box around all frames, without points at infinity. */
  measure() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let frame = 0; frame < this.times.length; frame += 1) {
      for (const { kind, points, offset } of this.shapes) {
        const base = frame * this.stride + offset;
        const radius = kind === "circle" ? Math.abs(this.frames[base + 3]) : 0;
        for (let i = 0; i < 3 * points; i += 1) {
          const x = this.frames[base + i];
          if (Math.abs(x) < 1e15) {
            low[i % 3] = Math.min(low[i % 3], x - (radius < 1e15 ? radius : 0));
            high[i % 3] = Math.max(high[i % 3], x + (radius < 1e15 ? radius : 0));
          }
        }
      }
    }
    for (let axis = 0; axis < 3; axis += 1) {
      if (!(low[axis] <= high[axis])) [low[axis], high[axis]] = [-0.5, 0.5];
    }
    if (!this.spatial) low[2] = high[2] = 0;
    this.bound(low, high);
  }

  /** The box, and how large it is. */
  bound(low, high) {
    this.low = low;
    this.high = high;
    this.middle = low.map((x, axis) => (x + high[axis]) / 2);
    const diagonal = Math.hypot(...high.map((x, axis) => x - low[axis]));
    this.size = diagonal > 1e-9 * Math.max(1, ...this.middle.map(Math.abs)) ? diagonal : 1;
  }

  /** Which points never move: those of the ground. */
  findGround() {
    this.fixed = new Set();
    for (const { kind, points, offset } of this.shapes) {
      if (kind !== "line" && kind !== "polygon") continue;
      for (let i = 0; i < points; i += 1) {
        if (this.rests(offset + 3 * i)) this.fixed.add(offset + 3 * i);
      }
    }
  }

  rests(place) {
    const enough = Math.max(1, Math.floor(this.times.length / 400));
    for (let frame = 0; frame < this.times.length; frame += enough) {
      for (let axis = 0; axis < 3; axis += 1) {
        const moved = this.frames[frame * this.stride + place + axis] - this.frames[place + axis];
        if (!(Math.abs(moved) <= 1e-5 * this.size)) return false;
      }
    }
    // A run of one frame says nothing about what moves.
    return this.times.length > 1;
  }
}

// Time: what plays, pauses and steps.

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
/** A run should not take longer than this to be seen, nor be over sooner (s). */
const LONGEST = 60;
const SHORTEST = 2;

class Player {
  constructor(times, draw) {
    this.take(times);
    this.draw = draw;
    this.time = this.start;
    this.playing = false;
    this.loop = true;
    const length = this.end - this.start;
    const fits = SPEEDS.filter((speed) => length / speed <= LONGEST && length / speed >= SHORTEST);
    this.speed = fits.includes(1) || fits.length === 0 ? 1 : fits.reduce((a, b) => (Math.abs(Math.log(a)) < Math.abs(Math.log(b)) ? a : b));
    this.wanted = false;
  }

  /** Takes the times of a motion. */
  take(times) {
    this.times = times;
    [this.start, this.end] = [times[0], times[times.length - 1]];
  }

  /** Draws before the next picture of the screen. */
  ask() {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    this.wanted = false;
    if (this.playing) {
      const passed = this.last === undefined ? 0 : Math.min(0.1, (now - this.last) / 1000);
      this.time += passed * this.speed;
      if (this.time >= this.end) {
        this.time = this.loop && this.end > this.start ? this.start : this.end;
        this.playing = this.loop && this.end > this.start;
      }
      this.last = now;
    } else this.last = undefined;
    this.draw(this.time);
    if (this.playing) this.ask();
  }

  play(wanted = true) {
    if (wanted && this.time >= this.end) this.time = this.start;
    this.playing = wanted;
    this.last = undefined;
    this.ask();
  }

  seek(t) {
    this.time = Math.min(Math.max(t, this.start), this.end);
    this.ask();
  }

  /** Goes to another frame. */
  step(frames) {
    this.playing = false;
    const here = before(this.times, this.time);
    // Between two frames one back is the one before.
    const back = frames < 0 && this.times[here] < this.time ? 1 : 0;
    const place = Math.min(Math.max(here + frames + back, 0), this.times.length - 1);
    this.seek(this.times[place]);
  }

  faster(steps) {
    const place = SPEEDS.indexOf(this.speed) + steps;
    this.speed = SPEEDS[Math.min(Math.max(place, 0), SPEEDS.length - 1)];
    this.ask();
  }
}

// The curves: one chart for each unit, all over the same time.

const SYNC = "time";
/** The least range that is shown, relative to the values, so that a constant looks constant. */
const FLAT = 1e-3;

class Curves {
  constructor(place, run, times, seek) {
    this.place = place;
    this.times = times;
    this.marks = run.marks;
    this.seek = seek;
    this.span = [times[0], Math.max(times[times.length - 1], times[0] + 1e-9)];
    place.append(this.tools());
    this.charts = run.panels.map((panel) => this.chart(panel));
    new ResizeObserver(() => this.resize()).observe(place);
  }

  tools() {
    const button = (name, title, act) => {
      const made = element("button", { type: "button", title }, name);
      made.addEventListener("click", act);
      return made;
    };
    return element(
      "div",
      { class: "tools" },
      button("zoom in", "a shorter time around the cursor", () => this.zoom(0.5)),
      button("zoom out", "a longer time", () => this.zoom(2)),
      button("all", "the whole run", () => this.show(...this.span)),
      "drag to zoom, with Shift to move; click to go there; a name switches its curve off and on",
    );
  }

  chart(panel) {
    const box = element("div", { class: "chart" }, element("h2", {}, panel.axis));
    this.place.append(box);
    const raw = panel.series.map((series) => numbers(series.values, Float64Array));
    const chart = new uPlot(this.options(panel, raw, box), [this.times, ...shown(panel, raw)], box);
    const line = element("div", { class: "cursor" });
    chart.over.append(line);
    box.querySelectorAll(".u-series").forEach((row, i) => {
      if (i === 0) return;
      const label = row.querySelector("th");
      label.setAttribute("tabindex", "0");
      label.setAttribute("role", "switch");
      label.title = panel.series[i - 1].docs;
      label.addEventListener("keydown", (event) => {
        if (event.key === "Enter") label.click();
      });
    });
    this.listen(chart);
    return { chart, line, panel, raw };
  }

  /** Takes the times and, by the names of curves, the values of another motion. */
  take(times, values) {
    this.times = times;
    for (const { chart, panel, raw } of this.charts) {
      const { min, max } = chart.scales.x;
      panel.series.forEach(({ name }, i) => (raw[i] = values(name)));
      chart.setData([times, ...shown(panel, raw)], false);
      chart.setScale("x", { min, max });
    }
  }

  options(panel, raw, box) {
    const ink = (name) => () => colour(name);
    const axis = { stroke: ink("quiet"), grid: { stroke: ink("grid"), width: 1 }, ticks: { stroke: ink("rule"), width: 1 }, font: "12px system-ui, sans-serif" };
    const logarithmic = panel.scale === "logarithmic";
    const value = (series) => (u, y, i, at) => (at === null || at === undefined ? "–" : Number(raw[series][at].toPrecision(9)).toString().replaceAll("-", "−"));
    return {
      width: Math.max(260, box.clientWidth),
      height: 180,
      scales: {
        x: { time: false },
        y: logarithmic ? { distr: 3, range: (u, low, high) => [10 ** panel.low, Math.max(1e-12, 10 ** Math.ceil(Math.log10(high || 1e-12)))] } : { range: spread },
      },
      axes: [
        { ...axis, values: (u, ticks) => ticks.map((t) => `${Number(t.toPrecision(10))}`), size: 32 },
        { ...axis, size: (u, texts) => Math.max(68, 22 + 7 * Math.max(...(texts ?? []).map((text) => text.length))), values: logarithmic ? (u, ticks) => ticks.map((y) => (y && Math.round(Math.log10(y)) % 2 === 0 ? y.toExponential(0) : "")) : (u, ticks) => labels(ticks) },
      ],
      series: [
        { label: "t", value: (u, t) => (t === null || t === undefined ? "–" : `${Number(t.toPrecision(9))} s`) },
        ...panel.series.map((series, i) => ({
          label: series.name,
          stroke: ink(`c${i % COLOURS}`),
          width: 1.6,
          value: value(i),
          ...(logarithmic ? { paths: () => null, points: { show: true, size: 3, fill: ink(`c${i % COLOURS}`) } } : { points: { show: false } }),
        })),
      ],
      cursor: { sync: { key: SYNC }, drag: { x: true, y: false, dist: 6 }, y: false, bind: { mousedown: pressed, dblclick: () => () => this.show(...this.span) } },
      legend: { live: true },
      hooks: { draw: [(u) => this.strokeMarks(u)] },
    };
  }

  /** Lines at passages and events. */
  strokeMarks(u) {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.setLineDash([4, 4]);
    ctx.lineWidth = 1.5;
    for (const mark of this.marks) {
      ctx.strokeStyle = colour(mark.event ? "event" : "passage");
      for (const t of mark.times) {
        const x = u.valToPos(t, "x", true);
        if (x < bbox.left || x > bbox.left + bbox.width) continue;
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  /** Clicks go to a time, dragging with Shift moves, the wheel with Ctrl zooms. */
  listen(chart) {
    let pressedAt = null;
    let range = null;
    chart.over.addEventListener("pointerdown", (event) => {
      pressedAt = event.clientX;
      range = event.shiftKey ? [chart.scales.x.min, chart.scales.x.max] : null;
    });
    chart.over.addEventListener("pointermove", (event) => {
      if (range === null || event.buttons !== 1) return;
      const moved = ((pressedAt - event.clientX) / chart.over.clientWidth) * (range[1] - range[0]);
      this.show(range[0] + moved, range[1] + moved);
    });
    chart.over.addEventListener("click", (event) => {
      if (pressedAt !== null && Math.abs(event.clientX - pressedAt) < 4 && !event.shiftKey) {
        const box = chart.over.getBoundingClientRect();
        this.seek(chart.posToVal(event.clientX - box.left, "x"));
      }
    });
    chart.over.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        const box = chart.over.getBoundingClientRect();
        this.zoom(Math.exp(0.0015 * event.deltaY), chart.posToVal(event.clientX - box.left, "x"));
      },
      { passive: false },
    );
  }

  /** Shows a span of time in all charts. */
  show(from, to) {
    const width = Math.min(to - from, this.span[1] - this.span[0]);
    const low = Math.min(Math.max(from, this.span[0]), this.span[1] - width);
    for (const { chart } of this.charts) chart.setScale("x", { min: low, max: low + width });
  }

  zoom(factor, about = this.now) {
    if (this.charts.length === 0) return;
    const { min, max } = this.charts[0].chart.scales.x;
    const middle = Math.min(Math.max(about ?? min, min), max);
    this.show(middle - factor * (middle - min), middle + factor * (max - middle));
  }

  /** Puts the time cursors where the moving picture is. */
  at(t, values) {
    this.now = t;
    const place = before(this.times, t);
    for (const { chart, line } of this.charts) {
      const x = chart.valToPos(t, "x");
      line.style.display = x >= 0 && x <= chart.over.clientWidth ? "" : "none";
      line.style.transform = `translateX(${x}px)`;
      if (values && !(chart.cursor.left >= 0)) chart.setLegend({ idx: place });
    }
  }

  resize() {
    for (const { chart } of this.charts) {
      const width = Math.max(260, this.place.clientWidth);
      if (width !== chart.width) chart.setSize({ width, height: chart.height });
    }
    if (this.now !== undefined) this.at(this.now, true);
  }

  redraw() {
    for (const { chart } of this.charts) chart.redraw(false, true);
  }
}

/** The values of a panel as they are drawn, without infinite ones. */
function shown(panel, raw) {
  const floor = panel.scale === "logarithmic" ? 10 ** panel.low : -Infinity;
  const place = (y) => (Math.abs(y) <= 1e300 ? Math.max(floor === -Infinity ? y : Math.abs(y), floor) : null);
  return raw.map((values) => Array.from(values, place));
}

/** A range with a margin, not so narrow that round-off looks like motion. */
function spread(u, low, high) {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const least = size < 1e-290 ? 1 : (low === high ? 0.1 : FLAT) * size;
  const margin = Math.max(0.06 * (high - low), 0.5 * (least - (high - low)));
  return [low - margin, high + margin];
}

/** Dragging zooms, but with Shift it moves. */
function pressed(u, target, handler) {
  return (event) => {
    if (event.button === 0 && !event.shiftKey) handler(event);
  };
}

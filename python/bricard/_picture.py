"""The moving picture of a run, as HTML that stands alone."""

from __future__ import annotations

import html as escaping
import json
from typing import TYPE_CHECKING, List

import numpy as np

from . import _abi

if TYPE_CHECKING:
    from .result import Result

#: Pictures of a run; its rows are thinned out to that many.
_FRAMES = 240
#: How far a metre of depth moves a point to the left and down (m).
_DEPTH = np.array([-0.35, -0.25])

_PAGE = """<figure style="margin:0;max-width:32em">
<svg viewBox="{view}" style="width:100%;max-height:24em" role="img"
 aria-label="{name}, moving"><g transform="scale(1,-1)" fill="none" stroke="currentColor"
 stroke-width="{width}" stroke-linejoin="round"></g></svg>
<div style="display:flex;gap:.5em"><button type="button">pause</button>
<input type="range" min="0" max="{last}" value="0" style="flex:1" aria-label="time">
<output style="min-width:6em">t = 0 s</output></div>
<figcaption>{summary}</figcaption>
<script>
(() => {{
  const figure = document.currentScript.closest('figure');
  const frames = {frames}, times = {times}, paper = 'http://www.w3.org/2000/svg';
  const group = figure.querySelector('g'), slider = figure.querySelector('input');
  const button = figure.querySelector('button'), told = figure.querySelector('output');
  let moving = true, begun = null, offset = 0;
  const draw = (index) => {{
    const drawn = frames[index].map(([kind, data]) => {{
      const shape = document.createElementNS(paper, kind);
      for (const [name, value] of Object.entries(data)) shape.setAttribute(name, value);
      return shape;
    }});
    group.replaceChildren(...drawn);
    slider.value = index;
    told.textContent = 't = ' + times[index].toFixed(2) + ' s';
  }};
  const length = times[times.length - 1] - times[0];
  const tick = (now) => {{
    if (!figure.isConnected) return;
    if (moving && length > 0) {{
      begun ??= now - offset * 1000;
      const t = times[0] + ((now - begun) / 1000) % length;
      let index = times.findIndex((time) => time > t);
      draw(index < 0 ? times.length - 1 : Math.max(index - 1, 0));
    }}
    requestAnimationFrame(tick);
  }};
  slider.oninput = () => {{
    moving = false; button.textContent = 'play';
    draw(Number(slider.value));
  }};
  button.onclick = () => {{
    moving = !moving; begun = null;
    offset = times[Number(slider.value)] - times[0];
    button.textContent = moving ? 'pause' : 'play';
  }};
  draw(0);
  requestAnimationFrame(tick);
}})();
</script></figure>"""


def html(result: "Result") -> str:
    """The page; a table of the summary where the description draws nothing."""
    summary = escaping.escape(str(result.summary))
    rows = np.unique(np.linspace(0, len(result) - 1, min(_FRAMES, len(result))).astype(int))
    handle = result._beginning
    states = [(result.t[row], result.q[row].copy(), result.v[row].copy()) for row in rows]
    pictures = [handle.shapes(*state) for state in states]
    if not any(pictures):
        return f"<p>{escaping.escape(result.mechanism.name)}: {summary}</p>"
    points = np.concatenate([_flat(points) for shapes in pictures for _, points, _ in shapes])
    radii = [radius for shapes in pictures for _, _, radius in shapes if radius]
    margin = max(radii, default=0.0) + 0.05 * max(float(np.ptp(points, axis=0).max()), 1e-9)
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    size = high - low
    traces: List[List[np.ndarray]] = []
    frames = [_frame(shapes, traces) for shapes in pictures]
    return _PAGE.format(
        view=f"{low[0]:.6g} {-high[1]:.6g} {size[0]:.6g} {size[1]:.6g}",
        name=escaping.escape(result.mechanism.name),
        width=f"{0.008 * float(size.max()):.3g}",
        last=len(frames) - 1,
        summary=summary,
        frames=json.dumps(frames),
        times=json.dumps([float(result.t[row]) for row in rows]),
    )


def _flat(points: np.ndarray) -> np.ndarray:
    """Points as they are seen from the front, a little from the right and from above."""
    return points[:, :2] + points[:, 2:] * _DEPTH


def _path(points: np.ndarray) -> str:
    return " ".join(f"{x:.5g},{y:.5g}" for x, y in points)


def _frame(shapes: List[tuple], traces: List[List[np.ndarray]]) -> list:
    """The elements of one picture; traces grow from picture to picture."""
    frame, trace = [], 0
    for kind, points, radius in shapes:
        flat = _flat(points)
        if kind == _abi.CIRCLE:
            (x, y), r = flat[0], f"{radius:.5g}"
            frame.append(["circle", {"cx": f"{x:.5g}", "cy": f"{y:.5g}", "r": r}])
        elif kind == _abi.TRACE:
            if trace == len(traces):
                traces.append([])
            traces[trace].append(flat[0])
            grown = np.array(traces[trace])
            frame.append(["polyline", {"points": _path(grown), "opacity": "0.4"}])
            trace += 1
        else:
            name = "polygon" if kind == _abi.POLYGON else "polyline"
            frame.append([name, {"points": _path(flat)}])
    return frame

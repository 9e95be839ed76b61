// The page: what is on it, and what its buttons and keys do.

const $ = (id) => document.getElementById(id);
const run = JSON.parse($("run").textContent);
/** What the page keeps while it is loaded again. */
const MEMORY = `bricard ${location.pathname}`;
/** How often news are looked for (ms). */
const NEWS = 400;

/** Whether the system is dark. */
const SYSTEM = matchMedia("(prefers-color-scheme: dark)");
/** What the button says, if it was pressed, and whether the page is going to paper. */
const theme = { chosen: null, printed: false };

/** Dark or light as the system says, unless the button says otherwise; light on paper. */
function dress() {
  const wanted = theme.chosen ?? (SYSTEM.matches ? "dark" : "light");
  document.documentElement.dataset.theme = theme.printed ? "light" : wanted;
}

function complain(message) {
  $("message").hidden = message === null;
  $("message").replaceChildren(element("pre", {}, message ?? ""));
}

/** What to write so that something moves. */
function explainPicture() {
  $("view").querySelector("#canvas").hidden = true;
  $("tools").hidden = true;
  const example = "draw line([0, 0], A, B);\ndraw circle(C, 0.05);\ndraw polygon(P, Q, R);\ndraw trace(tip);";
  $("nothing").hidden = false;
  $("nothing").append(
    element("p", {}, "This description draws nothing, so there are only curves. Statements such as these add a picture, of any points that the description names:"),
    element("pre", {}, example),
  );
}

function remember(parts) {
  try {
    sessionStorage.setItem(MEMORY, JSON.stringify(parts));
  } catch {
    // Without a memory the page begins anew.
  }
}

function remembered() {
  try {
    const text = sessionStorage.getItem(MEMORY);
    sessionStorage.removeItem(MEMORY);
    return JSON.parse(text) ?? {};
  } catch {
    return {};
  }
}

function begin() {
  document.title = `${run.mechanism} · ${run.program}`;
  $("name").textContent = run.mechanism;
  // Line breaks are those of the file; an empty line ends a paragraph.
  $("docs").textContent = run.docs.trim().replace(/\s*\n\s*\n\s*/g, "\u2029").replace(/\s*\n\s*/g, " ").replaceAll("\u2029", "\n");
  if (run.error) complain(run.error);
  const times = numbers(run.times, Float64Array);
  const scene = run.scene ? new Scene(run.scene) : null;
  const view = scene ? new View($("canvas"), scene) : null;
  if (!view) explainPicture();
  if (view && run.moving) $("tools").prepend(element("label", {}, run.moving));
  let told = 0;
  const player = new Player(scene ? scene.times : times, (t) => {
    view?.draw(t);
    const values = !player.playing || performance.now() - told > 120;
    if (values) told = performance.now();
    curves.at(t, values);
    show(player, t);
  });
  const curves = new Curves($("curves"), run, times, (t) => player.seek(t));
  window.bricard = { run, scene, view, player, curves };
  controls(player, view);
  marks(player);
  if (run.sliders) {
    window.bricard.sliders = new Sliders($("sliders"), run.sliders, scene !== null, (made) => change(made, player, scene, curves));
  }
  facts(run);
  equations(run);
  const kept = times.length;
  $("thinned").textContent =
    kept < run.rows ? `Of ${run.rows} rows ${kept} are shown: the lowest and the highest value of each curve in each span of time, and evenly between them. The picture has ${scene ? scene.times.length : 0} frames.` : "";
  $("footer").textContent = `${run.program} · ${run.rows} rows · curves by uPlot 1.6.32 (MIT)`;
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const memory = remembered();
  if (memory.speed) player.speed = memory.speed;
  if (view && memory.camera) Object.assign(view, memory.camera);
  player.time = Math.min(Math.max(memory.time ?? player.start, player.start), player.end);
  player.play((memory.playing ?? !still) && player.end > player.start);
  return { player, view };
}

/** Puts another motion in place of the one that is there. */
function change({ columns, passages, events, scene: moved }, player, scene, curves) {
  const { times: own, kinetic, potential } = { times: columns.t, ...columns };
  const energy = () => kinetic.map((x, i) => x + potential[i]);
  run.marks.forEach((mark) => {
    const times = mark.event ? events.filter(({ name }) => name === mark.name).map(({ t }) => t) : passages;
    Object.assign(mark, { times, all: times.length });
  });
  if (scene && moved) scene.take(moved);
  player.take(scene ? scene.times : own);
  curves.take(own, (name) => columns[name] ?? (name === "energy" ? energy() : new Float64Array(own.length).fill(NaN)));
  marks(player);
  $("thinned").textContent = "The curves and the picture are those of the sliders; the tables below and the command are of the run that made this page.";
  player.ask();
}

/** What the controls say. */
function show(player, t) {
  const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(Math.max(player.end - player.start, 1e-9) / 10))));
  const time = $("time");
  if (document.activeElement !== time || time.value !== String(t)) time.value = t;
  time.setAttribute("aria-valuetext", `${t.toFixed(digits)} seconds`);
  $("now").textContent = `t = ${t.toFixed(digits)} s`;
  const play = $("play");
  const name = player.playing ? "pause" : "play";
  if (play.getAttribute("aria-label") !== name) {
    play.setAttribute("aria-label", name);
    play.textContent = player.playing ? "❚❚" : "▶";
  }
  if ($("speed").value !== String(player.speed)) $("speed").value = player.speed;
  $("loop").checked = player.loop;
}

function controls(player, view) {
  const redraw = () => player.ask();
  $("time").min = player.start;
  $("time").max = Math.max(player.end, player.start + 1e-9);
  $("time").addEventListener("input", (event) => {
    player.playing = false;
    player.seek(Number(event.target.value));
  });
  for (const speed of SPEEDS) $("speed").append(element("option", { value: speed }, `${speed}×`));
  $("speed").addEventListener("change", (event) => {
    player.speed = Number(event.target.value);
  });
  const acts = {
    play: () => player.play(!player.playing),
    back: () => player.step(-1),
    ahead: () => player.step(1),
    first: () => player.seek(player.start),
    whole: () => view?.whole(),
    full: () => (document.fullscreenElement ? document.exitFullscreen() : $("view").requestFullscreen()),
  };
  for (const [id, act] of Object.entries(acts)) {
    $(id).addEventListener("click", () => {
      act();
      redraw();
    });
  }
  $("loop").addEventListener("change", (event) => (player.loop = event.target.checked));
  $("trails").addEventListener("change", (event) => {
    view.trails = event.target.checked;
    redraw();
  });
  $("theme").addEventListener("click", () => {
    theme.chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    dress();
    repaint(player, view);
  });
  SYSTEM.addEventListener("change", () => {
    dress();
    repaint(player, view);
  });
  if (view) {
    steer(view, redraw);
    new ResizeObserver(redraw).observe($("canvas"));
    if (!view.scene.shapes.some(({ kind }) => kind === "trace")) $("trails").parentElement.hidden = true;
  }
  addEventListener("beforeprint", () => {
    for (const box of document.querySelectorAll("details")) box.open = true;
    theme.printed = true;
    dress();
    repaint(player, view);
    view?.draw(player.time);
  });
  addEventListener("afterprint", () => {
    theme.printed = false;
    dress();
    repaint(player, view);
  });
  document.addEventListener("keydown", (event) => key(event, player, view, acts));
}

function repaint(player, view) {
  view?.paint();
  window.bricard.curves.redraw();
  player.ask();
}

/** The keys, unless a control has a use for them. */
function key(event, player, view, acts) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const tag = event.target.tagName;
  if (tag === "SELECT" || (event.key === " " && (tag === "BUTTON" || event.target.type === "checkbox"))) return;
  const far = event.shiftKey ? 10 : 1;
  const look = (dx, dy) => (view?.scene.spatial ? view.orbit(dx, dy) : view?.pan(-dx, -dy));
  const keys = {
    " ": acts.play,
    ArrowLeft: () => player.step(-far),
    ArrowRight: () => player.step(far),
    Home: () => player.seek(player.start),
    End: () => player.seek(player.end),
    "+": () => player.faster(1),
    "-": () => player.faster(-1),
    l: () => (player.loop = !player.loop),
    t: () => $("trails").click(),
    f: acts.full,
    0: acts.whole,
    a: () => look(-20, 0),
    d: () => look(20, 0),
    w: () => look(0, -20),
    s: () => look(0, 20),
    q: () => view?.zoomAt(1 / 1.2, view.width / 2, view.height / 2),
    e: () => view?.zoomAt(1.2, view.width / 2, view.height / 2),
  };
  const act = keys[event.key] ?? keys[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
  player.ask();
}

/** Passages and events on the line of time, and by name. */
function marks(player) {
  const length = Math.max(player.end - player.start, 1e-9);
  const few = 24;
  $("ticks").replaceChildren();
  $("marks").replaceChildren();
  for (const { name, event, times, all } of run.marks) {
    const kind = event ? "event" : "passage";
    times.forEach((t, i) => {
      const tick = element("i", { class: kind, title: name });
      tick.style.left = `${(100 * (t - player.start)) / length}%`;
      $("ticks").append(tick);
      if (i >= few) return;
      const chip = element("button", { type: "button", class: kind, "data-time": t }, `${name}, t = ${short(t, length)} s`);
      chip.addEventListener("click", () => {
        player.playing = false;
        player.seek(t);
      });
      $("marks").append(chip);
    });
    if (all > few) {
      const marked = times.length < all ? ` (of which ${times.length} are marked)` : "";
      $("marks").append(element("span", { class: "hint" }, `${name}: ${all} in all${marked}`));
    }
  }
}

/** Reads the script beside the page again and again, as long as somebody writes it. */
function live(player, view) {
  let wait = null;
  const look = () => {
    const script = element("script", { src: `${encodeURIComponent(run.live.script)}?${Date.now()}` });
    script.addEventListener("load", () => script.remove());
    script.addEventListener("error", () => script.remove());
    document.head.append(script);
  };
  window.bricardLive = (news) => {
    if (news.ended) {
      clearInterval(wait);
      return;
    }
    if (news.error) complain(news.error);
    else if (news.version !== run.live.version) {
      if (player) {
        const { turn, zoom, target } = view ?? {};
        remember({ time: player.time, playing: player.playing, speed: player.speed, camera: view && { turn, zoom, target } });
      }
      clearInterval(wait);
      location.reload();
    } else complain(run.error ?? null);
  };
  wait = setInterval(look, NEWS);
}

dress();
if (run.mechanism) {
  const { player, view } = begin();
  if (run.live) live(player, view);
} else {
  for (const part of ["main", "footer", "header"]) document.querySelector(part).hidden = true;
  complain(run.error);
  if (run.live) live(null, null);
}

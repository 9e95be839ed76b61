// What the page of a run does in a browser, against the table of the same run.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { FOLDER, at, bricard, close, csv, drawn, open, pixels, started, stop, until, write } from "./harness.mjs";

/** Bytes of a page of ten seconds. */
const LARGEST = 1_500_000;

/** A description whose words would like to be more than words. */
const HOSTILE = `/// Ends </script><script>alert("x")</script> <b>"äö'</b> & <!-- {{script}}
mechanism Hostile {
    /// length <img src=x onerror=alert(1)>
    param L: m = 1;
    param m: kg = 1;
    const g: m/s^2 = 9.81;
    /// angle </script> "quoted" 角
    coord q: rad;
    kinetic 1/2*m*L^2*der(q)^2;
    potential -m*g*L*cos(q);
    start { q = 60*deg; }
    event bottom: sin(q) crossing;
    draw line([0, 0], [L*sin(q), -L*cos(q)]);
}
`;

/** Twenty bodies in space. */
const MANY = `mechanism Many {
    param J: kg*m^2 = 1;
    coord q: rad;
    kinetic 1/2*J*der(q)^2;
    start { q = 0; der(q) = 1; }
    for i in 0..20 { draw line([i, 0, 0], [i + cos(q), sin(q), 1 + i/10]); }
    draw trace([20 + cos(q), sin(q), 3]);
}
`;

const motionless = (name, more = "") => `mechanism ${name} {
    param m: kg = 1;
    coord x: m;
    kinetic 1/2*m*der(x)^2;
    start { x = 0; der(x) = 1; }
    ${more}
}
`;

let said;

before(() => {
  said = bricard("simulate", "slider_crank", "--until", "10", "--plot", "crank.html", "--out", "crank.csv");
  bricard("simulate", "stewart_platform", "--until", "10", "--plot", "stewart.html", "--out", "stewart.csv");
});
after(close);

test("the vendored library is byte for byte what is published", () => {
  const assets = path.join(import.meta.dirname, "../../cli/page/assets/vendor");
  const published = path.join(import.meta.dirname, "node_modules/uplot");
  for (const [ours, theirs] of [["uPlot.iife.min.js", "dist/uPlot.iife.min.js"], ["uPlot.min.css", "dist/uPlot.min.css"], ["LICENSE-uPlot", "LICENSE"]]) {
    assert.ok(fs.readFileSync(path.join(assets, ours)).equals(fs.readFileSync(path.join(published, theirs))), ours);
  }
  const { version } = JSON.parse(fs.readFileSync(path.join(published, "package.json")));
  assert.match(fs.readFileSync(path.join(FOLDER, "crank.html"), "utf8"), new RegExp(`uPlot ${version.replaceAll(".", "\\.")} \\(MIT\\)`));
});

test("pages of ten seconds are small, and ready within a second", async () => {
  for (const name of ["crank.html", "stewart.html"]) {
    assert.ok(fs.statSync(path.join(FOLDER, name)).size <= LARGEST, name);
  }
  await open("crank.html").then(({ page }) => page.close());
  const { page, took } = await open("stewart.html");
  assert.ok(took <= 1000, `${took} ms`);
  await page.close();
});

test("the mechanism moves as soon as the page is open, and nothing goes wrong", async () => {
  const { page, wrong } = await open("crank.html");
  const first = await pixels(page);
  await until("pixels move", async () => (await pixels(page)) !== first, 5);
  await page.keyboard.press("Space");
  await drawn(page);
  const still = await pixels(page);
  await new Promise((done) => setTimeout(done, 200));
  assert.equal(await pixels(page), still, "it moves though it is paused");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("who asks for less motion gets none until it is wanted", async () => {
  const features = [{ name: "prefers-reduced-motion", value: "reduce" }];
  const { page } = await open("crank.html", { features });
  assert.equal(await page.evaluate(() => bricard.player.playing), false);
  await page.click("#play");
  await until("it moves", () => page.evaluate(() => bricard.player.time > 0.05), 5);
  await page.close();
});

test("scrubbing to a time shows the pose that the table has", async () => {
  const { page } = await open("crank.html");
  for (const t of [0.5, 3.21, 7.77]) {
    await page.evaluate((t) => {
      const slider = document.getElementById("time");
      slider.value = t;
      slider.dispatchEvent(new Event("input"));
    }, t);
    await drawn(page);
    const row = at(csv("crank.csv"), t);
    const frame = await page.evaluate((t) => [...bricard.scene.at(t)], row.t);
    const pose = [0, 0, 0, 0.5 * Math.cos(row.q1), 0.5 * Math.sin(row.q1), 0, row.q3, 0, 0];
    pose.forEach((x, i) => assert.ok(Math.abs(x - frame[i]) < 1e-6, `t = ${t}: ${frame} is not ${pose}`));
    // The joint between crank and rod is where the picture has the colour of joints.
    const [pixel, joint] = await page.evaluate(([x, y]) => {
      const { view } = bricard;
      const [px, py] = view.project(x, y, 0);
      const detail = window.devicePixelRatio;
      const [r, g, b] = view.pen.getImageData(Math.round(px * detail), Math.round(py * detail), 1, 1).data;
      return [`#${[r, g, b].map((c) => c.toString(16).padStart(2, "0")).join("")}`, view.ink.joint];
    }, pose.slice(3, 5));
    assert.equal(pixel, joint);
  }
  await page.close();
});

test("hovering a curve shows the value that the table has", async () => {
  const { page } = await open("crank.html");
  await stop(page, 0);
  const over = await page.$(".chart .u-over");
  const box = await over.boundingBox();
  for (const part of [0.2, 0.63]) {
    await page.mouse.move(box.x + part * box.width, box.y + 0.4 * box.height);
    await drawn(page);
    const values = await page.$$eval(".chart:nth-of-type(2) .u-value", (cells) => cells.map((cell) => Number(cell.textContent.replace(" s", "").replace("−", "-"))));
    const row = at(csv("crank.csv"), values[0]);
    assert.ok(Math.abs(row.t - values[0]) < 1e-7 && Math.abs(row.t - 10 * part) < 0.03, `t = ${values[0]}`);
    assert.ok(Math.abs(row.q1 - values[1]) < 1e-7 * Math.abs(row.q1), `${values[1]} is not ${row.q1}`);
  }
  await page.close();
});

test("singular passages are marked at their times, by name", async () => {
  const times = [...said.matchAll(/passages through singular positions\s+\d+, at t = ([\d., ]+) s/g)][0][1].split(", ").map(Number);
  const { page } = await open("crank.html");
  const chips = await page.$$eval("#marks button", (all) => all.map((chip) => [Number(chip.dataset.time), chip.textContent]));
  assert.equal(chips.length, times.length);
  chips.forEach(([t, text], i) => {
    assert.ok(Math.abs(t - times[i]) < 6e-4, `${t} is not ${times[i]}`);
    assert.match(text, /singular position/);
  });
  const places = await page.$$eval("#ticks i", (all) => all.map((tick) => Number.parseFloat(tick.style.left)));
  places.forEach((place, i) => assert.ok(Math.abs(place - 10 * times[i]) < 0.01));
  await page.click("#marks button:nth-of-type(2)");
  await drawn(page);
  assert.ok(Math.abs((await page.evaluate(() => bricard.player.time)) - times[1]) < 6e-4);
  await page.close();
});

test("keys step, jump, change the speed and the view", async () => {
  const { page, wrong } = await open("crank.html");
  const time = () => page.evaluate(() => bricard.player.time);
  await stop(page, 1);
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
    await drawn(page);
  };
  await press("ArrowRight");
  assert.ok(Math.abs((await time()) - 1.01) < 1e-9);
  await press("ArrowLeft", "ArrowLeft");
  assert.ok(Math.abs((await time()) - 0.99) < 1e-9);
  await press("End");
  assert.equal(await time(), 10);
  await press("Home");
  assert.equal(await time(), 0);
  await press("+", "+", "-");
  assert.equal(await page.evaluate(() => bricard.player.speed), 2);
  await press("l");
  assert.equal(await page.evaluate(() => bricard.player.loop), false);
  const still = await pixels(page);
  await press("e");
  assert.notEqual(await pixels(page), still, "it does not zoom");
  await press("0");
  assert.equal(await pixels(page), still, "it does not go back to the whole view");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("in space the camera goes round and zooms", async () => {
  const { page, wrong } = await open("stewart.html");
  await stop(page, 1);
  const still = await pixels(page);
  const box = await (await page.$("#canvas")).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 80, y + 20, { steps: 4 });
  await page.mouse.up();
  await drawn(page);
  const turned = await pixels(page);
  assert.notEqual(turned, still, "dragging does not turn it");
  await page.mouse.wheel({ deltaY: -300 });
  await drawn(page);
  assert.notEqual(await pixels(page), turned, "the wheel does not zoom");
  await page.click("#whole");
  await drawn(page);
  assert.equal(await pixels(page), still);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("a curve can be switched off, and charts zoom together", async () => {
  const { page } = await open("crank.html");
  await stop(page, 5);
  await page.click(".chart .u-series:nth-of-type(2) th");
  assert.equal(await page.evaluate(() => bricard.curves.charts[0].chart.series[1].show), false);
  await page.click(".tools button");
  const spans = await page.evaluate(() => bricard.curves.charts.map(({ chart }) => chart.scales.x.max - chart.scales.x.min));
  spans.forEach((span) => assert.ok(Math.abs(span - 5) < 1e-9, `${spans}`));
  await page.close();
});

test("the equations of motion are there as formulas", async () => {
  const { page, wrong } = await open("crank.html");
  const [count, names, text] = await page.evaluate(() => {
    const all = [...document.querySelectorAll("#equations math")];
    document.querySelector("#equations details").open = true;
    const spaces = new Set(all.map((math) => math.namespaceURI.split("/").pop()));
    return [all.length, [...spaces], document.querySelector("#equations details").textContent];
  });
  assert.ok(count > 10, `${count} formulas`);
  assert.deepEqual(names, ["MathML"]);
  assert.match(text, /mass matrix/);
  assert.equal(await page.$("#equations merror, #equations parsererror"), null);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("a page of one row stands still", async () => {
  bricard("simulate", "slider_crank", "--until", "0", "--plot", "still.html");
  const { page, wrong } = await open("still.html");
  await page.keyboard.press("Space");
  await drawn(page);
  assert.equal(await page.evaluate(() => bricard.player.playing), false);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("nothing that a hostile description says does anything", async () => {
  write("hostile.mech", HOSTILE);
  bricard("simulate", "hostile.mech", "--until", "2", "--plot", "hostile.html");
  const { page, wrong } = await open("hostile.html");
  const text = await page.evaluate(() => document.body.innerText);
  assert.ok(text.includes(`Ends </script><script>alert("x")</script> <b>"äö'</b> & <!-- {{script}}`));
  assert.equal(await page.evaluate(() => document.getElementById("description").textContent), HOSTILE);
  assert.equal(await page.$("#docs b, #facts img"), null);
  assert.match(await page.evaluate(() => document.getElementById("marks").textContent), /bottom, t = 0.53/);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("a million rows are thinned, say so, and keep their extremes", async () => {
  bricard("simulate", "slider_crank", "--step", "1e-5", "--until", "10", "--plot", "million.html", "--out", "million.csv");
  assert.ok(fs.statSync(path.join(FOLDER, "million.html")).size <= LARGEST);
  const { page, wrong } = await open("million.html");
  assert.match(await page.evaluate(() => document.getElementById("thinned").textContent), /^Of 1000001 rows \d+ are shown/);
  const shown = await page.evaluate(() => Object.fromEntries(bricard.run.panels.flatMap(({ series }) => series.map(({ name, values }) => [name, [...numbers(values, Float64Array)]]))));
  const extremes = new Map();
  for (const row of csv("million.csv")) {
    for (const [name, y] of Object.entries(row)) {
      const [low, high] = extremes.get(name) ?? [Infinity, -Infinity];
      extremes.set(name, [Math.min(low, y), Math.max(high, y)]);
    }
  }
  for (const name of ["q1", "q3", "der(q1)", "der(q3)"]) {
    assert.deepEqual([Math.min(...shown[name]), Math.max(...shown[name])], extremes.get(name), name);
  }
  assert.deepEqual(wrong, []);
  await page.close();
});

test("a mechanism without a picture has its curves, and says how to add one", async () => {
  write("bare.mech", motionless("Bare"));
  bricard("simulate", "bare.mech", "--until", "1", "--plot", "bare.html");
  const { page, wrong } = await open("bare.html");
  assert.match(await page.evaluate(() => document.getElementById("nothing").innerText), /draw line/);
  assert.ok((await page.$$(".chart")).length >= 3);
  await page.keyboard.press("ArrowRight");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("points that go to infinity are left out while the rest moves", async () => {
  write("far.mech", motionless("Far", "draw line([0, 0], [x, 1]);\n    param f: m = 1e300;\n    draw line([0, 0], [f/(x - 0.5), 0]);\n    draw circle([0, 0], 1e30*x);"));
  bricard("simulate", "far.mech", "--until", "1", "--plot", "far.html");
  const { page, wrong } = await open("far.html");
  await stop(page, 0);
  const first = await pixels(page);
  await stop(page, 0.9);
  assert.notEqual(await pixels(page), first);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("twenty bodies in space move with fifty frames a second", async () => {
  write("many.mech", MANY);
  bricard("simulate", "many.mech", "--until", "10", "--plot", "many.html");
  const { page } = await open("many.html");
  const frame = await page.evaluate(() => {
    const begun = performance.now();
    for (let i = 0; i < 100; i += 1) {
      bricard.view.draw(i / 10);
      // Drawing is done at the latest when the pixels are asked for.
      if (i % 10 === 9) bricard.view.pen.getImageData(0, 0, 1, 1);
    }
    return (performance.now() - begun) / 100;
  });
  assert.ok(frame <= 20, `${frame} ms a frame`);
  await page.close();
});

test("on a telephone everything fits, in the dark it is dark", async () => {
  const features = [{ name: "prefers-color-scheme", value: "dark" }];
  const { page, wrong } = await open("stewart.html", { width: 360, height: 740, features });
  const [width, ground] = await page.evaluate(() => [document.documentElement.scrollWidth, getComputedStyle(document.body).backgroundColor]);
  assert.ok(width <= 360, `${width} pixels wide`);
  assert.equal(ground, "rgb(20, 23, 27)");
  await page.click("#theme");
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("an open page follows its file, at its time, and shows what is wrong with it", async () => {
  write("live.mech", HOSTILE);
  const watch = started("watch", "live.mech", "--until", "5", "--plot", "live.html");
  try {
    await until("there is a page", () => fs.existsSync(path.join(FOLDER, "live.html.live.js")));
    const { page, wrong } = await open("live.html");
    await stop(page, 2.1);
    write("live.mech", HOSTILE.replace("param L: m = 1;", "param L: m = 1.25;"));
    await until("the page has the new length", () => page.evaluate(() => bricard.run.parameters[0].value === "1.25"));
    assert.ok(Math.abs((await page.evaluate(() => bricard.player.time)) - 2.1) < 1e-9);
    assert.equal(await page.evaluate(() => bricard.player.playing), false);
    write("live.mech", HOSTILE.replace("param L: m = 1;", "param L: m = 1 +;"));
    await until("the page says what is wrong", () => page.evaluate(() => /live\.mech:4/.test(document.getElementById("message").innerText)));
    write("live.mech", HOSTILE.replace("param L: m = 1;", "param L: m = 1.25;"));
    await until("the message goes", () => page.evaluate(() => document.getElementById("message").hidden));
    assert.deepEqual(wrong, []);
    await page.close();
  } finally {
    watch.kill("SIGINT");
  }
});

test("ticks are told apart in few digits", () => {
  const text = fs.readFileSync(path.join(import.meta.dirname, "../../cli/page/assets/text.js"), "utf8");
  const labels = new Function(`${text}; return labels;`)();
  for (const [ticks, texts] of [
    [[-0.25, 0, 0.25], "−0.25 0 0.25"],
    [[123456, 123456.5, 123457], "123456 123456.5 123457"],
    [[1234560, 1234580, 1234600], "1.23456e6 1.23458e6 1.2346e6"],
    [[-5e-7, 0, 5e-7, 1e-6], "−5e−7 0 5e−7 1e−6"],
    [[9.80999, 9.81, 9.81001], "9.80999 9.81 9.81001"],
    [[3], "3"],
  ]) {
    assert.equal(labels(ticks).join(" "), texts);
  }
});

// Sliders of a page: what they change runs anew in the page, as the command runs it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { ENVIRONMENT, FOLDER, at, bricard, close, csv, drawn, open, pixels, stop, until, write } from "./harness.mjs";

/** What a page and the command may differ by: last bits of powers and the like, which choose
 * other steps, each of them off by up to 1e-9. */
const SAME = 1e-7;

/** A pendulum with a motor, whose current is a state of the first order. */
const MOTOR = fs.readFileSync(path.join(import.meta.dirname, "../embedding/motor.mech"), "utf8");
/** A page without sliders has no room for a mechanism. */
const LARGEST = 1_500_000;

let said;

before(() => {
  write("motor.mech", MOTOR.replace("event full", "draw line([0, 0], [l*sin(angle), -l*cos(angle)]);\n    event full"));
  said = bricard("simulate", "slider_crank", "--plot", "crank.html", "--live");
  bricard("simulate", "motor.mech", "--until", "4", "--plot", "motor.html", "--live", "--start", "current=0.25");
});
after(close);

/** Opens a page, and waits for its sliders. */
async function live(name) {
  const opened = await open(name);
  await until("there are sliders", () => opened.page.evaluate(() => bricard.sliders.rows !== undefined), 20);
  return opened;
}

/** Waits until the motion is that of the sliders. */
async function settled(page) {
  await until("the run is done", () => page.evaluate(() => document.getElementById("sliders").getAttribute("aria-busy") === "false"), 20);
  await drawn(page);
}

/** Writes into the field of a quantity. */
async function enter(page, label, text) {
  const field = await page.$(`#sliders input[type=text][aria-label="${label}"]`);
  await field.click({ clickCount: 3 });
  await page.keyboard.type(text);
  await page.keyboard.press("Enter");
  await settled(page);
}

/** The curves of a page by name. */
function curves(page) {
  return page.evaluate(() => ({
    t: [...bricard.curves.times],
    ...Object.fromEntries(bricard.curves.charts.flatMap(({ panel, raw }) => panel.series.map(({ name }, i) => [name, [...raw[i]]]))),
  }));
}

/** Holds all curves of a page against a table. */
async function same(page, table, names) {
  const found = await curves(page);
  const rows = csv(table);
  assert.equal(found.t.length, rows.length);
  for (const name of ["t", ...names]) {
    rows.forEach((row, i) => {
      const near = SAME * Math.max(1, Math.abs(row[name]));
      assert.ok(Math.abs(found[name][i] - row[name]) <= near, `${name} at t = ${row.t}: ${found[name][i]} is not ${row[name]}`);
    });
  }
}

test("a page without sliders is as small as ever, and one with them has no need of anything else", async () => {
  assert.doesNotMatch(said, /no sliders/);
  bricard("simulate", "slider_crank", "--plot", "plain.html");
  assert.ok(fs.statSync(path.join(FOLDER, "plain.html")).size <= LARGEST);
  assert.doesNotMatch(fs.readFileSync(path.join(FOLDER, "plain.html"), "utf8"), /new WebAssembly/);
  const { page, wrong } = await live("crank.html");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("there is a slider with unit and documentation for each parameter and for the start", async () => {
  const { page } = await live("motor.html");
  const rows = await page.$$eval("#sliders .slider", (all) => all.map((row) => [row.querySelector("label").textContent, row.querySelector("small").textContent, row.querySelector("input[type=text]").value]));
  const of = (label) => rows.find(([text]) => text === label) ?? [];
  assert.deepEqual(of("l [m]"), ["l [m]", "its length", "0.5"]);
  assert.match(of("voltage [kg*m^2/s^3/A]")[1], /voltage of the source \(follows its law\)/);
  assert.equal(Number(of("angle [rad]")[2]), Math.PI / 9);
  assert.deepEqual(of("current [A]").slice(1), ["current of the winding", "0.25"]);
  const groups = await page.$$eval("#sliders summary", (all) => all.map((one) => one.textContent));
  assert.deepEqual(groups, ["Parameters", "Inputs", "Start", "Guesses of the start"]);
  const [low, high] = await page.$eval('#sliders input[id="parameters l"]', (slider) => [Number(slider.min), Number(slider.max)]);
  assert.deepEqual([low, high], [0, 1]);
  await page.close();
});

test("moving a slider changes pose, curves and passages to those of the command", async () => {
  const { page, wrong } = await live("crank.html");
  await stop(page, 1.5);
  const before = [await pixels(page), await curves(page), await page.$eval("#marks", (all) => all.textContent)];
  const value = await page.evaluate(() => {
    const slider = document.querySelector('#sliders input[id="parameters m3"]');
    slider.value = 0.75 * slider.max;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    return document.querySelector('#sliders input[aria-label="m3 [kg]"]').value;
  });
  await settled(page);
  bricard("simulate", "slider_crank", "--set", `m3=${value}`, "--every", "0.01", "--out", "heavy.csv", "--columns", "energy,constraint_error");
  await same(page, "heavy.csv", ["q1", "q2", "q3", "der(q1)", "der(q3)", "energy"]);
  assert.notEqual(await pixels(page), before[0], "the pose is the old one");
  assert.notDeepEqual((await curves(page)).q1, before[1].q1);
  assert.notEqual(await page.$eval("#marks", (all) => all.textContent), before[2], "the passages are the old ones");
  const row = at(csv("heavy.csv"), 1.5);
  const frame = await page.evaluate(() => [...bricard.scene.at(1.5)]);
  [0, 0, 0, 0.5 * Math.cos(row.q1), 0.5 * Math.sin(row.q1), 0, row.q3, 0, 0].forEach((x, i) => assert.ok(Math.abs(x - frame[i]) < 1e-6));
  assert.ok(Math.abs((await page.evaluate(() => bricard.player.time)) - 1.5) < 1e-9, "the time has changed");
  await page.click("#reset");
  await settled(page);
  // The picture keeps the room that it has had meanwhile; the motion is that of before.
  const after = await curves(page);
  before[1].q1.forEach((q1, i) => assert.ok(Math.abs(after.q1[i] - q1) <= SAME * Math.max(1, Math.abs(q1)), "reset does not go back"));
  assert.deepEqual(wrong, []);
  await page.close();
});

test("start, states and inputs are changed by their fields, to the motion of the command", async () => {
  const { page, wrong } = await live("motor.html");
  await enter(page, "current [A]", "-0.5");
  await enter(page, "voltage [kg*m^2/s^3/A]", "1.5");
  await enter(page, "angle [rad]", "−0.3");
  bricard("simulate", "motor.mech", "--until", "4", "--start", "current=-0.5", "--start", "angle=-0.3", "--set", "voltage=1.5", "--every", "0.004", "--columns", "energy,swing,power", "--out", "motor.csv");
  await same(page, "motor.csv", ["angle", "der(angle)", "energy", "swing", "power"]);
  // Back to its law.
  await page.click('#sliders button[aria-label="voltage as it was"]');
  await settled(page);
  bricard("simulate", "motor.mech", "--until", "4", "--start", "current=-0.5", "--start", "angle=-0.3", "--every", "0.004", "--columns", "energy,swing,power", "--out", "law.csv");
  await same(page, "law.csv", ["angle", "der(angle)", "energy", "swing", "power"]);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("what can't be run is said, and the motion of before goes on", async () => {
  const { page, wrong } = await live("crank.html");
  await stop(page, 2);
  const still = await pixels(page);
  const refused = () => page.$eval("#sliders .refused", (box) => (box.hidden ? "" : box.textContent));
  // A crank as long as this doesn't reach back to its rod.
  await enter(page, "L2 [m]", "0.1");
  assert.match(await refused(), /no position near the start satisfies the constraints: .*\nThe motion is that of before\.$/s);
  assert.equal(await pixels(page), still);
  await enter(page, "L1 [m]", "two");
  assert.match(await refused(), /"two" is no number/);
  assert.equal(await page.$eval("#sliders .slider input[type=text]", (field) => field.getAttribute("aria-invalid")), "true");
  assert.equal(await pixels(page), still);
  await page.click("#reset");
  await settled(page);
  assert.equal(await refused(), "");
  assert.equal(await page.$eval("#sliders .slider input[type=text]", (field) => field.value), "0.5");
  assert.equal(await pixels(page), still);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("sliders are moved by the keyboard, and the animation goes on meanwhile", async () => {
  const { page, wrong } = await live("motor.html");
  await page.focus('#sliders input[id="parameters m"]');
  const began = await page.evaluate(() => [bricard.player.playing, bricard.player.time]);
  assert.equal(began[0], true);
  for (let i = 0; i < 5; i += 1) await page.keyboard.press("ArrowRight");
  await settled(page);
  assert.equal(await page.$eval('#sliders input[aria-label="m [kg]"]', (field) => field.value), "1.05");
  assert.equal(await page.evaluate(() => bricard.player.playing), true, "an arrow has stopped the animation");
  bricard("simulate", "motor.mech", "--until", "4", "--start", "current=0.25", "--set", "m=1.05", "--every", "0.004", "--columns", "energy,swing,power", "--out", "keys.csv");
  await same(page, "keys.csv", ["angle", "energy"]);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "m [kg]");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("where Rust can't compile for browsers the page has no sliders, and it is said what to do", async () => {
  // A toolchain that is as it is but for this target.
  const folder = path.join(FOLDER, "bin");
  fs.mkdirSync(folder);
  const rustc = execFileSync("sh", ["-c", "command -v rustc"], { encoding: "utf8" }).trim();
  fs.writeFileSync(path.join(folder, "rustc"), `#!/bin/sh\ncase "$*" in *target-libdir*) echo /nowhere;; *) exec "${rustc}" "$@";; esac\n`, { mode: 0o755 });
  const were = process.env.PATH;
  ENVIRONMENT.PATH = `${folder}:${were}`;
  const told = bricard("simulate", "cart_pole", "--until", "1", "--plot", "cart.html", "--live");
  ENVIRONMENT.PATH = were;
  assert.match(told, /the page has no sliders: .*can't compile for wasm32-unknown-unknown/);
  assert.match(told, /rustup target add wasm32-unknown-unknown/);
  const { page, wrong } = await open("cart.html");
  assert.equal(await page.$eval("#sliders", (place) => place.hidden), true);
  assert.deepEqual(wrong, []);
  await page.close();
});

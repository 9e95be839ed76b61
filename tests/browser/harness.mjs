// What the tests share: runs of the command, tables, an open page.

import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import puppeteer from "puppeteer-core";

export const BRICARD = process.env.BRICARD;
/** Compiled descriptions are kept from one run of the tests to the next. */
const CACHE = path.join(path.dirname(BRICARD), "..", "browser-cache");
export const ENVIRONMENT = { ...process.env, XDG_CACHE_HOME: CACHE };
export const FOLDER = fs.mkdtempSync(path.join(os.tmpdir(), "bricard-page-"));

/** Runs the command in the folder of the tests; what it says on standard error. */
export function bricard(...words) {
  const log = path.join(FOLDER, "said.txt");
  const file = fs.openSync(log, "w");
  try {
    execFileSync(BRICARD, words, { cwd: FOLDER, env: ENVIRONMENT, stdio: ["ignore", "ignore", file], timeout: 300_000 });
  } catch {
    throw new Error(`bricard ${words.join(" ")}: ${fs.readFileSync(log, "utf8")}`);
  } finally {
    fs.closeSync(file);
  }
  return fs.readFileSync(log, "utf8");
}

/** Starts the command and leaves it running. */
export function started(...words) {
  return spawn(BRICARD, words, { cwd: FOLDER, env: ENVIRONMENT, stdio: "ignore" });
}

export function write(name, text) {
  fs.writeFileSync(path.join(FOLDER, name), text);
}

/** A table as rows of numbers by the names of their columns. */
export function csv(name) {
  const [header, ...lines] = fs.readFileSync(path.join(FOLDER, name), "utf8").trim().split("\n");
  const names = header.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((word, i) => [names[i], Number(word)])));
}

/** The row of a table at a time. */
export function at(rows, t) {
  return rows.reduce((a, b) => (Math.abs(a.t - t) <= Math.abs(b.t - t) ? a : b));
}

let browser;

/** Opens a page from its file. What goes wrong on it is collected. */
export async function open(name, { width = 1300, height = 900, features = [] } = {}) {
  // In a container there is no sandbox for a browser that runs as root.
  browser ??= await puppeteer.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
  const page = await browser.newPage();
  const wrong = [];
  page.on("console", (message) => ["error", "warn"].includes(message.type()) && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("dialog", (dialog) => {
    wrong.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => /^https?:/.test(request.url()) && wrong.push(`network: ${request.url()}`));
  await page.setViewport({ width, height });
  await page.emulateMediaFeatures(features);
  const begun = Date.now();
  await page.goto(`file://${path.join(FOLDER, name)}`);
  await page.waitForFunction("window.bricard !== undefined && bricard.curves.now !== undefined");
  return { page, wrong, took: Date.now() - begun };
}

export async function close() {
  await browser?.close();
  fs.rmSync(FOLDER, { recursive: true, force: true });
}

/** The pixels of the moving picture, as text that differs if one of them does. */
export function pixels(page) {
  return page.evaluate(() => document.getElementById("canvas").toDataURL());
}

/** Waits until the page has drawn what it was told. */
export function drawn(page) {
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Stops the motion at a time. */
export async function stop(page, t) {
  await page.evaluate((t) => {
    bricard.player.play(false);
    bricard.player.seek(t);
  }, t);
  await drawn(page);
}

/** Tries until something holds, for so many seconds. */
export async function until(what, holds, seconds = 120) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    try {
      if (await holds()) return;
    } catch (error) {
      // A page that is just loaded again has nothing to look at.
      if (!/context|navigation|detached|not defined|undefined/i.test(String(error))) throw error;
    }
    if (Date.now() > end) throw new Error(`in ${seconds} s it never came true that ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

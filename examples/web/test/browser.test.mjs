// The same in Chromium: equal to the last bit, and the page moves.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { native } from "./native.mjs";

const KINDS = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".wasm": "application/wasm",
};
const FOLDERS = [
  fileURLToPath(new URL(".", import.meta.resolve("bricard-engine"))),
  import.meta.dirname,
];

/** What a page is made to tell after a while (ms): the text of an element, once it has one. */
const telling = (element, delay) => `<script>
  setTimeout(function tell() {
    const text = document.querySelector("${element}").textContent;
    if (!text) return setTimeout(tell, 100);
    fetch("/told", { method: "POST", body: text });
  }, ${delay});
</script>`;

let told;
let script = "";

async function answer(request, response) {
  if (request.method === "POST") {
    const parts = [];
    for await (const part of request) parts.push(part);
    response.end();
    return told(Buffer.concat(parts).toString());
  }
  for (const folder of FOLDERS) {
    const file = join(folder, new URL(request.url, "http://localhost").pathname);
    const text = await readFile(file).catch(() => undefined);
    if (!text) continue;
    response.setHeader("content-type", KINDS[extname(file)]).write(text);
    return response.end(extname(file) === ".html" ? script : "");
  }
  response.writeHead(404).end();
}

const server = createServer(answer);
before(() => new Promise((done) => server.listen(0, "127.0.0.1", done)));
after(() => server.close());

/** What an element of a page says a while after it was loaded, or once it says something. */
async function visit(page, element, delay) {
  script = telling(element, delay);
  const address = `http://127.0.0.1:${server.address().port}/${page}`;
  const answered = new Promise((done) => (told = done));
  const browser = spawn("chromium", ["--headless", "--no-sandbox", "--disable-gpu", address]);
  const ended = new Promise((_, fail) => {
    browser.on("error", fail);
    browser.on("exit", (code) => fail(new Error(`the browser ended with ${code}`)));
    setTimeout(() => fail(new Error("the page says nothing")), 100_000).unref();
  });
  return Promise.race([answered, ended]).finally(() => {
    browser.removeAllListeners("exit");
    browser.kill();
    server.closeAllConnections();
  });
}

test("every state in the browser equals that of native code to the last bit", async () => {
  const states = JSON.parse(await visit("bits.html", "#result", 0));
  assert.deepEqual(states, native(1).map(({ states }) => states));
});

test("the engine on the page moves", async () => {
  const status = await visit("index.html", "#status", 3000);
  const [, time, speed] = /^t = ([\d.]+) s, crank at (-?[\d.]+) rad/.exec(status) ?? [];
  assert.ok(time > 0.1 && Math.abs(speed) > 0, status);
});

// A suite that the program under test wrote, and a browser that looks at its pages.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

import { chromium } from "playwright-core";

const here = dirname(fileURLToPath(import.meta.url));
const program = process.env.FOGBENCH ?? join(here, "../../target/release/fogbench");

/** Runs the scenarios of the tests into a folder of their own. */
export function written() {
  const folder = mkdtempSync(join(tmpdir(), "fogbench-pages-"));
  const output = join(folder, "out");
  const ran = spawnSync(program, ["run", join(here, "scenarios"), "-o", output], { encoding: "utf8" });
  // One scenario has a gate and a channel that fail.
  if (ran.status !== 3) throw new Error(`exit code ${ran.status}: ${ran.stderr}`);
  const again = ["run", join(here, "scenarios/swing.toml"), "-o", join(folder, "again"), "--set", "seed=77"];
  spawnSync(program, again, { encoding: "utf8" });
  const page = ["compare", output, join(folder, "again"), "--html", join(output, "compared.html")];
  const compared = spawnSync(program, page, { encoding: "utf8" });
  if (![0, 1].includes(compared.status)) throw new Error(compared.stderr);
  const text = (name) => readFileSync(join(output, name), "utf8");
  const address = (name) => pathToFileURL(join(output, name)).href;
  return { output, text, address, remove: () => rmSync(folder, { recursive: true }) };
}

/** Debian's browser. */
export function browser() {
  const executablePath =
    process.env.CHROMIUM ?? execFileSync("which", ["chromium"], { encoding: "utf8" }).trim();
  const isRoot = process.getuid?.() === 0;
  return chromium.launch({ executablePath, args: isRoot ? ["--no-sandbox"] : [] });
}

/** A page of the suite, and what it asked for and complained of. */
export async function opened(context, address) {
  const page = await context.newPage();
  const complaints = [];
  const requests = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("dialog", (dialog) => {
    complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(address);
  return { page, complaints, requests };
}

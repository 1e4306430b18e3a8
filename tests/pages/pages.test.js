// The pages as a reader meets them: with and without script, on a phone and a wide screen, on paper.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";

import { browser, opened, written } from "./suite.js";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const PAGES = ["index.html", "compared.html", "filters.html", "swing/report.html", "repeats/report.html", "sweep/0003/report.html"];
const WIDTHS = [390, 1400];

let suite;
let chromium;

before(async () => {
  suite = written();
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  suite?.remove();
});

/** Does something with a page in a context of its own. */
async function look(name, options, act) {
  const context = await chromium.newContext(options);
  try {
    await act(await opened(context, suite.address(name)));
  } finally {
    await context.close();
  }
}

test("no page complains or asks for anything but itself", async () => {
  for (const name of PAGES) {
    await look(name, {}, async ({ page, complaints, requests }) => {
      await page.waitForTimeout(100);
      assert.deepEqual(complaints, [], name);
      const asked = requests.filter((url) => !url.startsWith("data:"));
      assert.deepEqual(asked, [suite.address(name)], name);
    });
  }
});

test("what a scenario says is text", async () => {
  for (const name of ["index.html", "repeats/report.html"]) {
    await look(name, {}, async ({ page, complaints }) => {
      const words = await page.textContent("body");
      assert.ok(words.includes("<script>alert('no')</script> & gates"), name);
      assert.equal(await page.locator("script").count(), 1, name);
      assert.deepEqual(complaints, []);
    });
  }
  await look("repeats/report.html", {}, async ({ page }) => {
    assert.ok((await page.textContent("#published")).includes("the <b>paper</b>, table 2"));
  });
});

test("a click on a heading sorts, a second one turns the order", async () => {
  await look("swing/report.html", {}, async ({ page }) => {
    const heads = page.locator("#main-metrics thead th");
    const column = (await heads.allTextContents()).findIndex((text) => text.startsWith("noise std"));
    assert.ok(column > 0);
    const head = heads.nth(column);
    const values = () =>
      page.locator(`#main-metrics tbody tr td:nth-child(${column + 1})`).evaluateAll((cells) =>
        cells.map((cell) => cell.dataset.v).filter(Boolean).map(Number),
      );
    for (const [order, sign] of [["ascending", 1], ["descending", -1]]) {
      await head.getByRole("button").click();
      assert.equal(await head.getAttribute("aria-sort"), order);
      const found = await values();
      assert.ok(found.length >= 3);
      assert.deepEqual(found, [...found].sort((a, b) => sign * (a - b)));
    }
  });
});

test("a word in the field leaves the rows that hold it", async () => {
  await look("swing/report.html", {}, async ({ page }) => {
    const rows = page.locator("#all-metrics tbody tr");
    const all = await rows.count();
    const field = page.getByRole("searchbox").first();
    await field.fill("delay");
    const shown = page.locator("#all-metrics tbody tr:visible");
    const texts = await shown.allTextContents();
    assert.ok(texts.length > 0 && texts.length < all);
    assert.ok(texts.every((text) => text.toLowerCase().includes("delay")));
    await field.fill("");
    assert.equal(await shown.count(), all);
  });
  await look("index.html", {}, async ({ page }) => {
    await page.getByRole("searchbox").first().fill("swing");
    assert.deepEqual(await page.locator("#runs-table tbody tr:visible th a").allTextContents(), ["swing"]);
  });
});

test("the pointer over a picture reads its values", async () => {
  await look("swing/report.html", { viewport: { width: 1400, height: 900 } }, async ({ page }) => {
    const figure = page.locator(".picture").first();
    const svg = figure.locator("svg");
    await svg.scrollIntoViewIfNeeded();
    const { width, panels } = JSON.parse(await svg.locator("metadata").textContent());
    const box = await svg.boundingBox();
    const panel = panels[0];
    const scale = box.width / width;
    const [x, y] = [(panel.left + panel.right) / 2, (panel.top + panel.bottom) / 2];
    await page.mouse.move(box.x + x * scale, box.y + y * scale);
    const told = await figure.locator("output").textContent();
    const middle = panel.x.log ? Math.sqrt(panel.x.low * panel.x.high) : (panel.x.low + panel.x.high) / 2;
    assert.ok(told.startsWith(`${panel.x.title}: `), told);
    const value = Number(told.slice(panel.x.title.length + 2).split(" ")[0]);
    assert.ok(Math.abs(value - middle) < 0.01 * (panel.x.high - panel.x.low), `${value}, not ${middle}`);
    await page.mouse.move(0, 0);
    assert.equal(await figure.locator("output").textContent(), "");
  });
});

test("axe finds nothing serious, light on a wide screen and dark on a phone", async () => {
  for (const name of PAGES) {
    for (const [colorScheme, width] of [["light", 1400], ["dark", 390]]) {
      await look(name, { colorScheme, viewport: { width, height: 900 }, bypassCSP: true }, async ({ page }) => {
        // What is folded away is looked at as well; of a picture its name, not each of its thousand lines.
        await page.evaluate(() => {
          for (const details of document.querySelectorAll("details")) details.open = true;
          for (const svg of document.querySelectorAll(".picture svg")) svg.replaceChildren();
        });
        await page.addScriptTag({ content: axe });
        const { violations } = await page.evaluate(() => window.axe.run());
        const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
        const told = serious.map(({ id, nodes }) => `${id}: ${nodes[0].html.slice(0, 200)} ${nodes[0].failureSummary}`);
        assert.deepEqual(told, [], `${name} ${colorScheme} ${width}`);
      });
    }
  }
});

test("no page is wider than its screen", async () => {
  for (const name of PAGES) {
    for (const width of WIDTHS) {
      await look(name, { viewport: { width, height: 900 } }, async ({ page }) => {
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${name}: ${wide} pixels of ${width}`);
      });
    }
  }
});

test("a comparison fits a wide screen", async () => {
  await look("compared.html", { viewport: { width: 1400, height: 900 } }, async ({ page }) => {
    const [wide, room] = await page
      .locator(".scroll:has(#figures-table)")
      .evaluate((scroll) => [scroll.scrollWidth, scroll.clientWidth]);
    assert.ok(wide <= room, `${wide} pixels of ${room}`);
  });
});

test("the rows of a sweep are low on a phone", async () => {
  await look("index.html", { viewport: { width: 390, height: 900 } }, async ({ page }) => {
    const rows = page.locator("#points-sweep tbody tr");
    const heights = await rows.evaluateAll((all) => all.map((row) => row.getBoundingClientRect().height));
    assert.ok(heights.length > 0);
    assert.ok(Math.max(...heights) < 100, `${heights}`);
  });
});

test("everything can be read without the script", async () => {
  for (const name of PAGES) {
    const shown = {};
    for (const javaScriptEnabled of [true, false]) {
      await look(name, { javaScriptEnabled }, async ({ page }) => {
        shown[javaScriptEnabled] = await page.locator("table tbody tr").allTextContents();
        const tools = await page.locator(".tools:visible").count();
        const buttons = await page.locator("th button").count();
        assert.equal(tools > 0 && buttons > 0, javaScriptEnabled, name);
      });
    }
    assert.ok(shown[false].length > 0, name);
    assert.deepEqual(shown[false], shown[true], name);
  }
  await look("swing/report.html", { javaScriptEnabled: false }, async ({ page }) => {
    for (const heading of ["Gates", "Channels", "All metrics", "Noise budget", "Assumed values", "Files and origin"]) {
      assert.ok(await page.getByRole("heading", { name: heading, exact: true }).isVisible(), heading);
    }
    assert.ok((await page.locator(".picture svg").count()) >= 4);
  });
});

test("on paper there is no tool, and black stands on white", async () => {
  for (const name of PAGES) {
    await look(name, { colorScheme: "dark" }, async ({ page }) => {
      await page.emulateMedia({ media: "print", colorScheme: "dark" });
      assert.equal(await page.locator(".tools:visible").count(), 0, name);
      assert.equal(await page.locator("nav:visible").count(), 0, name);
      const colours = await page.evaluate(() => {
        const of = (selector, key) => getComputedStyle(document.querySelector(selector))[key];
        return [of("body", "color"), of("section", "backgroundColor")];
      });
      assert.deepEqual(colours, ["rgb(0, 0, 0)", "rgb(255, 255, 255)"], name);
      const paper = await page.pdf({ format: "A4" });
      assert.ok(paper.length > 10_000, name);
    });
  }
});

test("a link of the index leads to a page or a file of the output", async () => {
  const links = [...suite.text("index.html").matchAll(/href="([^"#][^"]*)"/g)].map(([, link]) => link);
  const own = [...new Set(links)].filter((link) => !link.startsWith("data:"));
  assert.ok(own.includes("swing/report.html") && own.includes("metrics.csv"));
  for (const link of own) assert.ok(suite.text(link).length > 0, link);
  // Of a long sweep only what failed has a page.
  const points = own.filter((link) => /^long\/\d/.test(link));
  assert.equal(points.length, 110);
  const pages = points.filter((link) => link.endsWith("report.html"));
  assert.ok(pages.length > 0 && pages.length < points.length, `${pages.length} pages`);
});

test("pages are small enough to send", () => {
  for (const name of PAGES) assert.ok(suite.text(name).length < 2_000_000, name);
});

test("a run's page shows what was set, assumed and published", async () => {
  await look("repeats/report.html", {}, async ({ page }) => {
    await page.locator("#assumed summary").click();
    const assumed = await page.locator("#assumed-table tbody th").allTextContents();
    assert.ok(assumed.some((key) => key.includes("gyro.slow_noise.bias_instability_deg_per_h")));
    assert.ok(!assumed.includes("duration_s") && !assumed.includes("repeats"));
    assert.equal(await page.locator("#gates svg.bar").count(), 3);
    assert.ok((await page.locator("#repeats-table svg.histogram").count()) > 3);
    assert.ok((await page.textContent("#notes")).includes("wrong"));
    assert.ok((await page.textContent("#origin")).match(/[0-9a-f]{64}/));
  });
});

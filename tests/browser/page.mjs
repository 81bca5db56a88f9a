// SPDX-License-Identifier: GPL-3.0-or-later
// Opens reports' pages in Chromium, one process for all, and uses each as its reader would: sorts a table, moves over
// a plan, changes the exposure, asks a surface in 3D, prints. The first page's further controls are used too:
// filter, section, walk, dark page, A3. Run as
//   node page.mjs REPORT... [--pictures FOLDER]      with CHROMIUM naming the browser where it is not /usr/bin/chromium
// FOLDER receives screenshots of each page at desktop, tablet and phone size, and the PDF.
import assert from "node:assert/strict";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { mkdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";

// From where ctest has put the packages of package-lock.json; else from beside this file.
const require = createRequire(process.env.CLERESTORY_NODE ? `${process.env.CLERESTORY_NODE}/package.json` : import.meta.url);
const { chromium } = require("playwright-core");

const reports = process.argv.slice(2);
const option = reports.indexOf("--pictures");
const folder = option >= 0 ? reports.splice(option, 2)[1] : undefined;

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
let passed = 0;

const use = async (report, isFirst) => {
  const name = path.basename(report);
  const step = async (text, work) => {
    try {
      await work();
    } catch (error) {
      console.error(`FAILED: ${name}: ${text}`);
      throw error;
    }
    ++passed;
    console.log(`passed: ${name}: ${text}`);
  };
  const address = pathToFileURL(path.resolve(report, "index.html")).href;
  const html = await readFile(path.join(report, "index.html"), "utf8");
  const pictures = folder && path.join(folder, name);
  if (pictures) await mkdir(pictures, { recursive: true });

  const page = await browser.newPage({ viewport: { width: 1100, height: 800 } });
  const complaints = [];
  const requests = [];
  page.on("console", (message) => {
    // Software rendering tells of its own slowness when a picture is read back.
    if (["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text())) {
      complaints.push(message.text());
    }
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("dialog", async (dialog) => {
    complaints.push(`a dialog: ${dialog.message()}`);
    await dialog.dismiss();
  });
  page.on("request", (request) => requests.push(request.url()));
  /** What the page has besides. */
  const useFurther = async () => {
    await step("a long table filters", async () => {
      const fields = page.locator(".filter input");
      if ((await fields.count()) === 0) return;
      await fields.first().fill("no such thing anywhere");
      const table = page.locator(".filter + .table table").first();
      assert.equal(await table.locator("tbody tr:not([hidden])").count(), 0);
      await fields.first().fill("");
      assert.ok((await table.locator("tbody tr:not([hidden])").count()) > 10);
    });

    await step("a folded table shows the first rows of its order", async () => {
      const table = page.locator("table.folded").first();
      if ((await table.count()) === 0) return;
      const head = table.locator("thead th[data-name=Mean]");
      await head.locator("button").click();
      const [shown, hidden] = await table.evaluate((element) => {
        const column = [...element.tHead.rows[0].cells].findIndex((cell) => cell.dataset.name === "Mean");
        const rows = [...element.tBodies[0].rows].filter((row) => !row.matches(".chosen")); // that one shows anywhere
        const values = (isShown) => rows.filter((row) => (row.offsetParent !== null) === isShown)
          .map((row) => parseFloat(row.cells[column].textContent.replace(/[\s\u202f]/g, "")));
        return [values(true), values(false)];
      });
      assert.ok(shown.length > 5 && hidden.length > 0);
      const isDown = (await head.getAttribute("aria-sort")) === "descending";
      assert.ok(isDown ? Math.min(...shown) >= Math.max(...hidden) : Math.max(...shown) <= Math.min(...hidden));
    });

    await step("the building in 3D turns and comes closer by keys", async () => {
      if (!html.includes('id="mesh-data"')) return;
      const canvas = page.locator("#viewer canvas");
      await canvas.scrollIntoViewIfNeeded();
      for (const key of ["ArrowLeft", "ArrowDown", "+"]) {
        const before = await canvas.screenshot();
        await canvas.press(key);
        await page.waitForTimeout(300);
        assert.notDeepEqual(await canvas.screenshot(), before, key);
      }
      await page.locator('[data-viewer="reset"]').click();
    });

    await step("the building in 3D cuts, colours and is walked through", async () => {
      if (!html.includes('id="mesh-data"')) return;
      const canvas = page.locator("#viewer canvas");
      await canvas.scrollIntoViewIfNeeded();
      const asLit = await canvas.screenshot();
      await page.locator('[data-viewer="colours"]').selectOption("illuminance");
      await page.waitForTimeout(300);
      assert.notDeepEqual(await canvas.screenshot(), asLit);
      assert.ok(await page.locator(".legend3d").isVisible());
      const whole = await canvas.screenshot();
      await page.locator('[data-viewer="section"]').fill("60");
      await page.waitForTimeout(300);
      assert.notDeepEqual(await canvas.screenshot(), whole);
      if (pictures) await canvas.screenshot({ path: path.join(pictures, "section.png") });
      await page.locator('[data-viewer="section"]').fill("200");
      await page.locator('[data-viewer="motion"]').selectOption("walk");
      await page.waitForTimeout(300);
      const standing = await canvas.screenshot();
      await canvas.press("ArrowUp", { delay: 400 });
      await page.waitForTimeout(300);
      assert.notDeepEqual(await canvas.screenshot(), standing);
      if (pictures) await canvas.screenshot({ path: path.join(pictures, "walk.png") });
      await page.locator('[data-viewer="motion"]').selectOption("orbit");
      await page.locator('[data-viewer="colours"]').selectOption("display");
    });

    await step("text stands out from its ground, light and dark (WCAG AA)", async () => {
      for (const theme of ["light", "dark"]) {
        await page.evaluate((name) => (document.documentElement.dataset.theme = name), theme);
        const least = await page.evaluate(() => {
          const style = getComputedStyle(document.documentElement);
          const luminance = (name) => {
            const hex = style.getPropertyValue(name).trim().replace(/^#(.)(.)(.)$/, "#$1$1$2$2$3$3");
            const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
              .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
            return 0.2126 * r + 0.7152 * g + 0.0722 * b;
          };
          const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
          return Math.min(...["--paper", "--tint"].flatMap((ground) =>
            ["--ink", "--soft", "--accent", "--yes", "--no"].map((ink) => contrast(luminance(ink), luminance(ground)))));
        });
        assert.ok(least >= 4.5, `${theme}: ${least}`);
      }
    });
  };

  await page.goto(address);

  await step("it says what it is", async () => {
    assert.ok((await page.locator("h1").textContent()).length > 0);
    assert.ok((await page.locator("main section").count()) > 3);
  });

  await step("a table sorts by a number, both ways", async () => {
    const table = page.locator("table").filter({ has: page.locator("caption", { hasText: "Surfaces" }) }).first();
    const column = await table.locator("thead th").evaluateAll((heads) => heads.findIndex((h) => h.dataset.name === "Mean"));
    const values = () =>
      table.locator("tbody tr").evaluateAll(
        (rows, c) => rows.map((row) => parseFloat(row.cells[c].textContent.replace(/[\s\u202f]/g, ""))), column);
    const button = table.locator("thead th").nth(column).locator("button");
    for (const order of [-1, 1]) {
      await button.click();
      const sorted = await values();
      assert.ok(sorted.length > 1);
      for (let i = 1; i < sorted.length; ++i) assert.ok(order * (sorted[i] - sorted[i - 1]) >= 0, `row ${i}`);
    }
    assert.equal(await table.locator("thead th").nth(column).getAttribute("aria-sort"), "ascending");
  });

  await step("a plan tells the sensor under the pointer and by arrow keys", async () => {
    const plan = page.locator("svg.plan").filter({ has: page.locator(".sensors rect") }).first();
    if ((await plan.count()) === 0) return;
    const sensors = plan.locator(".sensors rect");
    const middle = sensors.nth(Math.floor((await sensors.count()) / 2));
    await middle.scrollIntoViewIfNeeded();
    await middle.hover({ force: true });
    const readout = page.locator(".readout").first();
    const told = await readout.textContent();
    assert.equal(told, await middle.locator("title").textContent());
    assert.match(told, /lx/);
    await plan.focus();
    const others = new Set(); // at the grid's edge some keys lead nowhere
    for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]) {
      await page.keyboard.press(key);
      others.add(await readout.textContent());
    }
    assert.ok(others.size > 1);
    const numbers = page.locator(".switches input").first();
    await numbers.uncheck();
    assert.equal(await plan.locator(".values").isVisible(), false);
    await numbers.check();
  });

  await step("a picture's exposure changes what is seen", async () => {
    const slider = page.locator(".exposure input");
    const picture = page.locator(".views img").first();
    await picture.scrollIntoViewIfNeeded();
    const before = await picture.screenshot();
    await slider.fill("2");
    const after = await picture.screenshot();
    assert.notDeepEqual(before, after);
    assert.match(await page.locator(".exposure output").textContent(), /\+2 EV/);
    await slider.fill("0");
  });

  await step("the building in 3D tells a surface that is clicked", async () => {
    if (!html.includes('id="mesh-data"')) {
      assert.match(await page.locator("section", { has: page.locator("#model") }).textContent(), /without its 3D viewer|too many|nothing lit/);
      console.log("  (the page has no viewer and says so)");
      return;
    }
    await page.locator("#viewer[data-ready]").waitFor({ timeout: 60_000 });
    const canvas = page.locator("#viewer canvas");
    await canvas.scrollIntoViewIfNeeded();
    const drawn = new Set((await canvas.screenshot()).toString("base64").match(/.{64}/g)).size;
    assert.ok(drawn > 20, "the picture is empty");
    const box = await canvas.boundingBox();
    let told = "";
    for (const [x, y] of [[0.5, 0.5], [0.45, 0.6], [0.55, 0.45], [0.5, 0.7], [0.4, 0.5], [0.6, 0.6]]) {
      await canvas.click({ position: { x: x * box.width, y: y * box.height } });
      told = await page.locator(".picked").textContent();
      if (/lx/.test(told)) break;
    }
    assert.match(told, /Here.* lx.*Surface.*Material/s);
    const name = await page.locator("tr.chosen th").first().textContent();
    assert.ok(told.includes(name));
  });

  if (isFirst) await useFurther();

  await step("every control has a name", async () => {
    const nameless = await page.locator("button, input, select, img, svg[role=img], canvas").evaluateAll((all) =>
      all.filter((e) => !(e.getAttribute("aria-label") || e.alt || e.textContent.trim() || e.closest("label"))).length);
    assert.equal(nameless, 0);
  });

  await step("it prints to PDF", async () => {
    for (const format of isFirst ? ["A4", "A3"] : ["A4"]) {
      const pdf = await page.pdf({
        format,
        printBackground: true,
        preferCSSPageSize: true,
        path: pictures && path.join(pictures, `${format}.pdf`),
      });
      assert.ok(pdf.length > 20_000);
      assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
    }
  });

  await step("no table is wider than the paper", async () => {
    const before = page.viewportSize();
    await page.emulateMedia({ media: "print" });
    await page.setViewportSize({ width: 672, height: 900 }); // A4 between its margins
    const wide = await page.locator(".table").evaluateAll((all) =>
      all.filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.getAttribute("aria-label")));
    await page.emulateMedia({ media: null });
    await page.setViewportSize(before);
    assert.deepEqual(wide, []);
  });

  if (isFirst) {
    await step("a plan's numbers can be read on paper", async () => {
      const before = page.viewportSize();
      await page.emulateMedia({ media: "print" });
      await page.setViewportSize({ width: 672, height: 900 });
      const size_px = await page.locator("svg.plan").first().evaluate((plan) => plan.getScreenCTM().a * 10);
      await page.emulateMedia({ media: null });
      await page.setViewportSize(before);
      assert.ok(size_px * 0.75 >= 5, `${size_px * 0.75} pt`); // the smallest type of a printed drawing
    });
  }

  if (pictures) {
    for (const [shot, theme, width] of [["desktop", "light", 1440], ["tablet", "light", 820], ["dark", "dark", 1440], ["phone", "light", 390]]) {
      await page.evaluate((value) => (document.documentElement.dataset.theme = value), theme);
      await page.setViewportSize({ width, height: 1100 });
      await page.evaluate(() => window.scrollTo(0, 0));
      await page.waitForTimeout(400);
      await page.screenshot({ path: path.join(pictures, `${shot}.png`), fullPage: true });
      await page.screenshot({ path: path.join(pictures, `${shot}-first.png`) });
    }
  }

  await step("nothing was complained of, nothing left the file", async () => {
    assert.deepEqual(complaints, []);
    assert.deepEqual(requests.filter((url) => url !== address && !url.startsWith("data:") && !url.startsWith("blob:")), []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), true);
  });
  await page.close();
};

try {
  for (const [i, report] of reports.entries()) await use(report, i === 0);
} finally {
  await browser.close();
}
console.log(`${passed} passed, 0 failed`);

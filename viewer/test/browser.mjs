// A Chromium with software WebGL and an empty profile of its own, and pages in it that remember what they said and asked for.

import { chromium } from 'playwright-core';
import { mkdirSync, mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { readPng } from './picture.mjs';

/** Screenshots stay here, for whoever looks at what CI saw. */
export const screenshots = fileURLToPath(new URL('../../build-ci/pages/', import.meta.url));
mkdirSync(screenshots, { recursive: true });

const executablePath = process.env.KARCHER_CHROMIUM || '/usr/bin/chromium';
const folder = mkdtempSync(join(tmpdir(), 'karcher-pages-'));

export function start(...more) {
  return chromium.launch({ executablePath, args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-sandbox', ...more] });
}

/** Opens an HTML text or file. `page.said` are console messages and errors, `page.asked` the addresses asked for. */
export async function open(browser, html, { width = 1400, height = 900, dark = false, hash = '' } = {}) {
  const file = html.startsWith('<') ? join(folder, `page-${Math.random().toString(36).slice(2)}.html`) : html;
  if (file !== html) writeFileSync(file, html);
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? 'dark' : 'light', acceptDownloads: true });
  const page = await context.newPage();
  page.said = [];
  page.asked = [];
  page.on('console', (m) => page.said.push(`${m.type()}: ${m.text()}`));
  page.on('pageerror', (e) => page.said.push(`error: ${e.message}`));
  page.on('request', (r) => page.asked.push(r.url()));
  page.address = pathToFileURL(file).href;
  const begin = Date.now();
  await page.goto(page.address + hash);
  await page.evaluate(() => window.karcher.ready);
  page.readyAfter = (Date.now() - begin) / 1000;
  await settle(page);
  return page;
}

/** Until what was asked for is drawn. */
export async function settle(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
}

/** Pixels of an element. */
export async function look(page, selector) {
  await settle(page);
  return readPng(await page.locator(selector).screenshot());
}

/** Sets a control of the panel by its name. */
export async function set(page, name, value) {
  const control = page.locator(`[data-control="${name}"]`);
  if (typeof value === 'boolean') await control.locator('input[type=checkbox]').setChecked(value);
  else if (typeof value === 'number') {
    await control.locator('input').fill(String(value));
    await control.locator('input').press('Enter');
  } else await control.locator('select').selectOption({ label: value });
  await settle(page);
}

export async function showStep(page, index) {
  await page.locator('#step').fill(String(index));
  await settle(page);
}

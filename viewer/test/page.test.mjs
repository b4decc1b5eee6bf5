// What the page shows in a real browser, on synthetic results of every kind.

import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { look, open, screenshots, set, settle, showStep, start } from './browser.mjs';
import { pages } from './pages.mjs';
import { difference, drawn, part, readPng } from './picture.mjs';

const stage = '#stage', legend = '#legend';
/** A pixel of the picture inside its rounded frame. */
const inner = 12;
let browser;
before(async () => (browser = await start()));
after(() => browser.close());

function assertQuiet(page) {
  assert.deepEqual(page.said, []);
  assert.deepEqual(page.asked.filter((url) => !url.startsWith('data:') && !url.startsWith('blob:')), [page.address]);
}

async function inside(page, work) {
  try {
    await work(page);
    assertQuiet(page);
  } finally {
    await page.context().close();
  }
}

describe('every kind of shape is drawn, light and dark, wide and narrow, without a word or a request', () => {
  for (const name of ['moebius', 'solid', 'curve', 'sphereMap', 'spd']) {
    for (const [width, height] of [[1400, 900], [420, 900]]) {
      for (const dark of [false, true]) {
        test(`${name}, ${width} pixels, ${dark ? 'dark' : 'light'}`, async () => {
          await inside(await open(browser, pages[name](), { width, height, dark }), async (page) => {
            await page.screenshot({ path: join(screenshots, `${name}-${width}-${dark ? 'dark' : 'light'}.png`), fullPage: true });
            const seen = drawn(await look(page, stage), inner);
            assert.ok(seen > (name === 'curve' ? 0.02 : 0.15) && seen < 0.85, `${seen} of the picture is drawn`);
            const ground = (await look(page, stage)).pixel(inner, inner);
            assert.equal(ground[0] < 64, dark);
            const sizes = await page.evaluate(() => ({ inner: document.documentElement.clientWidth, scroll: document.documentElement.scrollWidth }));
            assert.ok(sizes.scroll <= sizes.inner, `the page is ${sizes.scroll} pixels wide in a window of ${sizes.inner}`);
            const box = (selector) => page.locator(selector).boundingBox();
            const picture = await box(stage);
            for (const other of ['#diagrams', '#controls', '#legend', '#player', '#details', 'header']) {
              const b = await box(other);
              if (!b || b.width === 0 || b.height === 0) continue;
              const apart = b.x >= picture.x + picture.width || b.x + b.width <= picture.x || b.y >= picture.y + picture.height || b.y + b.height <= picture.y;
              assert.ok(apart, `${other} lies over the picture`);
            }
          });
        });
      }
    }
  }
});

test('the colours of the surface are those of the colour map', async () => {
  await inside(await open(browser, pages.moebius(), { hash: '#edges=0' }), async (page) => {
    const picture = await look(page, stage);
    assert.ok(part(picture, (r, g, b) => r > 150 && g > 150 && b < 90) > 0.01, 'yellow, the top of viridis');
    assert.ok(part(picture, (r, g, b) => r < 90 && g < 40 && b > 40 && b > g + 30) > 0.01, 'purple, its bottom');
    assert.ok(part(picture, (r, g, b) => g > r + 40 && g > b && b > 60) > 0.01, 'green, its middle');
  });
});

describe('every control changes what it is meant to change', () => {
  // Name, value, least part of the picture's pixels that must change, whether the legend changes, what is done before.
  const list = [
    ['field', 'bending part', 0.02, true],
    ['field', 'displacement', 0.02, true],
    ['field', 'none', 0.1, true],
    ['map', 'cividis', 0.05, true],
    ['map', 'red-blue', 0.05, true],
    ['range', 'this step', 0.02, true, (page) => showStep(page, 2)],
    ['logarithmic', true, 0.02, true],
    ['smooth', true, 0.005, false],
    ['surface', false, 0.1, false],
    ['edges', false, 0.003, false],
    ['opacity', 0.3, 0.05, false],
    ['axes', false, 0.0001, false],
    ['glyphs', 'directors of Q', 0.02, true],
    ['glyphSize', 2, 0.02, false, (page) => set(page, 'glyphs', 'directors of Q')],
    ['glyphDensity', 60, 0.01, false, (page) => set(page, 'glyphs', 'directors of Q')],
    ['scale', 0, 0.02, false],
    ['scale', 1.8, 0.02, false],
    ['clip', 'across x', 0.05, false],
    ['clipAt', 0.2, 0.02, false, (page) => set(page, 'clip', 'across x')],
    ['clipFlip', true, 0.05, false, (page) => set(page, 'clip', 'across y')],
  ];
  for (const [name, value, least, inLegend, prepare] of list) {
    test(`${name}: ${value}`, async () => {
      await inside(await open(browser, pages.moebius()), async (page) => {
        if (prepare) await prepare(page);
        const before = await look(page, stage), key = await look(page, legend);
        await set(page, name, value);
        const changed = difference(before, await look(page, stage));
        assert.ok(changed > least, `${changed} of the picture changed`);
        assert.equal(difference(key, await look(page, legend)) > 0, inLegend, 'the legend');
      });
    });
  }

  test('capping outliers spreads the colours of the others, and the legend says so', async () => {
    await inside(await open(browser, pages.peak()), async (page) => {
      const capped = await look(page, stage), key = await look(page, legend);
      await set(page, 'clipOutliers', false);
      const whole = await look(page, stage);
      assert.ok(difference(capped, whole) > 0.05);
      assert.ok(difference(key, await look(page, legend)) > 0);
    });
  });

  test('dragging turns, the wheel zooms, the right button moves, and the whole shape comes back', async () => {
    await inside(await open(browser, pages.moebius()), async (page) => {
      const box = await page.locator(stage).boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2;
      const first = await look(page, stage);
      const drag = async (button) => {
        await page.mouse.move(x, y);
        await page.mouse.down({ button });
        await page.mouse.move(x + 130, y + 60, { steps: 4 });
        await page.mouse.up({ button });
      };
      await drag('left');
      const turned = await look(page, stage);
      assert.ok(difference(first, turned) > 0.05, 'turned');
      await page.mouse.move(x, y);
      await page.mouse.wheel(0, 400);
      await settle(page);
      const zoomed = await look(page, stage);
      assert.ok(drawn(zoomed, inner) < 0.9 * drawn(turned, inner), 'zoomed out');
      await drag('right');
      assert.ok(difference(zoomed, await look(page, stage)) > 0.05, 'moved');
      await page.locator('[data-control=fit] button').click();
      assert.ok(difference(first, await look(page, stage)) < 0.01, 'the first view again');
    });
  });

  test('the slider shows the load steps, in the picture, the diagrams and the table', async () => {
    await inside(await open(browser, pages.moebius()), async (page) => {
      const last = await look(page, stage), energy = await look(page, '#diagram-energy');
      assert.equal(await page.locator('#step-text').textContent(), 'step 4, t = 1');
      await showStep(page, 1);
      assert.equal(await page.locator('#step-text').textContent(), 'step 1, t = 0.25');
      assert.ok(difference(last, await look(page, stage)) > 0.02);
      assert.ok(difference(energy, await look(page, '#diagram-energy')) > 0.001);
      assert.equal(await page.locator('tr.shown').getAttribute('data-step'), '1');
      await showStep(page, 0);
      assert.equal(await page.locator('#step-text').textContent(), 'start');
      await page.locator('tr[data-step="3"]').click();
      assert.equal(await page.locator('#step').inputValue(), '3');
      const plot = page.locator('#diagram-energy .u-over'), size = await plot.boundingBox();
      await plot.click({ position: { x: size.width * 0.36, y: size.height / 2 } });
      assert.equal(await page.locator('#step').inputValue(), '2');
    });
  });

  test('play goes through the load steps and stops when asked', async () => {
    await inside(await open(browser, pages.moebius()), async (page) => {
      await page.locator('#play').click();
      const seen = new Set();
      for (let i = 0; i < 60 && seen.size < 4; ++i) {
        seen.add(await page.locator('#step').inputValue());
        await page.waitForTimeout(60);
      }
      assert.ok(seen.size >= 4, `${[...seen]}`);
      await page.locator('#play').click();
      const still = await page.locator('#step').inputValue();
      await page.waitForTimeout(1200);
      assert.equal(await page.locator('#step').inputValue(), still);
    });
  });

  test('the theme button turns page, picture and diagrams dark and light again', async () => {
    await inside(await open(browser, pages.moebius()), async (page) => {
      const light = await look(page, 'body');
      await page.locator('#theme').click();
      const dark = await look(page, 'body');
      assert.ok(part(light, (r, g, b) => r + g + b > 600) > 0.5 && part(dark, (r, g, b) => r + g + b < 200) > 0.5);
      await page.locator('#theme').click();
      assert.ok(difference(light, await look(page, 'body')) < 0.001);
    });
  });

  test('a saved picture is the picture with its legend, at twice the size', async () => {
    await inside(await open(browser, pages.moebius()), async (page) => {
      const download = page.waitForEvent('download');
      await page.locator('[data-control=save] button').click();
      const file = await (await download).path();
      assert.equal((await download).suggestedFilename(), 'moebius-strip-under-its-own-weight.png');
      const png = readPng(readFileSync(file));
      assert.ok(png.width >= 1400 && png.height >= 1000);
      assert.ok(drawn(png) > 0.15);
    });
  });
});

test('accepted and rejected steps are told apart, and every diagram shows something', async () => {
  await inside(await open(browser, pages.moebius()), async (page) => {
    for (const id of ['energy', 'probes', 'gradient', 'steps', 'inertia', 'phases']) {
      const picture = await look(page, `#diagram-${id}`);
      assert.ok(drawn(picture) > 0.01, id);
    }
    const steps = await look(page, '#diagram-steps .u-wrap');
    assert.ok(part(steps, (r, g, b) => r > 150 && g < 110 && b < 110) > 0.0002, 'rejected, red');
    assert.ok(part(steps, (r, g, b) => g > r + 30 && g > b + 30) > 0.0002, 'accepted, green');
    const words = await page.locator('#diagrams').textContent();
    for (const word of ['accepted', 'rejected', 'cosserat-shell', 'tip x', 'factorisation 1.90 s']) assert.ok(words.includes(word), word);
  });
});

test('what was reached, the facts, the resolved problem and the licences are there', async () => {
  await inside(await open(browser, pages.moebius()), async (page) => {
    assert.match(await page.locator('#result').textContent(), /strict local minimum/);
    assert.equal(await page.locator('#status').textContent(), 'converged');
    const details = await page.locator('#details').textContent();
    for (const words of ['8 cores, Linux', '0.1.0', '6528', 'generate = "moebius"']) assert.ok(details.includes(words), words);
    const licences = await page.locator('#licences').textContent();
    for (const name of ['three', 'uplot', 'lil-gui', 'd3-scale-chromatic', 'd3-interpolate', 'd3-color']) assert.ok(licences.includes(`${name} `), name);
    assert.ok(licences.includes('Permission is hereby granted') && licences.includes('Permission to use, copy, modify'));
  });
});

test('a title with markup and quotes is a title; values that are not numbers are grey, and noted', async () => {
  await inside(await open(browser, pages.nasty(), { hash: '#edges=0' }), async (page) => {
    assert.equal(await page.locator('h1').textContent(), 'A "quoted" title </script><b>&amp; \'more\'');
    assert.equal(await page.title(), 'A "quoted" title </script><b>&amp; \'more\'');
    assert.match(await page.locator('#shown-note').textContent(), /values of this field are not numbers; the places are shown in grey/);
    const grey = (picture) => part(picture, (r, g, b) => r > 110 && r < 200 && Math.abs(r - g) < 6 && Math.abs(g - b) < 6);
    assert.ok(grey(await look(page, stage)) > 0.01);
    await set(page, 'field', 'displacement');
    assert.equal(await page.locator('#shown-note').textContent(), '');
    assert.ok(grey(await look(page, stage)) < 0.002);
  });
});

test('a run that failed before its first state shows what is known', async () => {
  await inside(await open(browser, pages.failed()), async (page) => {
    assert.match(await page.locator('#result').textContent(), /first load step failed/);
    assert.match(await page.locator('#no-picture').textContent(), /No state was stored/);
    assert.ok(await page.locator('#diagram-phases').isVisible());
    assert.ok(!(await page.locator(stage).isVisible()));
  });
});

test('without WebGL there is a sentence, and the diagrams', async () => {
  const poor = await start('--disable-3d-apis');
  try {
    await inside(await open(poor, pages.moebius()), async (page) => {
      await page.screenshot({ path: join(screenshots, 'no-webgl.png'), fullPage: true });
      assert.match(await page.locator('#no-picture').textContent(), /offers no WebGL/);
      assert.ok(await page.locator('#no-picture').isVisible());
      assert.ok(drawn(await look(page, '#diagram-energy')) > 0.01);
      await assert.rejects(page.evaluate(() => window.karcher.picture(400, 300)), /offers no WebGL/);
    });
  } finally {
    await poor.close();
  }
});

test('the address sets direction, field, step and theme, and a wrong wish is refused by name', async () => {
  const html = pages.moebius();
  const picture = async (hash) => {
    const page = await open(browser, html, { hash });
    try {
      return readPng(Buffer.from(await page.evaluate(() => window.karcher.picture(800, 500)), 'base64'));
    } finally {
      await page.context().close();
    }
  };
  const plain = await picture('#picture');
  assert.deepEqual([plain.width, plain.height], [800, 500]);
  for (const hash of ['#picture&view=0,0,1', '#picture&field=displacement', '#picture&step=1', '#picture&theme=dark', '#picture&edges=0'])
    assert.ok(difference(plain, await picture(hash)) > 0.003, hash);
  await assert.rejects(picture('#picture&field=nonsense'), /There is no field "nonsense"; there are: energy, membrane, bending, displacement/);
  await assert.rejects(picture('#picture&step=9'), /Load step 9 is not in this page; it has 0, 1/);
});

test('20 000 triangles, 10 load steps and 3 fields: at most 4 MB, ready in at most 3 s', async () => {
  const html = pages.large();
  assert.ok(html.length <= 4 << 20, `${html.length} bytes`);
  let best = Infinity;
  for (let k = 0; k < 3 && best > 1; ++k) {
    const page = await open(browser, html);
    best = Math.min(best, page.readyAfter);
    const shape = await page.evaluate(() => document.getElementById('karcher-data').textContent.length);
    assert.ok(shape > 100000);
    assertQuiet(page);
    await page.context().close();
  }
  assert.ok(best <= 3, `ready after ${best} s`);
});

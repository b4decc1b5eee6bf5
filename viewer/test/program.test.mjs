// Pages that the program itself makes: run, look, `karcher view --png`. The program is ../build/karcher, or $KARCHER.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { look, open, screenshots, showStep, start } from './browser.mjs';
import { difference, drawn, part, readPng } from './picture.mjs';

const program = process.env.KARCHER || fileURLToPath(new URL('../../build/karcher', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'karcher-runs-'));
let browser;
before(async () => {
  assert.ok(existsSync(program), `${program} is not there; \`make build\` makes it`);
  browser = await start();
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

function karcher(...words) {
  const { status, stdout, stderr } = spawnSync(program, words, { encoding: 'utf8', cwd: folder });
  return { status, text: stdout + stderr };
}

/** Solves a problem; the page is <name>/report.html. */
function solve(name, problem, status = 0) {
  writeFileSync(join(folder, `${name}.toml`), problem);
  const ran = karcher('run', `${name}.toml`, '--output', name, '--quiet');
  assert.equal(ran.status, status, ran.text);
  return join(folder, name, 'report.html');
}

/** Opens a page of the program, and looks: something is drawn, nothing is said or asked for. */
async function inside(file, work, options) {
  const page = await open(browser, file, options);
  try {
    const seen = drawn(await look(page, '#stage'), 12);
    assert.ok(seen > 0.02 && seen < 0.9, `${seen} of the picture is drawn`);
    await work(page);
    assert.deepEqual(page.said, []);
    assert.deepEqual(page.asked.filter((url) => !url.startsWith('data:') && !url.startsWith('blob:')), [page.address]);
  } finally {
    await page.context().close();
  }
}

const strip = (more = '') => `
title = "A strip </script> with \\"quotes\\""
[mesh]
generate = "moebius"
cells = [24, 3]
shape = "quadrilateral"
order = 2
[regions.support]
dim = 2
where = "x < -0.8"
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 2
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.05
young = 1e6
poisson = 0.3
mu_c = 4e5
L_c = 0.01
[[loads]]
type = "volume"
field = "m"
value = [0, 0, "-100*t"]
[[dirichlet]]
field = "m"
on = "support"
value = "initial"
[[dirichlet]]
field = "Q"
on = "support"
value = "initial"
[continuation]
steps = 3
[[probes]]
name = "rim"
field = "m"
at = [1.0, 0.0, 0.0]
quantity = "displacement"
${more}`;

const map = (manifold, initial, mesh = 'generate = "rectangle"\nlower = [-1, -1]\nsize = [2, 2]\ncells = [8, 8]') => `
title = "A map into ${manifold}"
[mesh]
${mesh}
[fields.u]
manifold = "${manifold}"
order = 1
interpolation = "geodesic"
initial = ${initial}
[[energies]]
type = "harmonic"
field = "u"
[[dirichlet]]
field = "u"
on = "boundary"
value = "initial"
`;

test('a shell: load steps, parts of the energy, director angles, diagrams, and a picture by karcher view', async () => {
  const file = solve('strip', strip());
  await inside(file, async (page) => {
    await page.screenshot({ path: join(screenshots, 'program-strip.png'), fullPage: true });
    assert.equal(await page.locator('h1').textContent(), 'A strip </script> with "quotes"');
    assert.match(await page.locator('#result').textContent(), /local minimum/);
    const fields = await page.locator('[data-control=field] select').locator('option').allTextContents();
    for (const name of ['energy density', 'membrane energy density', 'bending energy density', 'curvature energy density', 'displacement'])
      assert.ok(fields.includes(name), `${name} in ${fields}`);
    assert.ok(fields.some((name) => name.startsWith('angle of the director')));
    assert.equal(await page.locator('tr[data-step]').count(), 3);
    const last = await look(page, '#stage');
    await showStep(page, 0);
    assert.ok(difference(last, await look(page, '#stage')) > 0.01);
    for (const id of ['energy', 'probes', 'gradient', 'steps', 'inertia', 'phases']) assert.ok(await page.locator(`#diagram-${id}`).isVisible(), id);
    assert.match(await page.locator('#problem pre').textContent(), /generate = "moebius"/);
  });
  const shot = (name, ...words) => {
    const made = karcher('view', 'strip', '--png', name, '--width', '700', '--height', '500', ...words);
    assert.equal(made.status, 0, made.text);
    return readPng(readFileSync(join(folder, name)));
  };
  const plain = shot('a.png');
  assert.deepEqual([plain.width, plain.height], [700, 500]);
  assert.ok(drawn(plain) > 0.1);
  assert.ok(difference(plain, shot('b.png', '--view', '0,0,1', '--field', 'displacement', '--step', '1')) > 0.1);
  const wrong = karcher('view', 'strip', '--png', 'c.png', '--field', 'enregy');
  assert.equal(wrong.status, 2);
  assert.match(wrong.text, /There is no field "enregy"/);
  assert.ok(!existsSync(join(folder, 'c.png')));
});

test('the page is made again from the stored results', async () => {
  const file = solve('again', strip());
  const kept = join(folder, 'kept.html');
  copyFileSync(file, kept);
  rmSync(file);
  assert.equal(karcher('view', 'again').status, 0);
  assert.ok(statSync(file).size > 0.9 * statSync(kept).size);
  const pictures = [];
  for (const name of [kept, file]) await inside(name, async (page) => pictures.push(await look(page, '#stage')));
  assert.equal(difference(...pictures), 0);
});

test('a run that did not converge has a page that says so', async () => {
  const file = solve('short', strip('[solver]\nmax_iterations = 1\n'), 1);
  await inside(file, async (page) => {
    assert.equal(await page.locator('#status').textContent(), 'not converged');
    assert.ok((await page.locator('#result').textContent()).length > 20);
  });
});

test('maps into spheres, rotations, positive matrices and numbers are drawn as what they are', async () => {
  const coloured = (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) > 60;
  const cases = [
    ['S2', '["x", "y", "1"]', 'arrows u', 0.1],
    ['SO3', '["x", "y", "0.5*x*y"]', 'directors of u', 0.01],
    ['SPD3', '["exp(x)", "0", "0", "0", "exp(-y)", "0", "0", "0", "1"]', 'ellipsoids u', 0.01],
    ['R1', '["sin(x)*y"]', '', 0.1],
  ];
  for (const [manifold, initial, , least] of cases) {
    const file = solve(manifold, map(manifold, initial));
    await inside(file, async (page) => {
      await page.screenshot({ path: join(screenshots, `program-${manifold}.png`) });
      assert.ok(part(await look(page, '#stage'), coloured) > least, manifold);
    });
  }
});

test('solids show their boundary, curves on the sphere the sphere', async () => {
  const box = solve('box', map('S2', '["x", "y", "z + 2"]', 'generate = "box"\nlower = [-1, -1, -1]\nsize = [2, 2, 2]\ncells = [3, 3, 3]'));
  await inside(box, (page) => page.screenshot({ path: join(screenshots, 'program-box.png') }));
  const curve = solve('curve', map('S2', '["cos(3*x)", "sin(3*x)", "sin(6*x)"]', 'generate = "interval"\ncells = [20]'));
  await inside(curve, async (page) => {
    await page.screenshot({ path: join(screenshots, 'program-curve.png') });
    const round = part(await look(page, '#stage'), (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) < 25 && r > 90 && r < 240);
    assert.ok(round > 0.1, `${round} of the picture is the sphere`);
  });
});

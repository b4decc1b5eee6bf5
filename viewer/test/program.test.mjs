// Pages that the program itself makes: run, look, `karcher view --png`. The program is ../build/karcher, or $KARCHER.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { spawn, spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { look, open, screenshots, set, showStep, start } from './browser.mjs';
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
function solve(name, problem, status = 0, words = []) {
  writeFileSync(join(folder, `${name}.toml`), problem);
  const ran = karcher('run', `${name}.toml`, '--output', name, '--quiet', ...words);
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

test('a solid that is cut open shows its cells and their values, and what is beyond the cut is gone', async () => {
  const file = solve('solid', map('R1', '["x"]', 'generate = "box"\nlower = [-1, -1, -1]\nsize = [2, 2, 2]\ncells = [6, 6, 6]\nshape = "hexahedron"'));
  const purple = (r, g, b) => r < 110 && g < 50 && b > r;
  await inside(
    file,
    async (page) => {
      // u = x, seen along the x axis from its positive end: yellow, and behind it, at the cut, the colour of the middle, not the purple of the far wall.
      const whole = await look(page, '#stage');
      assert.ok(part(whole, (r, g, b) => r > 150 && g > 150 && b < 100) > 0.2, 'yellow');
      await set(page, 'clip', 'across x');
      const cut = await look(page, '#stage');
      await page.screenshot({ path: join(screenshots, 'program-solid-cut.png') });
      const middle = part(cut, (r, g, b) => g > 80 && b > 80 && r < 80);
      assert.ok(middle > 0.2, `${middle} of the picture has the colour of the middle`);
      assert.ok(part(cut, purple) < 0.01);
      await set(page, 'clipAt', 0.02);
      assert.ok(drawn(await look(page, '#stage'), 12) < 0.02, 'all is cut away');
      await set(page, 'clip', 'none');
      assert.equal(difference(whole, await look(page, '#stage')), 0);
      await set(page, 'clip', 'across z');
      await set(page, 'clipAt', 0.5);
      assert.ok(drawn(await look(page, '#stage'), 12) < 0.7 * drawn(whole, 12), 'the upper half is gone');
    },
    { hash: '#view=1,0,0&edges=0' },
  );
});

test('maps into the plane and the line have components as colours', async () => {
  const plane = solve('plane', map('R2', '["x*x - y*y", "2*x*y"]'));
  await inside(plane, async (page) => {
    const first = await look(page, '#stage');
    await set(page, 'field', 'u, component 2');
    assert.ok(difference(first, await look(page, '#stage')) > 0.1);
  });
});

test('a curve on the sphere leaves a trail of its earlier states', async () => {
  const arc = (at) => `["sin(${at})*cos(6.2831853*x)", "sin(${at})*sin(6.2831853*x)", "cos(${at})"]`;
  const file = solve('trail', `
title = "Circles"
[mesh]
generate = "interval"
cells = [24]
[fields.u]
manifold = "S2"
order = 2
initial = ${arc('1.4')}
[[energies]]
type = "l2-distance"
field = "u"
weight = 1
target = ${arc('1.4-0.8*t')}
[continuation]
steps = 6
`);
  await inside(file, async (page) => {
    await page.screenshot({ path: join(screenshots, 'program-trail.png') });
    const trail = await look(page, '#stage');
    await set(page, 'trail', false);
    const without = await look(page, '#stage');
    assert.ok(difference(trail, without) > 0.002);
    await showStep(page, 0);
    await set(page, 'trail', true);
    const start = await look(page, '#stage');
    await set(page, 'trail', false);
    assert.equal(difference(start, await look(page, '#stage')), 0, 'nothing came before the start');
  });
});

test('on two ranks the page tells so, and shows the same', async () => {
  const one = solve('one', strip()), two = solve('two', strip(), 0, ['-n', '2']);
  const pictures = [];
  for (const [file, ranks] of [[one, '1'], [two, '2']])
    await inside(file, async (page) => {
      pictures.push(await look(page, '#stage'));
      const facts = await page.locator('.facts div').allTextContents();
      assert.ok(facts.includes(`ranks${ranks}`), `${facts}`);
      assert.match(await page.locator('#result').textContent(), /local minimum/);
    });
  assert.ok(difference(...pictures) < 0.001);
});

test('a run whose second load step fails has a page that says what failed', async () => {
  // A single geodesic from the pole: half way round, the mean of its ends is not unique.
  const file = solve('fails', `
[mesh]
generate = "interval"
cells = [1]
[fields.u]
manifold = "S2"
interpolation = "geodesic"
[[energies]]
type = "harmonic"
field = "u"
[[dirichlet]]
field = "u"
on = "left"
value = [0, 0, 1]
[[dirichlet]]
field = "u"
on = "right"
value = ["sin(pi*t)", 0, "cos(pi*t)"]
[continuation]
steps = 2
`, 1);
  await inside(file, async (page) => {
    await page.screenshot({ path: join(screenshots, 'program-failed.png'), fullPage: true });
    assert.equal(await page.locator('#status').textContent(), 'failed');
    const result = await page.locator('#result').textContent();
    assert.match(result, /not defined/);
    assert.equal(await page.locator('tr[data-step]').count(), 2);
    assert.match(await page.locator('tr[data-step="2"]').textContent(), /failed/);
  });
});

test('a run that was interrupted shows the finished load steps', async () => {
  writeFileSync(join(folder, 'long.toml'), strip().replace('steps = 3', 'steps = 400'));
  const running = spawn(program, ['run', 'long.toml', '--output', 'long', '--quiet'], { cwd: folder, stdio: 'ignore' });
  const ended = new Promise((done) => running.on('exit', done));
  const rows = () => {
    try {
      return JSON.parse(readFileSync(join(folder, 'long', 'summary.json'))).load_steps.length;
    } catch {
      return 0;
    }
  };
  for (let k = 0; k < 1200 && rows() < 2; ++k) await new Promise((wake) => setTimeout(wake, 50));
  running.kill('SIGINT');
  assert.equal(await ended, 130);
  await inside(join(folder, 'long', 'report.html'), async (page) => {
    await page.screenshot({ path: join(screenshots, 'program-interrupted.png'), fullPage: true });
    assert.equal(await page.locator('#status').textContent(), 'interrupted');
    assert.match(await page.locator('#result').textContent(), /interrupt/i);
    assert.ok((await page.locator('tr[data-step]').count()) >= 2);
    assert.ok(Number(await page.locator('#step').getAttribute('max')) >= 2);
  });
});

test('the page of the Klein bottle: ready in 3 s, light and dark; writing it takes at most a twentieth of the run', async () => {
  const problem = fileURLToPath(new URL('../../examples/klein-bottle/problem.toml', import.meta.url));
  const ran = karcher('run', problem, '--output', 'klein', '--quiet');
  assert.equal(ran.status, 0, ran.text);
  const total = JSON.parse(readFileSync(join(folder, 'klein', 'summary.json'))).seconds.total;
  let written = Infinity;
  for (let k = 0; k < 3; ++k) {
    const begin = performance.now();
    assert.equal(karcher('view', 'klein').status, 0);
    written = Math.min(written, (performance.now() - begin) / 1000);
  }
  console.log(`Klein bottle: run ${total.toFixed(2)} s, page ${written.toFixed(3)} s (${((100 * written) / total).toFixed(1)} %)`);
  assert.ok(written <= 0.05 * total, `${written} s of ${total} s`);
  const file = join(folder, 'klein', 'report.html');
  assert.ok(statSync(file).size <= 4 << 20);
  let ready = Infinity;
  for (const dark of [false, true])
    await inside(file, async (page) => {
      ready = Math.min(ready, page.readyAfter);
      await page.screenshot({ path: join(screenshots, `klein-bottle-${dark ? 'dark' : 'light'}.png`), fullPage: true });
      assert.match(await page.locator('#result').textContent(), /local minimum/);
    }, { dark });
  assert.ok(ready <= 3, `ready after ${ready} s`);
});

// Builds dist/page.html: page.html with style, script and licence texts in it. `--check` compares with the committed file byte for byte.

import { build } from 'esbuild';
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const source = (name) => readFileSync(join(here, name), 'utf8');

const result = await build({
  absWorkingDir: here,
  entryPoints: ['src/main.ts'],
  bundle: true,
  write: false,
  minify: true,
  format: 'iife',
  target: 'es2022',
  legalComments: 'none',
  charset: 'ascii',
  metafile: true,
});
const script = result.outputFiles[0].text.trim();
if (/<\/script/i.test(script) || /<!--/.test(script)) throw new Error('The bundle holds text that would end the script element of the page.');
if (script.includes('@KARCHER_')) throw new Error('The bundle holds one of the marks that the library fills in.');

/** Packages of which something is in the bundle, with version and licence text. */
const used = Object.entries(Object.values(result.metafile.outputs)[0].inputs)
  .filter(([, input]) => input.bytesInOutput > 0)
  .map(([path]) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1])
  .filter(Boolean);
used.push('uplot');
const licences = [...new Set(used)].sort().map((name) => {
  const folder = join(here, 'node_modules', name);
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`The package ${name} has no licence file.`);
  const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  return `${name} ${version}\n\n${readFileSync(join(folder, file), 'utf8').replace(/\r/g, '').trim()}`;
});

const style = [source('node_modules/uplot/dist/uPlot.min.css'), source('src/style.css')].join('\n');
const small = (await build({ absWorkingDir: here, stdin: { contents: style, loader: 'css' }, write: false, minify: true, legalComments: 'none' })).outputFiles[0].text.trim();
const escape = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');

/** A replacement function: no pattern of String.replace is read in the replacing text. */
const fill = (page, mark, text) => {
  if (page.split(mark).length !== 2) throw new Error(`page.html must hold ${mark} once.`);
  return page.replace(mark, () => text);
};
let page = source('src/page.html');
page = fill(page, '/*STYLE*/', small);
page = fill(page, '<!--LICENCES-->', escape(licences.join(`\n\n${'-'.repeat(80)}\n\n`)));
page = fill(page, '/*SCRIPT*/', script);

const target = join(here, 'dist', 'page.html');
if (process.argv.includes('--check')) {
  if (!existsSync(target) || readFileSync(target, 'utf8') !== page) {
    console.error('viewer/dist/page.html is not what its sources build; run viewer/build.sh and commit the result.');
    process.exit(1);
  }
  console.log(`viewer/dist/page.html is what its sources build (${page.length} bytes).`);
} else {
  mkdirSync(dirname(target), { recursive: true });
  writeFileSync(target, page);
  console.log(`viewer/dist/page.html: ${page.length} bytes`);
}

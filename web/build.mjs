// Bundles the parts of OpenBridge that the page uses, with the colours that these use:
// `npm ci && npm run build`. The result is committed, so that nobody needs Node.js to install.
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import * as esbuild from 'esbuild';

const folder = process.argv[2];
const { outputFiles } = await esbuild.build({
  entryPoints: ['parts.js'],
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  legalComments: 'inline',
  banner: {
    js: '/* @oicl/openbridge-webcomponents 1.0.1, Apache-2.0; lit, BSD-3-Clause. Built by web/build.mjs. */',
  },
  write: false,
});
const code = outputFiles[0].text;
writeFileSync(join(folder, 'openbridge.js'), code);

// Of the 11,000 variables of all palettes, those that the parts and the page use, and those that
// these are made of.
const palette = readFileSync(
  'node_modules/@oicl/openbridge-webcomponents/dist/openbridge.css',
  'utf8',
);
const blocks = [...palette.matchAll(/([^{}]+)\{([^{}]*)\}/g)].map(([, selector, body]) => ({
  selector: selector.replace(/\/\*.*?\*\//gs, '').trim(),
  lines: [...body.matchAll(/(--[\w-]+)\s*:\s*([^;]+);?/g)].map(([, name, value]) => [
    name,
    value.trim(),
  ]),
}));
const made = new Map();
for (const { lines } of blocks)
  for (const [name, value] of lines) made.set(name, `${made.get(name) ?? ''} ${value}`);
const wanted = new Set();
function want(text) {
  for (const [name] of text.matchAll(/--[\w-]+/g)) {
    if (!wanted.has(name) && made.has(name)) {
      wanted.add(name);
      want(made.get(name));
    }
  }
}
want(code);
const own = readdirSync(folder).filter((name) => /^(?!openbridge).*\.css$/.test(name));
for (const name of own) want(readFileSync(join(folder, name), 'utf8'));
const kept = blocks
  .map(({ selector, lines }) => [selector, lines.filter(([name]) => wanted.has(name))])
  .filter(([selector, lines]) => lines.length && !selector.startsWith('@'))
  .map(
    ([selector, lines]) =>
      `${selector}{${lines.map(([name, value]) => `${name}:${value}`).join(';')}}`,
  );
writeFileSync(
  join(folder, 'openbridge.css'),
  `/* @oicl/openbridge-webcomponents 1.0.1, Apache-2.0. Built by web/build.mjs. */\n${kept.join('\n')}\n`,
);

// The viewer's sources -> page.html: one file that needs no other, with a policy that runs nothing else.
//   node build.mjs MODULES OUT      MODULES holds node_modules, as package-lock.json names them
import {createHash} from 'node:crypto';
import {readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const [modules, out] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const esbuild = createRequire(resolve(modules, 'package.json'))('esbuild');

const build = (entry, settings) =>
  esbuild.buildSync({
    entryPoints: [join(here, entry)],
    nodePaths: [resolve(modules, 'node_modules')],
    bundle: true,
    minify: true,
    write: false,
    charset: 'ascii',
    legalComments: 'none',
    target: ['chrome114', 'firefox115', 'safari16.4'],
    ...settings,
  }).outputFiles[0].text.trim();

const script = build('viewer.js', {format: 'iife'});
const style = build('style.css', {});
// Either would end early in the page.
for (const [name, text] of [['script', script], ['style', style]])
  if (text.toLowerCase().includes(`</${name}`) || text.includes('<!--')) throw new Error(`the ${name} holds a tag`);

const hash = text => `sha256-${createHash('sha256').update(text).digest('base64')}`;
const license = readFileSync(join(resolve(modules, 'node_modules'), 'three/LICENSE'), 'utf8').trim();
const parts = {script, style, 'script-hash': hash(script), 'style-hash': hash(style)};
const template = readFileSync(join(here, 'template.html'), 'utf8');
const page = template.replace(/\{\{([a-z-]+)\}\}/g, (_, name) => parts[name]);
writeFileSync(out, page.replace('<html', () => `<!--\nThe script of this page holds three.js.\n\n${license}\n-->\n<html`));

// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Writes data/view/viewer.js and viewer.css of the sources here, and the licence of three.js beside
// them. The first line of viewer.js says what it was made of, so that a test can tell whether it is of
// these sources.

import { createHash } from 'node:crypto';
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import * as esbuild from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = join(here, '../data/view');
mkdirSync(out, { recursive: true });

const sources = ['build.mjs', 'package.json', 'package-lock.json', ...readdirSync(join(here, 'src')).sort().map((name) => `src/${name}`)];
const hash = createHash('sha256');
for (const source of sources) hash.update(source).update('\n').update(readFileSync(join(here, source))).update('\n');

const three = JSON.parse(readFileSync(join(here, 'node_modules/three/package.json'))).version;
const about = `/* doorforge's viewer (Apache-2.0) with three.js ${three} (MIT, see three.LICENSE.txt); made by web/build.mjs of ${hash.digest('hex')} */`;
const result = await esbuild.build({
  entryPoints: [join(here, 'src/main.js')],
  bundle: true,
  minify: true,
  format: 'iife',
  target: ['es2022'],
  legalComments: 'none',
  charset: 'ascii',
  write: false,
});
// a page holds the script in an element, which "</script" would end
const script = result.outputFiles[0].text.replaceAll('</script', '<\\/script');
writeFileSync(join(out, 'viewer.js'), `${about}\n${script}`);
const style = await esbuild.build({ entryPoints: [join(here, 'src/viewer.css')], minify: true, write: false, legalComments: 'none' });
writeFileSync(join(out, 'viewer.css'), style.outputFiles[0].text);
copyFileSync(join(here, 'node_modules/three/LICENSE'), join(out, 'three.LICENSE.txt'));

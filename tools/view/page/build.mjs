// Makes one HTML file of this folder and of what it imports, and OUT.cpp with it.   node build.mjs OUT.cpp
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const read = (name) => readFileSync(join(here, name), 'utf8');

async function bundled(entry) {
  const result = await build({
    entryPoints: [join(here, entry)],
    absWorkingDir: dirname(here),
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: 'iife',
    target: 'es2020',
    charset: 'utf8',
    logLevel: 'warning',
  });
  return { text: result.outputFiles[0].text, inputs: Object.keys(result.metafile.inputs) };
}

// The licences of all packages of which there is something in the page.
function licences(inputs) {
  const packages = new Set();
  for (const input of inputs) {
    const match = input.match(/^(?:.*\/)?node_modules\/((?:@[^/]+\/)?[^/]+)\//);
    if (match) packages.add(match[1]);
  }
  return [...packages].sort().map((name) => {
    const folder = join(dirname(here), 'node_modules', name);
    const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt', 'LICENCE'].find((f) => existsSync(join(folder, f)));
    // Some have it at the end of their README alone.
    const text = file ? readFileSync(join(folder, file), 'utf8')
      : readFileSync(join(folder, 'README.md'), 'utf8').match(/^licen[cs]e[^\n]*\n[\s\S]*/im)?.[0];
    if (!text) throw new Error(`${name}: has no licence`);
    return `${name}\n\n${text.trim()}\n`;
  });
}

// In C++ no string literal may be longer than 65,536 characters for certain: they are joined.
function literal(text) {
  const pieces = [];
  for (let at = 0; at < text.length; at += 8000) pieces.push(`R"page~(${text.slice(at, at + 8000)})page~"`);
  return pieces.join('\n');
}

const script = await bundled('main.js');
const style = await bundled('style.css');
// What stands in a script element must not end it.
const code = script.text.replaceAll('</script', '<\\/script');
const text = licences(script.inputs).join('\n').replaceAll('<', '&lt;');
const [before, after] = read('page.html')
  .replace('/* style.css */', () => style.text)
  .replace('<!-- licences -->', () => text)
  .replace('/* main.js */', () => code)
  .split('<!-- data -->\n');

writeFileSync(process.argv[2], `#include "tools/view/page_source.h"

namespace plc::tools {

PageSource page_source() {
  return {${literal(before)},
${literal(after)},
{}};
}

}  // namespace plc::tools
`);

// Pages of one HTML file each: page.html with a style, a script and all that they import in it.
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const packages = join(here, '../node_modules');

// entry: a file; more: what else esbuild is told.
export async function bundled(entry, more = {}) {
  const result = await build({
    entryPoints: [entry],
    absWorkingDir: dirname(here),
    nodePaths: [packages],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: 'iife',
    target: 'es2020',
    charset: 'utf8',
    logLevel: 'warning',
    ...more,
  });
  return { text: result.outputFiles[0].text, inputs: Object.keys(result.metafile.inputs) };
}

// The licences of all packages of which there is something in the page.
function licences(inputs) {
  const folders = new Set();
  for (const input of inputs) {
    const match = input.match(/^(.*?node_modules\/(?:.*\/node_modules\/)?(?:@[^/]+\/)?[^/]+)\//);
    if (match) folders.add(match[1]);
  }
  return [...folders].sort().map((folder) => {
    const name = folder.slice(folder.lastIndexOf('node_modules/') + 'node_modules/'.length);
    const whole = join(dirname(here), folder);
    const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt', 'LICENCE'].find((f) => existsSync(join(whole, f)));
    // Some have it at the end of their README alone.
    const text = file ? readFileSync(join(whole, file), 'utf8')
      : readFileSync(join(whole, 'README.md'), 'utf8').match(/^licen[cs]e[^\n]*\n[\s\S]*/im)?.[0];
    if (!text) throw new Error(`${name}: has no licence`);
    return `${name}\n\n${text.trim()}\n`;
  });
}

// What stands in a script element must not end it.
export const inScript = (text) => text.replaceAll('</script', '<\\/script');

// The page before and after its data. script, style: files; panel: HTML of its own at the head of the
// panel; policy: what it may do beyond page.html's; more: what else esbuild is told of the script.
export async function pageAround({ script, style, panel = '', policy = '', more = {} }) {
  const code = await bundled(script, more);
  const looks = await bundled(style);
  const text = licences(code.inputs).join('\n').replaceAll('<', '&lt;');
  return readFileSync(join(here, 'page.html'), 'utf8')
    .replace('/* policy */', () => policy)
    .replace('<!-- panel -->\n', () => panel)
    .replace('/* style.css */', () => looks.text)
    .replace('<!-- licences -->', () => text)
    .replace('/* main.js */', () => inScript(code.text))
    .split('<!-- data -->\n');
}

// Makes one HTML file of this folder and of what it imports, and OUT.cpp with it.   node build.mjs OUT.cpp
import { writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { pageAround } from './bundle.mjs';

const here = dirname(fileURLToPath(import.meta.url));

// In C++ no string literal may be longer than 65,536 characters for certain: they are joined.
function literal(text) {
  const pieces = [];
  for (let at = 0; at < text.length; at += 8000) pieces.push(`R"page~(${text.slice(at, at + 8000)})page~"`);
  return pieces.join('\n');
}

const [before, after] = await pageAround({ script: join(here, 'main.js'), style: join(here, 'style.css') });

writeFileSync(process.argv[2], `#include "tools/view/page_source.h"

namespace plc::tools {

PageSource page_source() {
  return {${literal(before)},
${literal(after)},
{}};
}

}  // namespace plc::tools
`);

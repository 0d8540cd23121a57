#!/usr/bin/env bash
# The page of tools/wasm/demo in a headless Chromium, opened from disk: what it extracts is what the command
# does, bit for bit; damaged files give one line; cancelling works; what it writes is valid.
#   tests/wasm/test_demo.sh PELLICLE PAGE NPM_FOLDER
# PAGE is what tools/wasm/build_demo has made; NPM_FOLDER is where tools/view/package-lock.json is installed.
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
skips() { echo "SKIPPED: $1"; exit 77; }
[ -s "$2" ] || skips "there is no page: tools/wasm/build_demo makes it"
command -v node >/dev/null || skips "there is no node"
[ -d "$3/node_modules" ] || skips "$3 has no puppeteer-core: it comes with the page of pellicle view"
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  skips "there is no chromium"
page=$(realpath "$2")
npm=$(realpath "$3")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

"$pellicle" phantom chain -o chain.nrrd >/dev/null || exit 1
head=/usr/share/doc/invesalius-examples/examples/Cranium.inv3
if [ -e $head ]; then "$tests/wasm/head_ct" $head head.nrrd || exit 1; fi
# shellcheck disable=SC2154 # $here is of command_helpers.sh
node "$tests/wasm/demo_page.mjs" "$npm" "$chromium" "$pellicle" "$page" "$here"

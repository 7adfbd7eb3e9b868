#!/usr/bin/env bash
# Section 4 of Andreff, Dallej and Martinet 2007 again: tables on stdout and, with the curves, in build/reproduction;
# figures in docs/images.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build/release/tests/reproduction/section_4 build/reproduction
printf '\n'
figures=build/release/apps/report/reproduction
node "$figures/write_figures.mjs" "$figures/draw.js" build/reproduction docs/images

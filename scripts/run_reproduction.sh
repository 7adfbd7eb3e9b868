#!/usr/bin/env bash
# Section 4 of Andreff, Dallej and Martinet 2007 and the tables of Briot et al. 2016 again: on stdout and, with the curves, in
# build/reproduction; figures in docs/images.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build/release/tests/reproduction/section_4 build/reproduction
build/release/tests/reproduction/hidden_robots | tee build/reproduction/hidden_robots.md
printf '\n'
figures=build/release/apps/report/reproduction
node "$figures/write_figures.mjs" "$figures/draw.js" build/reproduction docs/images

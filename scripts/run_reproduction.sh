#!/usr/bin/env bash
# Section 4 of Andreff, Dallej and Martinet 2007 and the tables of Briot et al. 2016 again: on stdout and, with the curves, in
# build/reproduction; figures in docs/images.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build/release/tests/reproduction/section_4 build/reproduction
build/release/tests/reproduction/hidden_robots build/reproduction/servos | tee build/reproduction/hidden_robots.md
printf '\n'
legs() { build/release/apps/legible legs datasets/robots/quattro.yaml "$@" --format json; }
legs --from "0 0 -0.7 0 0 0" --to "0.1 0 -0.7 0 0 0" --legs 2,3 --legs 2,4 --map x=-0.5:0.5,y=-0.5:0.5 \
  --out build/reproduction/slice_070.json
legs --from "0.1 0.1 -0.65 0 0 0" --to "0.1 0.1 -0.61 0 0 0" --legs 1,2,3,4 --map x=-0.5:0.5,y=-0.5:0.5 \
  --out build/reproduction/slice_061.json
figures=build/release/apps/report/reproduction
node "$figures/write_figures.mjs" "$figures/draw.js" build/reproduction docs/images

#!/usr/bin/env bash
# The whole chain on a simulated rig: a session, its calibration, the accuracy at the visited poses, which legs to
# watch, and a servo to a goal by the calibrated model. Needs build/release/apps/legible.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly out=build/demo goal="0.02 -0.015 0.34 0.08 -0.1 0.12"

# Prints a command as one would type it, and runs it.
legible() {
  printf '\n$ legible'
  printf ' %q' "$@"
  printf '\n'
  build/release/apps/legible "$@"
}

rm -rf "$out"
legible simulate --images 0 --known radius_m=5e-4 --out "$out/rig"
legible capture --rig "sim:$out/rig/truth.yaml" --count 16 --known radius_m=5e-4 --out "$out/session"
legible calibrate "$out/session" --out "$out/model"
legible accuracy "$out/model/model.yaml" --session "$out/session" --joint-error 2e-5 --edge-noise 0.05 \
  --format html --out "$out/accuracy.html"
legible legs "$out/model/model.yaml" --to "$goal" --format html --out "$out/legs.html"
legible servo "$out/model/model.yaml" --rig "sim:$out/rig/truth.yaml" --goal-pose "$goal" --log "$out/servo"

cat <<WHERE

The robot that the rig hides is $out/rig/truth.yaml; what the session started from is robot.yaml beside it. Look at

  file://$PWD/$out/model/report.html   what calibration found, over every image
  file://$PWD/$out/accuracy.html       how far off the robot can be in the poses of the session
  file://$PWD/$out/legs.html           which of its legs to watch on the way to the goal
  file://$PWD/$out/servo/report.html   how it went to the goal by its legs' edges
WHERE
if [[ -n ${DISPLAY-}${WAYLAND_DISPLAY-} ]] && command -v xdg-open >/dev/null; then
  xdg-open "$PWD/$out/servo/report.html" >/dev/null 2>&1 || echo "No browser could be opened: open it yourself."
fi

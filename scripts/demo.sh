#!/usr/bin/env bash
# Calibrates the shipped session, judges the accuracy of the model found, and shows both reports. Needs
# build/release/apps/legible.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out=build/demo
status=0
build/release/apps/legible calibrate datasets/hexapod --out "$out" || status=$?

if [[ $status -eq 0 ]]; then
  printf '\n'
  judge=(build/release/apps/legible accuracy "$out/model.yaml" --joint-error 2e-5 --edge-noise 0.05)
  "${judge[@]}"
  "${judge[@]}" --format html --out "$out/accuracy.html"
  printf '\nAccuracy: file://%s\n' "$PWD/$out/accuracy.html"
fi

report=$PWD/$out/report.html
if [[ -f $report ]]; then
  printf '\nReport: file://%s\n' "$report"
  if [[ -n ${DISPLAY-}${WAYLAND_DISPLAY-} ]] && command -v xdg-open >/dev/null; then
    xdg-open "$report" >/dev/null 2>&1 || echo "No browser could be opened: open it yourself."
  fi
fi
exit "$status"

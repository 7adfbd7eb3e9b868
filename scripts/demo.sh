#!/usr/bin/env bash
# Calibrates the shipped session and shows the result. Needs build/release/apps/legible.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out=build/demo
status=0
build/release/apps/legible calibrate datasets/hexapod --out "$out" || status=$?

report=$PWD/$out/report.html
if [[ -f $report ]]; then
  printf '\nReport: file://%s\n' "$report"
  if [[ -n ${DISPLAY-}${WAYLAND_DISPLAY-} ]] && command -v xdg-open >/dev/null; then
    xdg-open "$report" >/dev/null 2>&1 || echo "No browser could be opened: open it yourself."
  fi
fi
exit "$status"

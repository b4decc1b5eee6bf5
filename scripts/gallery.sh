#!/usr/bin/env bash
# Makes the picture of every example: examples/<name>/picture.png, from a run whose results stay in results/<name>. Usage: scripts/gallery.sh PROGRAM [NAME]...
# A line `karcher view` options in examples/<name>/view (for instance `--view 1,1,0.5`) chooses the camera.
set -euo pipefail
program=$(realpath "$1")
shift
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- $(cd examples && ls -d */ | tr -d /)
for name in "$@"; do
  options=()
  [ -f "examples/$name/view" ] && read -r -a options <"examples/$name/view"
  "$program" run "examples/$name/problem.toml" --output "results/$name" --quiet
  "$program" view "results/$name" --png "examples/$name/picture.png" "${options[@]}"
done

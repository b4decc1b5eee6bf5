#!/usr/bin/env bash
# The main job: bends the Klein bottle of examples/ and says where the results are. Usage: scripts/demo.sh PROGRAM [option of `karcher run`]...
set -euo pipefail
program=$(realpath "$1")
shift
cd "$(dirname "$0")/.."
results=results/klein-bottle
"$program" run examples/klein-bottle/problem.toml --output "$results" "$@"
echo
echo "The results are in $results/:"
[ -f "$results/report.html" ] && echo "  report.html    open it by double click: the shape under the mouse, the load steps, how the solver got there"
echo "  solution.pvd   open it in ParaView"
echo "  summary.json   energies, load steps, times; iterations.csv has a row per iteration"

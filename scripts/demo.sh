#!/usr/bin/env bash
# The main job: bends the Klein bottle of examples/. The program itself says where the results are. Usage: scripts/demo.sh PROGRAM [option of `karcher run`]...
set -euo pipefail
program=$(realpath "$1")
shift
cd "$(dirname "$0")/.."
exec "$program" run examples/klein-bottle/problem.toml --output results/klein-bottle "$@"

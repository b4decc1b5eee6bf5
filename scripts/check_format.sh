#!/usr/bin/env bash
# Names the C++ files that clang-format would change (exit code 1 if there are any); with --fix, changes them.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(git ls-files --cached --others --exclude-standard '*.hpp' '*.cpp')
if [ "${1:-}" = --fix ]; then
  clang-format -i "${files[@]}"
  exit 0
fi
wrong=0
for file in "${files[@]}"; do
  clang-format --dry-run --Werror "$file" >/dev/null 2>&1 || { echo "$file is not formatted; \`make format\` does it."; wrong=1; }
done
[ $wrong -eq 0 ] && echo "All ${#files[@]} C++ files are formatted."
exit $wrong

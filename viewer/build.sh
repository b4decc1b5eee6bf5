#!/usr/bin/env bash
# Builds the page's template, viewer/dist/page.html, from its sources. With --check: compares with the committed file instead.
set -euo pipefail
cd "$(dirname "$0")"
npm ci --no-fund --no-audit
if [ "${1:-}" = --check ]; then npm run check; else npm run build; fi

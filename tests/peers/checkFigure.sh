#!/usr/bin/env bash
# docs/error-against-time.svg and the seconds in docs/measurements are those of the results that are kept.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
results=$root/docs/results/cycles-2-cores
python3 "$root/tests/peers/figure.py" "$scratch/figure.svg" "$results/cornell-box-lights-h200.csv" \
    "$results"/{cornell-box-lights,spheres,monkey}.csv >"$scratch/table"
cmp "$scratch/figure.svg" "$root/docs/error-against-time.svg"
for seconds in $(sed -n 's/^  [^:]*: \([0-9.]*\) s.*/\1/p' "$scratch/table"); do
    grep -qF "| $seconds |" "$root/docs/measurements/2026-11-28-cycles.md" || {
        echo "tests/peers/checkFigure.sh: docs/measurements has no $seconds s" >&2
        exit 1
    }
done

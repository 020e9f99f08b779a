#!/usr/bin/env bash
# What ./build.sh says on a machine that lacks everything, before it does anything: tried with an apt, a dpkg and a
# cmake that only tell what they are asked for.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"
failures=0

# expect WHAT TEXT: what build.sh said last has the text, or with ! before it has it not.
expect() {
    local found=yes wanted=yes text=$2
    [[ $text != !* ]] || { wanted=no text=${text#!}; }
    grep -qF -- "$text" "$scratch/said" || found=no
    [[ $found == "$wanted" ]] || {
        echo "tests/packages/firstMinute.sh: $1: '$2' does not hold for:" >&2
        cat "$scratch/said" >&2
        failures=$((failures + 1))
    }
}

# fake PROGRAM <SCRIPT
fake() {
    { echo '#!/bin/sh'; cat; } >"$scratch/bin/$1"
    chmod +x "$scratch/bin/$1"
}

mkdir -p "$scratch/bin" "$scratch/tree/cmake"
cp "$root/build.sh" "$scratch/tree/"
cp "$root"/cmake/*.sh "$scratch/tree/cmake/"
fake dpkg-query <<<'exit 0'
fake sudo <<<'[ "$1" = --validate ] || exec "$@"'
fake apt-get <<'END'
case "$*" in *--assume-no*) echo "Need to get 12 MB of archives."; exit 1 ;; esac
echo "asked: $*"
END
fake cmake <<'END'
echo "asked: $*"
case "$*" in *--build*) echo "[1/2] Building"; [ -z "$RT_FAILS" ] || { echo "error: of a compiler"; exit 1; } ;; esac
END
for program in bash sh env sed rm mkdir nproc tail cat grep printf dirname id awk; do
    [[ -e $scratch/bin/$program ]] || ln -s "$(command -v "$program")" "$scratch/bin/"
done

# call: build.sh with those programs alone; sets status.
call() {
    status=0
    env -i HOME="$scratch" PATH="$scratch/bin" ${fails:+RT_FAILS=$fails} "$scratch/tree/build.sh" \
        >"$scratch/said" 2>&1 </dev/null || status=$?
}

fails='' call
expect "before installing" "will be installed"
expect "before installing" "Need to get 12 MB"
expect "before compiling" "min on these"
expect "a line a step" "!asked:"
# All of that is said before anything is installed, and once.
before=$(sed '/^Installing/,$d' "$scratch/said")
[[ $before == *"Need to get 12 MB"*"min on these"*"half a GB"* ]] || expect "before installing" "what compiling costs"
[[ $(grep -c 'min on these' "$scratch/said") == 1 ]] || expect "what compiling costs" "said once"
((status == 0)) || expect "build.sh" "exit code 0, and not $status"
grep -q 'asked: .*install.*libglfw3-dev' "$scratch/tree/build/build.log" || expect "the log" "what apt was asked for"

fails=yes call
expect "a compiler fails" "error: of a compiler"
expect "a compiler fails" "build/build.log"
((status == 1)) || expect "a compiler fails" "exit code 1, and not $status"

# Neither root nor sudo: the line to hand on.
rm "$scratch/bin/sudo"
if ((EUID != 0)) || command -v setpriv >/dev/null; then
    as_nobody=()
    ((EUID != 0)) || as_nobody=(setpriv --reuid=65534 --clear-groups)
    status=0
    env -i PATH="$scratch/bin" "$(command -v "${as_nobody[0]:-env}")" "${as_nobody[@]:1}" \
        "$scratch/bin/bash" "$scratch/tree/build.sh" >"$scratch/said" 2>&1 || status=$?
    expect "without root" "    apt-get install --no-install-recommends g++"
    ((status == 1)) || expect "without root" "exit code 1, and not $status"
fi
exit $((failures > 0))

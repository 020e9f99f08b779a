#!/usr/bin/env bash
# Plants the bugs of bugs.sh one after the other and expects the ci tier's test that each names to fail: evidence that
# the tests would see them. Needs a tree that Ninja built with its tests, a device (./build.sh test provides both), GNU
# sed. Takes less than a minute for most; minutes for a shared header whose bug only another test than a unit test sees.
#   tests/planted/run.sh          all bugs
#   tests/planted/run.sh REGEX    those whose names match
#   tests/planted/run.sh --list   names, files and tests, and whether each still applies; changes nothing. That they do
#                                 is tested with every change (structure.plantedApply): what renames a line or a test
#                                 renames it here, too
# Exit code 0: all were seen; 1: some were not, or could not be planted.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

only=${1:-.}
scratch=$(mktemp -d)
patched=
build=build_for # or build_suite
bad=0
declare -A passes # tests that were seen to pass without a bug

restore() {
    [[ -z $patched ]] || cp "$scratch/original" "$patched"
    [[ -z $patched || $build == build_for ]] || touch -r "$scratch/original" "$patched"
    patched=
}
trap 'restore; rm -rf "$scratch"' EXIT

report() {
    printf '%-9s %-55s %s\n' "$@"
}
fail() {
    report "$@"
    bad=1
}

# run_test TEST: 0 it passed, 1 it failed, 2 there is none
run_test() {
    nice -n 10 ctest --test-dir build --label-exclude nightly --tests-regex "^${1//+/\\+}\$" >"$scratch/test" 2>&1 && status=0 || status=1
    if grep -q 'No tests were found' "$scratch/test"; then
        status=2
    fi
    return $status
}

# build_for TEST: what it runs
build_for() {
    local target=rt-${1%%.*}-tests
    nice -n 10 cmake --build build --target "$target" >"$scratch/build" 2>&1
}

# build_suite TEST: formulas are compiled with their unit tests, so these sources suffice, and whatever else includes
# the header stays as it is.
build_suite() {
    local suite=${1##*[./]} units=build/tests/CMakeFiles/rt-unit-*.dir/Unity commands source unit compile
    commands=$(ninja -C build -t commands rt-unit-tests)
    for source in $(grep -rlE --include=*.cpp "TEST(_F|_P)?\($suite," tests/unit); do
        # Or what includes it, where several sources are compiled as one.
        unit=$(grep -lF "\"$PWD/$source\"" $units/*.cxx 2>/dev/null) || unit=$source
        compile=$(grep -F -- "-c $PWD/$unit" <<<"$commands") || return 1
        (cd build && nice -n 10 bash -c "$compile") >"$scratch/build" 2>&1 || return 1
    done
    (cd build && nice -n 10 bash -c "${commands##*$'\n'}") >>"$scratch/build" 2>&1
}

# is_written TEST: whether its tier's sources have a test of this name; that of the last part of a parametrized one.
is_written() {
    local name=${1##*[./]}
    [[ $1 != structure.* ]] || name=${1#structure.} name=${name%%.*}
    grep -rqwF -- "$name" "tests/${1%%.*}"
}

# bug NAME FILE SED TEST: FILE is the end of one path, SED an expression for it, TEST the one of ctest's that must fail.
bug() {
    local name=$1 file=$2 expression=$3 test=$4 path
    [[ $only == --list || $name =~ $only ]] || return 0
    path=$(find . -path './build*' -prune -o -path "*/$file" -type f -printf '%P\n')
    if [[ -z $path || $path == *$'\n'* ]]; then
        fail 'no file' "$name" "$file names not one file"
        return
    fi
    sed -E "$expression" "$path" >"$scratch/planted"
    if cmp -s "$path" "$scratch/planted"; then
        fail 'obsolete' "$name" "$path has no such line"
        return
    fi
    if [[ $only == --list ]]; then
        if is_written "$test"; then report applies "$name" "$path, $test"; else fail 'no test' "$name" "$test"; fi
        return
    fi
    if [[ -z ${passes[$test]:-} ]]; then
        build_for "$test" && run_test "$test" || {
            fail 'no test' "$name" "$test does not pass, or is not there, without a bug"
            return
        }
        passes[$test]=1
    fi
    build=build_for
    [[ $path != Common/Shared/* || $test != unit.* ]] || build=build_suite
    cp -p "$path" "$scratch/original"
    patched=$path
    cp "$scratch/planted" "$path"
    if ! $build "$test"; then
        fail 'no bug' "$name" "does not compile: $(grep -m 1 error "$scratch/build")"
    elif run_test "$test"; then
        fail MISSED "$name" "$test passes"
    else
        report caught "$name" "$test"
    fi
    restore
}

. tests/planted/bugs.sh
for test in "${!passes[@]}"; do build_for "$test"; done # without the last bug
exit $bad

#!/usr/bin/env bash
# Applies the patches of this folder one after the other, each to a checkout of the last commit: evidence that a
# material, a technique, a texture, a setting and a panel can be added in as few files as docs/extending.md says, by
# what the tests name. A patch begins with lines "# what", "# files at most: N", "# build: TARGET...", "# tests:
# TEST...".
#   tests/additions/run.sh          all additions; takes as long as a build of the tests, and minutes more for each
#   tests/additions/run.sh REGEX    those whose names match
#   tests/additions/run.sh --list   names, limits and tests, and whether each applies to the last commit; builds nothing
# ADDITIONS_SCRATCH=FOLDER keeps checkout and build there for the next time. Needs Git, CMake and Ninja, and what the
# tests named need (./build.sh test provides it). Exit code 0: all passed; 1: some did not.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

only=${1:-.}
patches=$PWD/tests/additions
scratch=${ADDITIONS_SCRATCH:-}
[[ -n $scratch ]] || trap 'git worktree remove --force "$scratch/tree" 2>/dev/null; rm -rf "$scratch"' EXIT
[[ -n $scratch ]] || scratch=$(mktemp -d)
tree=$scratch/tree
bad=0

report() {
    printf '%-10s %s\n' "$@"
}
fail() {
    report "$@"
    bad=1
}

# head_of PATCH FIELD: what its line of that name says
head_of() {
    sed -n "1,/^diff /s/^# $2: //p" "$1"
}

# revert: the checkout as it is without any addition. What did not change keeps its time, so that builds stay short.
revert() {
    git -C "$tree" reset --quiet --hard
    git -C "$tree" clean --quiet -fd # build folders are ignored and stay
}

prepare() {
    mkdir -p "$scratch"
    if [[ -e $tree ]]; then
        revert
        git -C "$tree" checkout --quiet --detach "$(git rev-parse HEAD)"
    else
        git worktree add --quiet --force --detach "$tree" HEAD
    fi
}

# run_tests TEST...: prints "N passed, N failed"; a test that is not there has failed
run_tests() {
    local test passed=0 failed=0
    for test in "$@"; do
        if nice -n 10 ctest --test-dir "$tree/build-engine" --no-tests=error --tests-regex "^${test//+/\\+}\$" \
            >"$scratch/test" 2>&1; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            cat "$scratch/test" >&2
        fi
    done
    echo "$passed passed, $failed failed"
    ((failed == 0))
}

# addition PATCH
addition() {
    local patch=$1 name limit files targets tests result
    name=$(basename "$patch" .patch)
    limit=$(head_of "$patch" 'files at most')
    read -ra targets <<<"$(head_of "$patch" build)"
    read -ra tests <<<"$(head_of "$patch" tests)"
    files=$(grep -c '^diff --git ' "$patch")
    if [[ -z $limit || ${#targets[@]} == 0 || ${#tests[@]} == 0 ]]; then
        fail "$name" "its head lacks the limit, the targets or the tests"
    elif ((files > limit)); then
        fail "$name" "touches $files files, at most $limit are allowed"
    elif ! git -C "$tree" apply --check "$patch" 2>"$scratch/apply"; then
        fail "$name" "does not apply: $(head -n 1 "$scratch/apply")"
    elif [[ $only == --list ]]; then
        report "$name" "$files files of at most $limit, applies: ${tests[*]}"
    else
        git -C "$tree" apply "$patch"
        if ! (cd "$tree" && nice -n 10 cmake --preset engine && nice -n 10 cmake --build --preset engine --target "${targets[@]}") \
            >"$scratch/build" 2>&1; then
            fail "$name" "$files files of at most $limit, does not compile: $(grep -m 1 -E 'error|FAILED' "$scratch/build")"
        elif result=$(run_tests "${tests[@]}"); then
            report "$name" "$files files of at most $limit: $result"
        else
            fail "$name" "$files files of at most $limit: $result"
        fi
        revert
    fi
}

prepare
for patch in "$patches"/*.patch; do
    [[ $only == --list || $(basename "$patch" .patch) =~ $only ]] || continue
    addition "$patch"
done
exit $bad

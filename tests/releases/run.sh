#!/usr/bin/env bash
# Runs README's two commands, word for word, on bare systems of the releases that README promises: what a user meets
# whose machine has nothing installed. ./build.sh releases runs it.
#   tests/releases/run.sh FOLDER              all releases
#   tests/releases/run.sh FOLDER RELEASE...   some: bookworm, trixie, noble
# A system is debootstrap's least one, made anew in FOLDER, from the archive of this machine's own apt sources or, where
# that has no such release, from the one that debootstrap knows. In it is a clone of what is committed here; there are
# neither variables of a CI service nor /sys. It is removed when both commands passed and stays for a look when one failed.
# Prints a line for each release; all else is in FOLDER/RELEASE.log. Exit code 0: all passed; 1: some failed or could not
# be tried. A release takes one to two hours on two cores, and 6 GB.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

fail() {
    echo "tests/releases: $*" >&2
    exit 1
}

commands=('./build.sh run' './build.sh test')
. "$root/tests/releases/System.sh"

((EUID == 0)) || fail "only root can make systems: use sudo"
[[ ${1:-} && $1 != -* ]] || fail "say which folder to make systems in"
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
for release in "$@"; do
    [[ -n ${components[$release]:-} ]] || fail "$release: must be among ${releases[*]}"
done
for program in debootstrap git unshare chroot /usr/lib/apt/apt-helper; do
    command -v "$program" >/dev/null || fail "there is no $program"
done
for command in "${commands[@]}"; do
    grep -q "^    $command  *#" "$root/README.md" || fail "README.md no longer says '$command'"
done
[[ -z $(git -C "$root" status --porcelain) ]] || echo "What is not committed is not tested"

# try_release RELEASE: prints its line
try_release() {
    local release=$1 log=$folder/$1.log archive command begin=$SECONDS outcome=passed
    archive=$(archive_of "$release")
    if [[ -z $archive ]]; then
        echo "$release: not tried, as no archive that has it can be reached"
        return 1
    fi
    if ! { make_system "$release" "$archive" &&
        git clone --quiet --no-hardlinks "$root" "$folder/$release/root/checkout"; } >"$log" 2>&1; then
        echo "$release: no system could be made, $log"
        return 1
    fi
    for command in "${commands[@]}"; do
        printf '\n==== %s: %s\n' "$release" "$command" >>"$log"
        run_in "$folder/$release" "cd /root/checkout && $command" >>"$log" 2>&1 </dev/null || outcome="$command failed"
    done
    echo "$release: $outcome, $(grep 'tests passed' "$log" | tail -n 1 || true), $(((SECONDS - begin) / 60)) min, $log"
    [[ $outcome == passed ]] || return 1
    rm -rf --one-file-system "${folder:?}/$release"
}

(($#)) || set -- "${releases[@]}"
status=0
for release in "$@"; do
    try_release "$release" || status=1
done
exit $status

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
releases=(bookworm trixie noble)
declare -A components=([bookworm]=main [trixie]=main [noble]="main,universe")
declare -A keyrings=([bookworm]=debian-archive-keyring [trixie]=debian-archive-keyring [noble]=ubuntu-archive-keyring)

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

# script_of RELEASE: debootstrap's; one of an older debootstrap's Ubuntu does for the next.
script_of() {
    local scripts=/usr/share/debootstrap/scripts
    if [[ -e $scripts/$1 ]]; then
        echo "$scripts/$1"
    else
        echo "$scripts/gutsy"
    fi
}

# archive_of RELEASE: the first one that has it; nothing where none can be reached.
archive_of() {
    local archive
    for archive in $(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | awk '!seen[$0]++') \
        $(sed -n 's/^[[:space:]]*default_mirror //p' "$(script_of "$1")"); do
        if /usr/lib/apt/apt-helper download-file "${archive%/}/dists/$1/Release" "$folder/Release" >/dev/null 2>&1; then
            rm -f "$folder/Release"
            echo "${archive%/}"
            return
        fi
    done
}

# make_system RELEASE ARCHIVE: at $folder/RELEASE, with the checkout at /root/checkout
make_system() {
    local system=$folder/$1 keyring=/usr/share/keyrings/${keyrings[$1]}.gpg settings=()
    rm -rf --one-file-system "$system"
    [[ ! -e $keyring ]] || settings=(--force-check-gpg "--keyring=$keyring")
    [[ $2 != https:* ]] || settings+=(--include=ca-certificates)
    debootstrap --variant=minbase "--components=${components[$1]}" "${settings[@]}" "$1" "$system" "$2" \
        "$(script_of "$1")"
    # Updates, as every installation has them, and this machine's way to the archive.
    echo "deb $2 $1-updates ${components[$1]//,/ }" >>"$system/etc/apt/sources.list"
    apt-config dump --format '%f "%v";%n' 'Acquire::http' 'Acquire::https' >"$system/etc/apt/apt.conf.d/90archive"
    git clone --quiet --no-hardlinks "$root" "$system/root/checkout"
}

# run_in SYSTEM COMMAND: with nothing of this environment, and without /sys; what it leaves running ends with it.
run_in() {
    env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        unshare --mount --pid --fork --kill-child \
        sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" bash -c "cd /root/checkout && $1"' "$1" "$2"
}

# try_release RELEASE: prints its line
try_release() {
    local release=$1 log=$folder/$1.log archive command begin=$SECONDS outcome=passed
    archive=$(archive_of "$release")
    if [[ -z $archive ]]; then
        echo "$release: not tried, as no archive that has it can be reached"
        return 1
    fi
    if ! make_system "$release" "$archive" >"$log" 2>&1; then
        echo "$release: no system could be made, $log"
        return 1
    fi
    for command in "${commands[@]}"; do
        printf '\n==== %s: %s\n' "$release" "$command" >>"$log"
        run_in "$folder/$release" "$command" >>"$log" 2>&1 </dev/null || outcome="$command failed"
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

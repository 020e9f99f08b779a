# Sourced by scripts that try the project on bare systems, which debootstrap makes in $folder as root.
releases=(bookworm trixie noble)
declare -A components=([bookworm]=main [trixie]=main [noble]="main,universe")
declare -A keyrings=([bookworm]=debian-archive-keyring [trixie]=debian-archive-keyring [noble]=ubuntu-archive-keyring)

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

# make_system RELEASE ARCHIVE: at $folder/RELEASE
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
}

# run_in SYSTEM COMMAND: with nothing of this environment, and without /sys, but with terminals of its own (shells that
# complete a line want one); what it leaves running ends with it.
run_in() {
    env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        unshare --mount --pid --fork --kill-child \
        sh -c 'mount -t proc proc "$0/proc" && mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts" &&
            exec chroot "$0" bash -c "$1"' "$1" "$2"
}

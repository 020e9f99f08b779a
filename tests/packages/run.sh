#!/usr/bin/env bash
# Tries the packages that ./build.sh package made, in a bare system of a release: the archive of one folder runs where
# little is installed; the programs' .deb installs, renders on CPU and GPU, opens its windows, and is upgraded; with
# those beside it Python renders the same picture and the examples are built; all of them leave nothing when they are purged.
#   tests/packages/run.sh FOLDER [RELEASE]   as root; RELEASE: that of this machine, which the packages were built on
# The bare system is made once, in FOLDER/RELEASE.bare, and copied for each try. Pictures of the windows stay in FOLDER.
# Prints a line for each thing tried. Exit code 0: all of them passed.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

fail() {
    echo "tests/packages: $*" >&2
    exit 1
}

. "$root/tests/releases/System.sh"

((EUID == 0)) || fail "only root can make systems: use sudo"
[[ ${1:-} && $1 != -* ]] || fail "say which folder to make systems in"
mkdir -p "$1"
folder=$(cd "$1" && pwd)
release=${2:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
system=$folder/$release
log=$folder/$release.log
[[ " ${releases[*]} " == *" $release "* ]] || fail "$release: must be among ${releases[*]}"
names=(ray-tracing-twins ray-tracing-twins-dev python3-raytracing)
packages=()
for name in "${names[@]}"; do
    packages+=("$root/build/packages/${name}"_*.deb)
done
archives=("$root"/build/packages/*.tar.gz)
((${#packages[@]} == 3 && ${#archives[@]} == 1)) && ls "${packages[@]}" "${archives[@]}" >/dev/null ||
    fail "there must be three .deb and one .tar.gz in build/packages: ./build.sh package makes them"
: >"$log"
failures=0

# try WHAT COMMAND: in the system; a line on what came of it.
try() {
    printf '\n==== %s\n' "$1" >>"$log"
    if run_in "$system" "set -e; $2" >>"$log" 2>&1 </dev/null; then
        echo "passed: $1"
    else
        echo "FAILED: $1 ($log)"
        failures=$((failures + 1))
    fi
}

# ---- the packages by themselves -------------------------------------------------------------------------------------
if command -v lintian >/dev/null; then
    if lintian --allow-root --fail-on error,warning "${packages[@]}" >>"$log" 2>&1; then
        echo "passed: lintian has neither errors nor warnings"
    else
        echo "FAILED: lintian ($log)"
        failures=$((failures + 1))
    fi
else
    echo "not tried: lintian, which is not installed"
fi

# The same bytes wherever it is built: no path of this checkout is in it.
for package in "${packages[@]}"; do
    dpkg-deb -x "$package" "$folder/unpacked"
done
if grep -rlF "$root" "$folder/unpacked" >>"$log"; then
    echo "FAILED: files name the folder that they were built in ($log)"
    failures=$((failures + 1))
else
    echo "passed: no file names the folder that it was built in"
fi
rm -rf "${folder:?}/unpacked"

# ---- a bare system -------------------------------------------------------------------------------------------------
if [[ ! -d $system.bare ]]; then
    archive=$(archive_of "$release")
    [[ $archive ]] || fail "no archive that has $release can be reached"
    make_system "$release" "$archive" >>"$log" 2>&1 || fail "no system could be made: $log"
    mv "$system" "$system.bare"
fi
rm -rf --one-file-system "$system"
cp -a "$system.bare" "$system"
mkdir "$system/packages"
cp "${archives[0]}" "$system/packages/programs.tar.gz"
cp "${packages[0]}" "$system/packages/new.deb"
cp "${packages[1]}" "$system/packages/dev.deb"
cp "${packages[2]}" "$system/packages/python.deb"
# The version before: the same files under a lower number.
dpkg-deb -R "${packages[0]}" "$folder/old"
sed -i 's/^Version: .*/Version: 0.0.1/' "$folder/old/DEBIAN/control"
dpkg-deb --root-owner-group -Znone -b "$folder/old" "$system/packages/old.deb" >>"$log"
rm -rf "${folder:?}/old"

render="--no-config -q --scene irradiance/quad.json --width 64 --spp 4"
install="DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends"

# What the archive leaves to the system, as the drivers of screens and graphics belong to it.
try "the archive's libraries of the system" "apt-get update && $install libvulkan1 libx11-6"
try "the archive of one folder renders, from another folder" "
    mkdir -p '/opt/a folder' && tar -xzf /packages/programs.tar.gz -C '/opt/a folder'
    cd / && '/opt/a folder'/*/bin/ray-tracing-cpu $render -o /tmp/archive.pfm
    '/opt/a folder'/*/bin/ray-tracing-image info /tmp/archive.pfm"
rm -rf "$system/opt/a folder"

try "the programs install, and neither Python nor what compilers need" "$install /packages/old.deb
    ! dpkg-query -W -f '\${Package}\n' | grep -E '^python3|-dev\$'"
backports=
candidate="apt-cache policy mesa-vulkan-drivers | awk '/Candidate/ { print \$2 }'"
if run_in "$system" "dpkg --compare-versions \$($candidate) lt 25" >/dev/null 2>&1; then
    backports="-t $release-backports"
    sed -n "s/^\(deb [^ ]*\) $release main.*/\1 $release-backports main/p" "$system/etc/apt/sources.list" \
        >"$system/etc/apt/sources.list.d/backports.list"
fi
try "a driver and a screen install" "apt-get update
    $install $backports mesa-vulkan-drivers && $install xvfb x11-apps"

# Files of the system, without what apt and dpkg keep of their work, caches and what this try itself writes.
list_files="find / -xdev \\( -path /proc -o -path /tmp -o -path /packages -o -path /var/lib/dpkg -o -path /var/lib/apt \
    -o -path /var/log -o -path /var/cache -o -path /root \\) -prune -o -print | sort"
try "the package is purged" "dpkg --purge ray-tracing-twins && $list_files >/packages/before"
try "the version before installs" "$install /packages/old.deb"
try "it is upgraded" "$install /packages/new.deb
    dpkg -s ray-tracing-twins | grep -v 'Version: 0.0.1' | grep '^Version: '"

try "CPU renders" "cd / && ray-tracing-cpu $render -o /tmp/cpu.pfm"
try "GPU renders the same picture" "cd / && ray-tracing-gpu --list-devices && ray-tracing-gpu $render -o /tmp/gpu.pfm
    ray-tracing-image diff /tmp/cpu.pfm /tmp/gpu.pfm --metric relmse --max 0.01"
try "the archive's picture is the package's" "cmp /tmp/archive.pfm /tmp/cpu.pfm"
try "--version names the version" "ray-tracing-cpu --version
    ray-tracing-cpu --version | grep -q \"\$(dpkg-query -W -f '\${Version}' ray-tracing-twins)\""
for program in cpu gpu; do
    # As the menu starts it. Widgets alone have a quarter as many colours as a picture must.
    try "the window of ray-tracing-$program opens" "
        command=\$(sed -n 's/^Exec=//p' /usr/share/applications/ray-tracing-$program.desktop)
        Xvfb :1 -screen 0 1280x800x24 -nolisten tcp & sleep 3
        export DISPLAY=:1 HOME=/tmp
        \$command --no-config --scene cornell-box-lights &
        colours=0
        for turn in \$(seq 60); do
            sleep 5
            kill -0 %2
            xwd -root -silent >/packages/window-$program.xwd
            colours=\$(od -An -v -tx4 -w4 /packages/window-$program.xwd | sort -u | wc -l)
            ((colours < 60000)) || break
        done
        kill %2; wait %2 || true
        kill %1; wait %1 || true # it takes its lock away
        ((colours >= 60000))"
    cp "$system/packages/window-$program.xwd" "$folder/" 2>/dev/null || true
done
# What the other packages need stays in the system, so that theirs alone is compared below.
try "what compiles the examples and runs Python installs" "$install g++ cmake ninja-build /packages/dev.deb \
    /packages/python.deb
    dpkg --purge ${names[*]}
    $list_files >/packages/before
    $install /packages/new.deb /packages/dev.deb /packages/python.deb"
try "Python renders the same picture" "cd / && python3 -c \"
import raytracing
raytracing.render('irradiance/quad.json', width=64, spp=4, output='/tmp/python.pfm')\"
    cmp /tmp/python.pfm /tmp/cpu.pfm"
try "the examples are built against the installed modules" "
    for example in /usr/share/doc/ray-tracing-twins-dev/examples/*; do
        build=/tmp/examples/\${example##*/}
        cmake -G Ninja -S \$example -B \$build && cmake --build \$build
        (cd \$build && ./\${example##*/})
    done
    rm -r /tmp/examples"
try "nothing is left when all are purged" "dpkg --purge ${names[*]}
    $list_files >/packages/after
    diff /packages/before /packages/after
    ! find /bin /etc /lib /opt /usr /var -xdev \( -name '*ray-tracing*' -o -name '*raytracing*' \) -print | grep ."

((failures)) || rm -rf --one-file-system "$system"
exit $((failures > 0))

#!/usr/bin/env bash
# Installs what is missing, builds and runs. ./build.sh help lists the verbs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# Debian 12, Debian 13 and Ubuntu 24.04 have all of these.
headless_packages=(g++ cmake ninja-build pkg-config libglm-dev libspdlog-dev nlohmann-json3-dev libcli11-dev
                   libtinygltf-dev libstb-dev libjpeg-dev libpng-dev libopenexr-dev libtiff-dev libwebp-dev
                   libdraco-dev libmeshoptimizer-dev libpugixml-dev zlib1g-dev libtbb-dev libvulkan-dev glslang-tools)
build_packages=("${headless_packages[@]}" libglfw3-dev libimgui-dev fonts-dejavu-core)
test_packages=(libgtest-dev libbenchmark-dev libembree-dev clang clang-format clang-tidy spirv-tools patch
               vulkan-validationlayers xvfb xdotool libx11-dev assimp-testmodels zsh fish groff-base
               desktop-file-utils appstream shared-mime-info mkdocs)
bench_packages=(libbenchmark-dev libembree-dev)
compiler_packages=(g++-mingw-w64-x86-64-posix wine wine64) # of other systems, and a library of C++ that has ranges
if grep -qs bookworm /etc/os-release; then
    compiler_packages+=(clang-16 libc++-16-dev libc++abi-16-dev)
else
    compiler_packages+=(clang libc++-dev libc++abi-dev)
fi
fuzz_packages=(clang libclang-rt-dev) # which holds libFuzzer and the sanitizers; clang only recommends it
cluster_packages=(libopenmpi-dev openmpi-bin)
release_packages=(debootstrap git)
package_packages=(dpkg-dev file)
docs_packages=(mkdocs)
python_packages=(python3-dev pybind11-dev python3-numpy)

preset=release # whatever the environment: what users build is what is tested
log=build/build.log # of one call

fail() {
    echo "build.sh: $*" >&2
    exit 1
}

# step TEXT COMMAND...: one line; what the command says goes to the log, of which a failure shows the end.
step() {
    local begin=$SECONDS
    printf '%s ... ' "$1"
    mkdir -p build
    printf '\n==== %s\n' "${*:2}" >>$log
    if ! "${@:2}" >>$log 2>&1; then
        echo failed
        tail -n 40 $log >&2
        fail "all that was said is in $log"
    fi
    echo "$((SECONDS - begin)) s"
}

. cmake/SoftwareDriver.sh
. cmake/CompareEngines.sh

usage() {
    cat <<'END'
./build.sh               install what is needed and build Release into build/
./build.sh run [gpu]     build the programs alone, then open the window of ray-tracing-cpu, or of ray-tracing-gpu;
                         without a display render the default scene on CPU and GPU and compare them
./build.sh run --minimal the same without a window: neither built nor opened
./build.sh test          the same as ./build.sh, then build and run the tests of every change (label ci)
./build.sh test --all    those and the nightly ones (label nightly): random actions, larger samples, the second GPU engine
./build.sh fuzz [--fixed] [SECONDS [TARGET...]]
                         build fuzz targets with Clang, unless some are named all, and run them, 60 s together; finds are
                         kept in build/fuzz/finds; --fixed: the same inputs every time
./build.sh sanitize      build the CPU program, the Python module and their tests with sanitizers and run the tests of
                         every change: address and undefined behaviour in build-asan/, then threads, without the
                         module, in build-tsan/
./build.sh releases [RELEASE...]
                         as root: ./build.sh run and ./build.sh test on bare systems of each release that is promised
                         (or of some: bookworm, trixie, noble), made in build/releases; hours, for nights
./build.sh compilers     build, then compile everything with LLVM's library of C++ and, for Windows, with MinGW, and
                         run programs of that under Wine
./build.sh package       packages for this system in build/packages: .deb of the programs, of the modules in C++ and of
                         the Python module, and .tar.gz of the programs that runs from any folder
./build.sh package --test
                         then, as root, try them in a bare system (tests/packages/run.sh): for nights
./build.sh python        the Python module, installed into the active virtual environment or else for this user, and its
                         tests (docs/python.md)
./build.sh docs          the guides as a site in build/site
./build.sh guide         the students' guide (docs/guide): runs its notebooks, minutes, and makes the site with their
                         pictures
./build.sh cluster       the same as ./build.sh, and what mpirun needs to share a render out (docs/many-machines.md)
./build.sh bench [ARGS]  build, then run ray-tracing-bench with ARGS
With VCPKG_ROOT set, libraries come from vcpkg; otherwise from apt (Debian 12 or newer, Ubuntu 24.04 or newer).
END
}

# What compiling into a folder will cost, where nothing is compiled yet and nothing was said of it.
cost_told=
tell_cost() {
    [[ ! -e $1/bin && $cost_told != "$1" ]] || return 0
    cost_told=$1
    local work=7 # minutes of one processor
    [[ $verb != test ]] || work=12
    echo "Compiling takes about $((work / $(nproc) + 1)) min on these $(nproc) processors," \
        "and half a GB in $1/; $log tells the details"
}

# Installs those of the given Debian packages that are missing; needs root only then.
install_packages() {
    if [[ -n ${VCPKG_ROOT:-} ]] || ! command -v apt-get >/dev/null; then
        return # vcpkg installs libraries during configuration; elsewhere CMake names what it does not find
    fi
    local installed missing=()
    installed=" $(dpkg-query --show --showformat='${db:Status-Status}:${Package} ' "$@" 2>/dev/null || true)"
    for package in "$@"; do
        [[ $installed == *" installed:$package "* ]] || missing+=("$package")
    done
    ((${#missing[@]})) || return 0

    local as_root=() install=(apt-get install --no-install-recommends)
    if ((EUID != 0)); then
        command -v sudo >/dev/null ||
            fail "packages are missing, and neither root nor sudo is at hand. Ask who administers this machine for
    ${install[*]} ${missing[*]}"
        as_root=(sudo)
    fi
    echo "These packages of the system will be installed, with what they need: ${missing[*]}"
    ((EUID == 0)) || sudo --validate # asks for the password while there is a line to type it on
    # A failing update (a third party's archive, say) need not concern our packages: the installation tells.
    step "Asking the archive" "${as_root[@]}" sh -c 'apt-get update || true'
    LC_ALL=C "${install[@]}" --assume-no "${missing[@]}" 2>/dev/null | sed -n '/^Need to get/p; /^After this/p' || true
    case $verb in build | cluster | run | test | bench) tell_cost build ;; esac # before, so that one may say no
    step "Installing" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" --assume-yes "${missing[@]}"
}

# configure [-DNAME=VALUE...]
configure() {
    local toolchain=()
    if [[ -n ${VCPKG_ROOT:-} ]]; then
        toolchain=(--toolchain "$VCPKG_ROOT/scripts/buildsystems/vcpkg.cmake")
    fi
    step "Configuring" cmake --preset "$preset" "${toolchain[@]}" "$@"
}

# How far the build is, in one line of a terminal; reads what the build says.
show_progress() {
    local line
    while IFS= read -r line; do
        if [[ -t 1 && $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
            printf '\rCompiling ... %s of %s ' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
        fi
        printf '%s\n' "$line" >>$log
    done
}

build_with_progress() {
    cmake --build --preset "$preset" "$@" 2>&1 | show_progress
}

build() {
    local begin=$SECONDS folder=build
    case $preset in
        fuzz) folder=build/$preset ;;
        asan | tsan | package) folder=build-$preset ;;
    esac
    tell_cost "$folder"
    printf 'Compiling ... '
    if ! build_with_progress "$@"; then
        echo failed
        tail -n 40 $log >&2
        fail "all that was said is in $log"
    fi
    echo "$((SECONDS - begin)) s"
}

# Has ./build.sh run --minimal left out the window?
is_minimal() {
    grep -qs '^RT_BUILD_GUI:BOOL=OFF' build/CMakeCache.txt
}

# Packages with the time of the newest entry of their changelog, as Debian's tools do: the same sources make the same
# bytes.
make_packages() {
    local date
    date=$(sed -n 's/^ -- .*  //p' cmake/packages/changelog | head -n 1)
    SOURCE_DATE_EPOCH=$(date --date="$date" +%s)
    export SOURCE_DATE_EPOCH
    umask 022
    preset=package configure
    preset=package build
    mkdir -p build/packages
    step "Packing" cpack --config build-package/CPackConfig.cmake -B build/packages
    rm -rf build/packages/_CPack_Packages
    ls build/packages/*
}

# Where modules of the interpreter go: those of the active virtual environment, or this user's own.
python_folder() {
    local place='site.getusersitepackages()'
    [[ -z ${VIRTUAL_ENV:-} ]] || place='sysconfig.get_path("platlib")'
    "$1" -c "import site, sysconfig; print($place)"
}

# The interpreter of the active virtual environment, or else the system's; it has numpy.
find_python() {
    local python=${VIRTUAL_ENV:-/usr}/bin/python3
    [[ -x $python ]] || python=$(command -v python3) || fail "$verb: there is no python3"
    "$python" -c 'import numpy' 2>/dev/null ||
        fail "$verb: $python has no numpy. In a virtual environment: pip install numpy"
    echo "$python"
}

install_python_module() {
    local python
    python=$(find_python)
    configure -DRT_BUILD_PYTHON=ON -DRT_PYTHON="$python" -DRT_PYTHON_DIR="$(python_folder "$python")"
    build --target rt-python ray-tracing-cpu ray-tracing-image
    step "Installing into $(python_folder "$python")" sh -c '
        cmake --install build --component python && cmake --install build --component python-assets'
    local suite
    for suite in tests/python/test_*.py; do
        step "Testing $suite" env PYTHONDONTWRITEBYTECODE=1 RT_PROGRAM_DIR=build/bin "$python" "$suite"
    done
}

# The notebooks' pictures in build/guide, and the site with them.
make_guide() {
    local python
    python=$(find_python)
    configure -DRT_BUILD_PYTHON=ON -DRT_PYTHON="$python"
    build --target rt-python
    rm -rf build/guide
    step "Running the notebooks, minutes" env PYTHONPATH=build/python PYTHONDONTWRITEBYTECODE=1 "$python" \
        docs/guide/run.py --output build/guide
    make_site
    echo "$PWD/build/site/guide/index.html"
}

make_site() {
    step "Writing build/site" mkdocs build --clean
}

# open_window cpu|gpu
open_window() {
    [[ $1 == cpu || $1 == gpu ]] || fail "run $1: must be cpu or gpu"
    # Any driver shows the CPU's picture; the GPU program needs one that traces rays.
    if [[ $1 == gpu ]] || ! has_vulkan_driver; then
        provide_device || fail "$no_device_reason"
    fi
    "build/bin/ray-tracing-$1"
}

# run_tests [--all]
run_tests() {
    local log=build/test.log failed=build/Testing/Temporary/LastTestsFailed.log status=0 tier=(--label-exclude nightly)
    [[ ${1:-} != --all ]] || tier=()
    # Windows wait more than they compute: two more at a time than there are processors.
    ctest --test-dir build --output-on-failure --no-label-summary --parallel "$(($(nproc) + 2))" "${tier[@]}" 2>&1 |
        tee $log ||
        status=$?
    # Windows that share processors with other tests may be too slow for hands that do not wait: those that failed, if
    # nothing else did, are tried once more, alone.
    if ((status != 0)) && [[ -s $failed ]] && ! grep -qv ':gui\.' $failed; then
        echo "Windows that failed beside other tests, once more, alone"
        ctest --test-dir build --output-on-failure --no-label-summary --rerun-failed 2>&1 | tee $log && status=0
    fi
    grep 'tests passed' $log || echo "No test ran"
    return $status
}

# build_fuzz [TARGET...]: fuzz targets are compiled apart, by Clang, into build/fuzz/; without a name all of them.
build_fuzz() {
    local targets=("${@/#/fuzz-}")
    preset=fuzz configure
    preset=fuzz build ${targets[@]+--target "${targets[@]}"}
}

# sanitize PRESET [-DNAME=VALUE...]: what runs without a device, as no driver is compiled with sanitizers.
sanitize() {
    local targets=(rt-unit-tests rt-image-tests rt-program-tests)
    [[ $1 != asan ]] || targets+=(rt-python)
    preset=$1
    configure -DRT_BUILD_GPU=OFF -DRT_BUILD_GUI=OFF -DRT_WITH_MPI=OFF "${@:2}"
    build --target "${targets[@]}"
    ctest --test-dir "build-$1" --output-on-failure --no-label-summary --parallel "$(nproc)" \
        --label-regex 'unit|image|program|python' --label-exclude nightly
}

rm -f $log 2>/dev/null || true # of whom may not, the first step tells
verb=${1:-build}
shift $(($# > 0))
case $verb in
    build)
        install_packages "${build_packages[@]}"
        configure
        build
        ;;
    cluster)
        install_packages "${build_packages[@]}" "${cluster_packages[@]}"
        configure -DRT_WITH_MPI=ON -DRT_KERNELS=all # ranks may run on processors unlike this one
        build
        ;;
    run)
        if [[ ${1:-} == --minimal ]]; then
            install_packages "${headless_packages[@]}"
            configure -DRT_BUILD_GUI=OFF
            build --target programs
            compare_engines
            exit
        fi
        install_packages "${build_packages[@]}"
        if is_minimal; then configure -URT_BUILD_GUI; else configure; fi
        build --target programs
        if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
            open_window "${1:-cpu}"
        else
            compare_engines
        fi
        ;;
    test)
        [[ -z ${1:-} || $1 == --all ]] || fail "test $1: must be --all or nothing"
        install_packages "${build_packages[@]}" "${test_packages[@]}" "${cluster_packages[@]}" \
            "${python_packages[@]}" ${1:+"${compiler_packages[@]}"}
        configure -DRT_BUILD_TESTS=ON ${1:+-DRT_KERNELS=all -DRT_BUILD_BENCH=ON} \
            ${VCPKG_ROOT:+-DVCPKG_MANIFEST_FEATURES=tests}
        build
        provide_device || fail "$no_device_reason"
        run_tests "$@"
        ;;
    compilers)
        install_packages "${build_packages[@]}" "${test_packages[@]}" "${compiler_packages[@]}"
        configure -DRT_BUILD_TESTS=ON
        build
        ctest --test-dir build --output-on-failure --tests-regex '^portable\.'
        ;;
    package)
        [[ -z ${1:-} || $1 == --test ]] || fail "package $1: must be --test or nothing"
        install_packages "${build_packages[@]}" "${package_packages[@]}" "${python_packages[@]}"
        make_packages
        if [[ ${1:-} == --test ]]; then
            install_packages "${release_packages[@]}" lintian
            tests/packages/run.sh build/packages/try
        fi
        ;;
    python)
        install_packages "${build_packages[@]}" "${python_packages[@]}"
        install_python_module
        ;;
    docs)
        install_packages "${docs_packages[@]}"
        make_site
        echo "$PWD/build/site/index.html"
        ;;
    guide)
        install_packages "${build_packages[@]}" "${python_packages[@]}" "${docs_packages[@]}"
        make_guide
        ;;
    fuzz)
        fixed=()
        [[ ${1:-} != --fixed ]] || { fixed=(--fixed); shift; }
        [[ ${1:-60} =~ ^[1-9][0-9]{0,6}$ ]] || fail "fuzz $1: must be a number of seconds, 1 to 9999999"
        install_packages "${build_packages[@]}" "${fuzz_packages[@]}"
        build_fuzz "${@:2}"
        tests/fuzz/campaign.sh ${fixed[@]+"${fixed[@]}"} build/fuzz "${1:-60}" "$(nproc)" "${@:2}"
        ;;
    sanitize)
        install_packages "${build_packages[@]}" "${test_packages[@]}" "${python_packages[@]}"
        sanitize asan
        # Embree's threads are not compiled with the sanitizer: it takes what they hand on for races.
        sanitize tsan -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON
        ;;
    releases)
        install_packages "${release_packages[@]}"
        tests/releases/run.sh build/releases "$@"
        ;;
    bench)
        install_packages "${build_packages[@]}" "${bench_packages[@]}"
        configure -DRT_BUILD_BENCH=ON ${VCPKG_ROOT:+-DVCPKG_MANIFEST_FEATURES=bench}
        build --target ray-tracing-bench
        build/bin/ray-tracing-bench "$@"
        ;;
    help | --help | -h)
        usage
        ;;
    *)
        usage >&2
        fail "unknown verb '$verb'"
        ;;
esac

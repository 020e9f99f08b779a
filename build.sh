#!/usr/bin/env bash
# Installs what is missing, builds and runs. ./build.sh help lists the verbs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# Debian 12, Debian 13 and Ubuntu 24.04 have all of these.
build_packages=(g++ cmake ninja-build pkg-config libglm-dev libspdlog-dev nlohmann-json3-dev libcli11-dev
                libtinyobjloader-dev libstb-dev libtbb-dev libvulkan-dev glslang-tools spirv-tools libglfw3-dev
                libimgui-dev fonts-dejavu-core)
test_packages=(libgtest-dev libbenchmark-dev libembree-dev clang vulkan-validationlayers)
bench_packages=(libbenchmark-dev libembree-dev)

preset=${CI:+ci} # in continuous integration warnings are errors and the benchmarks must build
preset=${preset:-release}

fail() {
    echo "build.sh: $*" >&2
    exit 1
}

. cmake/SoftwareDriver.sh

usage() {
    cat <<'END'
./build.sh               install what is needed and build Release into build/
./build.sh run           the same, then render the default scene and show figures
./build.sh test          the same, then build and run all tests
./build.sh bench [ARGS]  the same, then run ray-tracing-bench with ARGS
With VCPKG_ROOT set, libraries come from vcpkg; otherwise from apt (Debian 12 or newer, Ubuntu 24.04 or newer).
END
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

    local as_root=()
    if ((EUID != 0)); then
        command -v sudo >/dev/null || fail "these packages are missing, and neither root nor sudo is at hand: ${missing[*]}"
        as_root=(sudo)
    fi
    echo "Installing ${missing[*]}"
    # A failing update (a third party's archive, say) need not concern our packages: the installation tells.
    "${as_root[@]}" apt-get update -qq || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends "${missing[@]}"
}

# configure [-DNAME=VALUE...]
configure() {
    local toolchain=()
    if [[ -n ${VCPKG_ROOT:-} ]]; then
        toolchain=(--toolchain "$VCPKG_ROOT/scripts/buildsystems/vcpkg.cmake")
    fi
    cmake --preset "$preset" "${toolchain[@]}" "$@"
}

build() {
    cmake --build --preset "$preset" "$@"
}

# figure KEY FILE: the number of a key of the statistics.
figure() {
    sed -n "s/.*\"$1\": *\([-+.0-9eE]*\).*/\1/p" "$2" | head -n 1
}

run_default_scene() {
    local folder=build/run
    local image=$folder/cornell-box-lights.cpu.png statistics=$folder/cornell-box-lights.cpu.json
    mkdir -p $folder
    build/bin/ray-tracing-cpu --headless --spp 100 -o $image --stats $statistics
    printf '%-8s %10s %14s\n' engine seconds 'Msamples/s'
    printf '%-8s %10.2f %14.2f\n' cpu "$(figure render $statistics)" \
        "$(figure samples_per_second $statistics | awk '{ print $1 / 1e6 }')"
    echo "$PWD/$image"
}

run_tests() {
    local log=build/test.log status=0
    ctest --test-dir build --output-on-failure --no-label-summary --parallel "$(nproc)" 2>&1 | tee $log || status=$?
    grep 'tests passed' $log || echo "No test ran"
    return $status
}

verb=${1:-build}
shift $(($# > 0))
case $verb in
    build)
        install_packages "${build_packages[@]}"
        configure
        build
        ;;
    run)
        install_packages "${build_packages[@]}"
        configure
        build --target ray-tracing-cpu
        run_default_scene
        ;;
    test)
        install_packages "${build_packages[@]}" "${test_packages[@]}"
        configure -DRT_BUILD_TESTS=ON ${VCPKG_ROOT:+-DVCPKG_MANIFEST_FEATURES=tests}
        build
        provide_device
        run_tests
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

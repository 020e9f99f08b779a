# Part of build.sh: gives a machine without a device that traces rays Mesa's software driver, 25.0 or newer, and leaves the
# drivers that the user has alone.

driver_folder=$PWD/build/software-driver
min_mesa=25.0

has_ray_tracing_device() {
    build/bin/ray-tracing-gpu --list-devices 2>/dev/null | grep -q ': suitable$'
}

# Beside software. The list names the kind of a device first in its brackets.
has_hardware_device() {
    build/bin/ray-tracing-gpu --list-devices 2>/dev/null | grep ': suitable$' | grep -qv ' (software, '
}

has_vulkan_driver() {
    compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null || compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null
}

# apt's settings for lists and packages of its own below build/: asking another suite changes nothing on the machine.
private_apt=(-o "Dir::Etc::SourceList=$driver_folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
             -o "Dir::State::Lists=$driver_folder/lists" -o "Dir::Cache=$driver_folder/cache"
             -o "APT::Sandbox::User=$(id -un)")

# The release and its backports from the archive that the machine already uses.
write_private_sources() {
    mkdir -p "$driver_folder/lists/partial" "$driver_folder/cache/archives/partial"
    apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' |
        awk -v suite="$1" '$2 == suite && !seen[$1]++ {
            print "deb", $1, suite, "main"
            print "deb", $1, suite "-backports", "main"
        }' >"$driver_folder/sources.list"
}

# Version of the newest driver that apt knows of with the given settings; nothing if that is too old.
sufficient_mesa() {
    local version
    version=$(apt-cache "$@" madison mesa-vulkan-drivers 2>/dev/null | awk -F'|' '{ gsub(/ /, "", $2); print $2 }' |
        sort -rV | head -n 1)
    if [[ -n $version ]] && dpkg --compare-versions "$version" ge $min_mesa; then
        echo "$version"
    fi
}

# Installs the driver where the machine has none, otherwise unpacks it.
get_software_driver() {
    local codename version as_root=() settings=()
    command -v apt-get >/dev/null || return 1
    codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
    mkdir -p "$driver_folder"
    version=$(sufficient_mesa)
    if [[ -z $version ]]; then
        settings=("${private_apt[@]}" -t "$codename-backports")
        write_private_sources "$codename"
        apt-get "${settings[@]}" update -qq
        version=$(sufficient_mesa "${private_apt[@]}")
    fi
    if [[ -z $version ]]; then
        echo "This release has no Mesa $min_mesa or newer" >&2
        return 1
    fi
    if ! has_vulkan_driver && { ((EUID == 0)) || command -v sudo >/dev/null; }; then
        ((EUID == 0)) || as_root=(sudo)
        echo "Installing mesa-vulkan-drivers $version"
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "${settings[@]}" install -qq \
            --no-install-recommends mesa-vulkan-drivers
    else
        unpack_driver "$version" "${settings[@]}"
    fi
    rm -rf "$driver_folder/lists" "$driver_folder/cache"
}

# unpack_driver VERSION [SETTINGS OF APT...]
unpack_driver() {
    local version=$1
    shift
    echo "Unpacking mesa-vulkan-drivers $version below build/"
    (cd "$driver_folder" && apt-get "$@" download -qq "mesa-vulkan-drivers=$version")
    dpkg -x "$driver_folder"/mesa-vulkan-drivers_*.deb "$driver_folder/root"
    rm "$driver_folder"/mesa-vulkan-drivers_*.deb
    printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.3.0"}}\n' \
        "$(find "$driver_folder/root" -name libvulkan_lvp.so)" >"$driver_folder/lvp_icd.json"
}

# Needs build/bin/ray-tracing-gpu. Fails, with no_device_reason, when there is no device at the end.
provide_device() {
    [[ -x build/bin/ray-tracing-gpu ]] || return 0 # a build without the GPU engine
    has_ray_tracing_device && return
    [[ -e $driver_folder/lvp_icd.json ]] || get_software_driver || true
    if [[ -e $driver_folder/lvp_icd.json ]]; then
        export VK_DRIVER_FILES=$driver_folder/lvp_icd.json
    fi
    has_ray_tracing_device && return
    no_device_reason="no device can trace rays: $(build/bin/ray-tracing-gpu --list-devices 2>&1)"
    return 1
}

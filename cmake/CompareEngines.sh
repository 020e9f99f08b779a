# Part of build.sh: renders the default scene on both engines and prints what that took, how exact the pictures are, and how much
# quicker the GPU is.

comparison_folder=$PWD/build/run
comparison_scene=cornell-box-lights
comparison_width=200
comparison_spp=100
software_spp=25      # of Mesa's software driver
reference_spp=4096   # of the common reference, or as many as fit into
reference_seconds=5

# figure KEY FILE: the number of a key of the statistics.
figure() {
    sed -n "s/.*\"$1\": *\([-+.0-9eE]*\).*/\1/p" "$2" | head -n 1
}

# text KEY FILE: the same for a text.
text() {
    sed -n "s/.*\"$1\": *\"\(.*\)\",\{0,1\}$/\1/p" "$2" | head -n 1
}

# render ENGINE NAME FLAGS...: statistics in NAME.json.
render() {
    local engine=$1 name=$2
    shift 2
    "build/bin/ray-tracing-$engine" --headless --no-config --scene $comparison_scene \
        --width $comparison_width --stats "$comparison_folder/$name.json" "$@"
}

# row ENGINE: of the table. The reference's own error, which its replicates tell, is not the engine's.
row() {
    local statistics=$comparison_folder/$1.json
    awk -v engine="$1" -v spp="$(figure spp_done "$statistics")" -v seconds="$(figure render "$statistics")" \
        -v rate="$(figure samples_per_second "$statistics")" -v error="$(figure relmse "$statistics")" \
        -v noise="$(figure estimated_relmse "$comparison_folder/reference.json")" \
        -v baseline="$(figure samples_per_second "$comparison_folder/cpu.json")" -v device="$(text device "$statistics")" \
        'BEGIN { printf("%-6s %5d %9.2f %12.2f %10.2e %9.2f  %s\n", engine, spp, seconds, rate / 1e6, error - noise,
                        rate / baseline, device) }'
}

# A device that is no software renders as many samples as the CPU, and the reference, too.
compare_engines() {
    local engine engines=(cpu) gpu_spp=$comparison_spp reference_engine=cpu name
    if [[ -x build/bin/ray-tracing-gpu ]] && provide_device; then
        engines+=(gpu)
        if has_hardware_device; then
            reference_engine=gpu
        else
            gpu_spp=$software_spp
        fi
    fi
    name=$comparison_folder/$comparison_scene
    mkdir -p "$comparison_folder"
    echo "Rendering $comparison_scene: a reference on the $reference_engine, then ${engines[*]}"
    render $reference_engine reference --seed 1 --replicates 4 --spp $reference_spp --time-limit $reference_seconds \
        --output "$name.reference.exr"
    for engine in "${engines[@]}"; do
        local spp=$comparison_spp
        [[ $engine == cpu ]] || spp=$gpu_spp
        render "$engine" "$engine" --spp $spp --reference "$name.reference.exr" --output "$name.$engine.png"
    done

    printf '\n%-6s %5s %9s %12s %10s %9s  %s\n' engine spp seconds Msamples/s relMSE speed-up device
    for engine in "${engines[@]}"; do row "$engine"; done
    printf 'speed-up: samples per second against the CPU. Reference: another seed, %d spp in %.0f s, its own relMSE of %.1e taken off.\n' \
        "$(figure spp_done "$comparison_folder/reference.json")" "$(figure render "$comparison_folder/reference.json")" \
        "$(figure estimated_relmse "$comparison_folder/reference.json")"
    for engine in "${engines[@]}"; do echo "$name.$engine.png"; done
    [[ ${engines[*]} == *gpu* ]] || echo "There is no GPU row: ${no_device_reason:-this build has no GPU engine}"
    [[ ${VK_DRIVER_FILES:-} != "$driver_folder"/* ]] ||
        echo "ray-tracing-gpu found its device through VK_DRIVER_FILES=$VK_DRIVER_FILES"
}

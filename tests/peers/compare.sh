#!/usr/bin/env bash
# Our pictures and those of Blender's Cycles of the same scenes, on this machine: error against time.
#   tests/peers/compare.sh BIN FOLDER [WIDTH [SCENE...]]
# BIN holds our programs; Blender with Cycles is BLENDER or blender (Debian, Ubuntu: apt install blender). SCENE:
# cornell-box-lights, spheres (one-weekend-final, with its metals polished, as rough ones are other formulas elsewhere)
# or monkey (a glTF that Blender writes). In FOLDER/SCENE/report is the report of each, in FOLDER/SCENE the pictures.
# The programs take turns. Seconds of imported pictures are processor seconds over the number of threads; those of our
# rows are wall time, of which "threads busy" is that share.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$(cd "$1" && pwd)
mkdir -p "$2"
folder=$(cd "$2" && pwd)
width=${3:-200}
scenes=("${@:4}")
((${#scenes[@]})) || scenes=(cornell-box-lights spheres monkey)
samples=(16 64 256) # fewer take no longer than what is subtracted
denoised_samples=(4 16 64)
repeats=3
TIMEFORMAT='%U %S'

median() { sort -g | sed -n "$(((repeats + 1) / 2))p"; }

# source_of SCENE: writes what both programs read, and prints what ours is given.
source_of() {
    local file=$folder/$1/scene.json id=$1
    case $1 in
        monkey) echo "$folder/$1/cycles/monkey.gltf" && return ;;
        spheres) id=one-weekend-final ;;
    esac
    "$bin/ray-tracing-cpu" --no-config --scene "$id" --export-scene "$file.rough.json" >/dev/null
    sed 's/"fuzz": [0-9.e-]*/"fuzz": 0/' "$file.rough.json" >"$file"
    echo "$file"
}

# cycles SCENE SOURCE HEIGHT: seconds of each picture go to FOLDER/SCENE/cycles-SPP.
cycles() {
    local place=$folder/$1 source=$2
    [[ $1 != monkey ]] || source=monkey
    "${BLENDER:-blender}" --background --python "$here/cycles.py" -- "$source" "$place/cycles" "$width" "$3" \
        "${samples[@]}" >"$place/cycles.log" 2>&1
    local marker file seconds
    while read -r marker file seconds; do
        [[ $marker == import: ]] || continue
        echo "$seconds" >>"$place/cycles-$(basename "$file" .exr)"
    done <"$place/cycles.log"
}

# denoised SCENE SOURCE HEIGHT: the same for FOLDER/SCENE/denoised-SPP, of all that the program does.
denoised() {
    local place=$folder/$1 spp
    for spp in "${denoised_samples[@]}"; do
        { time "$bin/ray-tracing-cpu" --no-config -q --scene "$2" --width "$width" --height "$3" --spp "$spp" \
            --denoise only -o "$place/denoised-$spp.exr"; } 2>&1 |
            awk -v threads="$(nproc)" '{ print ($1 + $2) / threads }' >>"$place/denoised-$spp"
    done
}

# suite SCENE SOURCE HEIGHT
suite() {
    cat <<END
{"version": 1, "title": "Beside Blender's Cycles: $1", "reference_seconds": 120, "experiments": [
  {"name": "$1", "title": "$1, $width×$3", "scene": "$2", "engine": "multi", "width": $width, "height": $3,
   "spp": [$(IFS=,; echo "${samples[*]}")], "repeats": $repeats}]}
END
}

for scene in "${scenes[@]}"; do
    place=$folder/$scene
    rm -rf "${place:?}"
    mkdir -p "$place/cycles"
    source=$(source_of "$scene")
    height=$width
    [[ $scene != spheres ]] || height=$((width * 9 / 16))
    for ((turn = 0; turn < repeats; ++turn)); do
        cycles "$scene" "$source" "$height"
        denoised "$scene" "$source" "$height"
    done
    suite "$scene" "$source" "$height" >"$place/suite.json"
    imports=()
    for spp in "${samples[@]}"; do
        imports+=(--import Cycles "$place/cycles/$spp.exr" "$(median <"$place/cycles-$spp")")
    done
    for spp in "${denoised_samples[@]}"; do
        imports+=(--import "ours, denoised" "$place/denoised-$spp.exr" "$(median <"$place/denoised-$spp")")
    done
    "$bin/ray-tracing-bench" "$place/suite.json" "${imports[@]}" --report "$place/report"
done

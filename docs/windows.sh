#!/usr/bin/env bash
# docs/windows.sh FOLDER [THEME...]: the pictures of the windows in docs/, made anew by the programs in FOLDER (a
# build's bin/), with settings and histories of their own. Needs Xvfb, xdotool, xwd and ImageMagick, and a Vulkan
# device for ray-tracing-gpu.
set -euo pipefail
bin=$(realpath "${1:?docs/windows.sh FOLDER [THEME...]}")
shift
themes=("$@")
((${#themes[@]})) || themes=(dark light contrast dark-200)
docs=$(dirname "$(realpath "$0")")
scratch=$(mktemp -d)
jobs_to_end=()
end() {
    ((${#jobs_to_end[@]} == 0)) || kill "${jobs_to_end[@]}" 2>/dev/null || true
    rm -rf "$scratch"
}
trap end EXIT

export XDG_CONFIG_HOME=$scratch XDG_STATE_HOME=$scratch XDG_DATA_HOME=$scratch LC_ALL=C
folder=$scratch/ray-tracing
mkdir -p "$folder"
exec 3<>"$scratch/number" # where Xvfb writes the screen that it has found
Xvfb -displayfd 3 -screen 0 2560x1720x24 2>"$scratch/xvfb.log" &
jobs_to_end+=($!)
until [[ -s $scratch/number ]]; do sleep 0.1; done
export DISPLAY=:$(<"$scratch/number")

# settings THEME COMPARISON: what the next window begins with.
settings() {
    local mode=${1%-200} scale=1 program
    [[ $mode != contrast ]] || mode=high-contrast
    [[ $1 != *-200 ]] || scale=2
    for program in cpu gpu; do
        cat >"$folder/ray-tracing-$program.json" <<END
{"version": 1, "color_mode": "$mode", "ui_scale": $scale, "window_width": $((1280 * scale)),
 "window_height": $((860 * scale)), "window_x": 0, "window_y": 0, "window_placed": true, "saw_first_steps": true,
 "scene": "cornell-box-lights", "show_race": false, "show_panels": true, "show_comparison": $2}
END
    done
}

# waits_for COMMAND...: until it succeeds, for ten minutes.
waits_for() {
    for ((i = 0; i < 1200; ++i)); do
        "$@" && return
        kill -0 "$program_job" 2>/dev/null || { echo "docs/windows.sh: a window has closed" >&2; exit 1; }
        sleep 0.5
    done
    echo "docs/windows.sh: not within ten minutes: $*" >&2
    exit 1
}

runs() { wc -l 2>/dev/null <"$folder/history.jsonl" || echo 0; }
has_run() { (($(runs) > runs_before)); }
# Twice the same screen, two seconds apart: the final denoised picture is there, too.
is_still() {
    local now
    now=$(xwd -root -silent | sha256sum)
    sleep 2
    [[ $now == $(xwd -root -silent | sha256sum) ]]
}

# begins PROGRAM: a window whose first render is done.
begins() {
    runs_before=$(runs)
    "$bin/$1" --width 432 --height 432 --spp 16 >"$scratch/$1.log" 2>&1 &
    program_job=$!
    jobs_to_end+=($program_job)
    waits_for has_run
    waits_for is_still
}
presses() {
    for key in "$@"; do
        xdotool key "$key"
        waits_for is_still
    done
}
ends() {
    kill "$program_job"
    wait "$program_job" || true
}
# takes FILE SCALE: the window as a picture of 256 colours.
takes() {
    xwd -root -silent |
        convert xwd:- -crop "$((1280 * $2))x$((860 * $2))+0+0" +repage -dither FloydSteinberg -colors 256 "png8:$1"
    echo "$1"
}

# Each window's table has a run of the other program.
settings dark false
for program in gpu cpu; do
    begins ray-tracing-$program
    ends
    cp "$folder/history.jsonl" "$scratch/$program.jsonl"
    rm "$folder/history.jsonl"
done
for theme in "${themes[@]}"; do
    scale=1
    [[ $theme != *-200 ]] || scale=2
    for program in cpu gpu; do
        settings "$theme" true
        other=cpu
        [[ $program == gpu ]] || other=gpu
        cp "$scratch/$other.jsonl" "$folder/history.jsonl"
        begins ray-tracing-$program
        presses n b n # raw as A, denoised as B
        takes "$docs/window-$program-$theme.png" $scale
        ends
    done
done

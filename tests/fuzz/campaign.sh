#!/usr/bin/env bash
# campaign.sh [--fixed] FOLDER SECONDS JOBS [TARGET...]: runs these fuzz targets, or all that are built in FOLDER, JOBS at a time,
# SECONDS in all. What makes one fail is kept in FOLDER/finds, and the exit code is 1 then; 77 where nothing is built.
# Corpora grow in FOLDER/corpus. Files that targets write and read are kept in memory, where the system offers a folder.
# --fixed: all begin alike and end after so many inputs, about as many as such a time takes, instead of after that time:
# whether it fails depends on the tree alone, not on the machine's speed.
set -euo pipefail
export fixed=''
[[ $1 != --fixed ]] || { fixed=yes; shift; }
folder=$1 seconds=$2 jobs=$3
[[ -d $folder/targets ]] || { echo "$folder has no fuzz targets: ./build.sh fuzz builds them"; exit 77; }
cd "$folder"
export inputs_per_second=10000

# Bytes of the longest input of a target: half as many again as the longest of its seeds has, as what is longer yet
# tells little that is new and takes its time.
max_bytes() {
    wc -c "seeds/$1"/* |
        awk '$2 != "total" && $1 > most { most = $1 } END { print most < 1024 ? 1536 : int(1.5 * most) }'
}

# One kind of input: its outcome as a line, of a find also what was found and how to replay it. Of every allocation one
# place is noted, which takes a tenth of the time less than all that call it: replays tell those. Features that were
# seen four times are no longer rare for libFuzzer, whose look through the list of rare ones would take half of the
# time.
fuzz() {
    local target=$1 seconds=$2 log=logs/$1.log status=0 words=() end=(-max_total_time="$2")
    [[ -z $fixed ]] || end=(-seed=1 -runs=$((seconds * inputs_per_second)))
    [[ ! -f seeds/words/$target ]] || words=("-dict=seeds/words/$target")
    mkdir -p "corpus/$target"
    # The programs that are tested see neither the user's files nor another place for files of their own.
    env -u RT_ASSETS -u RT_DEVICE -u RT_THREADS -u RT_LOG TMPDIR="$scratch" ASAN_OPTIONS=malloc_context_size=1 \
        XDG_CONFIG_HOME="$scratch/none" "targets/$target" "corpus/$target" "seeds/$target" \
        "${end[@]}" -max_len="$(max_bytes "$target")" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
        -entropic_feature_frequency_threshold=3 "${words[@]}" -artifact_prefix="finds/$target-" \
        -print_final_stats=1 >"$log" 2>&1 || status=$?
    if ((status)); then
        echo "$target: FAILED"
        grep -E 'ERROR|SUMMARY|runtime error|what\(\)|terminate called' "$log" || tail -n 5 "$log"
        sed -nE "s|.*Test unit written to (.*)|replay: $PWD/targets/$target $PWD/\1|p" "$log"
        return 1
    fi
    echo "$target: $(sed -nE 's/^stat::number_of_executed_units: *//p' "$log") executions"
}
export -f max_bytes fuzz

mkdir -p finds logs
place=$PWD
[[ ! -w /dev/shm ]] || place=/dev/shm
scratch=$(mktemp -d "$place/rt-fuzz-XXXXXX")
export scratch
trap 'rm -rf "$scratch"' EXIT
for program in bin/rt-fuzz-*seeds; do "$program" seeds; done
targets=("${@:4}")
((${#targets[@]})) || targets=(targets/*)
each=$((seconds * jobs / ${#targets[@]}))
printf '%s\n' "${targets[@]##*/}" | xargs -P "$jobs" -I{} bash -c "fuzz {} $((each > 0 ? each : 1))" || exit 1

#!/usr/bin/env bash
# What a desktop and a shell take from the programs is well-formed: completions parse and complete, man pages render
# without warnings, desktop entries, AppStream data and MIME types validate.
#   tests/packages/desktop.sh MANUAL   the folder that rt-write-manual wrote
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
manual=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failures=0

complain() {
    echo "tests/packages/desktop.sh: $*" >&2
    failures=$((failures + 1))
}

# expect WHAT WORDS WANTED...: each of WANTED is a word of WORDS.
expect() {
    local what=$1 words=" $2 " wanted
    for wanted in "${@:3}"; do
        [[ $words == *" $wanted "* ]] || complain "$what: no $wanted in:$words"
    done
}

for program in bash zsh fish groff desktop-file-validate appstreamcli update-mime-database; do
    command -v "$program" >/dev/null || complain "there is no $program"
done
((failures == 0)) || exit 1

# ---- completions ---------------------------------------------------------------------------------------------------
touch "$scratch/a.exr" "$scratch/b c.png" "$scratch/d.txt" "$scratch/e.json" "$scratch/f.rtc"
mkdir "$scratch/folder"
cd "$scratch"

# bash_words PROGRAM WORDS...: what bash makes of the last of these words.
bash_words() {
    bash -c 'compopt() { :; }
        . "$1"
        shift
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
        function=$(complete -p "$1" | sed "s/.*-F \([^ ]*\) .*/\1/")
        "$function" "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
        echo "${COMPREPLY[@]}"' - "$manual/bash/$1" "$@"
}

# fish_words LINE: the same for fish.
fish_words() {
    fish --no-config -c "source $manual/fish/${1%% *}.fish; complete -C '$1'" | cut -f 1 | tr '\n' ' '
}

# zsh_words PROGRAM WORDS...: what the functions of zsh's completion hand on, seen by functions in their place.
zsh_words() {
    zsh -f "$root/tests/packages/complete.zsh" "$manual/zsh" "$@" | tr '\n' ' '
}

for program in ray-tracing-cpu ray-tracing-gpu ray-tracing-image ray-tracing-bench; do
    bash -n "$manual/bash/$program" || complain "bash cannot read the completion of $program"
    zsh -n "$manual/zsh/_$program" || complain "zsh cannot read the completion of $program"
    fish --no-config -n "$manual/fish/$program.fish" || complain "fish cannot read the completion of $program"
    groff -man -ww -Tutf8 -z "$manual/man/$program.1" 2>"$scratch/warnings" || complain "groff fails on $program.1"
    [[ ! -s $scratch/warnings ]] || complain "groff warns of $program.1: $(cat "$scratch/warnings")"
done

cpu=ray-tracing-cpu
expect "bash, scenes" "$(bash_words $cpu --scene '')" cornell-box-lights veach-mis e.json folder
expect "bash, values" "$(bash_words $cpu --sampler s)" sobol sobol-blue stratified
expect "bash, --flag=" "$(bash_words $cpu --sampler = s)" sobol
expect "bash, files" "$(bash_words $cpu -o '')" a.exr folder
[[ $(bash_words $cpu -o '') != *d.txt* ]] || complain "bash: d.txt is no picture"
expect "bash, lists" "$(bash_words $cpu --aov albedo,d)" albedo,depth
expect "bash, flags" "$(bash_words $cpu --light-s)" --light-sampling --light-selection
expect "bash, commands" "$(bash_words ray-tracing-image '')" diff info merge
expect "bash, of a command" "$(bash_words ray-tracing-image diff --metric ps)" psnr
expect "fish, scenes" "$(fish_words "$cpu --scene ")" cornell-box-lights e.json folder/
expect "fish, values" "$(fish_words "$cpu --sampler s")" sobol stratified
expect "fish, files" "$(fish_words "$cpu -o ")" a.exr folder/
[[ $(fish_words "$cpu -o ") != *d.txt* ]] || complain "fish: d.txt is no picture"
expect "fish, lists" "$(fish_words "$cpu --aov albedo,d")" albedo,depth
expect "fish, of a command" "$(fish_words "ray-tracing-image diff --metric ps")" psnr
expect "zsh, scenes" "$(zsh_words $cpu --scene '')" cornell-box-lights
expect "zsh, values" "$(zsh_words $cpu --sampler s)" sobol stratified
expect "zsh, flags" "$(zsh_words $cpu --light-s)" --light-sampling
expect "zsh, of a command" "$(zsh_words ray-tracing-image diff --metric '')" psnr

# ---- desktop -------------------------------------------------------------------------------------------------------
for entry in "$root"/Assets/desktop/*.desktop; do
    [[ -z $(desktop-file-validate "$entry" 2>&1) ]] || complain "$(desktop-file-validate "$entry" 2>&1)"
done
appstreamcli validate --no-net "$root"/Assets/desktop/*.metainfo.xml >"$scratch/appstream" ||
    complain "$(cat "$scratch/appstream")"
mkdir -p "$scratch/mime/packages"
cp "$root/Assets/desktop/ray-tracing-twins.mime.xml" "$scratch/mime/packages/"
XDG_DATA_DIRS=$scratch PKGSYSTEM_ENABLE_FSYNC=0 update-mime-database "$scratch/mime" 2>"$scratch/warnings" ||
    complain "MIME types are refused"
[[ ! -s $scratch/warnings ]] || complain "MIME types: $(cat "$scratch/warnings")"
for type in application/x-ray-tracing-checkpoint application/x-ray-tracing-scene+json; do
    [[ -e $scratch/mime/$type.xml ]] || complain "there is no $type"
done
exit $((failures > 0))

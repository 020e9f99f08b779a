# What zsh completes, without a terminal: complete.zsh FOLDER WORDS..., the last of which is to be completed.
# A pseudo-terminal holds a shell whose compadd prints what it is given, as completion needs a line that is edited.
zmodload zsh/zpty
folder=$1
shift
line="${(j: :)${(q)@[1,-2]}} ${@[-1]}"
zpty shell zsh -f -i
# drain MARK: prints what the shell says up to the mark.
drain() {
    local text all=
    while zpty -r shell text "*"; do
        all+=$text
        [[ $all == *$1* ]] && break
    done
    print -r -- $all
}
zpty -w shell "PS1= PS2= ; unsetopt zle_bracketed_paste"
zpty -w shell "fpath=($folder \$fpath); autoload -Uz compinit; compinit -u -D; stty -echo"
zpty -w shell 'zstyle ":completion:*" list-grouped false; zstyle ":completion:*" insert-tab false
compadd() {
    local -a hits
    if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return $?; fi
    builtin compadd -O hits "$@"
    for hit in $hits; do print -r -- "HIT $hit"; done
    builtin compadd "$@"
}
finish() { print -r -- "END""MARK"; zle kill-whole-line }
zle -N finish; bindkey "^X^F" finish; bindkey "^I" list-choices; print -r -- "READY""MARK"'
drain READYMARK >/dev/null
zpty -n -w shell "$line"$'\t'$'\x18\x06'
drain ENDMARK | tr -d '\r' | sed -n 's/.*HIT //p' | sort -u
zpty -d shell

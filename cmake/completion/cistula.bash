# Completion of Cistula's programs for bash: the options that the program's --help lists; elsewhere file names.
_cistula() {
    local word=${COMP_WORDS[COMP_CWORD]} command=("$1")
    [[ ${COMP_WORDS[1]} != suite ]] || command+=(suite)  # of render-compare
    [[ $word == -* ]] || return 0
    mapfile -t COMPREPLY < <(compgen -W "$("${command[@]}" --help 2>/dev/null |
        sed -nE 's/^ +(-[a-zA-Z])?,? *(--[a-z-]+)?([ =,].*)?$/\1 \2/p')" -- "$word")
}
complete -o default -F _cistula render render-compare render-verify render-merge

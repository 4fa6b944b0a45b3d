# What the checks of the source tree share; sourced by them. Such a check defines
#   check ROOT      prints what is wrong with a tree, nothing if all is well
#   good_tree ROOT  fills an empty folder with a tree without faults
#   put FILE TEXT   writes a fault into a file of such a tree
#   all_rules       calls `breaks` for each of its rules
# and ends with run_check "$@".
self=$(cd "$(dirname "${BASH_SOURCE[1]}")" && pwd)/$(basename "${BASH_SOURCE[1]}")
rules=0 failures=0

fresh() {
    rm -rf "${tree:?}/t"
    mkdir -p "$tree/t"
    good_tree "$tree/t"
}

# must_detect WHAT: the tree as it is must be refused.
must_detect() {
    if "$self" "$tree/t" >/dev/null; then
        echo "not detected: $1"
        failures=$((failures + 1))
    fi
    rules=$((rules + 1))
}

breaks() {  # breaks FILE TEXT: a good tree with this text in this file must be refused
    fresh
    put "$tree/t/$1" "$2"
    must_detect "in $1: ${2:0:80}"
}

# Every rule must see the tree that breaks it.
self_test() {
    tree=$(mktemp -d)
    trap 'rm -rf "$tree"' EXIT
    fresh
    "$self" "$tree/t" || { echo "a good tree was refused"; failures=1; }
    all_rules
    echo "$rules broken trees tried, $failures failures"
    [ "$failures" -eq 0 ]
}

run_check() {
    local found
    case ${1:-} in
        --self-test) self_test ;;
        "" | -*) echo "usage: $0 ROOT | --self-test" >&2; exit 2 ;;
        *)
            found=$(check "$1")
            [ -z "$found" ] || { printf '%s\n' "$found"; exit 1; }
            ;;
    esac
}

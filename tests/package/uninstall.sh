#!/usr/bin/env bash
# cmake/uninstall removes what was installed, with a DESTDIR and without, leaves the rest, and refuses what it does not know.
# usage: uninstall.sh CMAKE BUILD WORK
set -euo pipefail
cmake=$1 build=$2 work=$3
uninstall=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/cmake/uninstall
fail() { echo "uninstall.sh: $*" >&2; exit 1; }
files() { find "$1" -type f | LC_ALL=C sort; }

install_to() {  # install_to DESTDIR PREFIX: as `make install` does
    DESTDIR=$1 "$cmake" --install "$build" --prefix "$2" >/dev/null
    install -D -m 644 "$build/install_manifest.txt" "$1$2/share/cistula/installed-files.txt"
}
refuses() {  # refuses DESTDIR PREFIX TEXT
    ! DESTDIR=$1 "$uninstall" "$2" 2>"$work/message" || fail "$1$2 was not refused"
    [ "$(wc -l <"$work/message")" -eq 1 ] && grep -qF -e "$3" "$work/message" || fail "$1$2: $(cat "$work/message")"
}

for destination in "$work/destination" ""; do
    prefix=$work/"cistula prefix" root=$destination$work/"cistula prefix"
    refuses "$destination" "$prefix" "there is no $root/share/cistula/installed-files.txt"
    mkdir -p "$root/bin" "$root/share/cistula/scenes"
    touch "$root/bin/other" "$root/share/cistula/scenes/mine.json"
    install_to "$destination" "$prefix"
    [ -x "$root/bin/render" ] || fail "nothing was installed under $root"
    DESTDIR=$destination "$uninstall" "$prefix"
    [ "$(files "$root")" = "$root/bin/other"$'\n'"$root/share/cistula/scenes/mine.json" ] || fail "left: $(files "$root")"
    folders=$(find "$root" -type d -name 'cistula*' ! -path "$root" ! -path "$root/share/cistula")
    [ -z "$folders" ] || fail "left: $folders"
    refuses "$destination" "$prefix" "there is no $root/share/cistula/installed-files.txt"

    # A list that names a file elsewhere removes nothing.
    for other in /etc/none "$prefix/../none"; do
        printf '%s\n' "$prefix/bin/other" "$other" >"$root/share/cistula/installed-files.txt"
        refuses "$destination" "$prefix" "names $other, which is not under $prefix; nothing was removed"
        [ -e "$root/bin/other" ] || fail "$root/bin/other was removed"
    done
done

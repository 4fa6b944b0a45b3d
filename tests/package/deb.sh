#!/usr/bin/env bash
# The Debian package of BUILD: its fields, what it depends on, what it holds.
# usage: deb.sh CPACK BUILD
set -euo pipefail
work=$2/tests/deb
fail() { echo "deb.sh: $*" >&2; exit 1; }

rm -rf "$work"
"$1" --config "$2/CPackConfig.cmake" -B "$work" >"$2/tests/deb.log" 2>&1 || { cat "$2/tests/deb.log" >&2; fail "cpack failed"; }
package=$(echo "$work"/*.deb)
[ -f "$package" ] || fail "not one package: $package"
[[ $(basename "$package") =~ ^cistula_[0-9.]+-1~[a-z]+[0-9.]*_amd64\.deb$ ]] || fail "its name is $package"
depends=$(dpkg-deb --field "$package" Depends)
for library in libc6 libdeflate libembree libtbb libpng libqhull libopenexr libfmt; do
    [[ ", $depends" == *", $library"* ]] || fail "does not depend on $library: $depends"
done
[ "$(dpkg-deb --field "$package" Package)" = cistula ] || fail "it is $(dpkg-deb --field "$package" Package)"
[[ $(dpkg-deb --field "$package" Description) == *$'\n Cistula renders'* ]] || fail "it has no description"

dpkg-deb --extract "$package" "$work/root"
wrong=$(dpkg-deb --contents "$package" | awk '$1 !~ /^(d|-)rwxr-xr-x$/ && $1 != "-rw-r--r--" || $2 != "root/root"')
[ -z "$wrong" ] || fail "owners or permissions: $wrong"
bash "$(dirname "${BASH_SOURCE[0]}")/installed.sh" "$work/root/usr"

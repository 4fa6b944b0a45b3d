#!/usr/bin/env bash
# The page of render-compare suite --html, with real differences in it, in headless Chromium at two widths (report-check).
# usage: check_suite_page.sh ROOT BUILD [SCREENSHOTS]; exit code 77 where there is no Chromium or no selenium
set -euo pipefail
root=$1 compare=$2/bin/render-compare
python=/usr/bin/python3
if ! command -v chromedriver >/dev/null || ! "$python" -c 'import selenium' 2>/dev/null; then
    echo "check_suite_page.sh: no Chromium or no selenium (Debian: apt-get install chromium chromium-driver python3-selenium)"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$root"/tests/package/suite/*.json "$work"
cat >"$work/suite.json" <<'END'
{"cases": [{"name": "scene", "scene": "cube.json", "golden": "scene.exr"},
           {"name": "settings", "scene": "glass.json", "depth": 6, "layers": "N,Z", "golden": "settings.exr"},
           {"name": "size", "scene": "film.json", "golden": "size.exr"},
           {"name": "hash", "scene": "cube.json"},
           {"name": "missing", "scene": "cube.json", "golden": "missing.exr"},
           {"name": "broken", "scene": "none.json", "golden": "a.exr"}]}
END
"$compare" suite "$work" scene settings size hash --update -q
sed -i 's/"reflection": 0.5/"reflection": 0.4/' "$work/cube.json"
sed -i 's/"depth": 6/"depth": 2/; s/"name": "size",/"name": "size", "resolution": [20, 40],/' "$work/suite.json"
code=0
"$compare" suite "$work" -q --html "$work/page" || code=$?
[ "$code" = 1 ] || { echo "check_suite_page.sh: the suite ends with $code" >&2; exit 1; }
page=$work/page/index.html
expect() { grep -qF -- "$1" "$page" || { echo "check_suite_page.sh: the page has no $1" >&2; exit 1; }; }
expect 'only its values are known: it shows the scene, or the camera, as it was before a change'
expect '; depth 6, cutoff 0, float, one sample'  # of the golden image, followed with the settings of its header
expect '; depth 2, cutoff 0, float, one sample'
expect 'another size: 16x12 in the golden image, 20x40 rendered'
expect 'There is no golden image to show beside it.'
"$python" "$root/tests/report-check" "$page" --screenshots "${3:-$work/shots}"

#!/usr/bin/env bash
# browser_test.sh WRITE_SAMPLES: a browser without network loads each sample report, finds every section in the document
# as it parsed it, and logs nothing to its console. Needs chromium; fails without it.
set -euo pipefail

write_samples=$1
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
"$write_samples" "$directory"

command -v chromium >/dev/null || { echo "chromium is missing (scripts/packages.txt)"; exit 1; }

failures=0
fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# load PAGE: the document as parsed into $dom, the browser's log into $log.
load() {
  dom=$directory/$1.dom
  log=$directory/$1.log
  timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
    --disable-background-networking --disable-component-update --host-resolver-rules='MAP * ~NOTFOUND' \
    --user-data-dir="$directory/profile" --enable-logging=stderr --v=0 --dump-dom "file://$directory/$1" \
    >"$dom" 2>"$log" || fail "$1: chromium ended with $?"
  if grep -F 'CONSOLE' "$log"; then fail "$1: the page wrote to the console"; fi
}

# has PAGE SELECTOR-LIKE-TEXT…
has() {
  local page=$1
  shift
  for text in "$@"; do grep -qF -- "$text" "$directory/$page.dom" || fail "$page: no $text"; done
}

sections=('id="theorem"' 'id="assumptions"' 'id="inputs"' 'id="robot"' 'id="path"' 'id="recheck"')
sampled=('id="tensions"' 'id="lengths"' 'id="slice"')

# Does this test see what it looks for? A page with a script error must be told from a good one.
echo '<!DOCTYPE html><title>x</title><script>throw new Error("seen")</script>' >"$directory/broken.html"
(load broken.html) >/dev/null
grep -qF 'CONSOLE' "$directory/broken.html.log" || fail "console messages don't reach the log: this test is blind"

for page in proved refuted singular undecided no_path hostile; do
  load "$page.html"
  has "$page.html" "${sections[@]}" 'class="sign"'
done
for page in proved refuted singular undecided hostile; do has "$page.html" "${sampled[@]}"; done
has proved.html 'id="margins"' 'class="verdict proved"'
has refuted.html 'class="verdict refuted"' 'class="witness"'
has undecided.html 'class="verdict undecided"' 'class="opening"'
if grep -qE '<(script|img)' "$directory/hostile.html.dom"; then fail "hostile.html: an element was injected"; fi

((failures == 0)) && echo "all pages load"

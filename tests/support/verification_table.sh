#!/usr/bin/env bash
# verification_table.sh BUILD [FILE]: runs all tests with the label verify in the folder BUILD and writes what they
# found to FILE (docs/verification.md beside this script by default). No table comes from a run in which a test fails.
#
# A test prints lines "VERIFY | case | quantity | reference | computed | error | order | tolerance | reason". A line that
# comes again with the same reference, from another number of ranks, is shown once: as it came first, on one rank. That
# one run prints it twice is an error: the quantity has to say what makes the two different.
set -euo pipefail

[ $# -ge 1 ] && [ -f "$1/CTestTestfile.cmake" ] || {
  echo "usage: $0 BUILD [FILE]: BUILD is a folder in which the project has been built with its tests" >&2
  exit 2
}
build=$1
here=$(cd "$(dirname "$0")" && pwd)
file=${2:-$(cd "$here/../.." && pwd)/docs/verification.md}
log=$(mktemp)
trap 'rm -f "$log"' EXIT

if ! ctest --test-dir "$build" -L verify -V >"$log" 2>&1; then
  grep -E '^ *[0-9]+/[0-9]+ Test|ERROR:|FAIL' "$log" | grep -Ev 'Passed' >&2 || tail -n 20 "$log" >&2
  echo "a verification failed: no table is written" >&2
  exit 1
fi

awk -v intro="$here/verification_intro.md" -v breaks="$here/verification_breaks.md" '
  function trim(s) { gsub(/^[ \t]+|[ \t]+$/, "", s); return s }
  { sub(/\r$/, ""); run = match($0, /^[0-9]+: /) ? substr($0, 1, RLENGTH) : ""; sub(/^[0-9]+: /, "") }
  /^SKIP: / { skipped[skips++] = substr($0, 7) }
  /^VERIFY \|/ {
    n = split($0, field, "|")
    if (n != 9) { print "not 8 columns: " $0 > "/dev/stderr"; bad = 1; next }
    row = ""
    for (k = 2; k <= n; k++) row = row " " trim(field[k]) " |"
    what = trim(field[2])
    line = what SUBSEP trim(field[3]) SUBSEP trim(field[4])
    if (line in seen) {
      if (seen[line] == run) { print "twice in one run: " $0 > "/dev/stderr"; bad = 1 }
      next
    }
    seen[line] = run
    if (!(what in first)) { first[what] = cases; name[cases++] = what }
    rows[what, count[what]++] = "|" row
    total++
  }
  END {
    if (bad || !total) exit 1
    while ((getline text < intro) > 0) print text
    for (c = 0; c < cases; c++) {
      print "## " name[c] "\n"
      print "| quantity | reference | computed | error | order | tolerance | reason |"
      print "| --- | --- | --- | --- | --- | --- | --- |"
      for (k = 0; k < count[name[c]]; k++) {
        line = rows[name[c], k]
        print "|" substr(line, index(substr(line, 2), "|") + 2)
      }
      print ""
    }
    while ((getline text < breaks) > 0) print text
    if (skips) { print "## Left out in this run\n"; for (k = 0; k < skips; k++) print "- " skipped[k] }
  }' "$log" >"$file.new" || { rm -f "$file.new"; echo "no usable VERIFY lines" >&2; exit 1; }
mv "$file.new" "$file"
echo "$(grep -c '^| ' "$file") lines in $file"

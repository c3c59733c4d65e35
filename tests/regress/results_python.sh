#!/usr/bin/env bash
# timeout: 120
# The ten lines of docs/output.md read a result with nothing but h5py, and print what is in it.
. "$SOURCE_DIR/tests/support/regress.sh"

python=
for candidate in python3 /usr/bin/python3; do
  "$candidate" -c 'import h5py' 2>/dev/null && python=$candidate && break
done
[ -n "$python" ] || skip 'no Python with h5py (Debian: python3-h5py)'

awk '/^```python$/ { n++; next } /^```/ { if (n == 1) exit } n == 1' "$SOURCE_DIR/docs/output.md" >read.py
lines=$(grep -c . read.py)
[ "$lines" -ge 5 ] && [ "$lines" -le 10 ] || fail "docs/output.md promises ten lines of Python, and shows $lines"
"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -panel_columns 10 -panel_rows 21 -panel_displacement 2e-4 -output panel.h5 >run.log
"$python" read.py >read.out || fail 'the program fails'

# The same numbers by other ways: the CSV file, and h5dump.
read -r load displacement < <(paste -d' ' <(csv_column panel.csv load) <(csv_column panel.csv displacement) |
  awk 'NR == 1 || $1 > m { m = $1; d = $2 } END { print m, d }')
expect_match "^peak load $(printf '%g N/m at %g m' "$load" "$displacement")\$" read.out
last=$(h5ls panel.h5/snapshots | awk '{ print $1 }' | tail -n 1)
h5dump -w 1 -y -m %.17g -o pressure.txt -d "/snapshots/$last/pressure" panel.h5 >dump.out
read -r pressure disc < <(tr -d ', ' <pressure.txt | grep . | awk 'NR == 1 || $1 > m { m = $1; d = NR - 1 } END { print m, d }')
expect_match "^largest: $(printf '%g' "$pressure") Pa, disc $disc at \[" read.out
version=$(sed -n 's/^#define PG_VERSION "\(.*\)"/\1/p' "$SOURCE_DIR/include/porograin/base.h")
expect_match "^made by porograin $version\$" read.out

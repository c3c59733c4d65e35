# timeout: 120
# The commands of docs/packings.md do what the page says: every block of shell and Python is run as it stands, and what
# it prints is compared with what the page shows.
. "$SOURCE_DIR/tests/support/regress.sh"
. "$SOURCE_DIR/tests/support/page_blocks.sh"

page=$SOURCE_DIR/docs/packings.md
mkdir build
ln -s "$POROGRAIN" build/porograin

take_blocks docs/packings.md
if ! command -v python3 >/dev/null; then
  echo 'no python3: heap.csv is made by awk'
  mkdir programs
  cat >programs/python3 <<'END'
#!/usr/bin/env bash
awk 'BEGIN { print "x,y,r"; for (row = 0; row < 8; row++) for (c = 0; c < 20; c++) {
  r = (row + c) % 3 ? 0.004 : 0.005; x = 0.0055 + 0.0105 * c + (row % 2 ? 0.003 : 0)
  print x "," 0.0055 + 0.0105 * row "," r } }' >heap.csv
END
  chmod +x programs/python3
  PATH=$PWD/programs:$PATH
fi
run_block 1
[ -s heap.py ] || fail 'the first block is not heap.py'
for k in 1 2 3 4 5; do
  run_block $((k + 1)) >"out.$k" 2>&1 || { cat "out.$k" >&2; fail "block $((k + 1)) of the tutorial"; }
done
no_block_left

# shown FILE LINE...: the page shows the line, and the program printed it (seconds aside)
shown() {
  local file=$1 line
  shift
  for line in "$@"; do
    grep -qxF -- "$line" "$page" || fail "the page does not show: $line"
    grep -qxF -- "$line" "$file" || { head -n 6 "$file" >&2; fail "not printed: $line"; }
  done
}
shown out.1 "packing: 160 discs from 'heap.csv'" \
  '  radius 0.004 to 0.005 m, mean 0.00433125 m; velocities zero' '  box 0,0.22,0,0.10000000000000001 m' \
  '  porosity 0.566317 in the box, 0.4885 in 118 sample circles of radius 4 r inside it' \
  '  0 pairs touch; smallest gap 0.375 of the smaller radius, discs 14 and 15'
# Radii and box follow from the seed by arithmetic; places also from the motion in the press, which a compiler with
# another library of mathematics may round differently.
shown out.3 '  radius 0.00400306 to 0.00599683 m, mean 0.00507097 m; velocities zero' \
  '  box 0,0.2010583985161549,0,0.2010583985161549 m'
expect_match '^  porosity 0.190000 in the box, 0.17[0-9]+ in 2[0-9][0-9] sample circles' out.3

# The heap has fallen and rests: on the floor, within the walls, slow against the 1.4 m/s of a fall through the box.
grep -v '^[#x]' rest.csv >rest.discs
[ "$(wc -l <rest.discs)" -eq 160 ] || fail 'rest.csv has lost discs'
awk -F, '{ if ($1 < 0 || $1 > 0.22 || $2 < 0 || $2 > 0.1) { print; bad = 1 }
           v = $4 * $4 + $5 * $5; if (v > fast) fast = v; y += $2 }
         END { if (sqrt(fast) > 0.1 || y / NR > 0.042) { print "speed", sqrt(fast), "mean height", y / NR; bad = 1 }
               exit bad }' rest.discs || fail 'the heap has not come to rest in its box'
expect_match '^packing: 160 discs from .fall.h5.' out.2
expect_match 'velocities from the file' out.2
expect_match '^packing: 400 discs from .dense.csv.' out.4
expect_match '^results in pressed.h5' out.4
expect_match 'fluid darcy' out.5

# timeout: 300
# 5000 discs of different sizes pressed to a porosity of 0.18: in less than a minute on one core, with the same bits on
# 1 and 4 ranks.
. "$SOURCE_DIR/tests/support/regress.sh"

random='-case packing -packing_generate random -packing_count 5000 -packing_target_porosity 0.18
  -packing_radius_spread 0.25 -packing_seed 7 -dt 1e-7 -end_time 1e-7'
TIMEFORMAT='%U %S'
# shellcheck disable=SC2086
{ time "$POROGRAIN" $random -packing_export one.csv >one.out 2>one.err </dev/null; } 2>seconds
# Time of the processor, not of the clock, so that a busy machine does not count; 5 s on the machine of the authors.
awk '{ print "processor time " $1 + $2 " s"; exit !($1 + $2 < 60) }' seconds || fail "more than a minute: $(cat seconds)"
# shellcheck disable=SC2086
run 4 "$POROGRAIN" $random -packing_export four.csv >four.out
cmp one.csv four.csv || fail 'another packing on 4 ranks'

# From the file alone: 5000 discs; the area of the box is found from the message.
expect_match '5000 discs, random' one.out
expect_match 'porosity 0.180000 in the box' one.out
box=$(sed -n 's/^  box \([0-9.,e+-]*\) m.*/\1/p' one.out)
awk -F, -v box="$box" '
  BEGIN { split(box, b, ",") }
  /^[0-9.]/ { n++; solid += 4*atan2(1, 1)*$3*$3 }
  END { porosity = 1 - solid/((b[2] - b[1])*(b[4] - b[3])); print n " discs, porosity " porosity
        # radii are scaled to meet the area: rounding of 5000 numbers
        exit !(n == 5000 && porosity > 0.18 - 1e-9 && porosity < 0.18 + 1e-9) }' one.csv || fail 'not 5000 discs at a porosity of 0.18'

# timeout: 120
# The cases without time, operator_mms and pressure_mms: table on the screen, as CSV and HDF5 beside -output, a picture of
# it; an order that is missed ends the program with status 3; what they have no use for is refused, with nothing written.
. "$SOURCE_DIR/tests/support/regress.sh"

# ---- operators: two ranks and one give the same table but for the order of sums ----
run 2 "$POROGRAIN" -case operator_mms -mms_levels 3 -output operators.h5 >operators.out
"$POROGRAIN" -case operator_mms -mms_levels 3 -output one.h5 >one.out
expect_match '^gradient against k times the exact one: order 2\.0[0-9], expected 2 or more: holds$' operators.out
expect_match '^Laplacian against k times the exact one: order (2\.0|1\.99)[0-9]*, expected 2 or more: holds$' operators.out
for column in N gradient_error gradient_rest laplacian_error laplacian_rest_order; do
  for row in 1 2 3; do
    one=$(csv_column one.csv $column | sed -n "${row}p")
    [ -n "$one" ] || continue # no order in the first row
    # sums of 1e4 numbers
    expect_close "$(csv_column operators.csv $column | sed -n "${row}p")" "$one" "$(awk "BEGIN { print 1e-9 * ($one) }")"
  done
done
# 25, 50, 100 discs across in 27, 57, 115 rows of 24 and 25
[ "$(csv_column one.csv N | paste -sd ' ')" = '661 2821 11442' ] || fail "N: $(csv_column one.csv N | paste -sd ' ')"
# the plateau of the paper's form, |k - 1|, less a term of h^2, 1e-3 of the derivative here
expect_close "$(csv_column one.csv laplacian_error | tail -n 1)" 0.0762 0.001
expect_close "$(csv_column one.csv gradient_error | tail -n 1)" 0.0224 0.001
h5ls -r operators.h5 >objects
expect_match '/study/002' objects
# another seed is another disorder, the same seed the same
for name in a b c; do
  seed=5
  [ $name != c ] || seed=6
  "$POROGRAIN" -case operator_mms -mms_levels 3 -mms_jitter 0.1 -mms_seed $seed -sph_operators corrected -output $name.h5 >$name.out
done
cmp a.csv b.csv || fail 'the same seed gives another table'
if cmp -s a.csv c.csv; then fail 'another seed gives the same table'; fi
expect_match '^gradient: order 1\.[0-9]+, expected 1 or more: holds$' a.out

# ---- pressure, prescribed and natural ----
run 2 "$POROGRAIN" -case pressure_mms -mms_levels 3 -sph_operators corrected -output pressure.h5 >pressure.out
expect_match '^solved pressure: order (2\.0|1\.9)[0-9]*, expected 2 or more: holds$' pressure.out
"$POROGRAIN" -case pressure_mms -mms_levels 3 -mms_sides natural -output natural.h5 >natural.out
expect_match '^shape of the solved pressure: order (1\.|0\.9)[0-9]+, expected 1 or more: holds$' natural.out
# what has no solution is removed: the ragged ends of the rows, some 1e-4 of the right-hand side
removed=$(csv_column natural.csv removed | tail -n 1)
awk "BEGIN { exit !($removed > 0 && $removed < 1e-3) }" || fail "removed: $removed"

# ---- pictures ----
"$POROGRAIN_PLOT" operators.h5 natural.h5 -figures figures -plot_gnuplot none >plot.out
expect_match 'gradient' figures/operators-orders.gp
expect_match 'its shape' figures/natural-orders.gp

# ---- an order that is missed is a failed run, its table written ----
expect_error 3 'case pressure_mms: solved pressure: order .* expected is 2, and at least 1\.80' "$POROGRAIN" \
  -case pressure_mms -mms_levels 3 -sph_operators corrected -pressure_ksp_rtol 3e-2 -output missed.h5
[ "$(wc -l <missed.csv)" -eq 4 ] || fail 'the table of the run that missed its order'

# ---- refusals ----
refused() { # PATTERN OPTIONS...
  local pattern=$1
  shift
  expect_error 2 "$pattern" "$POROGRAIN" -output refused.h5 "$@"
}
refused 'option -mms_levels: 2 is out of range, it must be between 3 and 8' -case operator_mms -mms_levels 2
refused 'option -mms_jitter: 0\.01 is out of range, it must be 0 or between 0\.02 and 0\.3' -case operator_mms -mms_jitter 0.01
refused 'option -mms_seed: -1 ' -case pressure_mms -mms_seed -1
refused "option -mms_sides" -case pressure_mms -mms_sides none
refused '-mms_sides natural is not read in this run, it needs -case pressure_mms' -case operator_mms -mms_sides natural
refused '12 discs across the packing are too few for a kernel that reaches over 5 radii: 24 are needed' \
  -case operator_mms -mms_points 12
refused 'a finest packing of 524288 discs across' -case operator_mms -mms_points 4096 -mms_levels 8
refused '-pressure explicit does not solve it' -case pressure_mms -pressure explicit
refused 'the corrected Laplacian is not symmetric' -case pressure_mms -mms_sides natural -sph_operators corrected
for option in '-dt 1e-6' '-fluid ns' '-end_time 1' '-checkpoint run.pgc' '-gravity 0,-9.81' '-dem_k_n 1e8'; do
  # shellcheck disable=SC2086
  refused "option ${option%% *} .*(not read in this run|of no use to this case)" -case pressure_mms $option
done
expect_error 2 "the name must end in .h5" "$POROGRAIN" -case operator_mms -output refused.txt
expect_error 4 'option -output: cannot write no/such/refused.h5' "$POROGRAIN" -case operator_mms -output no/such/refused.h5
for study in solvers explicit stepping; do
  expect_error 2 'case operator_mms|needs water' "$POROGRAIN_STUDY" -study $study -case operator_mms -study_output refused \
    -study_solvers "$SOURCE_DIR/options/solvers/all.txt"
done
if ls refused* >/dev/null 2>&1; then fail "written all the same: $(ls refused*)"; fi

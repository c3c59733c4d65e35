# timeout: 120
# -study mms: orders of the operators and of the solved pressure.
. "$SOURCE_DIR/tests/support/regress.sh"

run 2 "$POROGRAIN_STUDY" -study mms -study_mms_levels 3 -study_output mms >mms.out
value() { awk -F, -v p="$1" -v o="$2" -v c="$3" -v n="$4" '
  NR == 1 { for (i = 1; i <= NF; i++) { name = $i; sub(/ .*/, "", name); if (name == c) k = i } next }
  { gsub(/"paper, eta 0.1"/, "paper"); if (c != "" && $1 == p && $2 == o) { last = $k; if (++m == n) print last } }' mms.csv; }

for points in lattice jittered; do
  # corrected: second order, less what 100 points across still lack (1.9 and more was seen)
  expect_close "$(value $points corrected pressure_order 3)" 2 0.15
  # the paper's form does not converge: the error of its weights on the lattice, 7.6 %, stays (8 % of the part of p that
  # is not linear, the reading of the moment of second order)
  expect_close "$(value $points paper pressure_order 3)" 0 0.15
done
expect_close "$(value lattice corrected gradient_order 3)" 2 0.05
expect_close "$(value lattice corrected laplacian_order 3)" 2 0.05
expect_close "$(value lattice paper laplacian_error 3)" 0.0762 0.002
expect_close "$(value lattice paper gradient_error 3)" 0.0223 0.001
expect_close "$(value lattice 'eta 0' laplacian_error 3)" 0.0224 0.001
# under disorder the Laplacian of the paper's form is the worse the finer the points are; at 100 points across the share of
# those near the edge, where kernels are cut and nothing is measured, still falls (-1.16 was seen, -1.01 at 200)
expect_close "$(value jittered paper laplacian_order 3)" -1 0.25

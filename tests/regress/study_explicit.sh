# timeout: 120
# -study explicit: sweeps on the matrix of a run are those of the explicit method, and diffuse as derived.
. "$SOURCE_DIR/tests/support/regress.sh"

# the reference of the unknown is not the pressure at the start, so that the guess of the first step is not zero
run_options=(-panel_columns 12 -fluid ns -dt 2e-6 -fluid_every 4 -sph_laplacian_eta 0.1 -end_time 8e-6
  -pressure_reference 1.3e5)
"$POROGRAIN_STUDY" -study explicit "${run_options[@]}" -pressure_ksp_rtol 1e-12 -study_at 1,3 -study_sweeps 0,1,5,5000 -study_time 4e-5 \
  -study_samples 2 -study_variants implicit:1,explicit2:4,implicit:2 -study_output explicit >explicit.out
residual=($(csv_column explicit.csv residual))
[ "${#residual[@]}" -eq 8 ] || fail 'rows'

# The same step in two runs, explicit and implicit: the largest difference of their pressures is that of the study.
pressures() {
  "$POROGRAIN" "${run_options[@]}" "$@" -output_every 8e-6 -output step.h5 >step.out
  h5dump -d /snapshots/000001/pressure -y -w 0 -m %.17g step.h5 | sed -n '/DATA {/,/}/p' | tr -cd '0-9.e+\n,-' |
    tr ',' '\n' | grep '^[0-9]'
}
pressures -pressure implicit -pressure_ksp_rtol 1e-12 >implicit.p
pressures -pressure explicit -pressure_sweeps 5 >explicit.p
[ "$(wc -l <implicit.p)" -eq 287 ] || fail "$(wc -l <implicit.p) pressures"
largest=$(paste implicit.p explicit.p | awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > m) m = d } END { printf "%.12g", m }')
# pressures of 1e5 Pa, in the explicit run rounded in another order than in the study, in the implicit run solved to 1e-12
expect_close "$largest" "$(csv_column explicit.csv error_max | sed -n 3p)" 1e-5
# far enough, sweeps find the solution
expect_close "$(csv_column explicit.csv error_l2 | sed -n 4p)" 0 1e-8
awk -v a="${residual[0]}" -v b="${residual[1]}" -v c="${residual[2]}" 'BEGIN { exit !(a > b && b > c && c > 1e-3) }' ||
  fail "residuals ${residual[*]}"

# 0.924/2.5245 from the weights of the lattice, h = 1.25 d and eta = 0.1; discs in motion change the third digit
d=$(sed -n 's/.* D = \([0-9.]*\) d^2\/dt.*/\1/p' explicit.out)
expect_close "$d" 0.366 0.003
# by the decay of the slowest mode, whose wavelength a panel 12 discs wide knows to about a tenth
expect_close "$(sed -n 's/.*; \([0-9.]*\) d^2\/dt by the decay.*/\1/p' explicit.out)" 0.366 0.04

# Runs against each other: the reference has no error, the others have some, and all came to the end.
errors=($(csv_column explicit-cost.csv load_error))
expect_close "${errors[0]}" 0 0
awk -v a="${errors[1]}" -v b="${errors[2]}" 'BEGIN { exit !(a > 0 && b > 0) }' || fail "errors ${errors[*]}"
# 4e-5 s in two samples of a multiple of 4 steps each: 2 x 12
[ "$(csv_column explicit-cost.csv steps | paste -sd ' ')" = '24 24 24' ] || fail 'steps'
[ "$(csv_column explicit-cost.csv remark | sort -u)" = 'as asked' ] || fail 'ends'

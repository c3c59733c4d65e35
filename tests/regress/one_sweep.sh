# processors: 2
# One explicit sweep is one iteration of Richardson's method with Jacobi's preconditioner, from the same guess: in the
# first solve and after 40 fluid steps, whatever scheme, operators and sides. k sweeps are k iterations.
. "$SOURCE_DIR/tests/support/regress.sh"

# The largest difference of p and u is compared with the largest change that they have undergone. p of 1e5 Pa has a
# rounding of 1.5e-11 Pa; the smallest change below is 156 Pa, so one rounding is 1e-13 of it. Ten times that, for 40
# steps in which differences come and go, are allowed. Seen: 2e-14 at most.
tolerance=1e-12

richardson="-pressure implicit -pressure_ksp_type richardson -pressure_pc_type jacobi"
# More than one sweep: neither the norm nor convergence is asked for, and the diagonal is that of this step. One sweep is
# understood without that.
none="-pressure_ksp_norm_type none -pressure_error_if_not_converged false -pressure_pc_lag 1"

# run_panel END options...: fluid steps of 4e-6 s, with a snapshot after each
run_panel() {
  local end=$1
  shift
  "$POROGRAIN" -case panel -panel_columns 10 -dem_local_damping 0.7 -dt 2e-6 -fluid_every 2 -end_time "$end" \
    -output_every 4e-6 "$@" >log 2>&1 || { cat log >&2; fail "$*"; }
}

# same NAME SWEEPS options...: in a folder of its own
same() { beside within "$1" compare "$@"; }
compare() {
  local name=$1 sweeps=$2 end
  shift 2
  for end in 4e-6 1.6e-4; do
    run_panel $end "$@" -pressure explicit -pressure_sweeps "$sweeps" -output "$name-explicit.h5"
    # shellcheck disable=SC2086
    run_panel $end "$@" $richardson $(if [ "$sweeps" != 1 ]; then echo "$none"; fi) -pressure_ksp_max_it "$sweeps" \
      -output "$name-richardson.h5"
    "$SUPPORT/compare_results" "$name-explicit.h5" "$name-richardson.h5" $tolerance pressure fluid_velocity >differ.txt ||
      { cat differ.txt >&2; fail "$name, to t = $end s"; }
  done
}

same paper 1 -fluid ns -ns_continuity solenoidal -coupling drag -sph_operators paper
same darcy 1 -fluid darcy -coupling drag -porosity_rate sampled -bc_top flux -bc_top_flux -0.13
same sweeps 3 -fluid ns -ns_theta 0.7 -coupling drag_and_pressure -ns_continuity averaged -sph_gradient corrected \
  -bc_tracking surface

together

# Everything said by hand is the same.
# shellcheck disable=SC2086
{
  run_panel 4e-6 -fluid ns $richardson $none -pressure_ksp_max_it 1 -output spelt.h5
  run_panel 4e-6 -fluid ns $richardson -pressure_ksp_max_it 1 -output short.h5
}
expect_match 'a single sweep in each solve: convergence is not asked for' log
expect_same_results spelt.h5 short.h5 /snapshots
# Who asks for convergence, or for a norm, gets it.
# shellcheck disable=SC2086
for asked in '-pressure_error_if_not_converged true' '-pressure_ksp_norm_type unpreconditioned' '-pressure_ksp_norm_type none'; do
  expect_error 3 'pressure: the solver' "$POROGRAIN" -panel_columns 10 -dt 2e-6 -fluid_every 2 -end_time 4e-6 -fluid ns \
    $richardson -pressure_ksp_max_it 1 $asked
done

# Two sweeps are not one: the comparison can fail.
run_panel 4e-6 -fluid ns -pressure explicit -output one.h5
run_panel 4e-6 -fluid ns -pressure explicit -pressure_sweeps 2 -output two.h5
if "$SUPPORT/compare_results" one.h5 two.h5 $tolerance pressure >/dev/null 2>&1; then fail "one sweep is like two"; fi

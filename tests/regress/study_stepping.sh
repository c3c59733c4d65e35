# timeout: 120
# -study stepping: a solver that goes along does in each step what a run with that solver does.
. "$SOURCE_DIR/tests/support/regress.sh"

run_options=(-panel_columns 12 -fluid ns -ns_continuity averaged -coupling drag_and_pressure -dem_local_damping 0.7
  -dt 2e-6 -fluid_every 20 -end_time 1.2e-3 -neighbors_skin 0.01 -sph_laplacian_eta 0.01)
all="$SOURCE_DIR/options/solvers/all.txt"
for n in 1 2; do
  run "$n" "$POROGRAIN_STUDY" -study stepping "${run_options[@]}" -study_solvers "$all" -study_only cg-icc,cg-jacobi \
    -study_output "stepping$n" >"stepping$n.out"
  # the same solver in a run of its own, with its last solution as guess
  run "$n" "$POROGRAIN" "${run_options[@]}" -options_file "$SOURCE_DIR/options/solvers/cg-icc.opts" \
    -pressure_guess last -history_every 4e-5 -output "own$n.h5" >"own$n.out"
  csv_column "own$n.csv" pressure_iterations | tail -n +2 >own
  h5dump -d /study/001/history -y -w 0 "stepping$n.h5" | sed -n '/DATA {/,/}/p' | tr -d ' }' | grep '^[0-9]' |
    tr ',' '\n' | grep . >along
  [ "$(wc -l <own)" -eq 30 ] || fail "$(wc -l <own) steps"
  # the residuals of two runs that differ by rounding may pass the tolerance one iteration apart
  paste own along | awk '{ d = $1 - $2; if (d < -1 || d > 1) exit 1; sum += d != 0 } END { exit sum > 6 }' ||
    fail "iterations differ: $(paste -sd ' ' own) and $(paste -sd ' ' along)"
done
[ "$(csv_column stepping1.csv failed | sort -u)" = 0 ] || fail 'solves failed'
[ "$(csv_column stepping1.csv solver | paste -sd ' ')" = 'cg-jacobi cg-icc' ] || fail 'solvers'
# lists are built on the way, with the narrow skin, and the diagonal is rebuilt when discs are renumbered
awk -v l="$(csv_column stepping1.csv list_builds | head -n 1)" 'BEGIN { exit !(l > 0) }' || fail 'no list was built'
[ "$(csv_column stepping1-windows.csv last_step | paste -sd ' ')" = '7 15 22 30 7 15 22 30' ] || fail 'windows'

# processors: 2
# timeout: 120
# The shipped files: each panel file runs some fluid steps with either pressure, each solver file converges; -log_view
# shows a stage for every phase of the step.
. "$SOURCE_DIR/tests/support/regress.sh"

options="$SOURCE_DIR/options"
runs=0

# short NAME options...: in the background
short() {
  local name=$1
  shift
  runs=$((runs + 1))
  while [ "$(jobs -rp | wc -l)" -ge "$abreast" ]; do wait -n || true; done
  {
    "$POROGRAIN" "$@" -output "$name.h5" >"$name.log" 2>&1 </dev/null || { echo "$name: $*" && tail -n 3 "$name.log"; } >"$name.failed"
  } &
}

none_failed() {
  wait
  if ls ./*.failed >/dev/null 2>&1; then
    cat ./*.failed >&2
    fail "option files"
  fi
}

# ---- panel files ----
for case in case1_dry case1_darcy case1_ns case2_darcy case2_ns; do
  for reading in '' _paper _literal; do
    file="$options/panel_$case$reading.opts"
    [ -f "$file" ] || fail "no $file"
    # four fluid steps of 1e-4 s, or twenty of 1e-6 s
    way=2.5e-5
    [ -z "$reading" ] || way=1.25e-6
    if [ $case = case1_dry ]; then
      short "$case$reading" -options_file "$file" -panel_displacement $way
      continue
    fi
    for pressure in explicit implicit; do
      short "$case$reading-$pressure" -options_file "$file" -panel_displacement $way -pressure $pressure
    done
  done
done
none_failed
[ $runs -eq 27 ] || fail "$runs runs"
if [ "$(find "$options" -maxdepth 1 -name '*.opts' ! -name 'up_*' ! -name 'wcsph_*' ! -name 'tak_*' | wc -l)" -ne 15 ]; then fail "not 15 files in options/"; fi
# What the files say is what is run.
expect_match 'time step 2.0000e-06 s.*; water every 50 steps, 1.0000e-04 s; 250 steps' case1_ns-implicit.log
expect_match 'theta 1\.?, continuity averaged' case1_ns-implicit.log
expect_match 'coupling drag_and_pressure by projection' case1_darcy-implicit.log
expect_match 'top: flux -0.13 m/s' case2_ns_paper-explicit.log
expect_match 'left: natural' case1_darcy_literal-explicit.log
expect_match 'pressure: explicit' case1_ns_paper-explicit.log

# ---- solver files, after a case ----
count=0
for file in "$options"/solvers/*.opts; do
  count=$((count + 1))
  short "solver-$(basename "$file" .opts)" -options_file "$options/panel_case1_ns.opts" -panel_displacement 2.5e-5 \
    -options_file "$file"
done
none_failed
[ $count -ge 10 ] || fail "only $count solver files"
for history in solver-*.csv; do
  # ten times the tolerance of 1e-8, as the run itself bears
  csv_column "$history" pressure_residual | awk 'NR > 1 && !($1 > 0 && $1 <= 1e-7) { bad = 1 } END { exit bad || NR < 5 }' ||
    fail "$history: $(csv_column "$history" pressure_residual | paste -sd ' ')"
done

# Files of solvers stack: behind any other, in the command or in a file that names both, each gives the solver that it is alone.
"$SUPPORT/stacked_solvers" "$options"/solvers/*.opts >stacked.log 2>stacked.err || { cat stacked.log stacked.err | tail -n 40 >&2; fail 'files of solvers'; }
expect_match "^$((count * (count - 1))) pairs, 0 wrong$" stacked.err

# PETSc reads this one only when it solves.
"$POROGRAIN" -fluid ns -panel_columns 5 -end_time 1e-5 -pressure_ksp_converged_reason >reason.log 2>&1 ||
  { cat reason.log >&2; fail '-pressure_ksp_converged_reason'; }
expect_match 'solve converged due to CONVERGED_' reason.log

# ---- one stage for each phase of the step (ghost values travel on two ranks only) ----
run 2 "$POROGRAIN" -case panel -panel_columns 10 -fluid ns -dt 2e-6 -end_time 2e-4 -neighbors_skin 2e-3 -output stages.h5 \
  -log_view >stages.log 2>&1 || fail '-log_view'
sed -n '/^Summary of Stages/,/^---/p' stages.log >stages.txt
for stage in setup lists halo contact integrate porosity geometry predictor source assemble pressure corrector output; do
  expect_match "^ *[0-9]+: +$stage: " stages.txt
done

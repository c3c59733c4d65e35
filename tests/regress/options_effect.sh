# processors: 2
# timeout: 120
# Options without effect: each row of src/simulation/rules.c ends a run before anything is written, with a message that
# names option, value and why; unless it stands in a file and was overruled later, which one line of warning says.
. "$SOURCE_DIR/tests/support/regress.sh"

options="$SOURCE_DIR/options"
runs=0
here=$PWD

# wrong MESSAGE...: the run of this folder is not as expected
wrong() { printf '%s\n' "$@" >>wrong; }

# begin: a folder for the next run. Runs are made side by side, since starting one is waiting more than work, and looked at
# in the end.
begin() {
  runs=$((runs + 1))
  if [ $runs -gt 4 ]; then wait -n || true; fi # all may have ended
  folder=$here/run-$runs
  mkdir "$folder"
}

# refuses options...: several at once, all of them are named
refuses() {
  begin
  {
    cd "$folder"
    status=0
    "$POROGRAIN" -end_time 1e-5 "$@" >out 2>&1 </dev/null || status=$?
    [ $status -eq 2 ] || wrong "exit status $status: $*" "$(tail -n 3 out)"
    if grep -q '^warning: without' out; then wrong "warned and refused: $*"; fi
    sed -n 's/^porograin: error: //p' out | sort >refused
  } &
}

# said MESSAGE...: by the run before, these and no others
said() { printf '%s\n' "$@" | sort >"$folder/expected"; }

# warns LINE options...: runs to its end, and this is the one line of warning about options ("": none)
warns() {
  local line=$1
  shift
  begin
  {
    cd "$folder"
    "$POROGRAIN" "$@" -output run.h5 >out 2>&1 </dev/null || wrong "$*" "$(tail -n 3 out)"
    [ -e run.h5 ] || wrong 'no results'
    { grep '^warning: without effect' out || true; } >warning
    printf '%s' "${line:+$line$'\n'}" | diff - warning >difference || wrong "another warning: $*" "$(cat difference)"
  } &
}

# settle: what was said by all runs so far
settle() {
  local folder
  wait
  for folder in run-*; do
    [ ! -e "$folder/expected" ] || diff "$folder/expected" "$folder/refused" || fail 'other messages than expected'
    [ ! -e "$folder/wrong" ] || { cat "$folder/wrong" >&2; fail "$folder"; }
  done
}

refuses -fluid_every 4 -output_every 1e-5 -checkpoint_every 1e-5 -progress none -progress_every 1e-5 -wall_friction 0.3 \
  -wall_servo_gain 0.1 -ns_theta 0.6
said 'option -fluid_every 4 has no effect with -fluid none (the default): there is no water to step' \
  'option -output_every 1e-5 has no effect without -output: there is no file for snapshots' \
  'option -checkpoint_every 1e-5 has no effect without -checkpoint: there is no file for checkpoints' \
  'option -progress_every 1e-5 has no effect with -progress none: there are no lines of progress' \
  'option -wall_friction 0.3 has no effect in a run without walls: there is nothing that it belongs to' \
  'option -wall_servo_gain 0.1 has no effect in a run without servo walls: there is nothing that it belongs to' \
  'option -ns_theta 0.6 has no effect with -fluid none (the default): it belongs to the Navier-Stokes scheme'

refuses -fluid ns -permeability 1e-6 -permeability_law constant -coupling_scheme staggered -porosity_rate sampled \
  -bc_left impermeable -bc_left_pressure 2e5 -bc_left_flux 0.1 -bc_right flux -bc_right_flux 0 -bc_right_pressure 2e5 \
  -bc_bottom natural -bc_bottom_flux 0.1 -bc_bottom_pressure 2e5 -bc_top_flux -0.13 -bc_surface_sum 0.9 \
  -sph_operators paper -sph_gradient corrected -sph_laplacian paper -pressure implicit -pressure_sweeps 3 \
  -pressure_dump_every 5 -pressure_pc_type jacobi -pressure_pc_hypre_type boomeramg
said \
  'option -permeability 1e-6 has no effect with -fluid ns: the Navier-Stokes scheme has a drag law (-ns_drag) in its place' \
  'option -permeability_law constant has no effect with -fluid ns: the Navier-Stokes scheme has a drag law (-ns_drag) in its place' \
  'option -coupling_scheme staggered has no effect with -coupling drag (the default): the drag alone needs no scheme' \
  'option -porosity_rate sampled has no effect with -fluid ns, with -ns_continuity solenoidal (the default): div u = 0 does not contain the rate of the porosity' \
  'option -bc_left_pressure 2e5 has no effect with -bc_left impermeable: only a drained side has a pressure' \
  'option -bc_left_flux 0.1 has no effect with -bc_left impermeable: only a flux side has a flux' \
  'option -bc_right_pressure 2e5 has no effect with -bc_right flux: only a drained side has a pressure' \
  'option -bc_bottom_pressure 2e5 has no effect with -bc_bottom natural: only a drained side has a pressure' \
  'option -bc_bottom_flux 0.1 has no effect with -bc_bottom natural: only a flux side has a flux' \
  'option -bc_top_flux -0.13 has no effect with -bc_top drained (the default): only a flux side has a flux' \
  'option -bc_surface_sum 0.9 has no effect with -bc_tracking initial (the default): discs do not become surface later' \
  'option -sph_operators paper has no effect with -sph_gradient corrected, with -sph_laplacian paper: these two say all that there is to choose' \
  'option -pressure_sweeps 3 has no effect with -pressure implicit: only explicit steps are made of sweeps' \
  'option -pressure_dump_every 5 has no effect without -pressure_dump: there is no file for systems' \
  'option -pressure_pc_hypre_type boomeramg has no effect with -pressure_pc_type jacobi: it belongs to another preconditioner'

solves='has no effect with -pressure explicit: only -pressure implicit has a solver and its tolerances'
refuses -fluid darcy -ns_drag linear -bc_top impermeable -bc_top_pressure 2e5 -bc_right_flux 1 -pressure explicit \
  -pressure_pc_lag 2 -pressure_rebuild_factor 2 \
  -pressure_error_if_not_converged false -pressure_ksp_type cg -pressure_pc_type gamg -pressure_sub_pc_type icc \
  -pressure_mg_levels_ksp_type cg -pressure_mat_type aij
said 'option -ns_drag linear has no effect with -fluid darcy: it belongs to the Navier-Stokes scheme' \
  'option -bc_top_pressure 2e5 has no effect with -bc_top impermeable: only a drained side has a pressure' \
  'option -bc_right_flux 1 has no effect with -bc_right drained (the default): only a flux side has a flux' \
  "option -pressure_pc_lag 2 $solves" "option -pressure_rebuild_factor 2 $solves" \
  "option -pressure_error_if_not_converged false $solves" "option -pressure_ksp_type cg $solves" \
  "option -pressure_pc_type gamg $solves" "option -pressure_sub_pc_type icc $solves" \
  "option -pressure_mg_levels_ksp_type cg $solves" "option -pressure_mat_type aij $solves"

packing=(-case packing -packing_generate random -packing_size 0.1,0.1 -packing_target_porosity 0.3 -dt 1e-6)
refuses "${packing[@]}" -packing_aspect 2 \
  -packing_second_share 0.2 -packing_plate_distance 0.3 -packing_side_distance 1 -packing_porosity 0.2 -plate_friction 0.1
said 'option -packing_aspect 2 has no effect without -packing_count: -packing_size has an aspect of its own' \
  'option -packing_second_share 0.2 has no effect without -packing_second_radius: there is one size of discs only' \
  'option -packing_plate_distance 0.3 has no effect without -packing_plates: there are no plates' \
  'option -packing_side_distance 1 has no effect with -fluid none (the default): only water sees these sides' \
  'option -packing_porosity 0.2 has no effect with -fluid none (the default), without -output: only water and result files have a porosity' \
  'option -plate_friction 0.1 has no effect in a run without plates: there is nothing that it belongs to'

rolling='has no effect with -dem_contact_law hertz: only that law has a rolling resistance'
refuses -dem_contact_law hertz -dem_bond_normal 1e3 -dem_k_n 1e8 -dem_k_r 1 -dem_k_theta 1 -dem_c_r 1 -dem_c_theta 1 -dem_mu_r 0.1 \
  -dem_mu_theta_r 1e-5 -dem_energy
said 'option -dem_bond_normal 1e3 has no effect with -dem_contact_law hertz: only that law has bonds' \
  "option -dem_k_n 1e8 has no effect with -dem_contact_law hertz: Hertz' law takes the stiffness from the material" \
  "option -dem_k_r 1 $rolling" "option -dem_k_theta 1 $rolling" "option -dem_c_r 1 $rolling" "option -dem_c_theta 1 $rolling" \
  "option -dem_mu_r 0.1 $rolling" "option -dem_mu_theta_r 1e-5 $rolling" \
  'option -dem_energy has no effect with -dem_contact_law hertz: the accounts are those of that law'
refuses -dem_hertz_young 1e9
said 'option -dem_hertz_young 1e9 has no effect with -dem_contact_law li2007 (the default): only that law asks for an elastic material'
refuses -case bed_darcy -bed_layer_radius 4e-3
said 'option -bed_layer_radius 4e-3 has no effect without -bed_layer_rows: there is one layer only'
factored='has no effect with -pressure_ksp_type preonly: the matrix of each solve is factored anew'
refuses -fluid ns -pressure_ksp_type preonly -pressure_pc_type lu -pressure_pc_lag 3 -pressure_rebuild_factor 2 -pressure_guess last
said "option -pressure_pc_lag 3 $factored" "option -pressure_rebuild_factor 2 $factored" \
  'option -pressure_guess last has no effect with -pressure implicit (the default), with -pressure_ksp_type preonly, in a run without a free level of pressure: a factor gives the solution from any start'
refuses -fluid ns -pressure_pc_lag 1 -pressure_rebuild_factor 2
said 'option -pressure_rebuild_factor 2 has no effect with -pressure_pc_lag 1: each solve has a preconditioner of its own'
refuses -fluid ns -pressure_ksp_type richardson -pressure_ksp_max_it 1 -pressure_rebuild_factor 2
said 'option -pressure_rebuild_factor 2 has no effect with -pressure_ksp_type richardson, with -pressure_ksp_max_it 1: iterations do not grow when there is one'

# No row of the table is left out.
settle
cat run-*/refused >all-refused
sed -n 's/^ *{"\(-[a-z_]*\)\*\{0,1\}",.*/\1/p; s/^ *SIDE("\([a-z]*\)").*/-bc_\1_pressure\n-bc_\1_flux/p' \
  "$SOURCE_DIR/src/simulation/rules.c" >rows
[ "$(wc -l <rows)" -ge 40 ] || fail "only $(wc -l <rows) rows found"
while read -r row; do
  grep -q -- "^option $row" all-refused || fail "no test of the row $row"
done <rows

# ---- the same place: an error, whichever stands first; another place: the later one wins, and a line says so ----
refuses -dt 1e-6 -dt_safety 0.2
said 'options -dt 1e-6 and -dt_safety 0.2 contradict each other: give one'
printf -- '-fluid ns\n-pressure_ksp_type cg\n-pressure explicit\n' >one.opts
vain='has no effect with -pressure explicit'
refuses -options_file ../one.opts
said "option -pressure_ksp_type cg $vain ('../one.opts'): only -pressure implicit has a solver and its tolerances"
# before and behind the name of another file is one place
printf -- '-fluid ns\n' >water.opts
printf -- '-pressure_ksp_type cg\n-options_file ../water.opts\n-pressure explicit\n' >around.opts
refuses -options_file ../around.opts
said "option -pressure_ksp_type cg $vain ('../around.opts'): only -pressure implicit has a solver and its tolerances"
# a file is on top of those that it names, as the command line is on top of its files
printf -- '-options_file ../one.opts\n-pressure_ksp_rtol 1e-6\n' >top.opts
refuses -options_file ../top.opts
said "option -pressure_ksp_type cg $vain ('../one.opts'): only -pressure implicit has a solver and its tolerances" \
  "option -pressure_ksp_rtol 1e-6 $vain ('../one.opts'): only -pressure implicit has a solver and its tolerances"
# text in YAML on the command line is the command line
refuses -fluid ns -pressure explicit -options_string_yaml 'pressure_ksp_type: cg'
said "option -pressure_ksp_type cg $vain: only -pressure implicit has a solver and its tolerances"
refuses -options_string_yaml $'fluid: ns\npressure: explicit' -pressure_ksp_type cg
said "option -pressure_ksp_type cg $vain: only -pressure implicit has a solver and its tolerances"
# what the file says comes before: the option on top of it is in vain
refuses -options_file "$options/panel_case1_ns_paper.opts" -pressure_ksp_type cg
said "option -pressure_ksp_type cg has no effect with -pressure explicit ('$options/panel_case1_ns_paper.opts'): only -pressure implicit has a solver and its tolerances"
# a case brings options along; they are chosen with it
refuses -case column_terzaghi -ns_theta 0.6
said 'option -ns_theta 0.6 has no effect with -fluid darcy: it belongs to the Navier-Stokes scheme'

short=(-panel_columns 4 -panel_rows 9 -panel_displacement 6.18e-7)
case1="$options/panel_case1_ns.opts"
warns '' -options_file "$case1" "${short[@]}"
warns 'warning: without effect: -pressure_sweeps 1 (-pressure implicit overrules it)' \
  -options_file "$options/panel_case1_ns_paper.opts" -pressure implicit -pressure_ksp_type cg "${short[@]}"
# files in their order; the solver's own options are read by nobody now
warns 'warning: without effect: -pressure_ksp_max_it 1000, -pressure_ksp_norm_type unpreconditioned, -pressure_ksp_pc_side left, -pressure_ksp_type cg, -pressure_pc_hypre_boomeramg_agg_nl 1, -pressure_pc_hypre_boomeramg_relax_type_down symmetric-SOR/Jacobi, -pressure_pc_hypre_boomeramg_relax_type_up symmetric-SOR/Jacobi, -pressure_pc_type hypre (-pressure explicit overrules them)' \
  -options_file "$case1" -options_file "$options/solvers/cg-hypre-aggressive.opts" -pressure explicit "${short[@]}"
warns 'warning: without effect: -bc_left_pressure 1e5 (-bc_left impermeable overrules it); -bc_top_flux -0.13 (-bc_top drained overrules it)' \
  -options_file "$options/panel_case2_ns_paper.opts" -bc_top drained -bc_left impermeable "${short[@]}"
sides=$folder
warns 'warning: without effect: -dt 2e-6 (-dt_safety 0.25 overrules it); -panel_displacement 0.012 (-end_time 1e-5 overrules it)' \
  -options_file "$case1" "${short[@]:0:4}" -end_time 1e-5 -dt_safety 0.25
safety=$folder
# water options of the file in a dry run
warns "$(sed -n 's/^\(-[a-z_]*  *[^ ]*\).*/\1/p' "$case1" | sed 's/  */ /' |
  grep -E '^-(fluid_|ns_|bc_|coupling|initial|porosity|pressure|sph)' | sort |
  awk '{ list = list (list ? ", " : "") $0 } END { print "warning: without effect: " list " (-fluid none overrules them)" }')" \
  -options_file "$case1" "${short[@]}" -fluid none
# Files of solvers stack: what the first solver wanted is idle with the second.
warns 'warning: without effect: -pressure_sub_pc_factor_mat_ordering_type rcm, -pressure_sub_pc_factor_mat_solver_type petsc, -pressure_sub_pc_type icc (-pressure_pc_type jacobi overrules them)' \
  -options_file "$case1" "${short[@]}" -options_file "$options/solvers/cg-icc.opts" -pressure_pc_type jacobi
warns 'warning: without effect: -pressure_pc_gamg_threshold 0.05 (-pressure_pc_type hypre overrules it)' \
  -options_file "$case1" "${short[@]}" -options_file "$options/solvers/cg-gamg-threshold.opts" -options_file "$options/solvers/cg-hypre.opts"
refuses -options_file "$case1" "${short[@]:0:4}" -pressure_ksp_type preonly -pressure_pc_type cholesky -pressure_ksp_max_it 3
said 'option -pressure_ksp_max_it 3 is not read by the solver of this run'
# where all sides are closed the guess has the level of the pressure
closed=(-bc_left impermeable -bc_right impermeable -bc_top impermeable -bc_bottom impermeable)
warns '' -fluid ns "${short[@]}" "${closed[@]}" -options_file "$options/solvers/mumps.opts" -pressure_guess last
# a switch thrown on top of a file that another file names
printf -- '-fluid ns\n-pressure_ksp_type cg\n' >solver.opts
printf -- '-options_file ../solver.opts\n-pressure explicit\n' >switched.opts
warns 'warning: without effect: -pressure_ksp_type cg (-pressure explicit overrules it)' -options_file ../switched.opts "${short[@]}"
# PETSC_OPTIONS is a file, too, and so is PETSC_OPTIONS_YAML
PETSC_OPTIONS_YAML='pressure_ksp_rtol: 1e-9' warns 'warning: without effect: -pressure_ksp_rtol 1e-9 (-pressure explicit overrules it)' \
  -fluid ns -pressure explicit "${short[@]}"
PETSC_OPTIONS='-pressure_ksp_rtol 1e-9' warns 'warning: without effect: -pressure_ksp_rtol 1e-9 (-pressure explicit overrules it)' \
  -fluid ns -pressure explicit "${short[@]}"
settle
grep -q 'left: impermeable' "$sides/out" && grep -q 'top: drained at 100000' "$sides/out" || fail 'the sides of the command line'
expect_match 'time step .*, 25.0 % of the critical' "$safety/out"

# A program that does something else than its work looks at nothing in the file of the run, and bears nothing beside it.
"$POROGRAIN" -options_file "$case1" -recover "$folder/run.h5" >recover.log 2>&1 || { cat recover.log >&2; fail '-recover behind a file'; }
expect_match "nothing to undo; it holds [0-9]+ snapshots" recover.log
[ "$(wc -l <recover.log)" -eq 1 ] || fail "-recover: $(cat recover.log)"
expect_error 2 '^porograin: error: option -recover does its work alone and has no use for -dt 1, -end_time 3$' \
  "$POROGRAIN" -end_time 3 -recover "$folder/run.h5" -dt 1

# ---- a singular system that the solver chosen cannot bear: said so ----
block() { awk -v at="$1" 'BEGIN { for (k = 0; k < 25; k++) printf "%g,%g,0.005\n", at + 0.01 * (k % 5), 0.005 + 0.01 * int(k / 5) }'; }
{ echo x,y,radius && block 0.005 && block 0.205; } >islands.csv
islands=(-case packing -packing islands.csv -fluid ns -ns_continuity averaged -bc_left drained -bc_right flux -bc_right_flux -0.1
  -bc_top impermeable -bc_bottom impermeable -packing_porosity 0.2 -detach_porosity 0.9 -detach_kernel_sum 0 -dt 1e-6 -end_time 1e-5)
loose='nothing ties 25 discs \(disc 25 is one\) to a prescribed pressure'
expect_error 3 "pressure: $loose, and the corrected Laplacian is not symmetric: .* use -sph_laplacian paper; the solver " \
  "$POROGRAIN" "${islands[@]}" -sph_laplacian corrected
expect_error 3 "pressure: the matrix is singular, as $loose, and has no complete factor: .*DIVERGED_PC_FAILED .*\(lu\) .*ZEROPIVOT; the system" \
  "$POROGRAIN" "${islands[@]}" -pressure_ksp_type preonly -pressure_pc_type lu
if grep -qi nan expect_error.out; then fail "$(cat expect_error.out)"; fi

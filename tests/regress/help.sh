# timeout: 180
# -help is short and says how to see more; every room has its section; -version names what the program stands on;
# docs/options.md is what the programs say.
. "$SOURCE_DIR/tests/support/regress.sh"

# lines NAME MOST: the file has at most so many lines
lines() { [ "$(wc -l <"$1")" -le "$2" ] || fail "$1 has $(wc -l <"$1") lines"; }

# ---- short ----
"$POROGRAIN" -help -fluid ns -panel_columns 4 -end_time 1e-5 -output run.h5 >short.txt 2>short.err || fail "-help: status $?"
[ ! -e run.h5 ] || fail '-help runs'
[ ! -s short.err ] || fail "-help: $(cat short.err)"
# what a terminal of ordinary height shows in two pages, and the options of the first try
lines short.txt 80
for pattern in '^  porograin -options_file options/panel_case1_ns\.opts' '^  -case$' '^  -fluid$' '^  dem +discs in contact$' \
  '^  pressure ' '^  water ' '^    panel: hexagonal packing' '^-version' '^Exit status: 0 done, 2 bad input'; do
  expect_match "$pattern" short.txt
done
if grep -q 'Options for all PETSc programs' short.txt; then fail 'the help of PETSc'; fi

# ---- sections, with units, bounds and equations, whatever the run ----
section() {
  local name=$1 option
  shift
  "$POROGRAIN" -help "$name" >"$name.txt" || fail "-help $name: status $?"
  for option; do expect_match "^  $option( |\$)" "$name.txt"; done
}
beside section run -case -fluid -dt -end_time -gravity
beside section output -output -checkpoint -restart -recover
beside section particles -particles_balance
beside section neighbors -neighbors_skin
beside section dem -dem_k_n -plate_friction
beside section water -ns_theta -bc_left_pressure -permeability -porosity
beside section sph -sph_laplacian_eta
beside section pressure -pressure -pressure_sweeps -pressure_ksp_type -pressure_ksp_rtol -pressure_pc_type
beside section panel -panel_columns -panel_displacement
beside section column_terzaghi -column_load
beside section undrained -column_load
beside section ns_theta -ns_theta
together
[ "$(grep -c '^  -' ns_theta.txt)" -eq 1 ] || fail '-help ns_theta shows more than that'
grep -A 2 '^  -dem_k_n \[N/m\]$' dem.txt >one.txt
expect_match 'Normal stiffness, Eq\. 8' one.txt
expect_match 'default 6e\+08; allowed: > 0' one.txt
grep -A 2 '^  -permeability \[m4/(N s)\]$' water.txt >one.txt
expect_match 'Eq\. 26' one.txt
"$POROGRAIN" -help all >all.txt
for option in case particles_balance neighbors_skin dem_k_n ns_theta sph_kernel pressure_sweeps panel_rows packing \
  biaxial_stress; do
  expect_match "^  -$option( |\$)" all.txt
done
# The word that the short help gives as an example leads to options, of each program.
for program in "$POROGRAIN" "$POROGRAIN_STUDY" "$POROGRAIN_PLOT"; do
  "$program" -help >short.txt
  word=$(sed -n 's/.* all whose names hold this word: -help //p' short.txt)
  [ -n "$word" ] || fail "no example in the help of $program"
  "$program" -help "$word" >word.txt || fail "-help $word of $program"
done
expect_error 2 "no section and no option 'dem_kn'; did you mean -dem_k_n\?" "$POROGRAIN" -help dem_kn
expect_error 2 "no section and no option 'nothing_like_it'" "$POROGRAIN" -help nothing_like_it

# ---- PETSc's own, with what this command line chooses ----
"$POROGRAIN" -fluid ns -panel_columns 4 -pressure_ksp_type gmres -help petsc -output run.h5 >petsc.txt 2>&1 ||
  fail "-help petsc: status $?"
expect_match '^  -pressure_ksp_gmres_restart <' petsc.txt
expect_match '^  -dem_k_n: <now 6e\+08>: .*Eq\. 8 \[N/m\]' petsc.txt
[ ! -e run.h5 ] || fail '-help petsc runs'

# ---- versions, once on two ranks ----
run 2 "$POROGRAIN" -version >version.txt || fail "-version: status $?"
[ "$(grep -c '^porograin [0-9]' version.txt)" -eq 1 ] || fail "-version: $(cat version.txt)"
for pattern in '^revision .*, build type ' '^PETSc 3\.[0-9]+' '^hypre' '^HDF5 1\.' '^MPI .*[0-9]'; do
  expect_match "$pattern" version.txt
done
"$POROGRAIN_STUDY" --version | grep -q '^porograin-study [0-9]' || fail 'porograin-study --version'
"$POROGRAIN_PLOT" -version | grep -q '^porograin-plot [0-9]' || fail 'porograin-plot -version'

# ---- the other programs ----
"$POROGRAIN_STUDY" -help >study.txt
lines study.txt 90
expect_match '^  study +solvers' study.txt
"$POROGRAIN_STUDY" -help study >study.txt
expect_match '^  -study_mms_levels$' study.txt
"$POROGRAIN_PLOT" -help >plot.txt
expect_match '^  -plot_fields$' plot.txt

# ---- the table in the docs ----
bash "$SOURCE_DIR/tests/support/options_table.sh" "$(dirname "$POROGRAIN")" options.md
cmp options.md "$SOURCE_DIR/docs/options.md" || {
  diff "$SOURCE_DIR/docs/options.md" options.md | head -n 20 >&2
  fail 'docs/options.md is not what the programs say: bash tests/support/options_table.sh BUILD'
}
[ "$(grep -c '^| `-' options.md)" -ge 150 ] || fail "only $(grep -c '^| `-' options.md) options"

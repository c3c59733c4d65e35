# processors: 2
# timeout: 120
# Wrong input ends the run before anything is written, with one message that names option, value and what was expected,
# and with exit status 2 (4 when a file cannot be read or written).
. "$SOURCE_DIR/tests/support/regress.sh"

here=$PWD
rows=0
ranks=1
messages=1

# check NUMBER STATUS PATTERN argument...: in a folder of its own, where nothing may remain
check() {
  local number=$1 status=$2 pattern=$3 got=0 log="$here/row-$1.log" folder="$here/row-$1" arguments
  shift 3
  mkdir "$folder"
  cd "$folder"
  # small, and not for ever: what is accepted by mistake runs to its end
  arguments=(-panel_columns 4 "$@")
  if [[ " $* " != *" -output"* ]]; then arguments=(-output run.h5 "${arguments[@]}"); fi
  run $ranks timeout 30 "$POROGRAIN" "${arguments[@]}" >"$log" 2>&1 </dev/null || got=$?
  {
    [ "$got" -eq "$status" ] || echo "exit status $got, expected $status"
    grep -Eq -- "^porograin: error: .*$pattern" "$log" || echo "no message like '$pattern'"
    [ "$(grep -c '^porograin: error:' "$log")" -eq $messages ] || echo "not $messages message"
    if grep -q 'PETSC ERROR' "$log"; then echo "a call stack of PETSc"; fi
    [ -z "$(ls -A)" ] || echo "written: $(ls -A)"
  } >"$here/row-$number.wrong"
  if [ -s "$here/row-$number.wrong" ]; then
    { echo "-- $*" && sed 's/^/   /' "$here/row-$number.wrong" && head -n 5 "$log"; } >"$here/row-$number.failed"
  fi
}

# row STATUS PATTERN argument...: four at a time, since starting MPI is waiting more than work
running=0
most=4
row() {
  rows=$((rows + 1))
  if [ $running -ge $most ]; then wait -n; else running=$((running + 1)); fi
  check $rows "$@" &
}
settle() {
  wait
  running=0
}

# ---- unknown and misspelt: the nearest known name ----
row 2 'unknown option -panel_colums 12; did you mean -panel_columns\?' -panel_colums 12
row 2 'unknown option -dem_kn 1e8; did you mean -dem_k_n\?' -dem_kn 1e8
row 2 'unknown option -bc_letf drained; did you mean -bc_left\?' -fluid ns -bc_letf drained
row 2 'unknown option -ns_teta 0.6; did you mean -ns_theta\?' -fluid ns -ns_teta 0.6
row 2 'unknown option -permeabilty 1e-6; did you mean -permeability\?' -fluid darcy -permeabilty 1e-6
row 2 'unknown option -nothing_like_it 5; -help all lists all' -nothing_like_it 5
row 2 'unknown option -pressure_ksp_rtoll 1e-6; did you mean -pressure_ksp_rtol\?' -fluid ns -pressure_ksp_rtoll 1e-6
row 2 'unknown option -pressure_ksp_tpye cg; did you mean -pressure_ksp_type\?' -fluid ns -pressure_ksp_tpye cg
row 2 'unknown option -pressure_pc_tpye jacobi; did you mean -pressure_pc_type\?' -fluid ns -pressure_pc_tpye jacobi
row 2 'unknown option -pressure_pc_hypre_boomeramg_strong_treshold 0.5; did you mean -pressure_pc_hypre_boomeramg_strong_threshold\?' \
  -fluid ns -pressure_pc_hypre_boomeramg_strong_treshold 0.5
row 2 'unknown option -pressure_mg_levels_ksp_typ cg; did you mean -pressure_mg_levels_(1_)?ksp_type\?' \
  -fluid ns -pressure_pc_type gamg -pressure_mg_levels_ksp_typ cg
row 2 'unknown option -pressure_sub_pc_typ icc; did you mean -pressure_sub_pc_type\?' \
  -fluid ns -pressure_pc_type bjacobi -pressure_sub_pc_typ icc
row 2 'unknown option -options_fil x; did you mean -options_file\?' -options_fil x -panel_columns 5 -end_time 1e-5
row 2 'unknown option -log_veiw; did you mean -log_view\?' -log_veiw -panel_columns 5 -end_time 1e-5
messages=2
row 2 'unknown option -dem_kn 1e8; did you mean -dem_k_n\?' -dem_kn 1e8 -panel_colums 12
settle
messages=1

# ---- out of range: value, unit and bound ----
row 2 'option -panel_columns: 2 is out of range, .* between 3 and 40000' -panel_columns 2
row 2 'option -panel_rows: 2 is out of range, .* between 3 and' -panel_rows 2
row 2 'option -dt: 0 s is out of range, it must be > 0 s and <= 1000 s$' -dt 0
row 2 'option -dt: -1e-6 s is out of range, it must be > 0 s and <= 1000 s$' -dt -1e-6
row 2 'option -dt: 1e-05 s is above the critical time step 6\.4[0-9]*e-06 s' -dt 1e-5
row 2 'option -dem_local_damping: 1\.5 is out of range, it must be >= 0 and <= 1$' -dem_local_damping 1.5
row 2 'option -dem_mu_s: -0\.1 is out of range, it must be >= 0$' -dem_mu_s -0.1
row 2 'option -solid_density: -2000 kg/m3 is out of range, it must be > 0 kg/m3 and <= 1e\+06 kg/m3$' -solid_density -2000
row 2 'option -ns_theta: 0 is out of range, it must be >= 0.01 and <= 1$' -fluid ns -ns_theta 0
row 2 'option -ns_theta: 1\.01 is out of range, it must be >= 0.01 and <= 1$' -fluid ns -ns_theta 1.01
row 2 'option -permeability: 0 m4/\(N s\) is out of range, it must be > 0 m4/\(N s\) and <= 1000 m4/\(N s\)$' -fluid darcy -permeability 0
row 2 'option -detach_porosity: 1\.2 is out of range, it must be >= 0 and <= 0.99$' -fluid ns -detach_porosity 1.2
row 2 'option -sph_laplacian_eta: -0\.1 is out of range, it must be >= 0 and <= 1$' -fluid ns -sph_laplacian_eta -0.1
row 2 'option -fluid_every: 0 is out of range, .* between 1 and' -fluid ns -fluid_every 0
row 2 'option -pressure_sweeps: 0 is out of range, .* between 1 and' -fluid ns -pressure explicit -pressure_sweeps 0
row 2 'option -panel_columns: -5 is out of range, .* between 3 and' -panel_columns -5
row 2 'option -panel_columns: 99999999999999999999 is out of range, .* between 3 and' -panel_columns 99999999999999999999
row 2 'option -pressure_ksp_rtol: 2 is out of range, it must be >= 0 and < 1' -fluid ns -pressure_ksp_rtol 2
row 2 'option -pressure_ksp_rtol: nan is out of range' -fluid ns -pressure_ksp_rtol nan
row 2 'option -pressure_ksp_max_it: -5 is out of range, it must be >= 1' -fluid ns -pressure_ksp_max_it -5
row 2 'the run has no end' -end_time 0
row 2 'option -particles_balance: 0\.5 is out of range, it must be >= 1$' -particles_balance 0.5
row 2 'option -neighbors_skin: 0 is out of range, it must be >=' -neighbors_skin 0

# ---- not a number, and missing values ----
row 2 "option -dt: 'fast' is not a number" -dt fast
row 2 "option -dem_k_n: '6e8x' is not a number" -dem_k_n 6e8x
row 2 'option -panel_columns: 12.5 is not a whole number' -panel_columns 12.5
row 2 'option -dem_k_n: inf is not a finite number' -dem_k_n inf
row 2 'option -dt: nan is not a finite number' -dt nan
row 2 "option -gravity: '0' has 1 values, it needs 2" -gravity 0
row 2 "option -gravity: 'down' is not a number" -gravity 0,down
row 2 "option -pressure_ksp_rtol: 'tight' is not a number" -fluid ns -pressure_ksp_rtol tight
row 2 "option -pressure_ksp_max_it: 'many' is not a whole number" -fluid ns -pressure_ksp_max_it many
row 2 "option -pressure_ksp_monitor_cancel: 'maybe' is not one of true, false" -fluid ns -pressure_ksp_monitor_cancel maybe
row 2 "option -pressure_pc_gamg_threshold: 'thin' is not a number" \
  -fluid ns -pressure_pc_gamg_threshold thin -pressure_pc_type gamg
row 2 "option -dt: '1e-3x' is not a number" -dt 1e-3x
row 2 "option -dt: '1e-6,2e-6' is not a number" -dt 1e-6,2e-6
row 2 'option -dt: 1e999 is not a finite number' -dt 1e999
row 2 'option -gravity: nan is not a finite number' -gravity 0,nan
row 2 "option -gravity: '1,2,3' has 3 values, it needs 2" -gravity 1,2,3
row 2 "option -panel_columns: '4k' is not a number" -panel_columns 4k
row 2 'option -fp_trap: .*maybe' -fp_trap maybe
row 2 'option -dt needs a number' -dt
row 2 'option -dem_k_n needs a number' -dem_k_n -fluid none
row 2 'option -output needs a value' -output
row 2 'option -fluid.* one of none, darcy, ns' -fluid

# ---- unknown words: those that are known ----
row 2 "option -fluid: 'water' is not one of none, darcy, ns" -fluid water
row 2 "option -case: 'pannel' is not one of .*panel.* did you mean 'panel'\?" -case pannel
row 2 "option -bc_left: 'open' is not one of drained, impermeable, flux, natural" -fluid ns -bc_left open
row 2 "option -pressure: 'implict' is not one of explicit, implicit; did you mean 'implicit'\?" -fluid ns -pressure implict
row 2 "option -ns_drag: 'stokes' is not one of ergun_wen_yu, linear" -fluid ns -ns_drag stokes
row 2 "option -pressure_error_if_not_converged: 'maybe' is not one of true, false" \
  -fluid ns -pressure_error_if_not_converged maybe
row 2 "option -pressure_ksp_type: 'cgg' is not one of .*gmres.* did you mean 'cg'\?" -fluid ns -pressure_ksp_type cgg
row 2 "option -pressure_pc_type: 'hypr' is not one of .*gamg.* did you mean 'hypre'\?" -fluid ns -pressure_pc_type hypr
row 2 "option -pressure_pc_hypre_type: 'boomer' is not one of .* did you mean 'boomeramg'\?" \
  -fluid ns -pressure_pc_hypre_type boomer
row 2 "option -pressure_ksp_norm_type: 'unprec' is not one of .* did you mean 'unpreconditioned'\?" \
  -fluid ns -pressure_ksp_norm_type unprec
# of a solver inside the preconditioner, which exists only when that is built
row 2 "option -pressure_mg_levels_ksp_type: 'chebishev' is not one of .* did you mean 'chebyshev'\?" \
  -fluid ns -pressure_pc_type gamg -pressure_mg_levels_ksp_type chebishev
# two of them: either may be named, with the right reason
row 2 "option -pressure_ksp_(rtol: 'tight' is not a number|type: 'cgg' is not one of)" \
  -fluid ns -pressure_ksp_type cgg -pressure_ksp_rtol tight
# right in itself, but this matrix has no such factors
row 2 'option -pressure_pc_factor_mat_solver_type: mumpss is refused by PETSc: .*mumpss' \
  -fluid ns -pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumpss
row 2 'option -pressure_mat_type: .*aij type, .*sbaij' -fluid ns -pressure_mat_type sbaij

# ---- contradictions: both options ----
row 2 'options -end_time 1e-3 and -panel_displacement 1e-3 contradict each other' -end_time 1e-3 -panel_displacement 1e-3
row 2 'option -bc_left_pressure 1e5 has no effect with -bc_left impermeable: only a drained side has a pressure' \
  -fluid ns -bc_left impermeable -bc_left_pressure 1e5
row 2 'option -bc_top flux needs -bc_top_flux W, .*\[m/s\]' -fluid ns -bc_top flux
row 2 'options -permeability 1e-6 and -permeability_law kozeny_carman contradict each other' \
  -fluid darcy -permeability 1e-6 -permeability_law kozeny_carman
row 2 'options -coupling_scheme projection and -ns_continuity solenoidal contradict' \
  -fluid ns -ns_continuity solenoidal -coupling drag_and_pressure -coupling_scheme projection
row 2 '-coupling_scheme staggered .* unstable for a fluid step of 1e-06 s: it must be below .* 3\.6e-09 s' \
  -fluid darcy -coupling drag_and_pressure -coupling_scheme staggered -permeability 1e-12 -dt 1e-6
row 2 '-dem_mu_r 0\.7 is larger than -dem_mu_s 0\.5' -dem_mu_r 0.7
row 2 'option -pressure_ksp_type: cg needs a symmetric matrix' -fluid ns -sph_laplacian corrected -pressure_ksp_type cg
row 2 'no disc has a prescribed pressure, .* use -sph_laplacian paper, or make a side drained' -fluid ns \
  -sph_laplacian corrected -bc_left impermeable -bc_right impermeable -bc_top impermeable -bc_bottom impermeable
row 2 'option -bc_left drained is not read in this run, it needs -fluid darcy or -fluid ns$' -bc_left drained
row 2 'option -pressure implicit is not read in this run, it needs -fluid' -fluid none -pressure implicit
row 2 'option -pressure_mg_levels_ksp_type cg is not read in this run, it needs -fluid' -pressure_mg_levels_ksp_type cg
row 2 'unknown option -bc_letf drained; did you mean -bc_left \(which needs -fluid' -bc_letf drained
row 2 'option -column_load 5 is not read in this run, it needs -case column or -case column_hydrostatic or ' -column_load 5
messages=2
row 2 'option -dt_safety 0\.2 is of no use to this case' -case up_terzaghi -dt_safety 0.2
settle
messages=1
row 2 'unknown option -pressure_pc_gamg_threshold 0.1: misspelt, or of a solver that this run does not use' \
  -fluid ns -pressure_pc_gamg_threshold 0.1

# ---- as programs of GNU have them ----
row 2 'unknown option --fluid ns; options begin with one .-., as in -fluid$' --fluid ns
row 2 'unknown option -fluid=ns; a blank, not .=., stands between an option and its value$' -fluid=ns

# ---- arguments that belong to no option ----
row 2 "argument 'stray' belongs to no option" stray
row 2 "argument '-9.81' belongs to no option: .* commas" -gravity 0 -9.81
row 2 "argument '2e-6' belongs to no option" -dt 1e-6 2e-6
row 2 "argument 'panel.opts' belongs to no option; did you mean -options_file panel.opts\?" panel.opts

# ---- files ----
printf -- '-fluid ns\nbc_left drained\n' >malformed.opts
printf -- '-fluid ns\n-panel_colums 5\n' >misspelt.opts
printf 'fluid: ns\npanel_colums: 5\n' >misspelt.yaml
printf 'fluid: ns\nbc:\n  left: [drained\n  right: drained\n' >malformed.yaml
printf -- '# a comment\n\n-gravity 0 -9.81\n' >blanks.opts
printf -- '-fluid -dt 1e-6\n' >two.opts
printf -- '-fluid ns\n-options_file nowhere.opts\n' >nested.opts
mkdir folder.h5
row 4 'options file.*nowhere\.opts' -options_file nowhere.opts
row 4 "options file 'nowhere\.yaml': No such file or directory$" -options_file nowhere.yaml
row 4 "options file '.*folder\.h5': Is a directory" -options_file "$here/folder.h5"
row 2 "options file '.*malformed\.opts', line 2: 'bc_left' is no option: options start with '-'" \
  -options_file "$here/malformed.opts"
row 2 "options file '.*blanks\.opts', line 3: '-9.81' is one word too many: .* commas" -options_file "$here/blanks.opts"
row 2 "options file '.*two\.opts', line 1: two options, -fluid and -dt, in one line" -options_file "$here/two.opts"
row 4 "options file 'nowhere\.opts': No such file" -options_file "$here/nested.opts"
row 2 "options file '.*malformed\.yaml': not understood as YAML from line 3 on" -options_file "$here/malformed.yaml"
# bad input and no trouble with a file: there is none
row 2 'option -options_file needs the name of a file' -options_file
row 2 'option -options_file needs the name of a file' -options_file -fluid ns
row 2 'unknown option -panel_colums 5; did you mean -panel_columns\?' -options_file "$here/misspelt.opts"
row 2 'unknown option -panel_colums 5; did you mean -panel_columns\?' -options_file "$here/misspelt.yaml"
row 2 "result file 'run\.txt': the name must end in \.h5" -output run.txt
row 4 "'nowhere'" -output nowhere/run.h5
row 4 'folder\.h5' -output "$here/folder.h5"
row 4 "option -pressure_dump: cannot write 'nowhere/system\.petsc': No such file" \
  -fluid ns -pressure_dump nowhere/system.petsc
row 4 "option -pressure_dump: cannot write 'nowhere/system-000000\.petsc'" \
  -fluid ns -pressure_dump nowhere/system.petsc -pressure_dump_every 5
row 4 "checkpoint 'nowhere/run\.pgc': No such file" -checkpoint nowhere/run.pgc
row 4 "cannot write packing 'nowhere/discs\.csv'" -packing_export nowhere/discs.csv
row 4 "nowhere\.pgc" -restart nowhere.pgc
row 4 "nowhere\.csv" -case packing -packing nowhere.csv
settle

# ---- on two ranks: the same, once ----
ranks=2
most=2
row 2 'unknown option -pressure_ksp_rtoll 1e-6; did you mean -pressure_ksp_rtol\?' -fluid ns -pressure_ksp_rtoll 1e-6
row 2 'option -dt: 1e-05 s is above the critical time step' -dt 1e-5
row 2 "option -pressure_ksp_type: 'cgg' is not one of" -fluid ns -pressure_ksp_type cgg
row 2 'option -bc_left drained is not read in this run' -bc_left drained
row 2 "malformed\.opts', line 2" -options_file "$here/malformed.opts"
row 2 'malformed\.yaml.* from line 3 on' -options_file "$here/malformed.yaml"
row 2 "argument 'stray' belongs to no option" stray
row 4 'options file.*nowhere\.opts' -options_file nowhere.opts
row 4 "'nowhere'" -output nowhere/run.h5
settle

# ---- and accepted: options files, plain and YAML, and PETSC_OPTIONS; later ones win ----
printf -- '# small\n-fluid darcy   # water\n-panel_columns 5\n-end_time 1e-5\n' >right.opts
printf '# small\nfluid: darcy\npanel_columns: 6\nend_time: 1.0e-5\npressure_ksp_rtol: 1.0e-6\nbc:\n  left: impermeable\n' >right.yaml
"$POROGRAIN" -options_file right.opts >right.log || fail 'right.opts'
expect_match 'case panel, 49 discs .* fluid darcy' right.log
"$POROGRAIN" -options_file right.opts -panel_columns 4 >right.log || fail 'right.opts and command line'
expect_match 'case panel, 31 discs .* fluid darcy' right.log
PETSC_OPTIONS='-panel_columns 4 -end_time 1e-5' "$POROGRAIN" >right.log || fail 'PETSC_OPTIONS'
expect_match 'case panel, 31 discs .* fluid none' right.log
"$POROGRAIN" -options_file right.yaml >right.log || fail 'right.yaml'
expect_match 'case panel, 71 discs .* fluid darcy' right.log
expect_match 'left: impermeable' right.log

[ "$rows" -ge 40 ] || fail "only $rows rows"
if ls row-*.failed >failed.txt 2>/dev/null; then
  cat row-*.failed >&2
  fail "$(wc -l <failed.txt) of $rows rows"
fi

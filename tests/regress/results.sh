# Result files hold what interface and docs promise: snapshots, history, provenance, CSV, index for ParaView; dumped
# systems can be read by PETSc's own means; a failed solve leaves its system behind.
. "$SOURCE_DIR/tests/support/regress.sh"

panel="-case panel -panel_columns 6 -dt 2e-6 -end_time 8e-5"

# attribute FILE OBJECT NAME: its value, without quotes
attribute() {
  h5dump -a "$2/$3" "$1" | sed -n '/ DATA {/,/^ *}/p' | sed -e '1d;$d' -e 's/^ *([0-9,]*): //; s/^ *//' | tr -d '"'
}

# values FILE DATASET: one on each line, row by row
values() {
  h5dump -y -w 1 -m %.17g -d "$2" "$1" | sed -n '/ DATA {/,/ }/p' | sed -n 's/^ *\([-+0-9.e]*\),\{0,1\}$/\1/p' | grep .
}

# ---- a wet run: 71 discs, 40 steps of the discs, 10 of the water ----
# shellcheck disable=SC2086
"$POROGRAIN" $panel -fluid ns -fluid_every 4 -output run.h5 -output_every 4e-5 -history_every 1.6e-5 \
  >run.log || fail 'wet run'
[ "$(h5ls run.h5/snapshots | awk '{ print $1 }' | paste -sd ' ')" = '000000 000001 000002' ] || fail 'snapshots'

# name, shape, unit
while read -r name shape unit; do
  object="/snapshots/000002/$name"
  [ "$(h5ls "run.h5$object" | sed 's/.*{\(.*\)}.*/\1/; s/[ ]//g')" = "$shape" ] || fail "$object: not of shape $shape"
  [ "$(attribute run.h5 "$object" unit)" = "$unit" ] || fail "$object: unit '$(attribute run.h5 "$object" unit)'"
  [ "$(attribute run.h5 "$object" description | wc -c)" -gt 10 ] || fail "$object: no description"
done <<END
id 71 1
position 71,2 m
velocity 71,2 m/s
rotation 71 rad
angular_velocity 71 rad/s
radius 71 m
porosity 71 1
pressure 71 Pa
fluid_velocity 71,2 m/s
relative_velocity 71,2 m/s
effective_strain 71 1
volumetric_strain 71 1
coordination_number 71 1
stress 71,2,2 Pa
END

# times, and rows in the order of permanent ids
expect_close "$(attribute run.h5 /snapshots/000000 time)" 0 0
expect_close "$(attribute run.h5 /snapshots/000001 time)" 4e-5 1e-18
expect_close "$(attribute run.h5 /snapshots/000002 time)" 8e-5 1e-18
values run.h5 /snapshots/000002/id | awk '$1 != NR - 1 { bad = 1 } END { exit bad || NR != 71 }' || fail 'ids'
# The lowest row has five discs of radius 5 mm, the first at 10 mm.
values run.h5 /snapshots/000000/position | paste -d ' ' - - >position
expect_close "$(awk 'NR == 1 { print $1 }' position)" 0.01 1e-15
expect_close "$(awk 'NR == 5 { print $1 }' position)" 0.05 1e-15
expect_close "$(awk 'NR == 5 { print $2 }' position)" 0.005 1e-15

# ---- history: in the file and in CSV ----
columns="time displacement load load_total kinetic_energy pressure_min pressure_mean pressure_max pressure_iterations \
  pressure_residual"
header=$(head -n 1 run.csv)
[[ $header == 'time [s],displacement [m],load [N/m],load_total [N/m],kinetic_energy [J/m],pressure_min [Pa],pressure_mean [Pa],pressure_max [Pa],pressure_iterations [1],pressure_residual [1],'* ]] ||
  fail "CSV header: $header"
# at the start, and every second of the ten fluid steps
[ "$(wc -l <run.csv)" -eq 7 ] || fail "$(wc -l <run.csv) lines of history"
for column in $columns; do
  object="/history/$column"
  [ "$(h5ls "run.h5$object" | sed 's/.*{\([0-9]*\)\/.*/\1/')" = 6 ] || fail "$object: not 6 rows"
  [ "$(attribute run.h5 "$object" description | wc -c)" -gt 10 ] || fail "$object: no description"
  [[ $header == *"$column [$(attribute run.h5 "$object" unit)]"* ]] || fail "$object: unit"
  csv_column run.csv "$column" >from_csv
  values run.h5 "$object" | paste -d ' ' - from_csv |
    awk '{ bad = bad || $1 + 0 != $2 + 0 } END { exit bad || NR != 6 }' || fail "$object: not as in the CSV file"
done
expect_close "$(csv_column run.csv displacement | tail -n 1)" "$(awk 'BEGIN { print 6.18e-2 * 8e-5 }')" 1e-15
csv_column run.csv pressure_residual | awk 'NR > 1 && !($1 > 0 && $1 <= 1e-7) { bad = 1 } END { exit bad }' ||
  fail 'residual of implicit solves'

# ---- provenance ----
for name in program_version git_revision petsc_version ranks options options_used options_unused; do
  attribute run.h5 /provenance "$name" >"$name.txt" || fail "no /provenance/$name"
  [ -s "$name.txt" ] || [ $name = options_unused ] || fail "/provenance/$name is empty"
done
expect_match '^[0-9]+\.[0-9]+\.[0-9]+' petsc_version.txt
expect_match '^1$' ranks.txt
expect_match '-panel_columns 6' options.txt
expect_match '-panel_columns' options_used.txt
if grep -q panel options_unused.txt; then fail 'an option that was used is called unused'; fi

# ---- index for ParaView: a grid for each snapshot, paths relative to it ----
[ "$(grep -c 'GridType="Uniform"' run.xmf)" -eq 3 ] || fail 'grids in run.xmf'
for name in position pressure stress; do expect_match ">run\.h5:/snapshots/000002/$name<" run.xmf; done
if command -v xmllint >xmllint.txt; then xmllint --noout --nonet run.xmf 2>xmllint.txt || fail 'run.xmf is not XML'; fi

# ---- explicit: how far a sweep is from the solution is in the history, too ----
# shellcheck disable=SC2086
"$POROGRAIN" $panel -fluid ns -pressure explicit -output sweep.h5 -history_every 8e-6 >sweep.log || fail 'explicit run'
csv_column sweep.csv pressure_residual | awk 'NR > 1 && !($1 > 1e-6 && $1 < 10) { bad = 1 } END { exit bad || NR < 5 }' ||
  fail "residual of explicit sweeps: $(csv_column sweep.csv pressure_residual | paste -sd ' ')"

# ---- a dry run has discs only ----
# shellcheck disable=SC2086
"$POROGRAIN" $panel -fluid none -output dry.h5 >dry.log || fail 'dry run'
h5ls dry.h5/snapshots/000000 | awk '{ print $1 }' >names
for name in position velocity rotation stress coordination_number effective_strain; do grep -qx $name names || fail "no $name"; done
if grep -qx pressure names; then fail 'pressure in a dry run'; fi
# Its porosity follows from the one at the start, which is the paper's, and from
# the volumetric strain: discs keep their areas.
[ "$(h5ls dry.h5/snapshots/000002 | awk '{ print $1 }' | paste -sd ' ')" = \
  'angular_velocity coordination_number effective_strain id porosity position radius rotation stress velocity volumetric_strain' ] ||
  fail "fields of a dry run: $(h5ls dry.h5/snapshots/000002)"
[ "$(attribute dry.h5 /snapshots/000002/porosity unit)" = 1 ] || fail 'unit of the porosity'
for k in 0 2; do
  values dry.h5 /snapshots/00000$k/porosity >n$k
  values dry.h5 /snapshots/00000$k/volumetric_strain >strain$k
done
[ "$(sort -u n0 | awk '{ printf "%.4f ", $1 }')" = '0.0931 0.0945 0.1025 ' ] || fail "porosities at the start: $(sort -u n0)"
# values have 17 digits; (1 - n)(1 + strain) is the same twice but for rounding
paste n0 n2 strain2 | awk '{ d = (1 - $2)*(1 + $3) - (1 - $1); if (d > 1e-15 || d < -1e-15) bad = 1; if ($1 != $2) moved++ }
  END { exit bad || moved < 20 }' || fail 'porosity of a dry run'

# ---- dumped systems ----
# A symmetric matrix with a row for each disc and 18 neighbours for most; the solution to the tolerance of the solver.
# shellcheck disable=SC2086
"$POROGRAIN" $panel -fluid ns -pressure_dump first.petsc >dump.log || fail '-pressure_dump'
"$SUPPORT/load_system" first.petsc >first.txt || fail 'first.petsc'
expect_match '^rows 71 ' first.txt
expect_close "$(awk '{ print $4 }' first.txt)" 1000 200
expect_close "$(awk '{ print $6 }' first.txt)" 0 1e-14
expect_close "$(awk '{ print $8 }' first.txt)" 0 1e-7
# shellcheck disable=SC2086
"$POROGRAIN" $panel -fluid ns -fluid_every 4 -pressure explicit -pressure_dump sweep.petsc -pressure_dump_every 4 \
  >dump.log || fail '-pressure_dump_every'
[ "$(echo sweep-*.petsc)" = 'sweep-000000.petsc sweep-000004.petsc sweep-000008.petsc' ] || fail "$(echo sweep-*)"
for file in sweep-*.petsc; do
  "$SUPPORT/load_system" $file >sweep.txt || fail $file
  # one sweep is not the solution
  awk '{ exit !($8 > 1e-4 && $8 < 10) }' sweep.txt || fail "$file: $(cat sweep.txt)"
done

# ---- a solve that fails ends the run, says why and leaves the system ----
# shellcheck disable=SC2086
expect_error 3 'error: pressure: the solver stopped with DIVERGED_ITS after 1 iterations, relative residual .* written to broken-failed\.petsc' \
  "$POROGRAIN" $panel -fluid ns -pressure_ksp_max_it 1 -output broken.h5
"$SUPPORT/load_system" broken-failed.petsc >broken.txt || fail 'broken-failed.petsc'
expect_match '^rows 71 ' broken.txt

# processors: 2
# timeout: 600
# Every registered case goes on from its checkpoints with the same bits: walls, servo walls, periodic packings, energy
# accounts, gravity.
. "$SOURCE_DIR/tests/support/regress.sh"

# check NAME RANKS END options...: NAME is free; a checkpoint at half of END, 20 rows and 5 snapshots
check() {
  local name=$1 n=$2 end=$3 times
  shift 3
  times=$(awk -v e="$end" 'BEGIN {
    printf "-end_time %.6e -history_every %.6e -output_every %.6e -checkpoint_every %.6e", e, e/20, e/5, e/2 }')
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" "$@" $times -output "$name.h5" -checkpoint "$name.pgc" >"$name.log" 2>&1 ||
    { cat "$name.log" >&2; fail "$name"; }
  cp "$name.h5" "$name-again.h5"
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" "$@" $times -output "$name-again.h5" -restart "$name.pgc.1" -checkpoint "$name-again.pgc" >"$name-again.log" 2>&1 ||
    { cat "$name-again.log" >&2; fail "$name: restart"; }
  expect_same_results "$name.h5" "$name-again.h5"
  cmp "$name.csv" "$name-again.csv" || fail "$name: the history as text differs"
  for object in /fields /ragged /state; do expect_same_results "$name.pgc" "$name-again.pgc" "$object"; done
  touch ../"$name.checked"
}

begin() { beside within "$1" check "$@"; }

begin bed_darcy 1 1e-2 -case bed_darcy
begin bed_ergun 1 4e-3 -case bed_ergun
begin bed_ns_to_darcy 2 4e-3 -case bed_ns_to_darcy
begin column 1 4e-3 -case column
begin column_hydrostatic 1 4e-3 -case column_hydrostatic
begin column_terzaghi 2 4e-3 -case column_terzaghi
begin column_seepage 1 4e-3 -case column_seepage
begin undrained 1 7e-4 -case undrained
begin disc_collision 1 2e-4 -case disc_collision -dt 1e-6
begin disc_on_plane 1 5e-3 -case disc_on_plane
begin disc_on_incline 1 5e-3 -case disc_on_incline
begin lattice_modulus 1 1e-3 -case lattice_modulus -dem_energy
begin box 2 2e-3 -case box -packing_count 100
begin biaxial 2 4e-3 -case biaxial -biaxial_columns 6 -dem_energy -dem_c_n 100
begin panel 2 4e-3 -case panel -panel_columns 6 -dem_energy -dem_local_damping 0.2 -dem_c_s 200 -dem_global_damping 10
# Discs fly through the periodic boundary and are dealt out anew on the way.
begin periodic 2 4e-3 -case packing -packing_generate random -packing_count 120 -packing_periodic -packing_radius_spread 0.3 \
  -packing_target_porosity 0.3 -packing_walls bottom,top -packing_top_velocity -0.5 -gravity 30,-9.81 -dt 2e-6 \
  -neighbors_skin 0.02 -particles_balance 1 -dem_energy
begin plates 1 1e-3 -case packing -packing_generate random -packing_count 100 -packing_plates bottom,top \
  -packing_top_velocity -0.05 -dt 2e-6 -fluid ns -fluid_every 5 -sph_gradient corrected
together

# All cases but packing, which is above under other names, those without steps, the continuum (up_restart.sh), and those that
# have no checkpoints (docs/reliability.md) have been here.
"$POROGRAIN" -help markdown >help.txt
cases=$(sed -n 's/^| `-case` |[^|]*|[^|]*| \([^|]*\) |.*$/\1/p' help.txt | tr -d ' ' | tr ',' '\n')
[ "$(echo "$cases" | wc -l)" -ge 16 ] || { grep -e -case help.txt >&2; fail "cases of -help: $cases"; }
for name in $cases; do
  case $name in packing | *_mms | up_* | wcsph_* | tak_*) continue ;; esac
  [ -e "$name.checked" ] || fail "case $name is not restarted here"
done

# timeout: 300
# Impermeable sides with the two-phase projection: a box of rigid walls full of grains and water stays calm, a panel with
# all sides impermeable lasts (both once blew up, at 1.4 ms and at 0.11 mm), and a side that nothing holds is warned of.
. "$SOURCE_DIR/tests/support/regress.sh"

water='-pressure implicit -coupling drag_and_pressure -sph_gradient corrected
  -sph_laplacian_eta 0.01 -bc_tracking surface -dem_local_damping 0.7'
closed='-bc_left impermeable -bc_right impermeable -bc_bottom impermeable'

# largest FILE NAME: of a column, or of its negative values with the sign changed
largest() { csv_column "$1" "$2" | awk '{ a = $1 < 0 ? -$1 : $1; if (a > most) most = a } END { print most + 0 }'; }

# 400 discs pressed together at random; the top wall comes down at 5 cm/s for 5 ms.
"$POROGRAIN" -case packing -packing_generate random -packing_count 400 -packing_radius_spread 0.2 -packing_target_porosity 0.19 \
  -packing_seed 4 -dt 1e-7 -end_time 1e-7 -packing_export dense.csv >dense.out
box=$(sed -n 's/^  box \([0-9.,e+-]*\) m.*/\1/p' dense.out)
for fluid in 'ns -ns_continuity averaged' darcy; do
  for top in impermeable drained; do
    # shellcheck disable=SC2086
    "$POROGRAIN" -case packing -packing dense.csv -packing_box "$box" -packing_walls left,right,bottom,top \
      -packing_top_velocity -0.05 -dt 1e-6 -fluid_every 10 -end_time 5e-3 -fluid $fluid $water $closed -bc_top $top \
      -history_every 1e-4 -output box.h5 >box.out || fail "box, ${fluid%% *}, top $top"
    # Seen: 0.9 to 1.9e5 Pa with the water's 1e5 Pa of the start; 5e8 Pa when side discs are moved by the computed gradient.
    p=$(largest box.csv pressure_max)
    awk -v p="$p" 'BEGIN { exit !(p >= 1e5 && p < 5e5) }' || fail "box, ${fluid%% *}, top $top: largest pressure $p Pa"
    # 7 kg of discs at 5 cm/s have 9e-3 J; with damping, ten times that is far from what a blow-up leaves (2e4 J).
    e=$(csv_column box.csv kinetic_energy | tail -n 1)
    awk -v e="$e" 'BEGIN { exit !(e < 0.5) }' || fail "box, ${fluid%% *}, top $top: kinetic energy $e J/m"
    echo "box, ${fluid%% *}, top $top: largest pressure $p Pa, kinetic energy at the end $e J/m"
  done
done

# The panel, all sides impermeable, half a millimetre.
for fluid in ns darcy; do
  grep -v -e '^-bc_.*_pressure' -e '^-output' "$SOURCE_DIR/options/panel_case1_$fluid.opts" >$fluid.opts
  # shellcheck disable=SC2086
  "$POROGRAIN" -options_file $fluid.opts $closed -bc_top impermeable -panel_displacement 5e-4 -history_every 1e-4 \
    -output panel-$fluid.h5 >panel-$fluid.out || fail "closed panel, $fluid"
  p=$(largest panel-$fluid.csv pressure_max)
  awk -v p="$p" 'BEGIN { exit !(p < 5e6) }' || fail "closed panel, $fluid: $p Pa"
done
expect_match 'warning: 98 discs of impermeable or flux sides are on no plate: .* walls must hold them' panel-ns.out
if grep -q warning panel-darcy.out; then fail "a warning for Darcy's law"; fi

# What the warning is about: only the lateral sides are impermeable, and nothing holds them.
expect_error 3 'the water has blown up .* an impermeable or flux side that neither plate nor wall holds is unstable' \
  "$POROGRAIN" -options_file ns.opts -bc_left impermeable -bc_right impermeable -guard_every 1 -output free.h5 -output_every 1

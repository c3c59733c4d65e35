# The dry panel against LAMMPS: frictional contacts with history, no rolling resistance, no damping, smooth plates.
# timeout: 300
# processors: 2
#
# Same law, same positions at the start, same integrator (velocity Verlet, tangential increments with half-step
# velocities, lever arms r_a, r_j). What differs: LAMMPS keeps the tangential spring as a vector and turns it with the
# contact by projecting it anew in every step, which shortens it by the square of the angle turned, some 1e-8 of it
# by the end; and the rounding of everything. Contacts that open, close and slip make both grow (see
# tests/verify/dem_panel.c: from 1e-10 at 4e-5 m of the plate to 1e-6 at 6e-5 m).
. "$SOURCE_DIR/tests/support/regress.sh"

if ! command -v lmp >/dev/null 2>&1; then
  echo "SKIP: LAMMPS (lmp) is not installed"
  exit 77
fi

columns=25
rows=51
discs=1249
radius=5e-3
velocity=6.18e-2
dt=1e-6
steps=1000
mu=0.5

awk -v w=$columns -v rows=$rows -v r=$radius 'BEGIN {
  pi = atan2(0, -1); n = 0
  for (k = 0; k < rows; k++) {
    length_of_row = k % 2 ? w : w - 1
    for (c = 0; c < length_of_row; c++) {
      x[n] = r*(2*c + (k % 2 ? 1 : 2)); y[n++] = r*(1 + sqrt(3)*k)
    }
  }
  print "dry panel\n\n" n " atoms\n1 atom types\n\n-0.1 0.5 xlo xhi\n-0.1 0.6 ylo yhi\n-0.005 0.005 zlo zhi\n\nAtoms # sphere\n"
  for (i = 0; i < n; i++) printf "%d 1 %.17g 2000.0 %.17g %.17g 0.0\n", i + 1, 2*r, x[i], y[i]
}' >panel.data
grep -q "^$discs atoms" panel.data || fail "not $discs discs"
lmp -in "$SOURCE_DIR/tests/support/lammps_panel.in" -var data panel.data -var steps $steps -var dt $dt -var velocity $velocity -var ylo 0.006 \
  -var yhi 0.437 -var mu $mu -log lammps.log -screen none </dev/null || { tail -n 20 lammps.log >&2; fail "LAMMPS failed"; }
lammps_load=$(awk -v s=$steps '$1 == s && NF == 2 { print $2 }' lammps.log | tail -n 1)

for ranks in 1 2; do
  run $ranks "$POROGRAIN" -case panel -fluid none -panel_velocity $velocity -plate_friction 0 -dem_mu_s $mu -dem_k_r 0 \
    -dem_mu_r 0 -dem_k_theta 0 -dem_mu_theta_r 0 -dt $dt -end_time 1e-3 -output ours-$ranks.h5 -output_every 1e-3 \
    -history_every 1e-3 >ours.log || fail "porograin failed"
done
expect_same_results ours-1.h5 ours-2.h5
h5dump -d /snapshots/000001/position -m %.17g -y -w 1 -o position.txt ours-1.h5 >/dev/null
h5dump -d /snapshots/000001/angular_velocity -m %.17g -y -w 1 -o spin.txt ours-1.h5 >/dev/null
load=$(csv_column ours-1.csv load | tail -n 1)

# Ids of both are in the order of rows: ours start at 0.
tr -d ' ,' <position.txt | grep . | paste - - >ours.xy
tr -d ' ,' <spin.txt | grep . >ours.w
awk 'seen { print $2, $3, $6 } /^ITEM: ATOMS/ { seen = 1 }' lammps.dump >theirs
[ "$(wc -l <ours.xy)" -eq $discs ] && [ "$(wc -l <theirs)" -eq $discs ] || fail "not $discs discs in both results"
paste ours.xy ours.w theirs | awk -v w=$columns -v r=$radius '
  function far(a, b) { return a > b ? a - b : b - a }
  { # where the disc was at the start
    i = NR - 1; k = 2*int(i/(2*w - 1)); c = i % (2*w - 1)
    if (c >= w - 1) { k++; c -= w - 1 }
    x0 = r*(2*c + (k % 2 ? 1 : 2)); y0 = r*(1 + sqrt(3)*k)
    d = far($1, $4); if (d > dx) dx = d
    d = far($2, $5); if (d > dx) dx = d
    d = far($1, x0); if (d > way) way = d
    d = far($2, y0); if (d > way) way = d
    d = far($3, $6); if (d > dw) dw = d
    d = $6 < 0 ? -$6 : $6; if (d > spin) spin = d
  }
  END { printf "%.3e %.3e %.3e %.3e\n", dx, way, dw, spin }' >compared
read -r dx way dw spin <compared
printf 'largest difference of positions %s m, largest displacement %s m, of spins %s of %s rad/s, loads %s and %s N/m\n' \
  "$dx" "$way" "$dw" "$spin" "$load" "$lammps_load"

# line QUANTITY REFERENCE COMPUTED DIFFERENCE SCALE TOLERANCE REASON
line() {
  local error
  # awk takes an empty word for 0: a difference or scale that is no positive number must not pass
  expect_close "$4" "$4" 0
  expect_close "$5" "$5" 0
  error=$(awk -v d="$4" -v s="$5" 'BEGIN { if (d < 0 || s <= 0) exit 1; printf "%.2e", d/s }') ||
    fail "$1: difference $4, scale $5"
  printf 'VERIFY | LAMMPS, dry panel | %s | %s | %s | %s |  | %s | %s\n' "$1" "$2" "$3" "$error" "$6" "$7"
  expect_close "$error" 0 "$6"
}
# a hundred times what was seen: 4e-9, 1.5e-8, 6e-7
reason='LAMMPS projects the tangential spring: square of the angles turned, 1e-8 of it, grown by slip'
line 'load after 1000 steps [N/m]' "$lammps_load" "$load" \
  "$(awk -v a="$load" -v b="$lammps_load" 'BEGIN { d = a - b; printf "%.9e", (d < 0) ? -d : d }')" "$lammps_load" 1e-6 "$reason"
line 'positions after 1000 steps: largest difference [m], error over largest displacement' 0 "$dx" "$dx" "$way" 2e-6 "$reason"
line 'spins after 1000 steps: largest difference [rad/s], error over largest spin' 0 "$dw" "$dw" "$spin" 1e-4 "$reason"

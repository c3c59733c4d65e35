# preset: long
# processors: 2
# timeout: 3600
# The examples of Tak, Park & Park (2013) at full length, by their option files: stable, and what docs/tak2013.md says.
. "$SOURCE_DIR/tests/support/regress.sh"
options="$SOURCE_DIR/options"

last() { csv_column "$1" "$2" | tail -n 1; }
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.12g\n", a / b }'; }
# mean FILE COLUMN: over the second half of its rows
mean() { csv_column "$1" "$2" | awk '{ v[NR] = $1 } END { for (i = int(NR / 2) + 1; i <= NR; i++) s += v[i]; print s / (NR - int(NR / 2)) }'; }
simulate() {
  local name=$1
  shift
  "$POROGRAIN" "$@" -output "$name.h5" >"$name.out" 2>&1 || { cat "$name.out" >&2; fail "$name"; }
}

beside simulate two -options_file "$options/tak_two_elements.opts"
beside simulate free -options_file "$options/tak_two_elements.opts" -wcsph_viscosity 0 -wcsph_diffusion 0
beside simulate mm -options_file "$options/tak_two_elements_mm.opts"
beside simulate block -options_file "$options/tak_block.opts"
together

# 60 s: momentum is impulse and energy is work where nothing is viscous; both elements go as far
expect_close "$(ratio "$(last free.csv momentum)" "$(last free.csv impulse)")" 1 1e-4
expect_close "$(ratio "$(last free.csv energy)" "$(last free.csv work)")" 1 1e-6
expect_close "$(ratio "$(last two.csv displacement_left)" "$(last two.csv displacement_right)")" 1 1e-3
expect_close "$(last two.csv outside)" 0 0
# Stokes: displacements within 1.5 %
expect_close "$(ratio "$(last mm.csv displacement_left)" "$(last mm.csv displacement_right)")" 1 0.015
# 1 Pa
for column in stress_1 stress_2 pore_pressure_1 pore_pressure_2; do expect_close "$(mean block.csv $column)" 1 0.005; done
expect_close "$(mean block.csv pressure_liquid)" 1.004 0.005

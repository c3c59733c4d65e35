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
# 0.32 % more, docs/tak2013.md; zones that swing by 0.1 % in the second half
expect_close "$(mean block.csv pressure_liquid)" 1.0032 0.001

# ---- numbers of docs/tak2013.md ----
mkdir numbers
cp two.csv numbers
FIGURES_KEEP=yes bash "$SOURCE_DIR/tests/figures/tak_numbers.sh" numbers means scaling >numbers.out
# number LINE FIELD: of the lines that begin with LINE
number() { awk -v what="$1" -v field="$2" 'index($0, what " ") == 1 { print $field }' numbers.out; }
# as printed there, to what the last digits of a long run of many particles may differ by between machines
expect_close "$(number means 2)" 0.643 0.01
expect_close "$(number means 3)" 0.430 0.01
expect_close "$(number means 7)" 0.997 0.002
expect_close "$(number means 8)" 0.022 0.005
# velocities grow by 1 % with each factor of ten
for side in 6 7; do
  expect_close "$(ratio "$(number 'scaling 100 0.8-1' $side)" "$(number 'scaling 1000 0.8-1' $side)")" 1.008 0.004
  expect_close "$(ratio "$(number 'scaling 10 0.8-1' $side)" "$(number 'scaling 100 0.8-1' $side)")" 1.011 0.004
done
# ways in 40 s differ by 4 and 5 %, by which particles get out
expect_close "$(ratio "$(number 'scaling 100 30-40' 8)" "$(number 'scaling 1000 30-40' 8)")" 0.96 0.02
expect_close "$(ratio "$(number 'scaling 100 30-40' 9)" "$(number 'scaling 1000 30-40' 9)")" 0.948 0.02

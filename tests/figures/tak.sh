#!/usr/bin/env bash
# tak.sh FOLDER: runs the examples of Tak, Park & Park (2013) in FOLDER and draws the pictures of docs/tak2013.md.
# Environment: POROGRAIN, SOURCE_DIR. FIGURES_KEEP=yes draws results that are in FOLDER again. Some minutes on one core.
set -euo pipefail
mkdir -p -- "$1"
cd -- "$1"
pictures=$SOURCE_DIR/docs/figures
export OMP_NUM_THREADS=1

run() { # NAME options...
  local name=$1
  shift
  [ "${FIGURES_KEEP:-}" = yes ] && [ -s "$name.h5" ] && return
  echo "figures: $name"
  "$POROGRAIN" "$@" -output "$name.h5" >"$name.log"
}
run two -options_file "$SOURCE_DIR/options/tak_two_elements.opts"
run mm -options_file "$SOURCE_DIR/options/tak_two_elements_mm.opts"
# a step four times that of the file: the same to three digits
run block -options_file "$SOURCE_DIR/options/tak_block.opts" -dt 2e-3 -tak_block_every 2

# column FILE NAME: its number
column() { head -n 1 "$1.csv" | tr ',' '\n' | tr -d '"' | awk -v name="$2" '$1 == name { print NR }'; }

# draw PICTURE TITLE-OF-Y FACTOR FILE:COLUMN:TITLE...
draw() {
  local picture=$1 y=$2 factor=$3 plots='' spec file name title colours=('#0072B2' '#D55E00' '#009E73' '#CC79A7') n=0
  shift 3
  for spec in "$@"; do
    IFS=: read -r file name title <<<"$spec"
    plots+="${plots:+, }'$file.csv' skip 1 using 1:($factor*\$$(column "$file" "$name")) with lines lw 1.5 lc rgb '${colours[n]}' title '$title'"
    n=$((n + 1))
  done
  gnuplot <<PLOT
set terminal pngcairo size 640,360 font 'DejaVu Sans,9'
set output '$pictures/$picture.png'
set datafile separator ','
set grid lt 1 lw 0.5 lc rgb '#dddddd'
set border 3
set tics nomirror
set key outside top center horizontal
set autoscale xfix
set xlabel 'time [s]'
set ylabel '$y'
plot $plots
PLOT
}
draw tak_two_pressure 'pressure [mPa]' 1e3 two:pressure_a:A two:pressure_b:B
draw tak_two_way 'displacement [mm]' 1e3 'two:displacement_left:left element' 'two:displacement_right:right element'
draw tak_mm_pressure 'pressure [Pa]' 1 mm:pressure_a:A mm:pressure_b:B
draw tak_mm_way 'displacement [mm]' 1e3 'mm:displacement_left:left element' 'mm:displacement_right:right element'
draw tak_two_speed 'velocity [µm/s]' 1e6 'two:velocity_left:left element' 'two:velocity_right:right element'
draw tak_mm_speed 'velocity [µm/s]' 1e6 'mm:velocity_left:left element' 'mm:velocity_right:right element'
draw tak_block_pressure 'pressure, stress [Pa]' 1 'block:pressure_liquid:liquid' 'block:stress_1:zone 1' \
  'block:pore_pressure_1:pores of zone 1' 'block:pore_pressure_2:pores of zone 2'
if command -v pngquant >/dev/null; then pngquant --force --ext .png --strip --speed 1 --nofs 64 -- "$pictures"/tak_*.png; fi

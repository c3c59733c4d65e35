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

# draw PICTURE TITLE-OF-Y FILE:COLUMN:TITLE...
draw() {
  local picture=$1 y=$2 plots='' spec file name title
  shift 2
  for spec in "$@"; do
    IFS=: read -r file name title <<<"$spec"
    plots+="${plots:+, }'$file.csv' skip 1 using 1:$(column "$file" "$name") with lines lw 1.5 title '$title'"
  done
  gnuplot <<PLOT
set terminal pngcairo size 720,400 font 'DejaVu Sans,10'
set output '$pictures/$picture.png'
set datafile separator ','
set grid lc '#dddddd'
set key outside bottom center horizontal
set xlabel 'time [s]'
set ylabel '$y'
set format y '%.2g'
plot $plots
PLOT
}
draw tak_two_pressure 'pressure [Pa]' two:pressure_a:A two:pressure_b:B
draw tak_two_way 'displacement [m]' 'two:displacement_left:left element' 'two:displacement_right:right element'
draw tak_mm_pressure 'pressure [Pa]' mm:pressure_a:A mm:pressure_b:B
draw tak_mm_way 'displacement [m]' 'mm:displacement_left:left element' 'mm:displacement_right:right element'
draw tak_two_speed 'velocity [m/s]' 'two:velocity_left:left element' 'two:velocity_right:right element'
draw tak_mm_speed 'velocity [m/s]' 'mm:velocity_left:left element' 'mm:velocity_right:right element'
draw tak_block_pressure 'pressure, stress [Pa]' 'block:pressure_liquid:liquid' 'block:stress_1:zone 1' \
  'block:pore_pressure_1:pores of zone 1' 'block:pore_pressure_2:pores of zone 2'
if command -v pngquant >/dev/null; then pngquant --force --ext .png --strip --speed 1 --nofs 64 -- "$pictures"/tak_*.png; fi

#!/usr/bin/env bash
# tak_numbers.sh FOLDER [means] [scaling] [sound]: numbers of docs/tak2013.md on the examples of Tak, Park & Park (2013), from
# runs in FOLDER; all three without further words. Environment: POROGRAIN, SOURCE_DIR. FIGURES_KEEP=yes takes results that
# are in FOLDER as they are. `means` takes a minute, `scaling` some, `sound` some seconds, on one core.
set -euo pipefail
mkdir -p -- "$1"
cd -- "$1"
shift
options=$SOURCE_DIR/options
export OMP_NUM_THREADS=1
[ $# -gt 0 ] || set -- means scaling sound

simulate() { # NAME options...
  local name=$1
  shift
  [ "${FIGURES_KEEP:-}" = yes ] && [ -s "$name.csv" ] && return
  "$POROGRAIN" "$@" -progress none -output "$name.h5" >"$name.log"
}

# columns FILE FROM COLUMN...: the rows whose first column, the time, is above FROM
columns() {
  local file=$1 from=$2
  shift 2
  awk -F, -v from="$from" -v names="$*" '
    NR == 1 { n = split(names, name, " "); gsub(/"/, "")
              for (i = 1; i <= NF; i++) { split($i, word, " "); at[word[1]] = i } }
    NR > 1 && $1 > from + 1e-9 { for (k = 1; k <= n; k++) printf "%s%s", $at[name[k]], k < n ? " " : "\n" }' "$file.csv"
}

# 6.1: what is alike in the pressures at A and B after the force has set in, and what is not. Over F/H.
means() {
  simulate two -options_file "$options/tak_two_elements.opts"
  columns two 20 pressure_a pressure_b | awk -v scale=1800 '
    { a = $1 * scale; b = $2 * scale; n++; A += a; B += b; AA += a * a; BB += b * b; AB += a * b }
    END { A /= n; B /= n; p = sqrt(AA / n - A * A); q = sqrt(BB / n - B * B); r = AB / n - A * B
          print "means: p_A p_B p_A-p_B std(p_A) std(p_B) correlation std(p_A-p_B)"
          printf "means %.4f %.4f %.4f %.4f %.4f %.4f %.4f\n", A, B, A - B, p, q, r / (p * q), sqrt(p * p + q * q - 2 * r) }'
}

# One run in millimetres with densities times FACTOR, rho c_0^2 as it is: NAME FACTOR c_0 dt end, means from FROM on.
scaled() {
  local name=$1 factor=$2
  simulate "$name" -options_file "$options/tak_two_elements_mm.opts" -tak_force_start 0 -wcsph_rest_density "${factor}e3" \
    -tak_solid_density "$((2 * factor))e3" -wcsph_sound_speed "$3" -dt "$4" -end_time "$5" -history_every 2e-3
  columns "$name" "$6" pressure_a pressure_b velocity_left velocity_right displacement_left displacement_right outside |
    awk -v scale=1.8 -v what="$factor $6-$5" '
    { n++; a += $1; b += $2; u += $3; v += $4; last = sprintf("%.4f %.4f %d", 1e3 * $5, 1e3 * $6, $7) }
    END { printf "scaling %s %.3f %.3f %.4f %.4f %s\n", what, scale * a / n, scale * b / n, 1e6 * u / n, 1e6 * v / n, last }'
}

scaling() {
  echo 'scaling: factor seconds p_A p_B [F/H] v_left v_right [um/s] way_left way_right [mm] outside'
  scaled mm1000 1000 0.0148 3.5e-4 1 0.8
  scaled mm100 100 0.0468 7e-5 1 0.8
  scaled mm10 10 0.148 7e-6 1 0.8
  scaled mm1000_40 1000 0.0148 3.5e-4 40 30
  scaled mm100_40 100 0.0468 7e-5 40 30
}

# 6.2: pressure of the particles over the stress on the zones, less 1, in per cent: NAME c_0 dt EVERY SMOOTHING
reading() {
  simulate "$1" -options_file "$options/tak_block.opts" -tak_block_cells 20,3 -tak_block_young 1e7 -up_damping 3 \
    -wcsph_sound_speed "$2" -dt "$3" -tak_block_every "$4" -wcsph_smoothing "$5" -end_time 14
  columns "$1" 7 pressure_liquid stress_1 stress_2 | awk -v what="$2 $5" -v c="$2" '
    { p += $1; s += ($2 + $3) / 2 } END { printf "sound %s %.4f %.4f\n", what, 0.1 / (c * c), 100 * (p / s - 1) }'
}

sound() {
  echo 'sound: c_0 [m/s] h/dx p/(rho_0 c_0^2) [%] excess [%]'
  reading c05 0.5 8e-3 4 1.2
  reading c1 1 4e-3 8 1.2
  reading c2 2 2e-3 16 1.2
  reading h10 2 2e-3 16 1.0
  reading h11 2 2e-3 16 1.1
  reading h13 2 2e-3 16 1.3
}

for part in "$@"; do
  case $part in
    means | scaling | sound) "$part" ;;
    *) echo "tak_numbers.sh: $part is neither means, scaling nor sound" >&2 && exit 2 ;;
  esac
done

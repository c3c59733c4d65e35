#!/usr/bin/env bash
# Speed and memory against their goals, side by side with LAMMPS, a bare loop and plain PETSc where they are there:
#   cmake --build build --target bench        (or: cmake --preset release && cmake --build --preset bench)
# Prints a table and writes bench.csv in the working folder. Measurements alternate; the median of BENCH_ROUNDS (3) counts.
#   BENCH_COLUMNS="25 100 316 707"   panels: 1249, 19999, 199711, 999697 discs
#   BENCH_PARTS="dem memory panel curve pressure assembly ranks million"
# Times are CPU seconds on one rank, wall seconds where ranks are compared: these mean something on a quiet machine only.
set -euo pipefail
export LC_ALL=C OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMP_NUM_THREADS=1
rounds=${BENCH_ROUNDS:-3}
columns=${BENCH_COLUMNS:-25 100 316 707}
parts=" ${BENCH_PARTS:-dem memory panel curve pressure assembly ranks million} "
options=$SOURCE_DIR/options
here=$SOURCE_DIR/tests/bench
mpiexec=${MPIEXEC:-mpiexec}
rm -rf values failures && mkdir values
for tool in "$BENCH"/{measure,bare_loop,triad,plain_petsc} "$POROGRAIN" "$POROGRAIN_STUDY"; do
  [ -x "$tool" ] || { echo "bench.sh: $tool is not built: cmake --build BUILD --target bench" >&2 && exit 1; }
done
for part in $parts; do
  case $part in dem | memory | panel | curve | pressure | assembly | ranks | million) ;; *) echo "bench.sh: BENCH_PARTS has no $part" >&2 && exit 1 ;; esac
done
grep -v '^-output' "$options/panel_case1_ns.opts" >quiet.opts # no result file: its strains need memory
echo "what,unit,goal,measured,yardstick,yardstick value,ratio" >bench.csv

# One number for a quantity; what fails is left out.
put() { [ -z "${2:-}" ] || echo "$2" >>"values/$1"; }
median() { [ -s "values/$1" ] && sort -g "values/$1" | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }' || echo -; }
# row QUANTITY TEXT UNIT GOAL [YARDSTICK TEXT]: the goal is shown as it is written.
row() {
  local m y=- r=-
  m=$(median "$1")
  [ "$m" != - ] || return 0
  if [ $# -gt 4 ]; then y=$(median "$5"); fi
  if [ "$y" != - ]; then r=$(awk -v a="$m" -v b="$y" 'BEGIN { printf "%.2f", a / b }'); fi
  printf '%-58s %-22s %-10s %-10.4g %-18s %-10s %s\n' "$2" "$3" "$4" "$m" "${6:--}" "$y" "$r"
  echo "$2,$3,$4,$m,${6:--},$y,$r" >>bench.csv
}
wants() { [[ $parts == *" $1 "* ]]; }

# Of a command that fails nothing is measured, and the end of this script says so.
measured() { # FIELD COMMAND...
  local field=$1 line
  shift
  line=$("$BENCH/measure" "$@" 2>measure.err) || {
    echo "failed: $*" | tee -a failures >&2
    tail -n 3 measure.err >&2
    return 1
  }
  echo "$line" | cut -d' ' -f"$field"
}
cpu() { measured 1 "$@"; }
wall() { measured 2 "$@"; }
rss() { measured 3 "$@"; }
discs() { echo $((2 * $1 * $1 - 1)); }
steps_for() { # enough for a second or so
  case $1 in 25) echo 20000 ;; 100) echo 1500 ;; 316) echo 150 ;; *) echo 30 ;; esac
}
panel() { # COLUMNS STEPS OPTION ...: a run of the panel with rare output
  local w=$1 n=$2
  shift 2
  echo "$POROGRAIN" "$@" -case panel -panel_columns "$w" -panel_rows $((2 * w + 1)) -dt 1e-6 \
    -panel_displacement "$(awk -v n="$n" 'BEGIN { printf "%.9g", n * 6.18e-8 }')" -history_every 1 -progress_every 1
}
# Difference of a long and a short run: the set-up drops out.
slope() { # MEASURE DISCS STEPS SHORT-COMMAND... -- LONG-COMMAND...
  local what=$1 n=$2 steps=$3 short=() a b
  shift 3
  while [ "$1" != -- ]; do short+=("$1") && shift; done
  shift
  a=$($what "${short[@]}") && b=$($what "$@") || return 0
  awk -v a="$a" -v b="$b" -v n="$n" -v s="$steps" 'BEGIN { if (b > a) printf "%.4g\n", n * s / (b - a) }'
}

dem() {
  local w n s
  for w in $columns; do
    n=$(discs "$w") s=$(steps_for "$w")
    # shellcheck disable=SC2046
    put "dem$w" "$(slope cpu "$n" "$s" $(panel "$w" 2 -fluid none) -- $(panel "$w" $((s + 2)) -fluid none))"
    put "bare$w" "$("$BENCH/bare_loop" "$w" $((s / 5 + 1)))"
    if command -v lmp >/dev/null; then
      put "lammps$w" "$(lmp -in "$here/panel.in" -var W "$w" -var steps $((s / 5 + 1)) -log none 2>/dev/null |
        awk -v n="$n" -v s=$((s / 5 + 1)) '/^Loop time/ { t = $4 } /CPU use/ { c = $1 } END { if (t) printf "%.4g\n", n * s / (t * c / 100) }')"
    fi
  done
  put triad "$("$BENCH/triad" | cut -d' ' -f1)"
}
memory() { # shellcheck disable=SC2046
  put memory "$(rss $(panel 707 2 -fluid none) | awk 'NF { print $1 * 1024 / 999697 }')"
}
case1() {
  put implicit "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -output run.h5)"
  put implicit_icc "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -options_file "$options/solvers/cg-icc.opts" -output run.h5)"
  put implicit_oneway "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -options_file "$options/solvers/cg-hypre-oneway.opts" -output run.h5)"
  put explicit "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -pressure explicit -fluid_every 1 -dt 1e-6 -output run.h5)"
  put paper "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_ns_paper.opts" -output run.h5)"
  put darcy "$(cpu "$POROGRAIN" -options_file "$options/panel_case1_darcy.opts" -pressure explicit -fluid_every 1 -dt 1e-6 -output run.h5)"
}
# Largest difference of the load, water in every 50th step against every step, up to the peak and over it.
curve() {
  local every
  for every in 1 50; do
    cpu "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -options_file "$options/solvers/cg-icc.opts" -fluid_every $every \
      -panel_displacement 6.5e-4 -history_every 1e-4 -output curve$every.h5 >/dev/null || return 0
  done
  put curve "$(awk -F, '
    FNR == 1 { for (i = 1; i <= NF; i++) { split($i, part, " "); at[part[1]] = i } next }
    NR == FNR { f[FNR] = $at["load"]; if (f[FNR] > peak) { peak = f[FNR]; last = FNR } next }
    FNR <= last { d = $at["load"] - f[FNR]; if (d < 0) d = -d; if (d > most) most = d }
    END { if (peak) printf "%.3g", 100 * most / peak }' curve1.csv curve50.csv)"
}
pressure() { # kept preconditioners over consecutive steps of Case I
  local w s k files
  for w in 25 316; do
    s=30
    [ "$w" = 25 ] || s=8
    "$POROGRAIN_STUDY" -study stepping -options_file "$options/panel_case1_ns.opts" -panel_columns "$w" \
      -panel_rows $((2 * w + 1)) -study_solvers "$options/solvers/all.txt" -study_only cg-icc,cg-hypre,cg-hypre-oneway,cg-cholmod,cg-cholesky \
      -study_steps $s -study_output stepping >/dev/null 2>&1 || { echo "failed: the study of $w columns" | tee -a failures >&2 && continue; }
    for k in icc hypre hypre-oneway cholmod cholesky; do
      put "$k$w" "$(awk -F, -v s="cg-$k" '$1 == s { print $12 }' stepping.csv)"
    done
    rm -f dump*
    "$POROGRAIN" -options_file "$options/panel_case1_ns.opts" -panel_columns "$w" -panel_rows $((2 * w + 1)) \
      -panel_displacement "$(awk -v s=$s 'BEGIN { print s * 6.18e-6 }')" -output run.h5 -pressure_dump dump -pressure_dump_every 1 \
      >/dev/null 2>&1 || { echo "failed: the run that dumps systems, $w columns" | tee -a failures >&2 && continue; }
    files=$(ls dump* | grep -v info | sort | head -60 | paste -sd,)
    put "plain$w" "$("$BENCH/plain_petsc" -f "$files" -pc_type hypre 2>/dev/null | cut -d' ' -f1)"
    put "plainicc$w" "$("$BENCH/plain_petsc" -f "$files" -pc_type icc 2>/dev/null | cut -d' ' -f1)"
    rm -f dump*
  done
}
# Weights and values of the matrix in every step, from the summary at the end of a run: wall time, of one rank alone.
assembly() {
  local w s
  for w in 25 316; do
    s=1000
    [ "$w" = 25 ] || s=20
    # shellcheck disable=SC2046
    put "assembly$w" "$($(panel "$w" $s -options_file quiet.opts -fluid_every 1) |
      awk -v n="$(discs "$w")" -v s=$s '$1 == "assemble" { printf "%.4g", 1e6 * $2 / (n * s) }')"
  done
}
ranks() { # shellcheck disable=SC2046
  local p
  for p in 1 2 4; do
    put "dry$p" "$(slope wall 199711 150 $mpiexec -n $p $(panel 316 2 -fluid none) -- $mpiexec -n $p $(panel 316 152 -fluid none))"
    put "ns$p" "$(slope wall 199711 100 $mpiexec -n $p $(panel 316 10 -options_file quiet.opts -fluid_every 10) -- \
      $mpiexec -n $p $(panel 316 110 -options_file quiet.opts -fluid_every 10))"
  done
}
million() { # shellcheck disable=SC2046
  put million "$(rss $mpiexec -n 2 $(panel 707 100 -options_file quiet.opts -fluid_every 10) |
    awk 'NF { print 2 * $1 / 1048576 }')" # of the larger of two ranks
  put balance "$($mpiexec -n 2 $(panel 707 20 -options_file quiet.opts -fluid_every 10) |
    sed -n 's/.*at most \([0-9.]*\) of the mean number of discs.*/\1/p')"
}

for ((round = 0; round < rounds; round++)); do
  for part in dem memory panel curve pressure assembly ranks million; do
    wants $part || continue
    echo "round $((round + 1)): $part" >&2
    if [ $part = panel ]; then case1; else $part; fi
  done
done

echo "$(date -u +%Y-%m-%d), $(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo), $(getconf _NPROCESSORS_ONLN) cores, load $(cut -d' ' -f1-3 /proc/loadavg)"
printf '%-58s %-22s %-10s %-10s %-18s %-10s %s\n' what unit goal measured yardstick value ratio
for w in $columns; do
  row "dem$w" "dry DEM, $(discs "$w") discs" "disc-steps/CPU s" "4 x" "lammps$w" "LAMMPS granular"
  row "dem$w" "dry DEM, $(discs "$w") discs" "disc-steps/CPU s" "> 1 x" "bare$w" "bare loop"
done
row triad "memory bandwidth, one core" "GB/s" -
if [ -s values/dem100 ] && [ -s values/dem707 ]; then
  put growth "$(awk -v a="$(median dem100)" -v b="$(median dem707)" 'BEGIN { print 100 * (a / b - 1) }')"
  row growth "growth of the cost of a disc-step, 20k to 1M" "%" "<= 25"
fi
row memory "memory, dry, 999697 discs" "bytes/disc" "<= 500"
row implicit "Case I to 1.2 cm, N-S, implicit (M = 50, hypre)" "CPU s" "<= 8.5"
row implicit_icc "the same with cg-icc.opts" "CPU s" "<= 8.5"
row implicit_oneway "the same with cg-hypre-oneway.opts" "CPU s" "<= 8.5"
row curve "its load curve against M = 1, to the peak" "% of the peak" "<= 2"
row explicit "the same, explicit sweep every step, dt 1e-6" "CPU s" "<= 40"
row paper "panel_case1_ns_paper.opts (explicit, dt 1e-6)" "CPU s" "<= 40"
row darcy "Case I, Darcy, explicit sweep every step, dt 1e-6" "CPU s" "<= 0.6 x" explicit "N-S"
for w in 25 316; do
  goal=$([ "$w" = 25 ] && echo "<= 0.25" || echo "<= 0.75")
  row "hypre$w" "pressure step, kept hypre, $(discs "$w") discs" "us/unknown" "$goal" "plain$w" "plain PETSc"
  row "hypre-oneway$w" "pressure step, kept hypre, half smoothing, $(discs "$w") discs" "us/unknown" "$goal" "plain$w" "plain PETSc"
  row "icc$w" "pressure step, kept icc, $(discs "$w") discs" "us/unknown" "$goal" "plainicc$w" "plain PETSc"
  row "cholmod$w" "pressure step, kept CHOLMOD, $(discs "$w") discs" "us/unknown" "$goal"
  row "cholesky$w" "pressure step, kept Cholesky factor, $(discs "$w") discs" "us/unknown" "$goal"
done
for w in 25 316; do
  row "assembly$w" "assembly (weights and values), $(discs "$w") discs" "us/row" "<= 0.2"
done
row dry2 "2 ranks against 1, 199711 discs, dry" "disc-steps/wall s" ">= 1.85 x" dry1 "1 rank"
row ns2 "2 ranks against 1, 199711 discs, N-S implicit" "disc-steps/wall s" ">= 1.7 x" ns1 "1 rank"
row dry4 "4 ranks against 1, 199711 discs, dry" "disc-steps/wall s" - dry1 "1 rank"
row ns4 "4 ranks against 1, 199711 discs, N-S implicit" "disc-steps/wall s" - ns1 "1 rank"
row million "999697 discs, N-S implicit, 2 ranks, 100 steps" "GiB" "<= 3"
row balance "the same, 20 steps: most discs on a rank" "of the mean" "<= 1.1"
if [ -s failures ]; then
  echo "bench.sh: $(wc -l <failures) runs failed, their rows are left out or rest on fewer runs" >&2
  exit 1
fi

#!/usr/bin/env bash
# The tables of docs/panel.md, "The paper's claims": every run behind them, about half an hour of one processor.
# preset: long
# timeout: 14400
# processors: 1
#
# By hand, in a folder whose finished runs are kept and not repeated:
#   POROGRAIN=build/porograin SUPPORT=build/tests/support SOURCE_DIR=. bash tests/regress/panel_claims.sh
. "$SOURCE_DIR/tests/support/regress.sh"

options="$SOURCE_DIR/options"

# go NAME STATUS ARGUMENT...: one run; processor time in NAME.seconds. STATUS "any" allows the guards' 3.
go() {
  local name=$1 status=$2 got=0 TIMEFORMAT='%U'
  shift 2
  [ ! -e "$name.done" ] || return 0
  { time "$POROGRAIN" "$@" -output "$name.h5" >"$name.log" 2>&1 </dev/null || got=$?; } 2>"$name.seconds"
  [ "$status" = any ] || [ "$got" -eq "$status" ] || { tail -n 5 "$name.log" >&2; fail "$name: exit status $got"; }
  echo "$got" >"$name.done"
}

# loads NAME: peak [kN/m], at [mm], mean of the last third [kN/m], that over the peak, way from which on the mean over
# 1/50 of the run is below half of the peak [mm], end [mm], exit status
loads() {
  awk -F, -v status="$(cat "$1.done")" '
    NR == 1 { for (i = 1; i <= NF; i++) { split($i, part, " "); at[part[1]] = i } next }
    { f[++n] = $at["load"]; d[n] = $at["displacement"]; if (f[n] > peak) { peak = f[n]; where = d[n] } }
    END {
      for (i = int(2*n/3) + 1; i <= n; i++) { last += f[i]; m++ }
      window = int(n/50) + 1; half = n
      for (i = n; i > window; i--) { mean = 0; for (j = 0; j < window; j++) mean += f[i - j]/window
                                     if (mean > peak/2) break; half = i }
      printf "%.1f | %.3f | %.1f | %.2f | %.2f | %.2f | %d\n", peak/1e3, 1e3*where, last/m/1e3, last/m/peak, 1e3*d[half], 1e3*d[n], status
    }' "$1.csv"
}

# line TEXT NAME: a line of a table of loads
line() { echo "| $1 | $(loads "$2") |"; }

head_of_loads() {
  echo
  echo "### $1"
  echo
  echo "| run | peak [kN/m] | at [mm] | mean of the last third [kN/m] | over the peak | below half of the peak from [mm] | end [mm] | exit status |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
}

cases="panel_case1_dry panel_case1_darcy panel_case1_ns panel_case2_darcy panel_case2_ns"

documented() {
  local name dt
  head_of_loads "Documented reading, time steps"
  for name in $cases; do
    for dt in 2e-6 1.5e-6 1e-6 5e-7; do
      go "$name-$dt" 0 -options_file "$options/$name.opts" -dt $dt
      line "\`$name\`, dt $dt s" "$name-$dt"
    done
  done
}

# -ns_smoothing is a share in each fluid step: the same viscosity needs a share in proportion to the step.
smoothing() {
  local dt share
  head_of_loads "Case 2, Navier-Stokes: smoothing in proportion to the step, and none"
  for dt in 2e-6 1.5e-6 1e-6; do
    share=$(awk -v dt=$dt 'BEGIN { print 0.02*dt/2e-6 }')
    go "smooth-$dt" 0 -options_file "$options/panel_case2_ns.opts" -dt $dt -ns_smoothing "$share"
    line "dt $dt s, \`-ns_smoothing $share\`" "smooth-$dt"
  done
  go rough any -options_file "$options/panel_case2_ns.opts" -ns_smoothing 0
  line "dt 2e-6 s, \`-ns_smoothing 0\`" rough
}

literal() {
  local name dt
  head_of_loads "Literal reading, time steps"
  for name in $cases; do
    for dt in 1e-6 5e-7 2.5e-7; do
      go "$name-literal-$dt" any -options_file "$options/${name}_literal.opts" -dt $dt -panel_displacement 1e-3 \
        -output_every 1 -history_every 1e-5
      line "\`${name}_literal\`, dt $dt s" "$name-literal-$dt"
    done
  done
}

# The paper's equations with drained sides and damping; pressure solved, in every tenth step.
paper() {
  local name dt
  head_of_loads "Paper's equations, with damping and drained sides"
  for name in $cases; do
    for dt in 2e-6 1e-6; do
      case $name-$dt in
      panel_case1_dry-*) go "$name-paper-$dt" 0 -options_file "$options/${name}_paper.opts" -dt $dt ;;
      panel_case2_*-1e-6) continue ;;
      *) go "$name-paper-$dt" any -options_file "$options/${name}_paper.opts" -pressure implicit -fluid_every 10 -dt $dt ;;
      esac
      line "\`${name}_paper\`, dt $dt s" "$name-paper-$dt"
    done
  done
}

# Both continuity options and both couplings, all else as documented.
choices() {
  local number continuity coupling name
  head_of_loads "Continuity and coupling, all else as documented, dt 1e-6 s"
  for number in 1 2; do
    for continuity in averaged solenoidal; do
      for coupling in drag_and_pressure drag; do
        name=ns$number-$continuity-$coupling
        go "$name" any -options_file "$options/panel_case${number}_ns.opts" -ns_continuity $continuity -coupling $coupling -dt 1e-6
        line "Case $number, Navier-Stokes, $continuity, $coupling" "$name"
      done
    done
    for coupling in drag_and_pressure drag; do
      name=darcy$number-$coupling
      go "$name" any -options_file "$options/panel_case${number}_darcy.opts" -coupling $coupling -dt 1e-6
      line "Case $number, Darcy, $coupling" "$name"
    done
  done
}

# How often the water is computed, up to the peak.
fluid_steps() {
  local fluid every
  head_of_loads "Documented reading of Case I, dt 2e-6 s, a fluid step in every M steps, to 1.5 mm"
  for fluid in darcy ns; do
    for every in 50 10 5 1; do
      go "every-$fluid-$every" 0 -options_file "$options/panel_case1_$fluid.opts" -fluid_every $every -panel_displacement 1.5e-3
      line "\`panel_case1_$fluid\`, M = $every" "every-$fluid-$every"
    done
  done
}

# What holds the panel: damping, friction, confinement.
help_for_the_panel() {
  local value fluid
  head_of_loads "Dry, local damping, to 3 mm"
  for value in 0 0.05 0.1 0.3 0.5 0.7 0.9; do
    go "damping-$value" 0 -options_file "$options/panel_case1_dry.opts" -dem_local_damping $value -dt 1e-6 -panel_displacement 3e-3
    line "\`-dem_local_damping $value\`" "damping-$value"
  done
  head_of_loads "Dry, friction without damping, to 3 mm"
  for value in 0.5 0.55 0.58 0.6 0.7 1; do
    go "friction-$value" 0 -options_file "$options/panel_case1_dry.opts" -dem_local_damping 0 -dem_mu_s $value \
      -dt 1e-6 -panel_displacement 3e-3
    line "\`-dem_mu_s $value\`" "friction-$value"
  done
  head_of_loads "Dry, confined by servo-controlled side walls, no damping, to 3 mm"
  for value in 0 1e4 1e5 1e6; do
    go "confined-$value" any -case biaxial -biaxial_columns 25 -biaxial_stress $value -biaxial_velocity 0.0618 -biaxial_displacement 3e-3 \
      -dem_mu_s 0.5 -dem_mu_r 0.5 -dem_k_r 2e3 -dem_mu_theta_r 1e-4 -dem_local_damping 0 -wall_friction 0.5 -dt 1e-6
    line "\`-biaxial_stress $value\`" "confined-$value"
  done
  head_of_loads "With water, without local damping, documented otherwise, to 3 mm"
  for fluid in darcy ns; do
    for value in 0.5 0.6; do
      go "wet-$fluid-$value" any -options_file "$options/panel_case1_$fluid.opts" -dem_local_damping 0 -dem_mu_s $value \
        -dt 1e-6 -panel_displacement 3e-3
      line "Case 1, $fluid, \`-dem_mu_s $value\`" "wet-$fluid-$value"
    done
  done
}

# Fields at every 2 mm; a folder of its own for each run would be no help.
fields() {
  local name dt
  echo
  echo "### Fields"
  echo
  "$SUPPORT/panel_fields" -head
  for name in $cases; do
    for dt in 2e-6 1.5e-6 1e-6 5e-7; do "$SUPPORT/panel_fields" "$name-$dt" "$name-$dt.h5"; done
  done
  for name in $cases; do "$SUPPORT/panel_fields" "${name}_paper-2e-6" "$name-paper-2e-6.h5"; done
}

# Claim (i): processor time of both schemes for the same way.
cost() {
  local fluid number
  for fluid in darcy ns; do
    go "cost-paper-$fluid" 0 -options_file "$options/panel_case1_${fluid}_paper.opts" -panel_displacement 3e-4
  done
  echo
  echo "### Processor time of Darcy over Navier-Stokes"
  echo
  echo "| reading | Darcy [s] | Navier-Stokes [s] | ratio |"
  echo "| --- | --- | --- | --- |"
  paste cost-paper-darcy.seconds cost-paper-ns.seconds | awk '{ printf "| paper, one sweep in each step, to 0.3 mm | %.1f | %.1f | %.2f |\n", $1, $2, $1/$2 }'
  for number in 1 2; do
    paste panel_case${number}_darcy-1e-6.seconds panel_case${number}_ns-1e-6.seconds | awk -v n=$number \
      '{ printf "| documented, Case %d, dt 1e-6 s | %.1f | %.1f | %.2f |\n", n, $1, $2, $1/$2 }'
  done
}

{
  documented
  fluid_steps
  smoothing
  help_for_the_panel
  literal
  choices
  cost
  paper
  fields
} | tee claims.md

# What docs/panel.md calls true of the documented reading at every time step: the order of the peaks of Case I, and theirs in time.
column() { grep -F "\`$1\`, dt $2 s" claims.md | head -n 1 | cut -d'|' -f"$3"; }
for dt in 2e-6 1.5e-6 1e-6 5e-7; do
  for number in 3 4; do
    awk -v a="$(column panel_case1_ns $dt $number)" -v b="$(column panel_case1_darcy $dt $number)" -v c="$(column panel_case1_dry $dt $number)" \
      'BEGIN { exit !(a + 0 > b + 0 && b + 0 > c + 0) }' || fail "dt $dt: peaks of Case I do not come in the order Navier-Stokes, Darcy, dry"
  done
done

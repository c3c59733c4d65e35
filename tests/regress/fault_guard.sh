# timeout: 300
# processors: 2
# A run that goes wrong stops with status 3 and one message that names step, time, disc, place and values, the same on
# one rank and on two; its state is in FILE-postmortem.h5; and the checkpoints from before are as they were.
. "$SOURCE_DIR/tests/support/regress.sh"

panel="-case panel -panel_columns 8 -dt 2e-6 -dem_local_damping 0.7 -end_time 4e-3 -output_every 5e-5 -guard_every 10 \
  -checkpoint_every 5e-5 -checkpoint run.pgc -output run.h5"
disc='disc [0-9]+ at \([-0-9.e]+, [-0-9.e]+\) m'

# A good checkpoint, of a run that is not stopped; with all of its files in the folder FLUID-RANKS.
begin() {
  # shellcheck disable=SC2086
  run "$1" "$POROGRAIN" $panel $fluid -end_time 5e-5 >good.log 2>&1 || { cat good.log >&2; fail "$fluid: a good run"; }
}

# trip NAME RANKS BEGUN PATTERN options...: in a folder of its own
trip() {
  local name=$1 n=$2 begun=$3 pattern=$4 got=0
  shift 4
  cp "../$begun"/* .
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" $panel $fluid -restart run.pgc "$@" >run.log 2>run.err </dev/null || got=$?
  [ "$got" = 3 ] || { cat run.err >&2; fail "$name on $n ranks: status $got"; }
  expect_match "^porograin: error: $pattern" run.err
  [ "$(grep -c 'porograin: error' run.err)" = 1 ] || { cat run.err >&2; fail "$name: not one message"; }
  expect_match "^porograin: the run failed at step [0-9]+, time [-0-9.e]+ s; its state is in 'run-postmortem.h5'$" run.err
  h5ls -r run-postmortem.h5 | grep -q '^/snapshots/000000/position' || fail "$name: no state of the failure"
  # the state that went wrong has replaced nothing
  cmp run.pgc "../$begun/run.pgc" || fail "$name on $n ranks: the checkpoint has changed"
  [ ! -e run.pgc.tmp ] || fail "$name: a temporary file is left"
  grep '^porograin: error' run.err >message
}

# trips NAME PATTERN options...: no checkpoint comes between the good one and the guard
names=()
trips() {
  local name=$1 n
  shift
  names+=("$name")
  for n in 1 2; do beside within "$name-$n" trip "$name" "$n" "$begun-$n" "$@"; done
}

none='-fluid none'
darcy='-fluid darcy -fluid_every 5 -pressure explicit'
ns='-fluid ns -fluid_every 5 -pressure implicit'
for begun in none darcy ns; do
  fluid=${!begun}
  for n in 1 2; do beside within $begun-$n begin $n; done
done
together

begun=none fluid=$none
trips overlap "step [0-9]+, time [-0-9.e]+ s: $disc, velocity .*: overlap with disc [0-9]+ is [0-9.e-]+ of the smaller radius" \
  -dem_guard_overlap 2e-5
trips domain "step [0-9]+, time [-0-9.e]+ s: $disc, velocity .*: it has left -dem_guard_domain" \
  -dem_guard_domain -1,1,0.02,1
trips speed "step [0-9]+, time [-0-9.e]+ s: $disc, velocity .*: speed [0-9.e-]+ m/s is above -dem_guard_speed" \
  -dem_guard_speed 0.06
trips time_step "step [0-9]+, time [-0-9.e]+ s: $disc, mass .*bears a time step of at most .*: give a smaller -dt" \
  -dem_guard_time_step 0.25
begun=darcy fluid=$darcy
trips pressure "the water has blown up at step [0-9]+, time [-0-9.e]+ s: $disc has pressure" -pore_guard_pressure 100100
trips velocity "the water has blown up at step [0-9]+, time [-0-9.e]+ s: $disc has pressure" -pore_guard_speed 1e-3
trips porosity "step [0-9]+, time [-0-9.e]+ s: the porosity of [0-9]+ of 127 discs is out of range .* the first is $disc" \
  -porosity_min 0.2
begun=ns fluid=$ns
trips diverged "pressure: the solver stopped with DIVERGED_ITS after 1 iterations, .* largest at $disc: residual .*; in step [0-9]+, time [-0-9.e]+ s\$" \
  -pressure_ksp_max_it 1 -pressure_ksp_rtol 1e-12
together

for name in "${names[@]}"; do
  # the solver's sums depend on the number of ranks, and with them the last digits of what it leaves
  [ "$name" = diverged ] || cmp "$name-1/message" "$name-2/message" || fail "$name: messages differ"
done

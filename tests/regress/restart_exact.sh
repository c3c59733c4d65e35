# processors: 2
# timeout: 600
# A run that goes on from a checkpoint has the same bits as the one that wrote it and went on: all three kinds of
# water, explicit and implicit, on 1, 2 and 4 ranks; dry and explicit runs on another number of ranks, too.
. "$SOURCE_DIR/tests/support/regress.sh"
abreast=2 # several ranks each, which compute more than they wait

# Dashpots and damping see half-step velocities, and friction on plates has a memory: nothing can be recomputed.
panel="-case panel -panel_columns 7 -dt 2e-6 -dem_local_damping 0.4 -dem_c_n 300 -dem_c_s 150 -neighbors_skin 0.01"
# A checkpoint at a third and two thirds, each in the middle of the time between two snapshots and between two rows.
times="-end_time 1.2e-3 -output_every 1.6e-4 -history_every 2.4e-5 -checkpoint_every 4e-4"
paper="-ns_continuity solenoidal -coupling drag -sph_operators paper -sph_laplacian_eta 0.1 -pressure explicit"
documented="-coupling drag_and_pressure -sph_gradient corrected -bc_tracking surface -pressure implicit"

# start NAME RANKS options...: the run that is not interrupted; its checkpoint at a third is kept as NAME.first.
start() {
  local name=$1 n=$2
  shift 2
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" $panel $times "$@" -output "$name.h5" -checkpoint "$name.pgc" >"$name.log" 2>&1 ||
    { cat "$name.log" >&2; fail "$name"; }
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" $panel ${times/-output_every 1.6e-4/} "$@" -end_time 4e-4 -checkpoint "$name.first" >"$name.log" 2>&1 ||
    { cat "$name.log" >&2; fail "$name up to a third"; }
  [ -e "$name.pgc.1" ] || fail "$name: the checkpoint before the last one is not there"
}

# restart NAME RANKS FROM options...: what goes on from FROM on so many ranks, as restarted.h5
restart() {
  local name=$1 n=$2 from=$3
  shift 3
  rm -f restarted.*
  cp "$name.h5" restarted.h5
  # shellcheck disable=SC2086
  run "$n" "$POROGRAIN" $panel $times "$@" -output restarted.h5 -restart "$from" -checkpoint restarted.pgc \
    >restarted.log 2>&1 || { cat restarted.log >&2; fail "$name from $from on $n ranks"; }
}

same_bits() {
  expect_same_results "$1.h5" restarted.h5
  cmp "$1.csv" restarted.csv || fail "$1: the history as text differs"
  "$SUPPORT/compare_results" "$1.h5" restarted.h5 || fail "$1: snapshots differ"
  # what a further restart would start from, contact histories included
  for object in /fields /ragged; do expect_same_results "$1.pgc" restarted.pgc "$object"; done
}

# The result file of the uninterrupted run names its run, so the restarted one must be given its copy. The run of
# NAME.first is another one: it has no result file, and its checkpoint is only good for the bits of the discs.
whole() { # NAME RANKS options...
  start "$@"
  restart "$1" "$2" "$1.pgc.1" "${@:3}"
  same_bits "$1"
}
bitwise() { # NAME RANKS... -- options...: folders NAME-RANKS
  local name=$1 ranks=()
  while shift && [ "$1" != -- ]; do ranks+=("$1"); done
  shift
  for n in "${ranks[@]}"; do beside within "$name-$n" whole "$name" "$n" "$@"; done
}
# taken FOLDER NAME: the files of a run into the present folder
taken() { cp "$1/$2".{h5,csv,pgc,pgc.1,first} .; }

# shellcheck disable=SC2086
{
  bitwise dry 1 2 4 -- -fluid none
  bitwise darcy-explicit 1 4 -- -fluid darcy -pressure explicit -coupling drag_and_pressure -fluid_every 2
  bitwise ns-explicit 1 2 -- -fluid ns $paper
  bitwise darcy 1 2 -- -fluid darcy $documented -fluid_every 5
  bitwise ns 1 2 4 -- -fluid ns -ns_continuity averaged $documented -fluid_every 5 -porosity_rate sampled
  together
}

# Other numbers of ranks.
other() { # FOLDER NAME RANKS options...
  taken "../$1" "$2"
  restart "$2" "$3" "$2.pgc.1" "${@:4}"
  same_bits "$2"
}
for n in 1 2; do beside within dry-4-on-$n other dry-4 dry $n -fluid none; done
# shellcheck disable=SC2086
beside within ns-explicit-2-on-4 other ns-explicit-2 ns-explicit 4 -fluid ns $paper
together

taken dry-4 dry
taken ns-4 ns
# From the third on nothing was written into results: the same discs at the end, and a new result file.
rm -f restarted.*
# shellcheck disable=SC2086
run 1 "$POROGRAIN" $panel $times -fluid none -restart dry.first -output restarted.h5 -checkpoint restarted.pgc \
  >restarted.log || fail "restart without results"
for object in /fields /ragged; do expect_same_results dry.pgc restarted.pgc "$object"; done
first=$(csv_column restarted.csv time | head -n 1)
expect_close "$first" 4.08e-4 1e-9

# A schedule of checkpoints changes nothing in a dry run.
# shellcheck disable=SC2086
run 1 "$POROGRAIN" $panel ${times/-checkpoint_every 4e-4/} -fluid none -output none.h5 >none.log || fail "run without checkpoints"
"$SUPPORT/compare_results" dry.h5 none.h5 || fail "checkpoints have changed a dry run"

# Implicit, on another number of ranks: within ten times the tolerance of the solver (1e-8) over the 40 fluid steps
# that remain, relative to the change of a field since the start, as in ranks.sh.
# shellcheck disable=SC2086
restart ns 2 ns.pgc.1 -fluid ns -ns_continuity averaged $documented -fluid_every 5 -porosity_rate sampled
"$SUPPORT/compare_results" ns.h5 restarted.h5 1e-7 pressure position velocity porosity >compared.txt ||
  { cat compared.txt >&2; fail "an implicit run restarted on 2 ranks instead of 4"; }

# The comparison can fail.
# shellcheck disable=SC2086
restart dry 1 dry.pgc.1 -fluid none -dem_local_damping 0.4000001
if "$SUPPORT/compare_results" dry.h5 restarted.h5 2>/dev/null; then fail "the comparison is blind"; fi

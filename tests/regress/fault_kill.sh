# processors: 2
# timeout: 3000
# kill -9 at random moments of a run that spends most of its time writing: there is always a checkpoint to go on
# from, the result file can be read up to its last complete snapshot, and in the end all is as if nothing had
# happened. (Five kills; fault_kill_long.sh makes it fifty.)
. "$SOURCE_DIR/tests/support/regress.sh"

kills=${KILLS:-5}
seed=${SEED:-$(($(date +%s) % 32000))}
echo "seed $seed (SEED=$seed repeats the sequence)"

panel="-case panel -panel_columns 8 -dt 2e-6 -dem_local_damping 0.7 -end_time 1.2e-3 -output_every 6e-5 -history_every 1e-5 -checkpoint_every 1e-4"
water="-fluid ns -ns_continuity averaged -coupling drag_and_pressure -sph_gradient corrected -fluid_every 5 -pressure implicit"

# simulate RANKS OPTIONS... in the background; its processes are $pids, $! to be waited for.
start() {
  local n=$1
  shift
  # shellcheck disable=SC2086
  if [ "$n" = 1 ]; then
    "$POROGRAIN" $panel "$@" >run.log 2>&1 &
  else
    "$MPIEXEC" -n "$n" "$POROGRAIN" $panel "$@" >run.log 2>&1 &
  fi
}

# Waits a random part of `seconds`, then kills all ranks of $!.
kill_sometime() {
  local n=$1 seconds=$2 leader=$! pids
  sleep "$(awk -v r="$RANDOM" -v s="$seconds" 'BEGIN { printf "%.3f", s*r/32768 }')"
  pids=$leader
  [ "$n" = 1 ] || pids=$(pgrep -P "$leader" -x porograin || true)
  [ -n "$pids" ] || return 0
  # shellcheck disable=SC2086
  kill -9 $pids 2>/dev/null || return 0
  # mpiexec of Open MPI 4.1 may wait for a lock of its own for ever when a rank dies while it starts: it gets 20 s
  for ((k = 0; k < 200; k++)); do
    jobs -rp | grep -qx "$leader" || return 0
    sleep 0.1
  done
  # shellcheck disable=SC2046
  kill -9 "$leader" $(pgrep -P "$leader" -x porograin || true) 2>/dev/null || true
}

# What is left of the result file holds all snapshots that it says it holds.
look_at_results() {
  local said
  [ -s "$1.h5" ] || return 0
  rm -f left.*
  cp "$1.h5" left.h5
  [ ! -e "$1.h5.journal" ] || cp "$1.h5.journal" left.h5.journal
  if [ ! -e "$1.pgc" ]; then return 0; fi # it may be that not even the file was begun
  "$POROGRAIN" -recover left.h5 >recover.log 2>&1 || { cat recover.log >&2; fail "results cannot be recovered"; }
  said=$(sed -n 's/.* it holds \([0-9]*\) snapshots$/\1/p' recover.log)
  h5ls -r left.h5 >left.list 2>&1 || fail "results cannot be read"
  [ "$(grep -c '^/snapshots/[0-9]*  *Group' left.list)" = "$said" ] || fail "$said snapshots were said to be there"
  h5dump -y -d "/snapshots/$(printf %06d $((said - 1)))/position" left.h5 >/dev/null 2>&1 ||
    fail "the last snapshot cannot be read"
}

# chain NAME RANKS KILLS options...: a run killed so many times, compared with NAME-whole.
chain() {
  local name=$1 n=$2 left=$3 seconds begun from undone=0 middle=0
  shift 3
  RANDOM=$((seed + n))
  begun=$(date +%s.%N)
  start "$n" "$@" -output "$name-whole.h5" -checkpoint "$name-whole.pgc"
  wait $! || { cat run.log >&2; fail "$name"; }
  seconds=$(awk -v a="$begun" -v b="$(date +%s.%N)" 'BEGIN { print b - a }')
  while [ "$left" -gt 0 ]; do
    from=
    [ ! -e "$name.pgc" ] && [ ! -e "$name.pgc.1" ] || from="-restart $name.pgc"
    # shellcheck disable=SC2086
    start "$n" "$@" -output "$name.h5" -checkpoint "$name.pgc" $from
    kill_sometime "$n" "$seconds"
    if wait $!; then # it was faster: again from the start
      expect_same_results "$name-whole.h5" "$name.h5"
      rm -f "$name".*
      continue
    fi
    if grep -E 'porograin: error' run.log; then fail "$name: a run that was killed has not gone on"; fi
    left=$((left - 1))
    [ ! -e "$name.h5.journal" ] || undone=$((undone + 1))
    [ ! -e "$name.pgc.tmp" ] || middle=$((middle + 1))
    look_at_results "$name"
  done
  from=
  [ ! -e "$name.pgc" ] && [ ! -e "$name.pgc.1" ] || from="-restart $name.pgc"
  # shellcheck disable=SC2086
  start "$n" "$@" -output "$name.h5" -checkpoint "$name.pgc" $from
  wait $! || { cat run.log >&2; fail "$name: cannot be finished"; }
  expect_same_results "$name-whole.h5" "$name.h5"
  cmp "$name-whole.csv" "$name.csv" || fail "$name: the history as text differs"
  echo "$name: $undone kills while results were written, $middle while a checkpoint was"
}

beside within dry chain dry 1 $((kills / 2)) -fluid none
# shellcheck disable=SC2086
beside within ns chain ns 2 $((kills - kills / 2)) $water
together

# timeout: 180
# Cases that run themselves end in order, too, when a signal, the limit of wall time or a closed pipe says so: the continuum
# with a checkpoint from which it goes on as if it had not been stopped, the liquid and bodies in it with whole results.
. "$SOURCE_DIR/tests/support/regress.sh"

# ended SIGNAL FILE HOW: the run that was started last gets it after some rows, ends with 5 and says so
ended() {
  local status=0
  await "$2.csv" 20
  kill -"$1" $!
  wait $! || status=$?
  [ "$status" = 5 ] || { cat "$2.log" >&2; fail "$2: status $status after $1"; }
  expect_match "^ended early at step [0-9]+, t = [-0-9.e+]+ s \(signal $1\): $3\$" "$2.log"
  [ "$(grep -c '^ended early' "$2.log")" = 1 ] || fail "$2: more than one line"
}

# whole FILE: nothing is left to be undone, and as many snapshots as the run says
whole() {
  "$POROGRAIN" -recover "$1.h5" >"$1.recover" || fail "$1: results are not whole"
  expect_match "nothing to undo; it holds $(sed -n 's/^results in .*: \([0-9]*\) snapshots.*/\1/p' "$1.log") snapshots" "$1.recover"
}

# ---- the continuum: steps enough to be signalled in the middle ----
up=(-case up_terzaghi -up_cells 1,10 -dt 1e-3 -output_every 1e-2 -history_every 1e-3)
"$POROGRAIN" "${up[@]}" -end_time 1000 -checkpoint_every 1000 -output term.h5 -checkpoint term.pgc >term.log 2>&1 &
ended TERM term 'go on with -restart term.pgc, which holds step [0-9]+'
expect_match 'ended early at step ([0-9]+), .* which holds step \1$' term.log
whole term
steps=$(sed -n 's/^ended early at step \([0-9]*\),.*/\1/p' term.log)
# 20 steps more, and all of them at once
times=(-end_time "$(awk -v s="$steps" 'BEGIN { printf "%.3f", (s + 20) / 1000 }')" -checkpoint_every 1000)
"$POROGRAIN" "${up[@]}" "${times[@]}" -output term.h5 -restart term.pgc >again.log 2>&1 || { cat again.log >&2; fail 'going on'; }
"$POROGRAIN" "${up[@]}" "${times[@]}" -output once.h5 >once.log 2>&1 || { cat once.log >&2; fail 'a run in one piece'; }
expect_same_results once.h5 term.h5
cmp once.csv term.csv || fail 'the history as text differs'

"$POROGRAIN" "${up[@]}" -end_time 1000 -checkpoint_every 1000 -output int.h5 -checkpoint int.pgc >int.log 2>&1 &
await int.csv 5
[ ! -e int.pgc ] || fail 'a checkpoint before USR1'
kill -USR1 $!
for _ in $(seq 100); do
  [ ! -e int.pgc ] || break
  sleep 0.1
done
[ -e int.pgc ] || fail 'no checkpoint after USR1'
rows=$(wc -l <int.csv)
await int.csv $((rows + 5)) # it goes on
ended INT int 'go on with -restart int.pgc, which holds step [0-9]+'
whole int
read -r at held <<<"$(sed -n 's/^ended early at step \([0-9]*\),.* holds step \([0-9]*\)$/\1 \2/p' int.log)"
[ "$at" -gt "$held" ] || fail "INT has written a checkpoint: of step $held at step $at"
# one more that has come to none of its own yet goes on from where it came from
"$POROGRAIN" "${up[@]}" -end_time 1000 -checkpoint_every 1000 -output from.h5 -checkpoint from.pgc -restart int.pgc >from.log 2>&1 &
ended INT from "go on with -restart int.pgc, which holds step $held"

# ---- the liquid and bodies in it: -wall_time in a run that would last for hours ----
for case in wcsph_couette tak_two_elements tak_block; do
  status=0
  "$POROGRAIN" -case $case -end_time 1e4 -output_every 0.01 -history_every 0.01 -wall_time 1.5 -output $case.h5 >$case.log 2>&1 || status=$?
  [ "$status" = 5 ] || { cat $case.log >&2; fail "$case: status $status after -wall_time"; }
  expect_match '^ended early at step [1-9][0-9]*, t = .* s \(option -wall_time\): this case has no checkpoints to go on from$' $case.log
  whole $case
done
"$MPIEXEC" -n 2 "$POROGRAIN" -case wcsph_couette -end_time 1e4 -history_every 0.01 -output two.h5 >two.log 2>&1 &
await two.csv 20
ranks=$(pgrep -P $! -x porograin)
kill -TERM "$(echo "$ranks" | tail -n 1)"
wait $! && fail 'status 0 of two ranks after TERM'
expect_match '^ended early .* \(signal TERM\): this case has no checkpoints to go on from$' two.log
whole two

# ---- a reader that goes away: no words, status 5, whole results ----
{
  status=0
  "$POROGRAIN" -case wcsph_couette -end_time 1e4 -history_every 0.01 -output pipe.h5 2>pipe.err || status=$?
  echo "$status" >pipe.status
} | head -n 2 >pipe.log
[ "$(cat pipe.status)" = 5 ] || fail "status $(cat pipe.status) after a closed pipe"
[ ! -s pipe.err ] || fail "words after a closed pipe: $(cat pipe.err)"
"$POROGRAIN" -recover pipe.h5 | grep -q 'nothing to undo' || fail 'results of a closed pipe are not whole'

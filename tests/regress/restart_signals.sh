# timeout: 300
# Signals, the limit of wall time and a closed pipe end a run in order, with status 5 and a way to go on.
. "$SOURCE_DIR/tests/support/regress.sh"

# Long enough to be signalled; the snapshots are those of a run that is never stopped.
run="-case panel -panel_columns 40 -dem_local_damping 0.7 -end_time 0.1 -output_every 4e-4 -history_every 2e-5"

# ends_with SIGNAL WORDS: sends the signal to a run and checks its end.
ends_with() {
  local status=0
  rm -f run.*
  # shellcheck disable=SC2086
  "$POROGRAIN" $run -output run.h5 -checkpoint run.pgc -checkpoint_every 1e-3 >run.log 2>run.err &
  await run.csv 60
  kill -"$1" $!
  wait $! || status=$?
  [ "$status" = 5 ] || { cat run.log run.err >&2; fail "status $status after $1"; }
  [ -s run.err ] && fail "words on standard error after $1: $(cat run.err)"
  [ "$(grep -c '^ended early' run.log)" = 1 ] || fail "no line on how to go on after $1"
  expect_match "^ended early at step [0-9]+, t = [-0-9.e]+ s \\($2\\): go on with -restart run.pgc, which holds step" run.log
  expect_match 'results in run.h5' run.log
}

ends_with TERM 'signal TERM'
# with a checkpoint of that very step
expect_match 'ended early at step ([0-9]+), .* which holds step \1$' run.log
# and what goes on from there is the run that was never stopped
# shellcheck disable=SC2086
"$POROGRAIN" $run -end_time 2.4e-3 -output whole.h5 >whole.log
# shellcheck disable=SC2086
"$POROGRAIN" $run -end_time 2.4e-3 -output run.h5 -restart run.pgc >run.log
"$SUPPORT/compare_results" whole.h5 run.h5 || fail 'a run stopped by TERM and gone on with differs'

ends_with INT 'signal INT'

# USR1: a checkpoint, and on.
rm -f run.*
# shellcheck disable=SC2086
"$POROGRAIN" $run -output run.h5 -checkpoint run.pgc -checkpoint_every 1 >run.log 2>run.err &
await run.csv 20
[ -e run.pgc ] && fail 'a checkpoint before USR1'
kill -USR1 $!
for _ in $(seq 100); do
  [ -e run.pgc ] && break
  sleep 0.1
done
[ -e run.pgc ] || fail 'no checkpoint after USR1'
rows=$(wc -l <run.csv)
await run.csv "$((rows + 5))"
kill -INT $!
wait $! && fail 'status 0 after INT'
steps=$(sed -n 's/^ended early at step \([0-9]*\),.*which holds step \([0-9]*\)$/\1 \2/p' run.log)
[ "${steps% *}" -gt "${steps#* }" ] || fail "USR1 has ended the run: $steps"

# USR1 while a run is set up, which takes a while for 10^5 discs, asks for a checkpoint after the first steps.
status=0
"$POROGRAIN" -panel_columns 300 -panel_rows 300 -end_time 1 -output big.h5 -checkpoint big.pgc -checkpoint_every 1 >big.log 2>&1 &
for _ in $(seq 1000); do # until the program catches it: bit 9 of the mask
  caught=$(awk '/^SigCgt/ { print $2 }' /proc/$!/status)
  [ $((0x$caught & 0x200)) -eq 0 ] || break
  sleep 0.01
done
[ ! -e big.csv ] || fail 'USR1 is not kept before the run has been set up'
kill -USR1 $!
for _ in $(seq 600); do
  if [ -e big.pgc ] || [ ! -e /proc/$! ]; then break; fi
  sleep 0.1
done
kill -INT $! || { cat big.log >&2; fail 'USR1 has ended a run that was being set up'; }
wait $! || status=$?
[ "$status" = 5 ] && [ -e big.pgc ] || { cat big.log >&2; fail "status $status after USR1 and INT"; }
rm big.*

# A run that has come to no checkpoint of its own yet goes on from where it came from.
status=0
# shellcheck disable=SC2086
"$POROGRAIN" $run -output new.h5 -restart run.pgc -checkpoint new.pgc -checkpoint_every 1 >new.log 2>new.err &
await new.csv 20
kill -INT $!
wait $! || status=$?
[ "$status" = 5 ] && [ ! -e new.pgc ] || fail "status $status after INT, before the first checkpoint"
expect_match "^ended early .*: go on with -restart run.pgc, which holds step ${steps#* }$" new.log

# Wall time.
status=0
# shellcheck disable=SC2086
"$POROGRAIN" ${run/-output_every 4e-4/} -end_time 10 -checkpoint wall.pgc -checkpoint_every 1 -wall_time 1.5 >run.log 2>&1 || status=$?
[ "$status" = 5 ] || fail "status $status after -wall_time"
expect_match '^ended early .* \(option -wall_time\): go on with -restart wall.pgc' run.log
seconds=$(sed -n 's/^\([0-9.]*\) s for .*/\1/p' run.log)
awk -v s="$seconds" 'BEGIN { exit !(s > 0.2 && s < 10) }' || fail "-wall_time 1.5 took $seconds s"

# Without -checkpoint there is nothing to go on from, and the line says so.
status=0
# shellcheck disable=SC2086
"$POROGRAIN" ${run/-output_every 4e-4/} -end_time 10 -wall_time 0.5 >run.log 2>&1 || status=$?
[ "$status" = 5 ] || fail "status $status after -wall_time without checkpoint"
expect_match '^ended early .*: there is no checkpoint to go on from \(option -checkpoint\)' run.log

# A reader that goes away: no words, a checkpoint, status 5.
rm -f run.* pipe.*
# shellcheck disable=SC2086
{
  status=0
  "$POROGRAIN" $run -output pipe.h5 -checkpoint pipe.pgc -checkpoint_every 1 2>pipe.err || status=$?
  echo "$status" >pipe.status
} | head -n 2 >pipe.log
[ "$(cat pipe.status)" = 5 ] || fail "status $(cat pipe.status) after a closed pipe"
[ -s pipe.err ] && fail "words after a closed pipe: $(cat pipe.err)"
[ -e pipe.pgc ] || fail 'no checkpoint after a closed pipe'

# On two ranks one of them may get the signal.
rm -f run.*
# shellcheck disable=SC2086
"$MPIEXEC" -n 2 "$POROGRAIN" $run -output run.h5 -checkpoint run.pgc -checkpoint_every 1 >run.log 2>run.err &
launcher=$!
await run.csv 20
ranks=$(pgrep -P "$launcher" -x porograin)
[ -n "$ranks" ] || fail "no ranks of $launcher"
kill -TERM "$(echo "$ranks" | tail -n 1)"
wait "$launcher" && fail 'status 0 of two ranks after TERM'
expect_match '^ended early .* \(signal TERM\): go on with -restart run.pgc' run.log

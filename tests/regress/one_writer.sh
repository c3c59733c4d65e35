#!/usr/bin/env bash
# processors: 2
# timeout: 120
# While a run writes a result file no other run takes it, and -recover, which would undo a change that is going on, leaves
# it alone; when the run has been killed, both work.
. "$SOURCE_DIR/tests/support/regress.sh"

panel=(-case panel -panel_columns 4 -panel_rows 9 -dem_local_damping 0.7 -dt 1e-6 -output run.h5)
# The first run goes on until it is killed, and writes all the time.
"$POROGRAIN" "${panel[@]}" -end_time 100 -history_every 1e-6 -output_every 1e-3 >first.log 2>&1 &
first=$!
trap 'kill -9 "$first" 2>/dev/null || true' EXIT
for ((k = 0; k < 600; k++)); do
  if [ -s run.csv ] && [ "$(wc -l <run.csv)" -gt 5 ]; then break; fi
  kill -0 "$first" || { cat first.log >&2; fail 'the first run'; }
  sleep 0.1
done
flock -s -n run.csv true 2>/dev/null && skip 'this file system has no locks'

size=$(head -c 200 run.csv | cksum)
for n in 1 2; do
  expect_error 4 "^porograin: error: result file 'run.h5': another run is writing it$" run $n "$POROGRAIN" "${panel[@]}" -end_time 1e-5
done
expect_error 4 "^porograin: error: cannot recover result file 'run.h5': a run is writing it" "$POROGRAIN" -recover run.h5
[ "$(head -c 200 run.csv | cksum)" = "$size" ] || fail 'the history of the first run has changed'
kill -0 "$first" || { cat first.log >&2; fail 'the first run has ended'; }

# A file in the middle of a change is not drawn, and the reader hears why. Where the run has been stopped there may be a
# journal or none.
kill -STOP "$first"
[ -e run.h5.journal ] || { : >run.h5.journal && : >made_here; }
expect_error 4 "a run is writing to it just now: try again" "$POROGRAIN_PLOT" run.h5 -plot_gnuplot none
if [ -e made_here ]; then rm run.h5.journal; fi

kill -9 "$first"
wait "$first" || true
"$POROGRAIN" -recover run.h5 >recover.log || fail 'results of a killed run'
"$POROGRAIN" "${panel[@]}" -end_time 1e-5 >again.log || fail 'a new run in the place of a killed one'

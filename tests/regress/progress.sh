#!/usr/bin/env bash
# timeout: 120
# How a run tells where it is: a bar on a terminal, lines for anything else, and a summary that agrees with the results.
. "$SOURCE_DIR/tests/support/regress.sh"

small=(-options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -panel_columns 10 -panel_rows 21 -panel_displacement 2e-4)
cr=$'\r'

# Not a terminal: lines.
"$POROGRAIN" "${small[@]}" -output lines.h5 -history_every 1e-4 -checkpoint lines.chk >lines.out
expect_match '^step +1600  t 3.2000e-03 s .* left [0-9]+ s$' lines.out
! grep -q "$cr" lines.out || fail 'a bar in a file'

# The summary says what the files say: the peak, iterations of all fluid steps, rows and snapshots.
fluid_step=$(awk '/water every/ { gsub(/[;,]/, " "); for (i = 1; i < NF; i++) if ($i == "every") print $(i + 3) }' lines.out)
expect_close "$fluid_step" 1e-4 0 # so that each fluid step has its row
expect_close "$(sed -n 's/^peak load \([^ ]*\) .*/\1/p' lines.out)" \
  "$(csv_column lines.csv load | awk 'NR == 1 || $1 > m { m = $1 } END { print m }')" 1 # five digits are printed of 3e4
rows=$(csv_column lines.csv time | wc -l)
read -r total most < <(csv_column lines.csv pressure_iterations | awk '{ s += $1; if ($1 > m) m = $1 } END { print s, m }')
expect_match "^$((rows - 1)) pressure solves, $total iterations, .* at most $most; [0-9]+ preconditioners?\$" lines.out
snapshots=$(h5ls lines.h5/snapshots | wc -l)
expect_match "^results in lines.h5, .*: $snapshots snapshots, $rows rows of history\$" lines.out
expect_match '^checkpoint in lines.chk, of step 1650$' lines.out
expect_match '^  pressure +[0-9.]+ s +[0-9.]+ %$' lines.out

# As asked.
"$POROGRAIN" "${small[@]}" -progress none >none.out
! grep -Eq "^step |$cr" none.out || fail 'progress although -progress none'
expect_match '^peak load ' none.out
"$POROGRAIN" "${small[@]}" -progress bar >bar.out
# Where one is, and how far: the bar of the last step is full, and then taken away for the summary.
grep -q "${cr}100 % \[#*\] t 0.0033 of 0.003236 s  load [0-9.]* kN/m  left 0:00" bar.out || fail 'no full bar'
tr "$cr" '\n' <bar.out | sed 's/^\x1b\[K//' | grep -q '^peak load ' || fail 'the bar is not taken away'
# What goes wrong has a line of its own, too.
if "$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns_literal.opts" -progress bar -output bad.h5 >bad.out 2>&1; then
  fail 'the literal reading is expected to fail'
fi
grep -q "left [0-9:]*"$'\x1b\\[K'"$cr" bad.out || fail 'no bar before the failure'
tr "$cr" '\n' <bad.out | sed 's/^\x1b\[K//' | grep -q '^porograin: error: ' || fail 'the message shares a line with the bar'
expect_error 2 "option -progress: .*'bars'.*bar" "$POROGRAIN" "${small[@]}" -progress bars

# Cases with a run of their own tell it in the same way.
up=(-case up_terzaghi -up_cells 2,20 -end_time 18)
liquid=(-case wcsph_couette -wcsph_cells 10 -wcsph_columns 12 -end_time 2)
tak=(-options_file "$SOURCE_DIR/options/tak_block.opts" -dt 4e-3 -tak_block_every 2 -tak_block_cells 20,3 -end_time 0.08)
for name in up liquid tak; do
  declare -n options=$name
  "$POROGRAIN" "${options[@]}" -output $name.h5 >$name.out
  [ "$(grep -c '^t [0-9]' $name.out)" -ge 20 ] || fail "$name: no lines"
  ! grep -q "$cr" $name.out || fail "$name: a bar in a file"
  rows=$(csv_column $name.csv time | wc -l)
  snapshots=$(h5ls $name.h5/snapshots | wc -l)
  expect_match "^results in $name.h5, .*: $snapshots snapshots, $rows rows of history\$" $name.out
  [ -s $name.xmf ] || fail "$name.xmf is told of, and not there"
  "$POROGRAIN" "${options[@]}" -progress bar >$name.bar.out
  grep -q "${cr}100 % \[#*\] t .* s  left 0:00" $name.bar.out || fail "$name: no full bar"
  tr "$cr" '\n' <$name.bar.out | sed 's/^\x1b\[K//' >$name.bar.lines
  expect_match '^[0-9.]+ s for ' $name.bar.lines # the bar is taken away
  "$POROGRAIN" "${options[@]}" -progress none >$name.none.lines
  for way in bar none; do # what the run has come to is told all the same
    [ "$(grep -c '^t [0-9]' $name.$way.lines)" -eq 1 ] || fail "$name: not one line with -progress $way"
  done
  ! grep -q "$cr" $name.none.lines || fail "$name: a bar although -progress none"
done
# Each step of the continuum has its row; the first is the start, which is not solved for.
read -r total most < <(csv_column up.csv pressure_iterations | awk '{ s += $1; if ($1 > m) m = $1 } END { print s, m }')
expect_match "^200 solves for displacement and pressure, $total iterations, .* at most $most\$" up.out
expect_match '^[0-9.]+ s for 200 steps of 63 nodes, [^ ]+ node-steps/s$' up.out
expect_match '^  pressure +[0-9.]+ s +[0-9.]+ %$' up.out
expect_match '^[0-9.]+ s for [0-9]+ steps of 216 particles, [^ ]+ particle-steps/s$' liquid.out
# a step of the zones every other one of the 20, and two zones
expect_match '^20 solves of the zones, [0-9]+ iterations, ' tak.out
# A run that goes on counts what it has done itself.
"$POROGRAIN" "${up[@]}" -checkpoint up.pgc -checkpoint_every 9 >first.out
expect_match '^checkpoint in up.pgc, of step 200$' first.out
"$POROGRAIN" "${up[@]}" -restart up.pgc.1 >second.out
expect_match '^[0-9.]+ s for 100 steps of 63 nodes' second.out
expect_match '^100 solves for displacement and pressure, ' second.out

# On a terminal.
command -v script >/dev/null || skip 'there is no program script (Debian: bsdutils) to make a terminal'
# terminal COLUMNS command...: its output, as a terminal gets it
terminal() {
  local columns=$1
  shift
  script -qec "stty cols $columns; $(printf '%q ' "$@")" /dev/null </dev/null
}
export TERM=xterm
terminal 100 "$POROGRAIN" "${small[@]}" >terminal.out
grep -q "${cr}100 % \[#*\] t " terminal.out || fail 'no bar on a terminal'
! grep -q '^step ' terminal.out || fail 'lines on a terminal'
terminal 40 "$POROGRAIN" "${small[@]}" >narrow.out
widest=$(tr "$cr" '\n' <narrow.out | grep -aE '^ *[0-9]+ %' | sed 's/\x1b\[K//' | awk '{ if (length > m) m = length } END { print m }')
expect_close "$widest" 39 0 # more would wrap, and is cut off
for name in up liquid; do
  declare -n options=$name
  terminal 100 "$POROGRAIN" "${options[@]}" >$name.terminal.out
  grep -q "${cr}100 % \[#*\] t .* s  left 0:00" $name.terminal.out || fail "$name: no bar on a terminal"
  tr "$cr" '\n' <$name.terminal.out | sed 's/^\x1b\[K//' >$name.terminal.lines
  [ "$(grep -c '^t [0-9]' $name.terminal.lines)" -eq 1 ] || fail "$name: lines on a terminal"
  expect_match '^[0-9.]+ s for ' $name.terminal.lines
done
TERM=dumb terminal 100 "$POROGRAIN" "${small[@]}" >dumb.out
expect_match '^step ' dumb.out
# mpiexec gives its processes terminals, but what they print may go anywhere.
terminal 100 "$MPIEXEC" -n 2 "$POROGRAIN" "${small[@]}" >mpi.out
expect_match '^step ' mpi.out
! grep -q '% \[' mpi.out || fail 'a bar under mpiexec'

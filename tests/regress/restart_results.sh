# timeout: 300
# The result file of a restarted run: cut to the time of the checkpoint and gone on with, or left alone with a message.
. "$SOURCE_DIR/tests/support/regress.sh"

panel="-case panel -panel_columns 5 -dt 2e-6 -dem_local_damping 0.7 -end_time 4e-4 -history_every 6e-6"
# simulate options...: with snapshots when there are results
simulate() {
  local every=
  case " $* " in *' -output '*) every='-output_every 4e-5' ;; esac
  # shellcheck disable=SC2086
  "$POROGRAIN" $panel $every "$@" >run.log 2>run.err
}
must() { simulate "$@" || { cat run.err >&2; fail "$*"; }; }

must -output whole.h5 -checkpoint whole.pgc -checkpoint_every 2.6e-4
cp whole.pgc.1 middle.pgc # step 130 of 200

same() {
  expect_same_results whole.h5 "$1.h5"
  cmp whole.csv "$1.csv" || fail "$1.csv differs"
  [ "$(grep -c '<Grid Name="0' "$1.xmf")" = "$(grep -c '<Grid Name="0' whole.xmf)" ] || fail "$1.xmf differs"
}
fresh() {
  rm -f again.*
  cp whole.h5 again.h5
}

# The two files beside it are made from the result file.
fresh
must -output again.h5 -restart middle.pgc
same again

# A finished run made longer, and then again from its end, where nothing is left to do.
must -output short.h5 -checkpoint short.pgc -end_time 1.3e-4 -checkpoint_every 1.3e-4
cp short.h5 longer.h5
must -output longer.h5 -restart short.pgc -checkpoint longer.pgc -checkpoint_every 1.3e-4
"$SUPPORT/compare_results" whole.h5 longer.h5 2>differences && fail 'a run made longer has the snapshot of its first end'
must -output whole.h5 -restart whole.pgc
expect_match 'results in whole.h5' run.log

# What a kill in the middle of a line leaves.
fresh
head -c 777 whole.csv >again.csv
must -output again.h5 -restart middle.pgc
same again

# A file that has less than the checkpoint says is told about.
cp short.h5 older.h5
h5dump -a /provenance/run short.h5 | grep '(0)' >run.short
must -output older.h5 -restart short.pgc
fresh
must -output again.h5 -restart middle.pgc -end_time 2.8e-4 -checkpoint again.pgc -checkpoint_every 1e-3
fresh_rows=$(csv_column again.csv time | wc -l)
must -output again.h5 -restart middle.pgc -end_time 2.7e-4 # cut back by a restart from an earlier checkpoint
[ "$(csv_column again.csv time | wc -l)" -lt "$fresh_rows" ] || fail 'nothing was cut'
must -output again.h5 -restart again.pgc
expect_match 'warning: result file .again.h5. has [0-9]+ rows and [0-9]+ snapshots where the checkpoint knows of' run.log

# Results of another run are left alone.
before=$(cksum <whole.h5)
# shellcheck disable=SC2086
expect_error 2 "result file 'whole.h5' belongs to another run than the checkpoint" "$POROGRAIN" $panel \
  -output whole.h5 -restart short.pgc
[ "$(cksum <whole.h5)" = "$before" ] || fail 'the results of another run were changed'

# Not there: a new file, with what comes after.
must -output new.h5 -restart middle.pgc
expect_close "$(csv_column new.csv time | head -n 1)" 2.64e-4 1e-9

# Not HDF5, or not readable.
echo 'some text' >text.h5
# shellcheck disable=SC2086
expect_error 4 "result file 'text.h5': cannot open the file" "$POROGRAIN" $panel -output text.h5 -restart middle.pgc
[ "$(cat text.h5)" = 'some text' ] || fail 'a foreign file was changed'

# The latest valid checkpoint of a directory or pattern; the one before a damaged one.
mkdir kept
cp -p middle.pgc kept/a.pgc
cp -p whole.pgc kept/b.pgc
cp whole.h5 kept/results.h5
must -restart kept -end_time 4.1e-4
expect_match 'continued from kept/b.pgc, step 200' run.log
must -restart 'kept/[a-b].pgc' -end_time 4.1e-4
expect_match 'continued from kept/b.pgc, step 200' run.log
printf 'x' | dd of=kept/b.pgc bs=1 seek=3000 conv=notrunc status=none
must -restart kept
expect_match "warning: checkpoint passed over: 'kept/b.pgc': its checksum is wrong" run.log
expect_match 'continued from kept/a.pgc, step 130' run.log
# Only damaged ones: each is named with what is wrong; what is no checkpoint, or a write that did not end, is not.
mkdir damaged
cp kept/b.pgc kept/results.h5 damaged
cp middle.pgc damaged/c.pgc.tmp
head -c 9999 middle.pgc >damaged/half
: >damaged/empty.pgc.1
wrong="'damaged/b.pgc': its checksum is wrong: it is damaged"
# shellcheck disable=SC2086
{
  expect_error 4 "cannot restart from 'damaged': no checkpoint there is valid: '" "$POROGRAIN" $panel -restart damaged
  for part in "$wrong" "'damaged/half': it has no seal" "'damaged/empty.pgc.1': it is empty"; do expect_match "$part" expect_error.out; done
  ! grep -E 'results|tmp' expect_error.out || fail 'what is no checkpoint is named'
  expect_error 4 "cannot restart from 'damaged/b\*': no checkpoint there is valid: $wrong" "$POROGRAIN" $panel -restart 'damaged/b*'
  cp damaged/half damaged/b.pgc.1
  expect_error 4 "cannot restart from 'damaged/b.pgc': its checksum is wrong: it is damaged; the one before it, 'damaged/b.pgc.1': it has no seal" \
    "$POROGRAIN" $panel -restart damaged/b.pgc
}
mv kept/b.pgc pair
mv kept/a.pgc pair.1
must -restart pair
expect_match "warning: checkpoint 'pair': its checksum is wrong: it is damaged; the one before it, 'pair.1', is taken" run.log
rm pair
must -restart pair
expect_match "warning: checkpoint 'pair': No such file or directory; the one before it, 'pair.1', is taken" run.log
rm pair.1
# shellcheck disable=SC2086
{
  expect_error 4 "cannot restart from 'pair': No such file or directory" "$POROGRAIN" $panel -restart pair
  expect_error 4 "cannot restart from 'kept': there is no checkpoint" "$POROGRAIN" $panel -restart kept
  expect_error 4 "cannot restart from 'kept/\*': no checkpoint there is valid: 'kept/results.h5': it has no seal" "$POROGRAIN" $panel -restart 'kept/*'
}

# Another problem, other steps.
# shellcheck disable=SC2086
{
  expect_error 4 "checkpoint 'middle.pgc': cannot go on from it: it holds 49 discs, this run has" \
    "$POROGRAIN" $panel -panel_columns 6 -restart middle.pgc
  expect_error 4 "cannot go on from it: option -fluid is 'none' in the checkpoint and 'darcy' now" \
    "$POROGRAIN" $panel -fluid darcy -restart middle.pgc
  expect_error 4 'cannot go on from it: the time step \(option -dt\) \[s\] is 2e-06 in the checkpoint and 1e-06 now' \
    "$POROGRAIN" $panel -dt 1e-6 -restart middle.pgc
  expect_error 4 'cannot go on from it: the mass of all discs, by the options of the case and -solid_density, \[kg/m\] is [0-9.]* in the checkpoint and [0-9.]* now' \
    "$POROGRAIN" $panel -solid_density 3000 -restart middle.pgc
  expect_error 4 'cannot go on from it: the sum of all radii, by the options of the case, \[m\] is 0.245' \
    "$POROGRAIN" $panel -panel_radius 6e-3 -restart middle.pgc
  expect_error 4 'cannot go on from it: velocity of plate upper \[m/s\] is -0.0618 in the checkpoint and -0.05 now' \
    "$POROGRAIN" $panel -panel_velocity 0.05 -restart middle.pgc
}

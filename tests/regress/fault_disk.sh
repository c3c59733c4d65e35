# timeout: 300
# Full disks, places that cannot be written, files and directories that vanish: a message, a status, and the last good
# checkpoint is intact.
. "$SOURCE_DIR/tests/support/regress.sh"

panel="-case panel -panel_columns 20 -dt 2e-6 -dem_local_damping 0.7 -end_time 0.1 -history_every 1e-4"

await_file() {
  for _ in $(seq 600); do
    if [ -e "$1" ]; then return; fi
    sleep 0.05
  done
  fail "$1 did not come"
}

# begin FILE options...: a run with checkpoints, as soon as the first one is there.
begin() {
  local file=$1
  shift
  # shellcheck disable=SC2086
  "$POROGRAIN" $panel -checkpoint "$file" -checkpoint_every 2e-3 "$@" >run.log 2>run.err &
  await_file "$file"
}

# ends STATUS PATTERN
ends() {
  local status=0
  wait $! || status=$?
  [ "$status" = "$1" ] || { cat run.log run.err >&2; fail "status $status instead of $1"; }
  grep -Eq "^porograin: error: $2" run.err || { cat run.err >&2; fail "nothing like '$2' in run.err"; }
  [ "$(grep -c 'porograin: error' run.err)" = 1 ] || { cat run.err >&2; fail 'more than one message'; }
}

# loadable FILE: a restart from it does its first steps.
loadable() {
  local step
  # shellcheck disable=SC2086
  "$POROGRAIN" $panel -end_time 1e-9 -restart "$1" >loaded.log 2>&1 || { cat loaded.log >&2; fail "$1 is lost"; }
  step=$(sed -n 's/^continued from .*, step \([0-9]*\),.*/\1/p' loaded.log)
  [ "$step" -gt 0 ] || fail "$1 holds step $step"
}

# ---- without any privileges ----

# shellcheck disable=SC2086
{
  expect_error 4 "checkpoint 'nowhere/run.pgc': No such file or directory" "$POROGRAIN" $panel -checkpoint nowhere/run.pgc
  expect_error 4 "checkpoint '/proc/run.pgc': " "$POROGRAIN" $panel -checkpoint /proc/run.pgc
  expect_error 4 "checkpoint '\.': Is a directory" "$POROGRAIN" $panel -checkpoint .
}
[ ! -e nowhere ] || fail 'a directory was made'

# A checkpoint that vanishes is written again; its directory is another matter.
mkdir place
begin place/run.pgc
rm -f place/run.pgc # while it is renamed there is none for a moment
await_file place/run.pgc
until rm -r place 2>/dev/null; do [ -e place ] || break; done # a new file may come in the middle
# at which of its calls a run notices depends on the moment: creating, writing, sealing
ends 4 ".*checkpoint 'place/run.pgc(.tmp)?': .*No such file or directory"

# The result file vanishes.
begin run.pgc -output run.h5 -output_every 1e-3
rm run.h5
ends 4 ".*result file 'run.h5'.*: .*No such file or directory"
loadable run.pgc

# No more room: a limit on the size of files stands in for a full disk where none can be mounted.
begin limited.pgc
prlimit --pid $! --fsize=$(($(stat -c %s limited.pgc) / 2))
# the limit may come when all is written but the seal
ends 4 "cannot (write [0-9.]+ MiB into|seal) checkpoint 'limited.pgc.tmp': File too large"
[ ! -e limited.pgc.tmp ] || fail 'a temporary file is left'
loadable limited.pgc

# ---- file systems of our own ----

mkdir disk
if ! mount -t tmpfs -o size=6m tmpfs disk 2>/dev/null; then
  echo 'mounting a small disk is not permitted here: the rest is skipped'
  exit 0
fi
# shellcheck disable=SC2064
trap "umount -l '$PWD/disk'" EXIT

begin disk/run.pgc
head -c 100m /dev/zero >disk/filler 2>/dev/null || true
ends 4 "cannot write [0-9.]+ MiB into checkpoint 'disk/run.pgc.tmp': No space left on device"
[ ! -e disk/run.pgc.tmp ] || fail 'a temporary file is left on the full disk'
rm disk/filler
loadable disk/run.pgc

# on two ranks, and with the results on the disk that fills up
rm -f disk/*
# shellcheck disable=SC2086
"$MPIEXEC" -n 2 "$POROGRAIN" $panel -output disk/run.h5 -output_every 4e-4 -checkpoint run2.pgc -checkpoint_every 3e-4 \
  >run.log 2>run.err &
await_file run2.pgc
head -c 100m /dev/zero >disk/filler 2>/dev/null || true
ends 4 "cannot write .*result file 'disk/run.h5': No space left on device"
rm disk/filler
loadable run2.pgc
"$POROGRAIN" -recover disk/run.h5 >recover.log || fail 'results on the full disk are lost'
h5ls -r disk/run.h5 | grep -q '^/snapshots/000000/position' || fail 'results on the full disk cannot be read'

# read-only from the start, and from the middle on
rm -f disk/*
begin disk/run.pgc
# busy while a checkpoint is being written
for _ in $(seq 200); do if mount -o remount,ro disk 2>mount.err; then break; else sleep 0.01; fi; done
ends 4 ".*checkpoint 'disk/run.pgc(.tmp)?': .*Read-only file system"
loadable disk/run.pgc
# shellcheck disable=SC2086
expect_error 4 "checkpoint 'disk/run.pgc': Read-only file system" "$POROGRAIN" $panel -checkpoint disk/run.pgc

# processors: 2
# timeout: 600
# Every call with which a run touches its files is made to fail, one after the other: no run ends by a signal or says
# nothing, and whatever happens the last good checkpoint is there. (Every tenth reading call; fault_io_long.sh all
# calls, with other errors.)
. "$SOURCE_DIR/tests/support/regress.sh"

export ASAN_OPTIONS="${ASAN_OPTIONS:-}:verify_asan_link_order=0"
panel=(-case panel -panel_columns 3 -dt 2e-6 -dem_local_damping 0.7 -progress none -checkpoint place/run.pgc -output
  place/run.h5)
every=${EVERY:-10} # of the calls that only read
errors=(28 5)      # ENOSPC, EIO
[ "$every" != 1 ] || errors=(28 5 2 30 116) # and ENOENT, EROFS, ESTALE

# A run with a checkpoint, and one that goes on from it, reads and writes all files, and replaces the checkpoint.
mkdir -p begun/place
(cd begun && "$POROGRAIN" "${panel[@]}" -end_time 2e-6) >begun.log
go_on=("${panel[@]}" -end_time 4e-6 -restart place/run.pgc)
cp -r begun whole
(cd whole && LD_PRELOAD="$PRELOAD/fail_io.so" FAIL_IO_PATH=place/ FAIL_IO_LOG=calls "$POROGRAIN" "${go_on[@]}") >whole.log
for name in open pread pwrite fsync rename ftruncate posix_fallocate fflush; do # otherwise nothing is tried
  grep -q " $name$" whole/calls || fail "no call of $name was seen"
done

# Of a folder in which a run has ended with status $1, its call $2 having failed, on $3 ranks.
judge() {
  local status=$1 said
  said=$(grep -c '^porograin: error: ' err || true)
  case $status in
    0) # close, unlink and the like: nothing is lost, and the run is the one that nobody has disturbed
      [ "$said" = 0 ] || echo 'status 0 and a message'
      [ "$(tail -n +1 place/run.csv)" = "$(cat ../whole/place/run.csv)" ] || echo 'status 0 and another history' ;;
    4)
      [ "$said" = 1 ] || echo "$said messages"
      grep -Eq "^porograin: error: .*'place/run[^']*'" err || echo 'the message names no file' ;;
    *) echo "status $status" ;;
  esac
  # nobody else has a say, but for mpiexec, which tells of the status
  if [ "$3" = 1 ]; then grep -Ev '^porograin: ' err; else grep -E 'HDF5|mca_|[Ss]ignal' err; fi || true
  # the checkpoint from before is one of the two, or has been replaced by a good one
  if ! cmp -s ../begun/place/run.pgc place/run.pgc && ! cmp -s ../begun/place/run.pgc place/run.pgc.1; then
    echo 'the checkpoint is lost'
  elif [ "$status" = 0 ] && ! [ -s place/run.pgc.1 ]; then
    echo 'status 0 and no new checkpoint'
  fi
  [ "$(wc -l <calls)" -ge "$2" ] || echo "it has not come to call $2"
}

# failing RANKS AT ERROR FROM_THEN_ON: FAILED gets a line for what is wrong.
failing() {
  local n=$1 at=$2 status=0 folder="run-$1-$2-$3-$4"
  cp -r begun "$folder"
  cd "$folder"
  # shellcheck disable=SC2016
  run "$n" env LD_PRELOAD="$PRELOAD/fail_io.so" FAIL_IO_PATH=place/ FAIL_IO_LOG=calls FAIL_IO_RANK=0 FAIL_IO_AT="$at" \
    FAIL_IO_ERROR="$3" ${4:+FAIL_IO_FROM_THEN_ON=1} timeout 60 "$POROGRAIN" "${go_on[@]}" >out 2>err </dev/null || status=$?
  judge "$status" "$at" "$n" | sed "s/^/call $(sed -n "${at}p" calls), error $3${4:+ from then on}, $n ranks: /" >../"$folder.wrong"
  cd ..
  rm -r "$folder"
}

tried=0
# Every second one is followed by failures only.
try() {
  local later=
  [ $((tried % 2)) -eq 0 ] || later=1
  tried=$((tried + 1))
  beside failing "$1" "$2" "${errors[$((tried / 2 % ${#errors[@]}))]}" "$later"
}

reads=0
while read -r number name; do
  if [ "$name" = pread ] || [ "$name" = fstat ]; then
    reads=$((reads + 1))
    [ $((reads % every)) -eq 0 ] || continue
  fi
  try 1 "$number"
done <whole/calls

# on two ranks the other one is not left waiting
calls=$(wc -l <whole/calls)
step=$((every == 1 ? 10 : calls / 6))
for ((number = step; number <= calls; number += step)); do try 2 "$number"; done
together

cat run-*.wrong >wrong
[ ! -s wrong ] || { head -n 40 wrong >&2; fail "$(cut -d: -f1 wrong | sort -u | wc -l) of $tried runs"; }
[ "$tried" -ge 150 ] || fail "only $tried runs"
echo "$tried runs, $calls calls"

# Sourced by the scripts in tests/regress and tests/verify:  . "$SOURCE_DIR/tests/support/regress.sh"
# The environment is made by tests/CMakeLists.txt: POROGRAIN, POROGRAIN_STUDY, POROGRAIN_PLOT, MPIEXEC,
# SOURCE_DIR, WORK_DIR (the present, empty folder).
set -euo pipefail

fail() {
  printf 'FAIL: %s\n' "$*" >&2
  exit 1
}

# skip REASON: for a test that needs a program which is not here and which porograin itself does not need.
skip() {
  printf 'SKIP: %s\n' "$*"
  exit 77
}

# run N command...: on N ranks.
run() {
  local n=$1
  shift
  if [ "$n" -eq 1 ]; then "$@"; else "$MPIEXEC" -n "$n" "$@"; fi
}

# Starts of programs mostly wait; those that do not need each other run side by side, at most so many at once.
abreast=4

# beside command...: a command or function in the background. What it says is kept until together(), which waits for all
# and fails when one has failed, was killed, or has called fail(). A script that ends without together() fails, too.
# Never as a condition (if beside, beside || ...): there bash goes on after what has failed.
beside_started=0
beside() {
  local id
  beside_started=$((beside_started + 1))
  printf -v id 'beside.%s.%04d' "$BASHPID" "$beside_started"
  beside_home=${beside_home:-$PWD}
  while [ "$(jobs -rp | wc -l)" -ge "$abreast" ]; do wait -n || true; done
  echo "$*" >"$beside_home/$id.open"
  trap beside_forgotten EXIT
  (
    "$@"
    rm "$beside_home/$id.open" # not when it has failed
  ) >"$beside_home/$id.said" 2>&1 </dev/null &
}

together() {
  local open bad=0
  wait
  trap - EXIT
  for open in "$beside_home/beside.$BASHPID".*.open; do
    [ -e "$open" ] || continue
    bad=$((bad + 1))
    { echo "-- $(head -c 300 "$open")" && cat "${open%.open}.said"; } >&2
  done
  [ "$bad" -eq 0 ] || fail "$bad of $beside_started that ran side by side"
  cat "$beside_home/beside.$BASHPID".*.said
  rm "$beside_home/beside.$BASHPID".*
  beside_started=0
}

# within FOLDER command...: in a new folder of that name, for beside().
within() {
  mkdir "$1"
  cd "$1"
  shift
  "$@"
}

beside_forgotten() {
  local status=$?
  wait
  [ "$status" -ne 0 ] || fail 'nobody has waited for what ran side by side: together()'
  exit "$status"
}

# expect_error STATUS PATTERN command...: the command must end with STATUS and its output match the
# extended regular expression PATTERN. The output stays in ./expect_error.out.
expect_error() {
  local status=$1 pattern=$2 got=0
  shift 2
  "$@" >expect_error.out 2>&1 </dev/null || got=$?
  if [ "$got" -ne "$status" ]; then
    cat expect_error.out >&2
    fail "exit status $got, expected $status: $*"
  fi
  if ! grep -Eq -- "$pattern" expect_error.out; then
    cat expect_error.out >&2
    fail "no message like '$pattern': $*"
  fi
}

# expect_match PATTERN FILE
expect_match() {
  grep -Eq -- "$1" "$2" || fail "nothing like '$1' in $2"
}

# expect_close VALUE REFERENCE TOLERANCE: |VALUE - REFERENCE| <= TOLERANCE, all three finite numbers.
expect_close() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
    number = "^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$"
    if (a !~ number || b !~ number || t !~ number) exit 1
    d = a - b; if (d < 0) d = -d
    exit !(d <= t + 0) }' || fail "$1 is not within $3 of $2"
}

# csv_column FILE NAME: the values of a column of a history file, one on each line.
csv_column() {
  awk -F, -v want="$2" '
    NR == 1 { for (i = 1; i <= NF; i++) { name = $i; gsub(/^[ #"]+/, "", name); sub(/[ ["(].*$/, "", name)
                                          if (name == want) column = i }
              if (!column) { print "no column " want > "/dev/stderr"; exit 1 }
              next }
    !/^#/   { print $column }' "$1"
}

# expect_same_results A.h5 B.h5 [OBJECT...]: bitwise equal snapshots and history (or the given objects).
expect_same_results() {
  local a=$1 b=$2 object
  shift 2
  [ $# -gt 0 ] || set -- /snapshots /history
  for object in "$@"; do
    # h5diff is silent, with status 0, about objects that cannot be compared and those in one file only
    # unless they are listed first.
    h5ls -r "$a$object" | sort >objects.a || fail "$a has no $object"
    h5ls -r "$b$object" | sort >objects.b || fail "$b has no $object"
    [ -s objects.a ] || fail "$a: $object is empty"
    cmp -s objects.a objects.b || fail "$a and $b do not hold the same objects under $object"
    h5diff "$a" "$b" "$object" "$object" >h5diff.out 2>&1 || {
      head -n 20 h5diff.out >&2
      fail "$a and $b differ in $object"
    }
  done
}

# await FILE LINES: waits for a run in the background until its history has more lines than that; fails after a minute
await() {
  for _ in $(seq 600); do
    if [ -e "$1" ] && [ "$(wc -l <"$1")" -gt "$2" ]; then return; fi
    sleep 0.1
  done
  fail "no progress in $1"
}

# timeout: 60
# The helpers that all other scripts rely on: each must pass where it should and fail where it should.
. "$SOURCE_DIR/tests/support/regress.sh"

# shellcheck disable=SC2016
leave() { bash -c 'echo "porograin: error: $1"; exit "$2"' _ "$@"; }
must_fail() {
  if (unset -f none; "$@") >/dev/null 2>&1; then fail "accepted: $*"; fi
}

expect_error 3 'no such.*option' leave 'no such -option' 3
must_fail expect_error 3 'no such' leave 'no such' 2
must_fail expect_error 0 'something else' leave 'no such' 0
must_fail expect_error 3 'something else' leave 'no such' 3

expect_close 1.0005 1 1e-3
expect_close -2e-3 -0.002 0
must_fail expect_close 1.002 1 1e-3
must_fail expect_close nan 1 1e9
must_fail expect_close '' 0 1

printf 'time [s],load [N/m],load_total [N/m]\n0,1,2\n1,3,4\n' >history.csv
[ "$(csv_column history.csv load | paste -sd ' ')" = '1 3' ] || fail 'csv_column load'
[ "$(csv_column history.csv load_total | paste -sd ' ')" = '2 4' ] || fail 'csv_column load_total'
must_fail csv_column history.csv pressure

expect_match '^0,1' history.csv
must_fail expect_match '^5' history.csv

# The scratch folder is the test's own and was empty.
[ "$PWD" = "$(cd "$WORK_DIR" && pwd)" ] || fail "runs in $PWD"

# Side by side: all is well only when all are; nobody is forgotten; what they say is shown, in their order.
# shellcheck disable=SC2016
both='. "$SOURCE_DIR/tests/support/regress.sh"; beside sleep 0.2; beside eval "echo first; $1; echo second"; together'
[ "$(bash -c "$both" _ true | paste -sd ' ')" = 'first second' ] || fail 'together does not show what was said'
for wrong in false 'fail nothing' 'exit 3' 'kill -9 $BASHPID' 'expect_match ^5 history.csv' 'cd nowhere'; do
  must_fail bash -c "$both" _ "$wrong"
done
must_fail bash -c "${both%together}" _ false
must_fail bash -c "${both%together}" _ true
bash -c "$both; $both" _ true >twice
[ "$(wc -l <twice)" -eq 4 ] || fail 'a second together'
rm -f beside.*
at_once() { # how many are there at once: each counts those that have begun and not ended
  mkdir "here.$1"
  find . -maxdepth 1 -name 'here.*' | wc -l >>counts
  sleep 0.3
  rmdir "here.$1"
}
abreast=3
for k in 1 2 3 4 5 6 7; do beside at_once $k; done
together
[ "$(sort -n counts | tail -n 1)" -eq 3 ] || fail "at once: $(paste -sd ' ' counts)"
! ls beside.* 2>/dev/null || fail 'files are left'

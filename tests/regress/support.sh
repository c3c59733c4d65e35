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

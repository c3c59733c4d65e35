# timeout: 60
# docs/verification.md has the rows of the tests in tests/verify, all of them and no others: every case and every quantity
# whose name stands in a test as it is, and every case of the table in some test. Numbers are not compared: they differ in
# the last digits between machines, and each test asserts its own. tests/support/verification_table.sh makes the file.
. "$SOURCE_DIR/tests/support/regress.sh"

table=$SOURCE_DIR/docs/verification.md
tests=$SOURCE_DIR/tests/verify

# Arguments "case", "quantity" of VerifyValue(), VerifyOrder() and so on, on one line or over several; quantities that
# are put together at run time (a variable) are left out.
cat "$tests"/*.c | tr '\n' ' ' |
  grep -oE '(Verify(Value|Order|Range|Report)|SequenceLine)\( *"[^"]*", *("([^"]*)"( *"[^"]*")*|[a-z&])' |
  sed -E 's/^[A-Za-z]*\( *"([^"]*)", */\1|/; s/" +"//g; s/"//g' | sort -u >from_tests
[ "$(wc -l <from_tests)" -gt 60 ] || fail "only $(wc -l <from_tests) calls found in the tests"
cut -d'|' -f1 from_tests | sort -u >cases
grep -hoE 'VERIFY \| [^|]*[^ |]' "$tests"/*.sh | sed 's/^VERIFY | //' | sort -u >>cases
sort -u -o cases cases

sed -n 's/^## //p' "$table" | grep -v '^Breaks' | grep -v '^Left out' | sort -u >headings
twice=$(grep '^## ' "$table" | sort | uniq -d)
[ -z "$twice" ] || fail "more than one table for: $twice"
missing=$(comm -23 cases headings)
[ -z "$missing" ] || fail "no table for: $missing"
extra=$(comm -13 cases headings)
[ -z "$extra" ] || fail "tables without a test: $extra"

# case|quantity of each row
awk -F' [|] ' '/^## / { name = substr($0, 4) } /^[|] / { sub(/^[|] /, "", $1); print name "|" $1 }' "$table" >in_table
count=0
while IFS='|' read -r case quantity; do
  [ ${#quantity} -gt 1 ] || continue # a variable
  count=$((count + 1))
  grep -Fxq -- "$case|$quantity" in_table || fail "no row '$quantity' in the table of $case: run tests/support/verification_table.sh"
done <from_tests
echo "$count quantities of $(wc -l <cases) cases"

# Each break replaces something in the sources as they are, and is a row of the table of breaks, and the other way round.
bash "$SOURCE_DIR/tests/support/breaks.sh" check || fail 'tests/support/breaks.sh has lines that break nothing'
sed -n "/<<'LINES'/,/^LINES/p" "$SOURCE_DIR/tests/support/breaks.sh" | sed '1d; $d' |
  sed -E 's/^([^ ]*) ;.*; ([^;]*)$/\1|\2/' | sort >lines
sed -nE 's/^\| `([^`]*)` \| (.*) \| yes.*$/\1|\2/p' "$table" | sort >rows
[ "$(wc -l <rows)" -gt 20 ] || fail "only $(wc -l <rows) breaks in $table"
diff lines rows >&2 || fail 'the breaks of tests/support/breaks.sh are not those of the table'

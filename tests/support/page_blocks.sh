# Sourced by tests that run blocks of a page themselves, those with the note <!-- by: tests/regress/NAME.sh -->:
#
#   take_blocks docs/PAGE.md    the blocks of the page with the note of this test become blocks/1, blocks/2, ...
#   run_block N                 in the order of the page, as they stand, in the present folder
#   no_block_left               they all have been run
#
# regress.docs_commands takes the first and the last call as the proof that the blocks are run.
blocks=$WORK_DIR/blocks

take_blocks() {
  local by=tests/regress/${0##*/} n=0 count=0
  mkdir -p "$blocks/all"
  (cd "$blocks/all" && awk -f "$SOURCE_DIR/tests/support/docs_blocks.awk" "$SOURCE_DIR/$1")
  while n=$((n + 1)) && [ -e "$blocks/all/block.$n" ]; do
    grep -qx "by: $by" "$blocks/all/block.$n.about" && grep -q '^language \(sh\|python\)$' "$blocks/all/block.$n.about" ||
      continue
    count=$((count + 1))
    cp "$blocks/all/block.$n" "$blocks/$count"
    cp "$blocks/all/block.$n.about" "$blocks/$count.about"
  done
  [ "$count" -gt 0 ] || fail "$1 has no block that $by runs"
}

# A program in Python that begins with "# NAME.py:" is written to that file; a command of the page runs it.
run_block() {
  local name
  [ -e "$blocks/$1" ] || fail "there is no block $1"
  name=$(sed -n '1s/^# *\([a-z_]*\.py\):.*/\1/p' "$blocks/$1")
  if [ -n "$name" ]; then
    cp "$blocks/$1" "$name"
  elif grep -q '^language python' "$blocks/$1.about"; then
    python3 "$blocks/$1"
  else
    bash -e -o pipefail "$blocks/$1"
  fi
  rm "$blocks/$1"
}

no_block_left() {
  local left
  left=$(cd "$blocks" && find . -maxdepth 1 -name '[0-9]*' ! -name '*.about')
  [ -z "$left" ] || fail "not run: block $left"
}

# Sourced by docs_commands.sh: whether a script runs the commands of a block. Needs build_folder.

# Lines of a script, or of a block, as bare words: lines that go on are joined, comments and quotes left out; a command
# in a variable goes by the name of that, "$POROGRAIN_PLOT" by porograin-plot. Parts of lines between && and ; are lines.
bare_lines() {
  awk '{ if (sub(/\\$/, "")) { held = held $0; next } print held $0; held = "" }' "$1" |
    sed -e 's/^[[:blank:]]*#.*//' -e 's/[[:blank:]]#.*//' -e 's/&&/\n/g' -e 's/;/\n/g' | tr -d "\"'(){}" |
    awk '{ for (i = 1; i <= NF; i++) if ($i ~ /^\$[A-Z_a-z]+$/) { $i = tolower(substr($i, 2)); gsub("_", "-", $i) } print }'
}

# has_command LINES COMMAND: one of the bare lines has all words of the command in their order; folders of a build or of
# a user may be others, and words may come in between.
has_command() {
  awk -v command="$2" '
    function base(word) { sub(/.*\//, "", word); return word }
    BEGIN { n = split(command, word, " ")
            for (i = 1; i <= n; i++) if (word[i] != "build" && word[i] != "sudo" && word[i] !~ /^~/) wanted[++count] = word[i] }
    { k = 1
      for (i = 1; i <= NF && k <= count; i++) if ($i == wanted[k] || base($i) == base(wanted[k])) k++
      if (k > count) found = 1 }
    END { exit !found }' "$1"
}

# has_target NAME FILE: a target of CMake runs the script
has_target() {
  awk -v name="$1" -v file="$2" '
    $0 ~ "^ *add_custom_target\\(" name "( |$)" { inside = 1 }
    inside && index($0, "/" file "\"") { found = 1 }
    /\)$/ { inside = 0 }
    END { exit !found }' "$SOURCE_DIR/CMakeLists.txt"
}

# tests_chosen FILE COMMAND: every alternative of ctest -R chooses tests, and one of them is FILE
tests_chosen() {
  local pattern part label=${1#tests/}
  pattern=$(sed -n 's/.* -R \([^ ]*\).*/\1/p' <<<"$2")
  [ -n "$pattern" ] || return 1
  (cd "$build_folder" && ctest -N -R "$pattern") >chosen
  label=${label%.*}
  grep -q " ${label/\//.}\$" chosen || return 1
  for part in ${pattern//|/ }; do grep -q "$part" chosen || return 1; done
}

# runs_block FILE PAGE BLOCK: and says what it does not run
runs_block() {
  local by=$1 page=$2 block=$3 command
  [ -s "$SOURCE_DIR/$by" ] || { echo "there is no $by" >&2; return 1; }
  # all blocks of the page that name it, or it fails
  bare_lines "$SOURCE_DIR/$by" >lines
  if grep -qx "take_blocks $page" lines && grep -qx 'no_block_left' lines; then return 0; fi
  bare_lines "$block" | grep -v '^ *$' >commands
  [ -s commands ] || { echo "no command in the block" >&2; return 1; }
  while read -r command; do
    case $command in
    "bash $by") continue ;;
    "cmake --build build --target "*) ! has_target "${command##* }" "$by" || continue ;;
    "ctest "*" -R "*) ! tests_chosen "$by" "$command" || continue ;;
    esac
    has_command lines "$command" || { echo "$by does not run: $command" >&2; return 1; }
  done <commands
}

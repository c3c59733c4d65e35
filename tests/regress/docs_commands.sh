#!/usr/bin/env bash
# processors: 2
# timeout: 600
# Every command of README.md and docs/*.md is run, in the order of the page and in a folder of its own, and every link
# leads somewhere. Blocks of shell begin with ```sh, programs in Python with ```python; what stands above them says how:
#   <!-- long -->                   only with POROGRAIN_LONG_TESTS
#   <!-- short PROGRAM: OPTIONS --> options that PROGRAM gets besides, in short runs
#   <!-- by: FILE -->               FILE, another test or a script of .ci, runs it: is seen to, by docs_by.sh
#   <!-- clone -->                  as it stands, in a new clone of the source, only with POROGRAIN_LONG_TESTS
#   <!-- needs: WORD... -->         programs or files without which it is left out
#   <!-- not run: REASON -->        never; but the presets and targets that it names are there
# and <!-- all ... --> says it for all blocks of the page that follow.
. "$SOURCE_DIR/tests/support/regress.sh"
. "$SOURCE_DIR/tests/support/docs_by.sh"
long=${DOCS_LONG:-no}
home=$WORK_DIR

# Programs that add the options of a short run to those of the page.
mkdir programs
for program in porograin porograin-study porograin-plot; do
  variable=$(echo "$program" | tr '[:lower:]-' '[:upper:]_')
  printf '#!/usr/bin/env bash\nexec %q "$@" $SHORT_%s\n' "${!variable}" "$variable" >programs/$program
  chmod +x programs/$program
done
ln -s "$MPIEXEC" programs/mpiexec
PATH=$home/programs:$PATH
# The Python of the distribution, which has its packages.
if [ -x /usr/bin/python3 ]; then ln -s /usr/bin/python3 programs/python3; fi

value() { sed -n "s|^$2: *||p" "$1.about" | head -n 1; }
has() { grep -q "^$2" "$1.about"; }
is_missing() { case $1 in /*) [ ! -e "$1" ] ;; *) ! command -v "$1" >/dev/null ;; esac; }

# left_out BLOCK: whether this machine lacks what the block needs; the reason is printed.
left_out() {
  local word module
  for word in $(value "$1" needs); do
    if is_missing "$word"; then echo "    left out: there is no $word"; return 0; fi
  done
  grep -q '^language python' "$1.about" || return 1
  if is_missing python3; then echo '    left out: there is no python3'; return 0; fi
  for module in $(sed -n 's/^\(import\|from\) \([A-Za-z0-9_]*\).*/\2/p' "$1"); do
    [ "$module" != paraview ] || continue # for pvpython
    if ! python3 -c "import $module" 2>/dev/null; then echo "    left out: python3 has no $module"; return 0; fi
  done
  return 1
}

# run_block BLOCK: in the present folder
run_block() {
  local block=$1 name
  SHORT_POROGRAIN='' SHORT_POROGRAIN_STUDY='' SHORT_POROGRAIN_PLOT=''
  if [ "$long" = no ]; then
    SHORT_POROGRAIN=$(value "$block" 'short porograin')
    SHORT_POROGRAIN_STUDY=$(value "$block" 'short porograin-study')
    SHORT_POROGRAIN_PLOT=$(value "$block" 'short porograin-plot')
  fi
  export SHORT_POROGRAIN SHORT_POROGRAIN_STUDY SHORT_POROGRAIN_PLOT
  if grep -q '^language python' "$block.about"; then
    name=$(sed -n '1s/^# *\([a-z_]*\.py\):.*/\1/p' "$block") # a program with a name is run by a command of the page
    if [ -n "$name" ]; then cp "$block" "$name"; else python3 "$block"; fi
  else
    bash -euo pipefail "$block"
  fi
}

# Presets and targets of CMake, as "preset NAME" and "target NAME".
build_folder=$(dirname -- "$POROGRAIN")
cmake=$(sed -n 's/^CMAKE_COMMAND:[^=]*=//p' "$build_folder/CMakeCache.txt")
(cd "$SOURCE_DIR" && "$cmake" --list-presets=all) | sed -n 's/^  "\([^"]*\)".*/preset \1/p' | sort -u >cmake_names
"$cmake" --build "$build_folder" --target help | sed -n 's/^\.\.\. \([^ ]*\).*/target \1/p; s/^\([^ :]*\): phony$/target \1/p' >>cmake_names

# names_exist BLOCK: of presets and targets
names_exist() {
  local word
  { grep -o -- '--\(preset\|target\) *[A-Za-z_-]*' "$1" || true; } | sed 's/^--//; s/  */ /' | while read -r word; do
    grep -qx "$word" "$home/cmake_names" || fail "there is no $word"
  done
}

# page FILE: all blocks
page() {
  local file=$1 n=0 block line by start
  echo "$file"
  mkdir -p "pages/$file" && cd "pages/$file"
  ln -s "$SOURCE_DIR"/{options,docs,tests} .
  ln -s "$home/programs" build
  mkdir .blocks
  (cd .blocks && awk -f "$SOURCE_DIR/tests/support/docs_blocks.awk" "$SOURCE_DIR/$file")
  while n=$((n + 1)) && [ -e .blocks/block.$n ]; do
    block=$PWD/.blocks/block.$n
    line=$(sed -n 's/^line //p' "$block.about")
    ! grep -Ev '^(language|line) |^(long|clone)$|^(short porograin(-study|-plot)?|by|needs|not run): ' "$block.about" ||
      fail "$file:$line: no such note"
    if ! grep -q '^language \(sh\|python\)$' "$block.about"; then
      # what the program prints may be shown, but a command must not escape
      ! grep -E '^(\$ )?((sudo|bash|cmake|ctest|cpack|mpiexec|mpicc|python3|pvpython) |(\S*/)?porograin(-study|-plot)? -)' "$block" ||
        fail "$file:$line: commands in a block that does not begin with \`\`\`sh are not run"
      continue
    fi
    by=$(value "$block" by)
    if [ -n "$by" ]; then
      runs_block "$by" "$file" "$block" || fail "$file:$line"
      echo "  line $line: by $by"
      continue
    fi
    if has "$block" 'not run'; then names_exist "$block"; fi
    if has "$block" 'not run'; then echo "  line $line: not run: $(value "$block" 'not run')"; continue; fi
    if has "$block" '\(long\|clone\)' && [ "$long" = no ]; then continue; fi
    if left_out "$block" >left_out.why; then echo "  line $line"; cat left_out.why; continue; fi
    start=$SECONDS
    if has "$block" clone; then
      [ -d clone ] || git clone -q "$SOURCE_DIR" clone
      (cd clone && run_block "$block") >out 2>&1 </dev/null || { tail -n 20 out >&2; fail "$file:$line"; }
    else
      run_block "$block" >out 2>&1 </dev/null || { tail -n 20 out >&2; fail "$file:$line"; }
    fi
    echo "  line $line: $((SECONDS - start)) s"
    echo "$file:$line" >>"$home/blocks_run.$(echo "$file" | tr / _)"
  done
}

# links FILE: to files of the source
links() {
  local target
  { grep -o ']([^)]*)' "$SOURCE_DIR/$1" || true; } | sed 's/^](//; s/)$//; s/#.*//' | sort -u | while read -r target; do
    [ -z "$target" ] || [[ $target == http* ]] || [ -e "$SOURCE_DIR/$(dirname "$1")/$target" ] || fail "$1 links to $target, which is not there"
  done
}

cd "$SOURCE_DIR"
pages=(README.md docs/*.md)
cd "$home"
for file in "${pages[@]}"; do links "$file"; done
# The README leads to all of them, and every picture is shown somewhere.
for file in "${pages[@]}"; do
  [ "$file" = README.md ] || grep -q "]($file)" "$SOURCE_DIR/README.md" || fail "README.md does not link to $file"
done
for picture in "$SOURCE_DIR"/docs/figures/*; do
  grep -q "figures/$(basename "$picture")" "$SOURCE_DIR"/README.md "$SOURCE_DIR"/docs/*.md || fail "no page shows ${picture##*/}"
done
# Pages know nothing of each other.
for file in "${pages[@]}"; do beside page "$file"; done
together
[ "$(cat blocks_run.* | wc -l)" -ge 10 ] || fail "only $(cat blocks_run.* | wc -l) blocks were found and run"

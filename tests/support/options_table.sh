#!/usr/bin/env bash
# options_table.sh BUILD [FILE]: writes the options of the three programs, as they tell them with -help markdown, to FILE
# (docs/options.md beside this script by default). BUILD is the folder of the programs.
set -euo pipefail

[ $# -ge 1 ] && [ -x "$1/porograin" ] || {
  echo "usage: $0 BUILD [FILE]: BUILD is the folder in which the programs have been built" >&2
  exit 2
}
build=$1
file=${2:-$(cd "$(dirname "$0")/../.." && pwd)/docs/options.md}

{
  cat <<'END'
# Options

Written by `tests/support/options_table.sh BUILD` from what the programs themselves say (`-help markdown`), and compared with
them by the test `regress.help`; not to be edited.

- Options stand on the command line, in files (`-options_file FILE`, plain or YAML) and in the variable `PETSC_OPTIONS`. Of an
  option given twice the last counts; the command line counts more than `PETSC_OPTIONS`.
- In a plain file each line holds one option, with its value; `#` begins a comment. A list of values has commas and no blanks.
- All numbers are in SI units; a number without unit has no dimension. Equations are those of Li, Chu & Sheng (2007).
- A default "of the case" is chosen by the case; where the meaning says what the default is, the column is empty. Cases bring
  options along, too: what a case sets stands at the top of `src/cases/NAME.c`, and what the user gives wins.
- An option that is misspelt, out of bounds, or without effect in the run ends it before anything is written, with exit status 2;
  one that stands in a file and is overruled by something given later is named in a line of warning instead.
- `-help` is short, `-help SECTION` lists one of the sections below, `-help NAME` one option, `-help petsc` what PETSc has to say,
  `-version` the versions of everything.
- Options of PETSc itself (`-log_view`, `-options_left`, ...) work as everywhere.
- Exit status: 0 done, 2 bad input, 3 the run failed, 4 trouble with a file, 5 ended early by a signal or `-wall_time`, 1 anything
  else.

# porograin
END
  "$build/porograin" -help markdown
  cat <<'END'

# porograin-study

Besides those of `porograin`, which belong to the runs that a study makes:
END
  "$build/porograin-study" -help markdown
  cat <<'END'

# porograin-plot

Arguments that belong to no option are the files to draw.
END
  "$build/porograin-plot" -help markdown
} | sed 's/ *$//' >"$file.new"
mv "$file.new" "$file"

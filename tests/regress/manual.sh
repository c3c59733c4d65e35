#!/usr/bin/env bash
# timeout: 120
# The manual pages: no option, exit status or field that the programs do not know, none of porograin-plot's left out, and
# no complaint of groff.
. "$SOURCE_DIR/tests/support/regress.sh"
man=$SOURCE_DIR/docs/man

# A run that is not to happen: the last option is none. Its complaint names all unknown options.
none=-no_such_option
porograin=('-fluid ns -pressure implicit -bc_top flux -bc_top_flux -0.1' '-fluid ns -pressure explicit'
  '-case packing -packing_generate square -packing_count 9 -dt 1e-7 -end_time 1e-6')
porograin_study=("-study_sizes 31 -study_solvers $SOURCE_DIR/options/solvers/all.txt")
porograin_plot=('-plot_gnuplot none')
# known PROGRAM OPTION: in one of the settings the program complains about another option, or about the value
known() {
  local setting name out=known-$(basename "$1")$2.out
  name=$(basename "$1" | tr - _)
  local -n settings=$name
  for setting in "${settings[@]}"; do
    # shellcheck disable=SC2086
    "$1" $setting "$2" "$none" >"$out" 2>&1 </dev/null && return 1
    grep -q "unknown option $2\b" "$out" || return 0
  done
  return 1
}
# is_known PROGRAM OPTION
is_known() { known "$1" "$2" || fail "$(basename "$1").1: the program does not know $2: $(head -n 1 known-*"$2.out")"; }
is_unknown() { ! known "$1" "$2" || fail "$1 knows everything"; }
options() { # PAGE: those in the headings of its lists
  sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' "$man/$1" | sed -n '/^\.TP/{n;p}' | grep -o '\\-[a-z][a-z_]*' | sed 's/^\\//' | sort -u
}
for program in porograin porograin-study porograin-plot; do
  binary=$(dirname "$POROGRAIN")/$program
  options "$program.1" >options
  [ "$(wc -l <options)" -ge 8 ] || fail "$program.1: only $(wc -l <options) options found"
  beside is_unknown "$binary" -no_such_other_option
  for option in $(grep -Ev '^-(help|version|log_view|options_file)$' options); do beside is_known "$binary" "$option"; done
done
together
# The fields of porograin-plot, all of them.
"$POROGRAIN_PLOT" none.h5 -plot_fields none >fields.out 2>&1 || true
sed -n 's/.*there are //p' fields.out | tr -d ',' | tr ' ' '\n' >fields
[ "$(wc -l <fields)" -ge 12 ] || fail "fields of porograin-plot: $(cat fields.out)"
while read -r field; do
  grep -q "\b$field\b" "$man/porograin-plot.1" || fail "porograin-plot.1 does not tell of field $field"
done <fields
# Each exit status.
for status in 0 1 2 3 4 5; do
  sed -n '/^\.SH EXIT/,/^\.SH SIGNALS/p' "$man/porograin.1" | grep -q "^\.B $status\$" || fail "porograin.1: exit status $status"
done

command -v groff >/dev/null || skip 'no groff: the pages are not formatted'
for page in "$man"/*.1; do
  groff -ww -man -Tascii "$page" >text 2>warnings || fail "groff on $page"
  [ ! -s warnings ] || fail "groff on $page: $(head -n 3 warnings)"
  sed 's/\x1b\[[0-9;]*m//g; s/.\x08//g' text >plain
  for section in NAME SYNOPSIS DESCRIPTION OPTIONS 'EXIT STATUS' EXAMPLES 'SEE ALSO'; do
    grep -q "^$section" plain || fail "$page has no section $section"
  done
done

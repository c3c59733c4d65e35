#!/usr/bin/env bash
# The table of docs/panel.md: all documented option files, and the `_paper` files of Case I, with both pressures.
# preset: long
# timeout: 7200
. "$SOURCE_DIR/tests/support/regress.sh"

# row NAME PRESSURE ARGUMENT...: one run to its end and its line of the table.
row() {
  local name=$1 pressure=$2 log=$1-$2.log argument=()
  shift 2
  [ "$pressure" = none ] || argument=(-pressure "$pressure")
  "$POROGRAIN" -options_file "$SOURCE_DIR/options/$name.opts" "${argument[@]}" -output "$name-$pressure.h5" "$@" >"$log" 2>&1 ||
    fail "$name with pressure $pressure ended with status $?: $(grep error "$log")"
  awk -F, -v name="$name" -v pressure="$pressure" '
    NR == 1 { for (i = 1; i <= NF; i++) { split($i, part, " "); at[part[1]] = i } next }
    { if ($at["load"] > peak) { peak = $at["load"]; where = $at["displacement"] }
      n++; load[n] = $at["load"]; end = $at["displacement"] }
    END { for (i = int(0.9 * n) + 1; i <= n; i++) { sum += load[i]; m++ }
          printf "| `%s` | %s | %.2f | %.3f | %.2f | %.1f |\n", name, pressure, 1e-3 * peak, 1e3 * where, 1e-3 * sum / m, 1e3 * end }' "$name-$pressure.csv"
}

echo "| options | pressure | peak load [kN/m] | at displacement [mm] | mean load of the last tenth [kN/m] | end [mm] |" | tee table.md
echo "| --- | --- | --- | --- | --- | --- |" | tee -a table.md
for name in panel_case1_dry panel_case1_dry_paper; do row $name none | tee -a table.md; done
for name in panel_case1_darcy panel_case1_ns panel_case2_darcy panel_case2_ns panel_case1_darcy_paper panel_case1_ns_paper; do
  for pressure in implicit explicit; do row $name $pressure | tee -a table.md; done
done
# the order of peaks that the paper reports in Case I, for the documented reading: N-S > Darcy > dry
peak() { grep -F "\`$1\` | $2" table.md | cut -d'|' -f4; }
awk -v a="$(peak panel_case1_ns implicit)" -v b="$(peak panel_case1_darcy implicit)" -v c="$(peak panel_case1_dry none)" \
  'BEGIN { exit !(a > b && b > c) }' || fail "peak loads of Case I do not come in the order N-S, Darcy, dry"

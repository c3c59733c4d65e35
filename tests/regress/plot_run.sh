#!/usr/bin/env bash
# timeout: 300
# porograin-plot on short runs and a study: the files that it promises, and its errors.
. "$SOURCE_DIR/tests/support/regress.sh"

short=(-panel_columns 10 -panel_rows 21 -panel_displacement 1.236e-4 -output_every 1e-3 -history_every 1e-4)
"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" "${short[@]}" -output "wet run's.h5" >wet.log
"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_dry.opts" "${short[@]}" -output dry.h5 >dry.log
mkdir other
cp dry.h5 other/dry.h5
wet=wet_run_s # a blank and a quotation mark have no place in the names of figures

# nothing FOLDER: no files, or no such folder, and no working folder left
nothing() { [ -z "$(ls -A "$1" 2>/dev/null)" ] || fail "files in $1: $(ls -A "$1")"; }

# Scripts and data do not need gnuplot.
"$POROGRAIN_PLOT" "wet run's.h5" dry.h5 other/dry.h5 -figures scripts -plot_gnuplot none -plot_film pressure >scripts.out
for f in load $wet-{effective_strain,volumetric_strain,rotation,porosity,pressure,streamlines,relative_speed,fields,history} \
  $wet-film-pressure dry-{effective_strain,volumetric_strain,rotation,fields,history} dry-2-rotation; do
  [ -s "scripts/$f.gp" ] || fail "no script $f.gp"
done
for f in $wet-{load,history,discs,streamlines,arrows,grid,contours,film-pressure-000000,film-pressure-000002} dry-discs dry-2-load; do
  [ -s "scripts/$f.dat" ] || fail "no data $f.dat"
done
# A dry run has nothing of water; that is said, and there is no empty figure of it.
expect_match 'note: dry.h5 has no data for these pictures: pressure, streamlines, relative_speed' scripts.out
! ls scripts | grep -Eq '^dry-(pressure|streamlines|relative_speed|film)' || fail 'figures of water in a dry run'
[ "$(ls -A scripts | grep -c '^\.')" -eq 0 ] || fail 'the working folder was left'
grep -q "title 'wet run''s'" scripts/load.gp || fail 'the name in the legend'
# What the figures show is what is in the file: peak of the load [kN/m], number of discs, time in the title.
expect_close "$(awk '!/^#/ && $2 > m { m = $2 } END { print m }' "scripts/$wet-load.dat")" \
  "$(csv_column "wet run's.csv" load | awk '$1 / 1000 > m { m = $1 / 1000 } END { print m }')" 1e-3
[ "$(grep -vc '^#' "scripts/$wet-discs.dat")" -eq 199 ] || fail 'number of discs'
expect_match 't = 0.002 s, displacement 0.124 mm' "scripts/$wet-pressure.gp" # 2e-3 s at 0.0618 m/s
# Signed fields have colours symmetric about 0.
range=$(sed -n 's/^set cbrange \[\(.*\)\]$/\1/p' "scripts/$wet-rotation.gp")
expect_close "${range%:*}" "-${range#*:}" 0

# Another time: the snapshot nearest to it.
"$POROGRAIN_PLOT" "wet run's.h5" -figures early -plot_time 1.2e-3 -plot_fields pressure -plot_gnuplot none >early.out
expect_match 't = 0.001 s' "early/$wet-pressure.gp"
expect_match "note: wet run's.h5 has no snapshot at 0.0012 s, the nearest is drawn, of 0.001 s" early.out
! grep -q 'no snapshot at' scripts.out || fail 'a note about a time that nobody asked for'

# Labels of the colour bar in the last column of a sheet end inside it, however many digits they have. In a PNG they begin
# 13 pixels from the bar; digits have 9.3, at small sizes rounded up to as much as 10 (6 at -plot_size 0.6), the point half.
"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" "${short[@]}" -panel_displacement 1.236e-5 -output narrow.h5 >narrow.log
"$POROGRAIN_PLOT" narrow.h5 -figures narrow -plot_fields porosity,pressure,effective_strain,rotation -plot_gnuplot none >narrow.out
awk '/set terminal svg size/ { split($5, size, ",") }
  /^set colorbox user/ { split($6, at, ","); split($9, wide, ","); end = (at[1] + wide[1]) * size[1] }
  /^set cbrange/ { gsub(/[^-+.:e0-9]/, "", $3); split($3, range, ":") }
  /^set format cb/ { gsub(/\x27/, "", $4); label = sprintf($4, range[1]); n++
    if (end + 13 + 10 * (length(label) - 1) + 5 > size[1]) { print "the label " label " ends outside"; bad = 1 } }
  END { exit bad || n != 4 || length(label) < 7 }' narrow/narrow-fields.gp || fail 'labels of the colour bars of a sheet'
[ ! -e "early/$wet-rotation.gp" ] || fail '-plot_fields draws more than asked'

# Left of a sheet there is room for the longest number at the y axis, and for "y [mm]", which is 15 pixels high and which
# gnuplot puts 40 pixels from the axis without the number; whatever the size is. And there are two tics on either axis.
tics() { # SHEET: longest number at the y axis
  awk -v sheet="$1" '/set terminal svg size/ { split($5, size, ",") }
    /^set [xy]range/ { split(substr($3, 2), range, ":"); low = range[1]; high = range[2] + 0 }
    /^set [xy]range/ { from[substr($2, 1, 1)] = low; to[substr($2, 1, 1)] = high }
    /^set [xy]tics [0-9.]/ { axis = substr($2, 1, 1); n = 0; longest = 0
      for (i = -int(-from[axis] / $3 ) - 1; i * $3 <= to[axis]; i++) {
        if (i * $3 < from[axis]) continue
        n++
        if (length(sprintf("%g", i * $3)) > longest) longest = length(sprintf("%g", i * $3)) }
      if (n < 2 && !done) { print sheet ": " n " tics on axis " axis; bad = 1 } }
    /^set border/ { done = 1; digits = longest }
    /^set lmargin/ && !placed++ { left = $5 * size[1]
      if (left < 7 * digits + 55) { print sheet ": " left " pixels for " digits " digits" ; bad = 1 } }
    END { if (!bad) print digits; exit bad || !placed }' "$1" || fail "room for the y axis"
}
"$POROGRAIN" -case panel -panel_radius 2.5 -panel_columns 10 -panel_rows 21 -dem_local_damping 0.7 -end_time 1e-3 -output large.h5 >large.log
"$POROGRAIN_PLOT" large.h5 -figures large -plot_fields rotation,porosity -plot_gnuplot none >large.out
[ "$(tics large/large-fields.gp)" -ge 5 ] || fail "numbers at the y axis of a large panel: $(tics large/large-fields.gp)"
tics narrow/narrow-fields.gp >/dev/null
# Numbers below the x axes of a tower, of discs and of the load, do not touch: 7 pixels each, and 4 in between.
"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_dry.opts" -panel_columns 4 -panel_rows 33 -panel_displacement 1.7e-4 -output tower.h5 >tower.log
"$POROGRAIN_PLOT" tower.h5 -figures tower -plot_fields rotation,porosity,effective_strain -plot_gnuplot none >tower.out
tics tower/tower-fields.gp >/dev/null
awk 'NR == FNR { if ($1 > way) way = $1; next }
  /set terminal svg size/ { split($5, size, ",") }
  /^set [xy]range/ { split(substr($3, 2), range, ":"); span = range[2] - range[1]; if (span > longest) longest = span }
  /^set lmargin/ { left = $5 } /^set rmargin/ { wide = ($5 - left) * size[1] }
  /^set xrange/ { to = range[2] + 0; if (range[2] ~ /[*]/) { load = 1; to = way } }
  /^set ytics/ && !load { check(380 / longest) }
  /^set xtics/ { step = $3; if (load) check(wide / way) }
  function check(scale, i, digits) {
    for (i = 1; i * step <= to; i++) if (length(sprintf("%g", i * step)) > digits) digits = length(sprintf("%g", i * step))
    if (step * scale < 7 * digits + 4) { print "every " step ": " step * scale " pixels for " digits " digits"; bad = 1 }
    checked++ }
  END { exit bad || checked != 2 }' tower/tower-load.dat tower/tower-fields.gp || fail 'numbers at the x axes of a tower'
# All discs but two rotate by round-off: the scale goes to the two. At the start nothing rotates: that is said, without
# a scale.
scale=$(sed -n 's/^set cbrange \[.*:\(.*\)\]$/\1/p' large/large-rotation.gp)
expect_close "$(awk -v scale="$scale" '!/^#/ { a = $4 < 0 ? -$4 : $4; if (a > most) most = a } END { print scale / most }' \
  large/large-discs.dat)" 1 1e-4 # five digits
"$POROGRAIN_PLOT" large.h5 -figures start -plot_time 0 -plot_fields rotation,porosity -plot_gnuplot none >start.out
for f in rotation fields; do
  grep -A 4 '^set title ".*rotation.*0 everywhere' "start/large-$f.gp" | grep -q '^unset colorbox' || fail "0 in large-$f.gp"
done
[ "$(cat start/*.gp | grep -c '0 everywhere')" -eq 2 ] || fail 'which fields are 0'

# Frames of a film have an even number of pixels each way, whatever their size: encoders want it.
for size in 0.3 0.45 0.75 1; do
  "$POROGRAIN_PLOT" dry.h5 -figures even -plot_fields rotation -plot_film rotation -plot_size $size -plot_gnuplot none >even.out
  sed -n 's/.*terminal png size \([0-9]*[02468]\),\([0-9]*[02468]\) .*/even/p' even/dry-film-rotation.gp | grep -q even ||
    fail "frames of a film of size $size: $(grep 'terminal png size' even/dry-film-rotation.gp)"
done

# A continuum: cells where they are with their displacement magnified, all fields, the settlement, a film.
"$POROGRAIN" -options_file "$SOURCE_DIR/options/up_footing.opts" -up_cells 8,8 -output ground.h5 >ground.log 2>&1 ||
  fail "up_footing: $(tail -n 3 ground.log)"
"$POROGRAIN_PLOT" ground.h5 -figures ground -plot_gnuplot none -plot_film pressure >ground.out
! grep -q note ground.out || fail "$(grep note ground.out)"
for f in pressure displacement volumetric_strain relative_speed mean_stress speed; do
  [ "$(grep -c '^set object polygon' "ground/ground-$f-cells.txt")" -eq 64 ] || fail "cells of $f"
  grep -q "^load 'ground-$f-cells.txt'" ground/ground-fields.gp || fail "no $f on the sheet"
done
[ -s ground/ground-history.gp ] && [ -s ground/ground-film-pressure-000001-cells.txt ] || fail 'history and film of a continuum'
grep -q 'displacement \[mm\]' ground/ground-history.gp || fail 'no settlement in the history'
times=$(sed -n 's/^set title.*drawn \([0-9]*\) times.*/\1/p' ground/ground-pressure.gp)
[ "$times" -gt 1 ] || fail "magnified $times times"
# The corner below the footing, at x = 0 and 8 m, lies lower by the settlement; it has the displacement of the history.
settled=$(csv_column ground.csv displacement | tail -n 1)
read -r corner displacement < <(awk '!/^#/ && $1 == 0 && ($2 > top || !n++) { top = $2; u = $5 } END { print top, u }' ground/ground-discs.dat)
# places have six digits, values five
expect_close "$corner" "$(awk -v n="$times" -v d="$settled" 'BEGIN { print 8e3 - n*1e3*d }')" 0.01
expect_close "$displacement" "$(awk -v d="$settled" 'BEGIN { print 1e3*d }')" 1e-4
# Nothing bursts off: the colours go as far as the pressures of the nodes do.
expect_close "$(sed -n 's/^set cbrange \[.*:\(.*\)\]$/\1/p' ground/ground-pressure.gp)" \
  "$(csv_column ground.csv pressure_max | tail -n 1 | awk '{ print $1/1e3 }')" 1e-4
expect_error 2 'there is no field|has no dataset' "$POROGRAIN_PLOT" ground.h5 -figures none -plot_fields porosity -plot_gnuplot none
nothing none

# A liquid: its speed, pressure and density; walls and bodies have no colour, and no part in the scale.
"$POROGRAIN" -options_file "$SOURCE_DIR/options/tak_two_elements.opts" -tak_force_start 0 -end_time 0.02 -output tak.h5 >tak.log
"$POROGRAIN_PLOT" tak.h5 -figures tak -plot_gnuplot none -plot_film velocity >tak.out
! grep -q 'no data for' tak.out || fail "$(grep 'no data for' tak.out)"
[ "$(cd tak && ls tak-*.gp | grep -v history | tr '\n' ' ')" = 'tak-density.gp tak-fields.gp tak-film-speed.gp tak-pressure.gp tak-speed.gp ' ] ||
  fail "pictures of a liquid: $(ls tak)"
for f in fields speed film-speed; do
  grep -q 'using (\$4 > 0 ? \$1 : NaN):2:3:.* with circles lc rgb variable' "tak/tak-$f.gp" || fail "walls and bodies of tak-$f.gp"
done
awk '!/^#/ { n[$4]++; if (($4 > 0) != ($5 == "nan")) bad = 1; if ($4 == 0 && $5 > most) most = $5 }
  END { if (bad || !n[0] || !n[1] || !n[2]) exit 1; print most }' tak/tak-discs.dat >most || fail 'kinds and values of a liquid'
# the colours end at the largest speed, or at a lower one and the title tells the largest: four digits
largest=$(sed -n 's/^set title "speed.*largest \([0-9.e+-]*\).*/\1/p' tak/tak-speed.gp)
scale=$(sed -n 's/^set cbrange \[.*:\(.*\)\]$/\1/p' tak/tak-speed.gp)
expect_close "$(awk -v told="${largest:-$scale}" '{ print told / $1 }' most)" 1 1e-3
"$POROGRAIN_PLOT" tak.h5 -figures density -plot_fields density -plot_gnuplot none >density.out
[ -s density/tak-density.gp ] && [ ! -e density/tak-speed.gp ] || fail 'density of a liquid alone'

# A load that goes nowhere has no curve: no empty figure.
"$POROGRAIN" -case bed_darcy -output bed.h5 >bed.log
"$POROGRAIN_PLOT" bed.h5 -figures still -plot_fields pressure -plot_gnuplot none >still.out
expect_match 'bed.h5 has no history of a load over a displacement' still.out
[ ! -e still/load.gp ] || fail 'an empty figure of the load'

# A study.
"$POROGRAIN_STUDY" -study_sizes 200,1249 -study_solvers "$SOURCE_DIR/options/solvers/all.txt" -study_only cg-jacobi,cg-gamg \
  -study_repeats 1 -study_output study >study.log
"$POROGRAIN_PLOT" study.h5 -figures scripts -plot_gnuplot none >study.out
growth=$(csv_column study.csv growth | tail -n 1)
expect_match "cg-gamg  N\^$(printf '%.2f' "$growth")'" scripts/study-growth.gp
expect_match "set xtics \('199' 199, '1249' 1249\)" scripts/study-growth.gp
for f in study-residuals-1 study-residuals-2; do [ -s "scripts/$f.gp" ] || fail "no $f.gp"; done

# Cost against accuracy: the shape of a point tells M, the same in both panels and explained in the second.
"$POROGRAIN_STUDY" -study explicit -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -panel_columns 6 -panel_rows 13 -study_at 1 \
  -study_sweeps 0,1 -study_time 8e-5 -study_samples 2 -study_variants implicit:1,explicit1:1,explicit1:20,implicit:4,explicit5:4 \
  -study_output cost >cost.log
"$POROGRAIN_PLOT" cost.h5 -figures scripts -plot_gnuplot none >cost.out
sed -n "s/.*[$]4 == \([0-9]*\) .* pt \([0-9]*\) .*/\1 \2/p" scripts/cost-cost.gp >points
sed -n "s/.* pt \([0-9]*\) .* title 'M = \([0-9]*\)'.*/\2 \1/p" scripts/cost-cost.gp >key
[ "$(awk '{ print $1 }' key | paste -sd ' ')" = '1 4 20' ] || fail "shapes explained: $(cat key)"
[ "$(awk '{ print $2 }' key | sort -u | wc -l)" -eq 3 ] || fail "one shape for two M: $(cat key)"
# two panels, three methods, each with three possible M
[ "$(wc -l <points)" -eq 18 ] && [ "$(sort -u points)" = "$(sort key)" ] || fail "shapes drawn: $(sort points | uniq -c)"

# Errors: message and status, and nothing half-written.
expect_error 2 "^porograin-plot: error: .*no file to plot" "$POROGRAIN_PLOT" -figures none
expect_error 4 "result file 'missing.h5': " "$POROGRAIN_PLOT" missing.h5 -figures none
expect_error 4 "result file 'wet.log': " "$POROGRAIN_PLOT" wet.log -figures none
head -c 100000 dry.h5 >cut.h5
expect_error 4 "result file 'cut.h5': .*truncated" "$POROGRAIN_PLOT" dry.h5 cut.h5 -figures none
expect_error 2 "option -plot_time: 5 s is out of range, the snapshots of dry.h5 are from 0 to 0.002 s" \
  "$POROGRAIN_PLOT" dry.h5 -figures none -plot_time 5
expect_error 2 "field pressure: the file has no dataset pressure" \
  "$POROGRAIN_PLOT" dry.h5 -figures none -plot_fields rotation,pressure
expect_error 2 "no field 'presure'; there are effective_strain, " "$POROGRAIN_PLOT" dry.h5 -figures none -plot_fields presure
expect_error 2 "no format 'gif'; there are png, svg" "$POROGRAIN_PLOT" dry.h5 -figures none -plot_format gif
expect_error 2 "streamlines is not drawn as discs" "$POROGRAIN_PLOT" "wet run's.h5" -figures none -plot_film streamlines
expect_error 2 "-plot_tme.*-plot_time" "$POROGRAIN_PLOT" dry.h5 -figures none -plot_tme 1
expect_error 4 "directory 'dry.h5': it is there, and not a directory" "$POROGRAIN_PLOT" dry.h5 -figures dry.h5
expect_error 4 "directory 'no/such': cannot make it: No such file or directory" "$POROGRAIN_PLOT" dry.h5 -figures no/such
nothing none
# A program that fails: the figures there were before stay as they are.
printf '#!/bin/sh\necho trouble >&2\nexit 3\n' >failing
chmod +x failing
mkdir kept
echo before >kept/load.gp
expect_error 4 "failing failed on load.gp \(status 3\)" "$POROGRAIN_PLOT" dry.h5 -figures kept -plot_gnuplot ./failing
[ "$(ls -A kept)" = load.gp ] && [ "$(cat kept/load.gp)" = before ] || fail 'a failure changed what was there'
expect_error 4 "failing failed on" "$POROGRAIN_PLOT" dry.h5 -figures none -plot_gnuplot ./failing
nothing none
# No such program: scripts, with a note.
"$POROGRAIN_PLOT" dry.h5 -figures without -plot_gnuplot no-such-gnuplot >without.out
expect_match "note: no program 'no-such-gnuplot'" without.out
[ -s without/load.gp ] || fail 'no scripts without gnuplot'

# With gnuplot: pictures in both formats.
if ! command -v gnuplot >/dev/null; then
  echo 'gnuplot is not installed: pictures are not tested'
  exit 0
fi
"$POROGRAIN_PLOT" "wet run's.h5" dry.h5 study.h5 cost.h5 -figures pictures -plot_film pressure -plot_size 0.6 >pictures.out 2>pictures.err
[ ! -s pictures.err ] || fail "gnuplot complains: $(head -n 3 pictures.err)"
for f in load $wet-{effective_strain,volumetric_strain,rotation,porosity,pressure,streamlines,relative_speed,fields,history} \
  dry-{rotation,fields,history} study-growth study-residuals-2 cost-cost; do
  [ "$(head -c 8 "pictures/$f.png" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$f.png is not a PNG file"
  [ "$(tail -c 8 "pictures/$f.png" | od -An -c | tr -d ' \n')" = 'IEND256B`202' ] || fail "$f.png has no end"
  head -c 300 "pictures/$f.svg" | grep -q '<svg' || fail "$f.svg is not an SVG file"
  tail -n 3 "pictures/$f.svg" | grep -q '</svg>' || fail "$f.svg has no end"
done
[ "$(ls pictures | grep -c "^$wet-film-pressure-00000[012].png\$")" -eq 3 ] || fail 'frames of the film'
# Every wall and every body of a liquid is there, in its grey.
"$POROGRAIN_PLOT" tak.h5 -figures liquid -plot_fields velocity -plot_format svg >liquid.out
for kind in '1 184' '2 128'; do
  read -r number grey <<<"$kind"
  [ "$(grep -c "<polygon fill = 'rgb($grey, $grey, $grey)'" liquid/tak-speed.svg)" -eq \
    "$(awk -v kind="$number" '!/^#/ && $4 == kind' liquid/tak-discs.dat | wc -l)" ] || fail "grey discs of kind $number"
done
# Run again by hand, the scripts draw the same.
cp pictures/load.png before.png
(cd pictures && gnuplot load.gp)
cmp -s before.png pictures/load.png || fail 'load.gp draws another picture by hand'

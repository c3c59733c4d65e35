# timeout: 120
# Whole runs with packings: a panel that went through a file moves like the panel, chance makes the same file on any
# number of ranks, and what was generated can be restarted.
. "$SOURCE_DIR/tests/support/regress.sh"

# -case box, without a word more: at rest the bottom bears the weight of its discs, 400 pi (5e-3)^2 2000 9.81 N/m. Contact
# forces end where motion is damped out; seen: 616.3805.
"$POROGRAIN" -case box -output box.h5 >box.out
expect_close "$(csv_column box.csv load | tail -n 1)" 616.38048 1e-3

# The panel of 7 columns by itself, and from the file it wrote, dry: every bit of all snapshots and of the history, but for the
# porosity, which begins with the paper's values or with that of the box.
common='-dem_local_damping 0.7 -end_time 2e-3'
# shellcheck disable=SC2086
for ending in csv h5; do
  "$POROGRAIN" -case panel -panel_columns 7 -panel_rows 15 $common -output panel.h5 -packing_export discs.$ending >panel.out
  run 2 "$POROGRAIN" -case packing -packing discs.$ending -packing_plates bottom,top -packing_top_velocity -6.18e-2 \
    $common -output packing.h5 >packing.out
  expect_same_results panel.h5 packing.h5 /history
  for file in panel packing; do h5ls -r $file.h5/snapshots >$file.names; done
  cmp -s panel.names packing.names || fail 'other snapshots or fields'
  mapfile -t but < <(sed -n 's|^\(/[0-9]*/porosity\) .*|--exclude-path=\1|p' panel.names)
  [ ${#but[@]} -ge 2 ] || fail 'no porosity in a packing'
  h5diff "${but[@]}" panel.h5 packing.h5 /snapshots /snapshots >h5diff.out 2>&1 || fail "panel and packing differ: $(head -n 5 h5diff.out)"
  rm -f panel.h5 packing.h5
done
# ... and the load is one: the plates are in the same place.
expect_match '^peak load [1-9]' packing.out

# 600 discs, on 1, 2 and 4 ranks; then the file by way of HDF5 and back.
random='-case packing -packing_generate random -packing_count 600 -packing_target_porosity 0.19
  -packing_radius_spread 0.25 -packing_seed 11 -dt 1e-7'
# shellcheck disable=SC2086
for n in 1 2 4; do
  run "$n" "$POROGRAIN" $random -end_time 1e-7 -packing_export "random$n.csv" >random$n.out
  cmp random1.csv "random$n.csv" || fail "another packing on $n ranks"
done
expect_match 'porosity 0.190000 in the box' random1.out

# What is found out about a packing, too: of a lattice with contacts between all ranks.
for n in 1 2 4; do
  run "$n" "$POROGRAIN" -case packing -packing_generate hexagonal -packing_count 400 -packing_periodic \
    -end_time 1e-8 | sed -n '2,5p' >report$n
  cmp report1 "report$n" || fail "other findings on $n ranks"
done
# 21 rows of 19, closed in x, and one disc more: 19 in each row, 38 between two rows, 2 of the last disc.
expect_match '^  1161 pairs touch; largest overlap' report1
# shellcheck disable=SC2086
"$POROGRAIN" $random -packing_seed 12 -end_time 1e-7 -packing_export other.csv >other.out
! cmp -s random1.csv other.csv || fail 'another seed makes the same packing'
run 2 "$POROGRAIN" -case packing -packing random1.csv -dt 1e-7 -end_time 1e-7 -packing_export copy.h5 >copy.out
run 2 "$POROGRAIN" -case packing -packing copy.h5 -dt 1e-7 -end_time 1e-7 -packing_export copy.csv >copy.out
cmp random1.csv copy.csv || fail 'the packing has changed on its way through HDF5'

# What the program says of it, from all pairs by awk.
awk -F, 'BEGIN { n = 0 } !/^[#x]/ { x[n] = $1; y[n] = $2; r[n++] = $3 }
  END { for (i = 0; i < n; i++) for (j = 0; j < i; j++) {
          d = sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2); o = (r[i] + r[j] - d) / (r[i] < r[j] ? r[i] : r[j])
          if (!(i == 1 && j == 0) && o <= worst) continue
          worst = o; a = j; b = i }
        printf "%.3g %d %d\n", worst < 0 ? -worst : worst, a, b }' random1.csv >worst
read -r worst a b <worst
expect_match "(overlap|gap) $worst of the smaller radius, discs $a and $b\$" random1.out

# Interrupted and restarted, with walls: as the run that was not. The packing is not pressed again.
walls="-packing_walls left,right,bottom,top -packing_top_velocity -0.1"
# shellcheck disable=SC2086
{
  "$POROGRAIN" $random $walls -end_time 4e-5 -output whole.h5 -output_every 2e-5 >whole.out
  "$POROGRAIN" $random $walls -end_time 2e-5 -output part.h5 -output_every 2e-5 -checkpoint run.checkpoint >part.out
  "$POROGRAIN" $random $walls -end_time 4e-5 -output part.h5 -output_every 2e-5 -restart run.checkpoint >restart.out
}
expect_same_results whole.h5 part.h5 /snapshots/000002
if grep -q 'pairs touch' restart.out; then fail 'a restart looks at the packing again'; fi

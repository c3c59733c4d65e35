# timeout: 300
# porograin-study: the table of solvers, its files, the same on 1, 2 and 4 ranks, and counts known from an independent
# program for the same systems.
. "$SOURCE_DIR/tests/support/regress.sh"

all="$SOURCE_DIR/options/solvers/all.txt"
columns() { csv_column "$1.csv" "$2" | paste -sd ' '; }

# Panels of 1249 and 4999 discs, displaced by 2 % as the independent program did at 1249: 98 iterations of cg+jacobi,
# 5 of cg+hypre, 15 of cg+gamg, 8810 sweeps.
few=cg-jacobi,cg-gamg,cg-hypre,mumps,richardson-jacobi
for n in 1 2 4; do
  run "$n" "$POROGRAIN_STUDY" -study_sizes 1249 -study_jitter 0.02 -study_solvers "$all" -study_only $few \
    -study_repeats 1 -study_output "ranks$n" >"ranks$n.out"
done
[ "$(columns ranks1 solver)" = 'richardson-jacobi cg-jacobi cg-gamg cg-hypre mumps' ] || fail 'order of solvers'
[ "$(columns ranks1 N)" = '1249 1249 1249 1249 1249' ] || fail 'sizes'
set -- $(columns ranks1 iterations)
# 15 %, as the volumes of edge discs differ a little between the programs
expect_close "$1" 8810 1321
expect_close "$2" 98 14
expect_close "$3" 15 2
expect_close "$4" 5 1
expect_close "$5" 1 0

# Without blocks and grids the counts are the same on any number of ranks; grids depend a little on the partition.
for n in 2 4; do
  expect_close "$(columns ranks$n iterations | cut -d' ' -f1)" "$1" 1
  [ "$(columns ranks$n iterations | cut -d' ' -f2)" = "$2" ] || fail "cg-jacobi on $n ranks"
  expect_close "$(columns ranks$n iterations | cut -d' ' -f4)" "$4" 1
done

# Every answer agrees with the direct one to 10 x rtol.
for n in 1 2 4; do
  for e in $(columns "ranks$n" error); do expect_close "$e" 0 1e-7; done
  for e in $(columns "ranks$n" residual); do expect_close "$e" 0 1.0001e-8; done
done
h5ls -r ranks2.h5 >objects
expect_match '/study/003/history' objects

# Levels and complexity of BoomerAMG's grids are those that hypre prints of itself, to its seven digits.
echo 'talkative -ksp_type cg -pc_type hypre -pc_hypre_boomeramg_print_statistics' >talkative.txt
"$POROGRAIN_STUDY" -study_sizes 1249 -study_solvers talkative.txt -study_repeats 1 -study_output talkative >talkative.out
levels=$(sed -n 's/^ *Num levels = //p' talkative.out | tail -n 1)
complexity=$(sed -n 's/^ *operator = //p' talkative.out | tail -n 1)
[ "$(columns talkative levels)" = "$levels" ] || fail "$(columns talkative levels) levels, hypre says $levels"
expect_close "$(columns talkative operator_complexity)" "$complexity" 1e-6
# Conditions of the Jacobi-scaled matrix go with the square of the spacing: 4 for half of it, but for the sides, whose
# part is the spacing over the width, 1/25. The value itself is that of this lattice as computed before (713).
"$POROGRAIN_STUDY" -study_sizes 1249,5000 -study_solvers "$all" -study_only cg-jacobi -study_condition -study_repeats 1 \
  -study_output condition >condition.out
set -- $(columns condition condition)
expect_close "$1" 713 7
expect_close "$(awk "BEGIN { print $2 / $1 }")" 4 0.16

# What a solver cannot do is a row, not an end: CHOLMOD on two ranks, CG for a matrix that is not symmetric.
run 2 "$POROGRAIN_STUDY" -study_sizes 200 -study_solvers "$all" -study_only cholmod,cg-jacobi -study_output rows >rows.out
expect_match 'cholmod .*failed: ' rows.out
expect_match 'cg-jacobi .*converged to rtol' rows.out

# Systems of a run: the solution in the file is found again.
"$POROGRAIN" -panel_columns 10 -fluid darcy -dt 2e-6 -fluid_every 10 -end_time 6e-5 -pressure_dump dump.petsc \
  -pressure_dump_every 1 >run.out
"$POROGRAIN_STUDY" -study_load dump-000000.petsc,dump-000002.petsc -study_solvers "$all" \
  -study_only cg-jacobi,cg-hypre -study_direct_limit 0 -study_output loaded >loaded.out
expect_match 'dump-000002.petsc: N = 199, symmetric; errors against the solution in the file' loaded.out
# the run solved to 1e-8, too
for e in $(columns loaded error); do expect_close "$e" 0 1e-7; done

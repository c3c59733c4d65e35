# timeout: 120
# Singular systems: what helps, and what the mistakes look like that -study_trap makes on purpose.
. "$SOURCE_DIR/tests/support/regress.sh"

study() {
  "$POROGRAIN_STUDY" -study_sizes 1249 -study_jitter 0.02 -study_solvers "$SOURCE_DIR/options/solvers/all.txt" \
    -study_only cg-jacobi,cg-gamg,cg-hypre -study_repeats 1 -bc_left impermeable -bc_right impermeable \
    -bc_bottom impermeable -bc_top impermeable "$@" -study_output out >out.txt
}
values() { csv_column out.csv "$1" | paste -sd ' '; }

# null space attached, right-hand side made compatible, whatever it was
study -study_imbalance 0.025
expect_match 'singular' out.txt
expect_match 'null space attached, right-hand side: 2.50e-02 of it has no solution, removed' out.txt
for r in $(values residual); do expect_close "$r" 0 1.0001e-8; done
for e in $(values error); do expect_close "$e" 0 1e-7; done

# not made compatible: the solver says it has converged, what cannot be solved is left (0.025/sqrt(1 + 0.025^2))
study -study_trap unprojected
for r in $(values residual); do expect_close "$r" 0.02499 1e-4; done
[ "$(values reason_code)" = '2 2 2' ] || fail 'converged reasons'

# neither, in PETSc's default norm: multigrid "converges" in one iteration, with a pressure that is wrong by more
# than the largest right one
study -study_trap no_nullspace,unprojected,preconditioned_norm
[ "$(values iterations | cut -d' ' -f2,3)" = '1 1' ] || fail 'iterations'
[ "$(values reason_code | cut -d' ' -f2,3)" = '2 2' ] || fail 'reasons'
for e in $(values error | cut -d' ' -f2,3); do awk -v e="$e" 'BEGIN { exit !(e > 1) }' || fail "error $e"; done
for r in $(values residual); do awk -v r="$r" 'BEGIN { exit !(r > 0.01) }' || fail "residual $r"; done

# timeout: 120
# Mistakes in the file of solvers and in options are errors that say where.
. "$SOURCE_DIR/tests/support/regress.sh"

try() { expect_error "$1" "$2" "$POROGRAIN_STUDY" -study_sizes 200 -study_solvers list.txt "${@:3}"; }

printf 'good -ksp_type cg -pc_type jacobi\n\nbad -ksp_type cg -pc_type gamg -pc_gamg_treshold 0.05\n' >list.txt
try 2 'list.txt:3: solver bad: nobody reads option -pc_gamg_treshold 0.05'
printf 'good -ksp_type cg -pc_type jacobi\nbad -ksp_type cg -pc_type bjacobi -sub_pc_type icc -sub_pc_factor_level 1\n' >list.txt
try 2 'list.txt:2: solver bad: nobody reads option -sub_pc_factor_level 1'
printf 'bad -ksp_type cg -pc_type jaccobi\n' >list.txt
try 2 'list.txt:1: solver bad: .*jaccobi'
# values of PETSc's lists, and an option of one level of a multigrid, whether the system has that level or not
while read -r pattern options; do
  printf '# one\nbad -ksp_type cg %s\n' "$options" >list.txt
  try 2 "list.txt:2: solver bad: .*$pattern"
done <<'END'
HMISS -pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_coarsen_type HMISS
boomeram -pc_type hypre -pc_hypre_type boomeram
unprec -pc_type jacobi -ksp_norm_type unprec
mump -pc_type cholesky -pc_factor_mat_solver_type mump
mg_levels_1_ksp_typo -pc_type gamg -mg_levels_1_ksp_typo 3
mg_levels_7_ksp_typo -pc_type gamg -mg_levels_7_ksp_typo 3
END
printf 'good -ksp_type cg -pc_type gamg -mg_levels_7_ksp_max_it 3\n' >list.txt
try 0 'converged to rtol'
printf '# one\nbad -ksp_type cg -ksp_max_it ten\n' >list.txt
try 2 'list.txt:2: solver bad: .*ten'
printf 'bad -ksp_type cg 5 -pc_type jacobi 7\n' >list.txt
try 2 "list.txt:1: '5' belongs to no option"
printf -- '-ksp_type cg\n' >list.txt
try 2 'list.txt:1: .*the name of the solver comes first'
printf 'a -ksp_type cg\na -ksp_type gmres\n' >list.txt
try 2 'list.txt:2: solver a is there already, line 1'
printf 'a -ksp_type cg -ksp_type gmres\n' >list.txt
try 2 'list.txt:1: solver a has option -ksp_type twice'
printf '# nothing\n' >list.txt
try 2 'list.txt holds no solver'

printf 'good -ksp_type cg -pc_type jacobi\n' >list.txt
try 2 "no solver 'better' in list.txt, which has good" -study_only better
try 2 'unknown option -study_repeat 2; did you mean -study_repeats' -study_repeat 2
try 2 'unknown option -bc_lefft drained; did you mean -bc_left' -bc_lefft drained
try 2 'contradict each other' -panel_columns 12
try 2 'contradict each other' -study_load x.petsc
try 2 "'nullspace' is not one of" -study_trap nullspace
try 4 'cannot write nowhere/x.h5' -study_output nowhere/x
try 2 "'x' is not a whole number" -study_sizes 200,x
expect_error 4 "'x.petsc': No such file" "$POROGRAIN_STUDY" -study_load x.petsc -study_solvers list.txt
expect_error 4 "'list.txt': it is not a system .*matrix: it does not begin like" "$POROGRAIN_STUDY" -study_load list.txt -study_solvers list.txt
expect_error 4 'cannot read none.txt: No such file or directory' "$POROGRAIN_STUDY" -study_solvers none.txt
mkfifo pipe.txt # into which nobody writes
expect_error 4 'cannot read pipe.txt: it is not a regular file' timeout 60 "$POROGRAIN_STUDY" -study_solvers pipe.txt
expect_error 2 "'solver' is not one of .*did you mean 'solvers'" "$POROGRAIN_STUDY" -study solver
expect_error 0 '-study_mms_levels' "$POROGRAIN_STUDY" -help study
[ "$(find . -name '*.csv' -o -name '*.h5')" = '' ] || fail 'files were written in spite of an error'
try 0 'converged to rtol'

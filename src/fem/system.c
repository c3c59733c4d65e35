/* The matrix of a step, and of the preconditioner of its Schur complement. Each rank adds up its cells; PETSc brings
   together what ranks share. Rows of held unknowns keep their places with a diagonal alone, so that displacements stay
   in pairs, as multigrid wants them. Pressures are scaled so that all rows are forces of like size. */
#include "femimpl.h"

void PgFemCellX(PgFem fem, PetscInt cell, PetscReal x[4][2])
{
  for (int a = 0; a < 4; a++)
    for (int d = 0; d < 2; d++) x[a][d] = fem->x[2 * fem->cell_node[4 * cell + a] + d];
}

PetscErrorCode PgFemCoefficientsOf(PgFem fem, PetscInt cell, PetscReal dt, PetscReal theta, PgFemCoefficients *c)
{
  const PgFemMaterial *m = &fem->material[fem->cell_material[cell]].material;
  const PetscReal      G = PgFemShearModulus(m), M = PgFemConstrainedModulus(m);

  PetscFunctionBeginUser;
  *c = (PgFemCoefficients){.lambda = M - 2.0 * G,
                           .G      = G,
                           .alpha  = m->alpha,
                           .S      = PgFemStorage(m),
                           .D      = m->k / m->mu_f,
                           .tau    = fem->element == PG_FEM_Q1Q1 ? fem->stabilisation / M : 0.0,
                           .rho    = (1.0 - m->n) * m->rho_s + m->n * m->rho_f,
                           .rho_f  = m->rho_f,
                           .dt     = dt,
                           .theta  = theta,
                           .scale  = fem->scale};
  if (fem->inertia) c->mass = (1.0 / (theta * dt) + fem->damping) / (theta * dt);
  if (fem->element == PG_FEM_Q1) { /* what the water in its pores adds */
    c->lambda += c->alpha * c->alpha / c->S;
    c->alpha = 0.0;
  }
  PetscFunctionReturn(0);
}

/* Area of a cell per cell, and the largest modulus: what the pressure is scaled by. */
static PetscErrorCode ChooseScale(PgFem fem)
{
  PetscReal sum[2] = {0.0, (PetscReal)fem->cells}, all[2], M = 0.0, largest;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < fem->cells; c++) {
    const PetscInt  *node = &fem->cell_node[4 * c];
    const PetscReal *a = &fem->x[2 * node[0]], *b = &fem->x[2 * node[1]], *d = &fem->x[2 * node[2]],
                    *e = &fem->x[2 * node[3]];
    sum[0] += 0.5 * ((d[0] - a[0]) * (e[1] - b[1]) - (d[1] - a[1]) * (e[0] - b[0]));
    M = PetscMax(M, PgFemConstrainedModulus(&fem->material[fem->cell_material[c]].material));
  }
  PetscCallMPI(MPI_Allreduce(sum, all, 2, MPIU_REAL, MPIU_SUM, fem->comm));
  PetscCallMPI(MPI_Allreduce(&M, &largest, 1, MPIU_REAL, MPIU_MAX, fem->comm));
  fem->scale = largest / PetscSqrtReal(all[0] / all[1]);
  PetscFunctionReturn(0);
}

/* Unknowns of this rank that are held, or all pressures when `pressure`: place and number. */
static PetscInt Held(const PgFem fem, PetscInt start, PetscBool pressure, PetscInt number[])
{
  PetscInt count = 0;

  for (PetscInt d = 0; d < fem->size; d++) {
    if (!fem->fixed[d] || fem->global[d] < start || fem->global[d] >= start + fem->mine) continue;
    if (pressure && !fem->is_pressure[d]) continue;
    if (number) number[count] = pressure ? fem->p_index[d] : fem->global[d];
    count++;
  }
  return count;
}

/* Index sets of both fields, and consecutive numbers for the pressures. */
static PetscErrorCode MakeFields(PgFem fem, PetscInt start)
{
  PetscInt     count[2] = {0, 0}, *list[2], first;
  PetscScalar *number;
  Vec          local;
  IS           all;
  VecScatter   scatter;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(fem->mine, &list[0], fem->mine, &list[1]));
  /* the points of this rank lie in the order of its numbers */
  for (PetscInt d = 0; d < fem->size; d++) {
    if (fem->global[d] < start || fem->global[d] >= start + fem->mine) continue;
    list[fem->is_pressure[d]][count[fem->is_pressure[d]]++] = fem->global[d];
  }
  for (int f = 0; f < 2; f++) PetscCall(PetscSortInt(count[f], list[f]));
  PetscCall(ISCreateGeneral(fem->comm, count[0], list[0], PETSC_COPY_VALUES, &fem->is_u));
  PetscCall(ISSetBlockSize(fem->is_u, 2));
  PetscCall(ISCreateGeneral(fem->comm, count[1], list[1], PETSC_COPY_VALUES, &fem->is_p));
  PetscCallMPI(MPI_Scan(&count[1], &first, 1, MPIU_INT, MPI_SUM, fem->comm));
  first -= count[1];
  PetscCall(VecSet(fem->w, -1.0));
  PetscCall(VecGetArray(fem->w, &number));
  for (PetscInt k = 0; k < count[1]; k++) number[list[1][k] - start] = (PetscScalar)(first + k);
  PetscCall(VecRestoreArray(fem->w, &number));
  PetscCall(PetscFree2(list[0], list[1]));

  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, fem->size, fem->global, PETSC_COPY_VALUES, &all));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, fem->size, &local));
  PetscCall(VecScatterCreate(fem->w, all, local, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, fem->w, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, fem->w, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(PetscMalloc1(fem->size, &fem->p_index));
  PetscCall(VecGetArray(local, &number));
  for (PetscInt d = 0; d < fem->size; d++) fem->p_index[d] = (PetscInt)PetscRealPart(number[d]);
  PetscCall(VecRestoreArray(local, &number));
  PetscCall(ISDestroy(&all));
  fem->scatter = scatter;
  fem->local   = local;
  PetscFunctionReturn(0);
}

/* `n` unknowns of each cell, numbers in `index` by cell: all pairs, then the diagonal of held ones. */
static PetscErrorCode MakeMatrix(PgFem fem, PetscInt mine, PetscInt n, const PetscInt index[], PetscInt held,
                                 const PetscInt number[], Mat *A)
{
  const PetscCount entries = (PetscCount)fem->cells * n * n + held;
  PetscInt        *i, *j;
  PetscCount       k = 0;

  PetscFunctionBeginUser;
  PetscCall(MatCreate(fem->comm, A));
  PetscCall(MatSetSizes(*A, mine, mine, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(PetscMalloc2(entries, &i, entries, &j));
  for (PetscInt c = 0; c < fem->cells; c++)
    for (PetscInt a = 0; a < n; a++)
      for (PetscInt b = 0; b < n; b++, k++) {
        i[k] = index[c * n + a];
        j[k] = index[c * n + b];
        if (i[k] < 0 || j[k] < 0) i[k] = j[k] = -1; /* left out */
      }
  for (PetscInt h = 0; h < held; h++, k++) i[k] = j[k] = number[h];
  PetscCall(MatSetPreallocationCOO(*A, entries, i, j));
  PetscCall(PetscFree2(i, j));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeMatrices(PgFem fem)
{
  PetscInt start, held, *number, *index, pressures;

  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(fem->comm, fem->mine, PETSC_DETERMINE, &fem->b));
  PetscCall(VecDuplicate(fem->b, &fem->w));
  PetscCall(VecDuplicate(fem->b, &fem->r));
  PetscCall(VecGetOwnershipRange(fem->b, &start, NULL));
  PetscCall(VecGetSize(fem->b, &fem->stats.unknowns));
  PetscCall(MakeFields(fem, start));
  PetscCall(ISGetLocalSize(fem->is_p, &pressures));
  held = Held(fem, start, PETSC_FALSE, NULL);
  PetscCall(PetscMalloc2(held, &number, 4 * fem->cells, &index));
  (void)Held(fem, start, PETSC_FALSE, number);
  PetscCall(MakeMatrix(fem, fem->mine, fem->dofs, fem->index, held, number, &fem->A));
  for (PetscInt c = 0; c < fem->cells; c++)
    for (int a = 0; a < 4; a++) {
      const PetscInt dof = fem->dof[c * fem->dofs + 2 * fem->un + a];
      index[4 * c + a]   = fem->fixed[dof] ? -1 : fem->p_index[dof];
    }
  held = Held(fem, start, PETSC_TRUE, number);
  PetscCall(MakeMatrix(fem, pressures, 4, index, held, number, &fem->P));
  PetscCall(PetscFree2(number, index));
  PetscFunctionReturn(0);
}

/* A uniform pressure that no equation feels: no side is drained, nothing can be compressed, nothing can give way. */
static PetscErrorCode FindNullSpace(PgFem fem)
{
  PetscScalar *e;
  PetscReal    norm, scale;
  PetscInt     start;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(fem->w, &start, NULL));
  PetscCall(VecSet(fem->w, 0.0));
  PetscCall(VecGetArray(fem->w, &e));
  for (PetscInt d = 0; d < fem->size; d++)
    if (fem->is_pressure[d] && !fem->fixed[d] && fem->global[d] >= start && fem->global[d] < start + fem->mine)
      e[fem->global[d] - start] = 1.0;
  PetscCall(VecRestoreArray(fem->w, &e));
  PetscCall(VecNormalize(fem->w, &norm));
  fem->singular = PETSC_FALSE;
  if (norm <= 0.0) PetscFunctionReturn(0);
  PetscCall(MatMult(fem->A, fem->w, fem->r));
  PetscCall(VecNorm(fem->r, NORM_2, &norm));
  PetscCall(MatNorm(fem->A, NORM_INFINITY, &scale));
  if (norm > 1e-13 * scale) PetscFunctionReturn(0); /* a thousand roundings */
  {
    MatNullSpace constant;
    PetscCall(MatNullSpaceCreate(fem->comm, PETSC_FALSE, 1, &fem->w, &constant));
    PetscCall(MatSetNullSpace(fem->A, constant));
    PetscCall(MatSetTransposeNullSpace(fem->A, constant));
    PetscCall(MatNullSpaceDestroy(&constant));
    fem->singular = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(PgFem fem, PetscReal dt, PetscReal theta)
{
  const PetscInt   n = fem->dofs, square = n * n;
  PetscInt         start, held, held_p;
  const PetscCount cells = fem->cells;
  PetscScalar     *value, *schur;
  PetscReal        diagonal = 0.0; /* of held unknowns: as of the stiffest cell */

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(fem->b, &start, NULL));
  held   = Held(fem, start, PETSC_FALSE, NULL);
  held_p = Held(fem, start, PETSC_TRUE, NULL);
  PetscCall(PetscMalloc2(cells * square + held, &value, cells * 16 + held_p, &schur));
  for (PetscInt c = 0; c < fem->cells; c++) {
    PgFemCoefficients k;
    PetscReal         x[4][2];
    PetscCall(PgFemCoefficientsOf(fem, c, dt, theta, &k));
    PgFemCellX(fem, c, x);
    PgFemElementMatrix(&fem->shape, fem->un, &k, x, value + (PetscCount)c * square, schur + (PetscCount)c * 16);
    for (PetscInt a = 0; a < 2 * fem->un; a++)
      diagonal = PetscMax(diagonal, PetscAbsScalar(value[(PetscCount)c * square + a * (n + 1)]));
  }
  {
    const PetscReal mine = diagonal;
    PetscCallMPI(MPI_Allreduce(&mine, &diagonal, 1, MPIU_REAL, MPIU_MAX, fem->comm));
  }
  for (PetscInt h = 0; h < held; h++) value[cells * square + h] = diagonal;
  for (PetscInt h = 0; h < held_p; h++) schur[cells * 16 + h] = -diagonal;
  PetscCall(MatSetValuesCOO(fem->A, value, INSERT_VALUES));
  PetscCall(MatSetValuesCOO(fem->P, schur, INSERT_VALUES));
  PetscCall(PetscFree2(value, schur));
  PetscCall(MatSetOption(fem->A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetOption(fem->P, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSystemBuild(PgFem fem, PetscReal dt, PetscReal theta)
{
  PetscFunctionBeginUser;
  if (fem->A && fem->built_dt == dt && fem->built_theta == theta) PetscFunctionReturn(0);
  if (!fem->A) {
    PetscCall(ChooseScale(fem));
    PetscCall(MakeMatrices(fem));
  }
  PetscCall(Fill(fem, dt, theta));
  PetscCall(FindNullSpace(fem));
  fem->built_dt    = dt;
  fem->built_theta = theta;
  PetscCall(PgFemSolverBuild(fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetSystem(PgFem fem, PgFemSystem *system)
{
  PetscFunctionBeginUser;
  PetscCheck(fem->A, fem->comm, PETSC_ERR_ORDER, "PgFemSetUpSolver() comes before PgFemGetSystem()");
  *system = (PgFemSystem){fem->A, fem->P, fem->is_u, fem->is_p, fem->scale};
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSystemDestroy(PgFem fem)
{
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&fem->ksp));
  PetscCall(MatDestroy(&fem->A));
  PetscCall(MatDestroy(&fem->P));
  PetscCall(VecDestroy(&fem->b));
  PetscCall(VecDestroy(&fem->w));
  PetscCall(VecDestroy(&fem->r));
  PetscCall(VecDestroy(&fem->local));
  PetscCall(VecScatterDestroy(&fem->scatter));
  PetscCall(ISDestroy(&fem->is_u));
  PetscCall(ISDestroy(&fem->is_p));
  PetscCall(PetscFree(fem->p_index));
  PetscFunctionReturn(0);
}

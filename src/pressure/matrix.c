/* The PETSc matrix of the equations. Its pattern lives as long as the row list; values are written straight
   into the CSR arrays of the two blocks, at places found once per pattern. Rows and columns of discs with a
   prescribed pressure keep their places and hold zeros, so the pattern does not change with the conditions. */
#include "pressureimpl.h"

PetscErrorCode PgPressureDestroyMatrix(PgPressure q)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&q->A));
  PetscCall(VecDestroy(&q->b));
  PetscCall(VecDestroy(&q->x));
  PetscCall(VecDestroy(&q->r));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateMatrix(PgPressure q)
{
  MatType     type;
  PetscBool   aij;
  PetscLayout rows, columns;

  PetscFunctionBeginUser;
  PetscCall(PgPressureDestroyMatrix(q));
  PetscCall(MatCreate(q->comm, &q->A));
  PetscCall(MatSetOptionsPrefix(q->A, "pressure_"));
  PetscCall(MatSetSizes(q->A, q->owned, q->owned, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetFromOptions(q->A)); /* aij when nothing is said */
  PetscCall(MatGetType(q->A, &type));
  PetscCall(PetscObjectBaseTypeCompareAny((PetscObject)q->A, &aij, MATSEQAIJ, MATMPIAIJ, ""));
  PgInputCheck(aij, q->comm, "option -pressure_mat_type: the pressure matrix must be of an aij type, %s is not", type);
  PetscCall(MatGetLayouts(q->A, &rows, &columns)); /* vectors want them complete, there is no pattern yet */
  PetscCall(PetscLayoutSetUp(rows));
  PetscCall(PetscLayoutSetUp(columns));
  PetscCall(MatCreateVecs(q->A, &q->x, &q->b));
  PetscCall(VecDuplicate(q->b, &q->r));
  PetscFunctionReturn(0);
}

/* The blocks of a matrix on any number of ranks: columns of this rank, and the others (NULL on one rank)
   whose column numbers are in `columns`. */
static PetscErrorCode Blocks(Mat A, Mat *own, Mat *other, const PetscInt *columns[])
{
  PetscBool parallel;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectBaseTypeCompare((PetscObject)A, MATMPIAIJ, &parallel));
  *own     = A;
  *other   = NULL;
  *columns = NULL;
  if (parallel) PetscCall(MatMPIAIJGetSeqAIJ(A, own, other, columns));
  PetscFunctionReturn(0);
}

/* Place of global column `column` in one row of a block, -1 when it is not there. The block numbers its
   columns from `shift`, or through `columns`; both keep them ascending. */
static PetscInt Find(const PetscInt ia[], const PetscInt ja[], PetscInt row, PetscInt column, PetscInt shift,
                     const PetscInt columns[])
{
  PetscInt low = ia[row], high = ia[row + 1];

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2, at = columns ? columns[ja[middle]] : ja[middle] + shift;
    if (at == column) return middle;
    if (at < column)
      low = middle + 1;
    else
      high = middle;
  }
  return -1;
}

static PetscErrorCode GrowPlaces(PetscInt needed, PetscInt *capacity, PetscInt **array)
{
  PetscFunctionBeginUser;
  if (needed <= *capacity) PetscFunctionReturn(0);
  *capacity = needed + needed / 8;
  PetscCall(PetscFree(*array));
  PetscCall(PetscMalloc1(*capacity, array));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindPlaces(PgPressure q, PetscInt start, const PetscInt index[])
{
  Mat             own, other;
  const PetscInt *columns, *ia, *ja, *oia = NULL, *oja = NULL;
  PetscInt        n, places;
  PetscBool       done, other_done = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(GrowPlaces(q->ptr[q->owned], &q->entry_size, &q->entry_at));
  PetscCall(GrowPlaces(q->owned, &q->diagonal_size, &q->diagonal_at));
  PetscCall(Blocks(q->A, &own, &other, &columns));
  PetscCall(MatGetRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &ia, &ja, &done));
  if (other) PetscCall(MatGetRowIJ(other, 0, PETSC_FALSE, PETSC_FALSE, &n, &oia, &oja, &other_done));
  PetscCheck(done && other_done, PETSC_COMM_SELF, PETSC_ERR_SUP, "matrix type without row access");
  for (PetscInt a = 0; a < q->owned; a++) {
    q->diagonal_at[a] = Find(ia, ja, a, start + a, start, NULL);
    PetscCheck(q->diagonal_at[a] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no diagonal in row %" PetscInt_FMT, a);
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      const PetscInt  column = index[q->col[k]];
      const PetscBool mine   = (PetscBool)(column >= start && column < start + q->owned);
      const PetscInt  at     = mine  ? Find(ia, ja, a, column, start, NULL)
                               : oia ? Find(oia, oja, a, column, 0, columns)
                                     : -1;
      PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no column %" PetscInt_FMT " in row %" PetscInt_FMT, column,
                 start + a);
      q->entry_at[k] = mine ? at : ~at;
    }
  }
  places = ia[q->owned] + (other ? oia[q->owned] : 0);
  /* two entries in one place: a disc and its image, in a period narrower than two reaches */
  PetscCheck(places == q->ptr[q->owned] + q->owned, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "a row of the pressure equation holds a disc twice: the period is too narrow");
  if (other) PetscCall(MatRestoreRowIJ(other, 0, PETSC_FALSE, PETSC_FALSE, &n, &oia, &oja, &other_done));
  PetscCall(MatRestoreRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &ia, &ja, &done));
  PetscFunctionReturn(0);
}

/* Entries of each row in the two blocks, the diagonal included. */
static PetscErrorCode CountEntries(PgPressure q, PetscInt start, const PetscInt index[], PetscInt own[],
                                   PetscInt other[], PetscInt *longest)
{
  PetscFunctionBeginUser;
  *longest = 1;
  for (PetscInt a = 0; a < q->owned; a++) {
    own[a]   = 1;
    other[a] = 0;
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      const PetscInt column = index[q->col[k]];
      if (column >= start && column < start + q->owned)
        own[a]++;
      else
        other[a]++;
    }
    *longest = PetscMax(*longest, own[a] + other[a]);
  }
  PetscFunctionReturn(0);
}

/* Row by row rather than by MatSetPreallocationCOO(), which would keep 24 bytes an entry to add values up that come in
   any order: ours are written where FindPlaces() says. */
static PetscErrorCode MakePattern(PgPressure q)
{
  const PetscInt *index;
  PetscInt        start, longest, *own, *other, *columns;
  PetscScalar    *zeros;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetGlobalIndices(q->particles, &start, &index));
  PetscCall(PetscMalloc2(q->owned, &own, q->owned, &other));
  PetscCall(CountEntries(q, start, index, own, other, &longest));
  PetscCall(MatXAIJSetPreallocation(q->A, 1, own, other, NULL, NULL));
  PetscCall(PetscFree2(own, other));
  PetscCall(MatSetOption(q->A, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_FALSE));
  PetscCall(PetscMalloc1(longest, &columns));
  PetscCall(PetscCalloc1(longest, &zeros));
  for (PetscInt a = 0; a < q->owned; a++) {
    const PetscInt row = start + a;
    PetscInt       n   = 0;

    columns[n++] = row;
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) columns[n++] = index[q->col[k]];
    PetscCall(MatSetValues(q->A, 1, &row, n, columns, zeros, INSERT_VALUES));
  }
  PetscCall(PetscFree(zeros));
  PetscCall(PetscFree(columns));
  PetscCall(MatSetOption(q->A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(MatAssemblyBegin(q->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(q->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(q->A, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  PetscCall(FindPlaces(q, start, index));
  q->patterns++;
  PetscFunctionReturn(0);
}

/* What the matrix is: told to PETSc after each new pattern and when the conditions make it singular, or in another way,
   or no more. */
static PetscErrorCode Describe(PgPressure q)
{
  const PetscBool definite = (PetscBool)(q->symmetric && !q->islands);
  MatNullSpace    space    = NULL;

  PetscFunctionBeginUser;
  PetscCall(MatSetOption(q->A, MAT_SYMMETRIC, q->symmetric));
  PetscCall(MatSetOption(q->A, MAT_SYMMETRY_ETERNAL, q->symmetric));
  PetscCall(MatSetOption(q->A, MAT_SPD, definite));
  PetscCall(MatSetOption(q->A, MAT_SPD_ETERNAL, definite));
  if (q->islands) PetscCall(MatNullSpaceCreate(q->comm, q->whole, 0, NULL, &space));
  if (q->islands && !q->whole) PetscCall(MatNullSpaceSetFunction(space, PgPressureRemoveIslandMeans, q));
  PetscCall(MatSetNullSpace(q->A, space));
  PetscCall(MatSetTransposeNullSpace(q->A, q->symmetric ? space : NULL));
  PetscCall(MatNullSpaceDestroy(&space));
  q->matrix_islands = q->islands;
  q->matrix_whole   = q->whole;
  PetscFunctionReturn(0);
}

/* Every place of the pattern belongs to one entry (FindPlaces() made sure), so all are written. */
static void WriteValues(PgPressure q, const PetscReal fixed[], const PetscReal prescribed[], PetscScalar own[],
                        PetscScalar other[])
{
  for (PetscInt a = 0; a < q->owned; a++) {
    const PetscReal free_row = fixed[a] == 0.0 ? 1.0 : 0.0;
    PetscReal       lift     = 0.0;
    own[q->diagonal_at[a]]   = q->diagonal[a];
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      const PetscInt b = q->col[k], at = q->entry_at[k];
      PetscReal      value = -free_row * q->weight[k];
      if (fixed[b] != 0.0) {
        lift -= value * (prescribed[b] - q->reference);
        value = 0.0;
      }
      if (at >= 0)
        own[at] = value;
      else
        other[~at] = value;
    }
    q->lift[a] = lift;
  }
}

static PetscErrorCode Fill(PgPressure q)
{
  Mat             own, other;
  const PetscInt *columns;
  PetscReal      *fixed, *prescribed;
  PetscScalar    *value, *other_value = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->prescribed, &prescribed));
  PetscCall(Blocks(q->A, &own, &other, &columns));
  PetscCall(MatSeqAIJGetArrayWrite(own, &value));
  if (other) PetscCall(MatSeqAIJGetArrayWrite(other, &other_value));
  WriteValues(q, fixed, prescribed, value, other_value);
  if (other) PetscCall(MatSeqAIJRestoreArrayWrite(other, &other_value));
  PetscCall(MatSeqAIJRestoreArrayWrite(own, &value));
  /* marks the values as new for whoever looks at the whole matrix; nothing is communicated */
  PetscCall(MatAssemblyBegin(q->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(q->A, MAT_FINAL_ASSEMBLY));
  q->fills++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureAssemble(PgPressure q)
{
  const PetscBool fresh = (PetscBool)(!q->A || q->resize);

  PetscFunctionBeginUser;
  PetscCall(PgPressureFindIslands(q));
  if (fresh) {
    PetscCall(KSPReset(q->ksp)); /* its vectors have the old size */
    PetscCall(CreateMatrix(q));
    q->built = PETSC_FALSE;
  }
  if (fresh || q->new_lists || q->new_numbers) {
    PetscCall(MakePattern(q));
    q->restructured = PETSC_TRUE;
    /* rows changed places: what was built belongs to other discs. With new pairs alone it still fits, roughly. */
    if (q->new_numbers) q->stale = PETSC_TRUE;
    PetscCall(Describe(q));
  } else if (q->islands != q->matrix_islands || q->whole != q->matrix_whole) {
    PetscCall(Describe(q));
    q->stale = PETSC_TRUE;
  }
  q->new_lists = q->new_numbers = q->resize = PETSC_FALSE;
  PetscCall(Fill(q));
  q->matrix_current = PETSC_TRUE;
  q->rhs_current    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureFillRhs(PgPressure q)
{
  PetscScalar *b;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(q->b, &b));
  for (PetscInt a = 0; a < q->owned; a++) b[a] = q->source[a] + q->lift[a];
  PetscCall(VecRestoreArrayWrite(q->b, &b));
  q->rhs_current = PETSC_TRUE;
  PetscFunctionReturn(0);
}

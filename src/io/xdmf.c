/* FILE.xmf: the index that ParaView opens, XDMF version 2. Every disc is a cell of its own (a Polyvertex
   of one point), so that filters on cells, such as Threshold, choose discs. Vectors of two components are
   plain "Vector" data, which the readers fill up with a zero; tensors are "Matrix" data with components xx,
   xy, yx, yy: 2 x 2 data is not a "Tensor" for XDMF, and functions that join slabs crash ParaView 5.11. */
#include "ioimpl.h"
#include <errno.h>
#include <unistd.h>

static PetscErrorCode AddDataItem(PgOutput output, const char group[], const char name[], PetscInt components,
                                  PetscBool integer, PetscInt rows)
{
  PgText   *text      = &output->grids;
  const int precision = (int)(integer ? sizeof(PetscInt) : sizeof(PetscReal));

  PetscFunctionBeginUser;
  PetscCall(PgTextPrint(text, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%lld",
                        integer ? "Int" : "Float", precision, (long long)rows));
  if (components > 1) PetscCall(PgTextPrint(text, " %lld", (long long)components));
  PetscCall(PgTextAppend(text, "\">"));
  PetscCall(PgTextAppendXml(text, output->base));
  PetscCall(PgTextAppend(text, ":"));
  PetscCall(PgTextAppend(text, group));
  PetscCall(PgTextAppend(text, "/"));
  PetscCall(PgTextAppendXml(text, name));
  PetscCall(PgTextAppend(text, "</DataItem>\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgXdmfBeginGrid(PgOutput output, const char group[], PetscReal time, PetscInt rows)
{
  PgText            *text = &output->grids;
  const PgFieldInfo *position;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetFieldInfo(output->particles, PG_POSITION, &position));
  PetscCall(PgTextPrint(text, "      <Grid Name=\"%s\" GridType=\"Uniform\">\n        <Time Value=\"",
                        strrchr(group, '/') + 1));
  PetscCall(PgTextReal(text, time));
  PetscCall(PgTextPrint(text,
                        "\"/>\n        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%lld\" "
                        "NodesPerElement=\"1\"/>\n        <Geometry GeometryType=\"XY\">\n",
                        (long long)rows));
  PetscCall(AddDataItem(output, group, position->name, position->components, PETSC_FALSE, rows));
  PetscCall(PgTextAppend(text, "        </Geometry>\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgXdmfAddField(PgOutput output, const char group[], const char name[], PetscInt components,
                              PetscBool integer, PetscInt rows)
{
  PgText     *text = &output->grids;
  const char *type = components == 1 ? "Scalar" : components == 2 ? "Vector" : "Matrix";

  PetscFunctionBeginUser;
  PetscCall(PgTextAppend(text, "        <Attribute Name=\""));
  PetscCall(PgTextAppendXml(text, name));
  PetscCall(PgTextPrint(text, "\" AttributeType=\"%s\" Center=\"Node\">\n", type));
  PetscCall(AddDataItem(output, group, name, components, integer, rows));
  PetscCall(PgTextAppend(text, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgXdmfBeginMesh(PgOutput output, const char group[], PetscReal time)
{
  PgText *text = &output->grids;

  PetscFunctionBeginUser;
  PetscCall(PgTextPrint(text, "      <Grid Name=\"%s\" GridType=\"Uniform\">\n        <Time Value=\"",
                        strrchr(group, '/') + 1));
  PetscCall(PgTextReal(text, time));
  PetscCall(PgTextPrint(text, "\"/>\n        <Topology TopologyType=\"Quadrilateral\" NumberOfElements=\"%lld\">\n",
                        (long long)output->grid.cells));
  PetscCall(AddDataItem(output, "/mesh", "cells", 4, PETSC_TRUE, output->grid.cells));
  PetscCall(PgTextAppend(text, "        </Topology>\n        <Geometry GeometryType=\"XY\">\n"));
  PetscCall(AddDataItem(output, "/mesh", "position", 2, PETSC_FALSE, output->grid.nodes));
  PetscCall(PgTextAppend(text, "        </Geometry>\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgXdmfAddGridField(PgOutput output, const char group[], const PgGridField *field)
{
  PgText     *text = &output->grids;
  const char *type = field->components == 1 ? "Scalar" : field->components == 2 ? "Vector" : "Matrix";

  PetscFunctionBeginUser;
  PetscCall(PgTextAppend(text, "        <Attribute Name=\""));
  PetscCall(PgTextAppendXml(text, field->name));
  PetscCall(PgTextPrint(text, "\" AttributeType=\"%s\" Center=\"%s\">\n", type, field->of_cells ? "Cell" : "Node"));
  PetscCall(AddDataItem(output, group, field->name, field->components, PETSC_FALSE,
                        field->of_cells ? output->grid.cells : output->grid.nodes));
  PetscCall(PgTextAppend(text, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgXdmfEndGrid(PgOutput output)
{
  PetscFunctionBeginUser;
  PetscCall(PgTextAppend(&output->grids, "      </Grid>\n"));
  PetscFunctionReturn(0);
}

/* Writes a new file under a temporary name and puts it into place: a reader sees the old index or the new
   one, never half of it. NULL or why not. */
static const char *Replace(PgOutput output, const char temporary[])
{
  FILE *stream = fopen(temporary, "w");
  int   bad;

  if (!stream) return strerror(errno);
  errno = 0;
  bad   = fprintf(stream,
                  "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
                    "<Xdmf Version=\"2.0\">\n  <Domain>\n"
                    "    <Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                output->particles ? "discs" : "continuum") < 0;
  bad |= output->grids.used && fputs(output->grids.string, stream) == EOF;
  bad |= fputs("    </Grid>\n  </Domain>\n</Xdmf>\n", stream) == EOF;
  bad |= fflush(stream) == EOF;
  if (bad && !errno) errno = EIO;
  if (bad) {
    const char *reason = strerror(errno);
    (void)fclose(stream);
    (void)unlink(temporary);
    return reason;
  }
  if (fclose(stream) == EOF || rename(temporary, output->xmf)) {
    const char *reason = strerror(errno);
    (void)unlink(temporary);
    return reason;
  }
  return NULL;
}

PetscErrorCode PgXdmfWrite(PgOutput output)
{
  PgText      temporary = {NULL, 0, 0};
  const char *reason    = NULL;

  PetscFunctionBeginUser;
  if (output->rank == 0) {
    PetscCall(PgTextAppend(&temporary, output->xmf));
    PetscCall(PgTextAppend(&temporary, ".tmp"));
    reason = Replace(output, temporary.string);
    PetscCall(PgTextDestroy(&temporary));
  }
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write index file", output->xmf, reason));
  PetscFunctionReturn(0);
}

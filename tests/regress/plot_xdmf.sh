#!/usr/bin/env bash
# timeout: 300
# The XDMF index opens in VTK's reader, the one of ParaView 5.11, without a screen: all times, all arrays, the values.
. "$SOURCE_DIR/tests/support/regress.sh"

python=
for candidate in python3 /usr/bin/python3; do
  "$candidate" -c 'from vtkmodules.vtkIOXdmf2 import vtkXdmfReader' 2>/dev/null && python=$candidate && break
done
[ -n "$python" ] || skip 'there is no VTK with XDMF for Python (Debian: python3-paraview or python3-vtk9)'

"$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -panel_columns 10 -panel_rows 21 -panel_displacement 1.236e-4 \
  -output_every 5e-4 -output run.h5 >run.log
h5ls run.h5/snapshots/000000 | awk '{ print $1 }' | sort >fields.txt
h5dump -w 1 -y -o pressure.txt -d /snapshots/000004/pressure run.h5 >dump.out

cat >check.py <<'PYTHON'
import sys
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

reader = vtkXdmfReader()
if not reader.CanReadFile("run.xmf"):
    sys.exit("the reader does not take run.xmf")
reader.SetFileName("run.xmf")
reader.UpdateInformation()
times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
if len(times) != 5 or any(abs(t - 5e-4 * i) > 1e-9 for i, t in enumerate(times)):
    sys.exit("times %s" % (times,))
expected = set(open("fields.txt").read().split()) - {"position"}
for t in times:
    reader.UpdateTimeStep(t)
    grid = reader.GetOutputDataObject(0)
    if grid.GetNumberOfPoints() != 199 or grid.GetNumberOfCells() != 199:
        sys.exit("t = %g: %d points, %d cells" % (t, grid.GetNumberOfPoints(), grid.GetNumberOfCells()))
    data = grid.GetPointData()
    missing = expected - {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    if missing:
        sys.exit("t = %g: no arrays %s" % (t, sorted(missing)))
    for name in expected:
        if data.GetArray(name).GetNumberOfTuples() != 199:
            sys.exit("t = %g: %s has %d values" % (t, name, data.GetArray(name).GetNumberOfTuples()))
pressure = [float(w) for w in open("pressure.txt").read().replace(",", " ").split()]
read = [data.GetArray("pressure").GetValue(i) for i in range(199)]
# h5dump prints six digits
if any(abs(a - b) > 1e-5 * abs(a) for a, b in zip(pressure, read)) or len(pressure) != 199 or max(read) == min(read):
    sys.exit("pressure of the last snapshot differs")
PYTHON
"$python" check.py >check.out 2>&1 || fail "VTK: $(tail -n 3 check.out)"
! grep -iq error check.out || fail "VTK says: $(grep -i error check.out | head -n 3)"

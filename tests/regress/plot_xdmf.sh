#!/usr/bin/env bash
# timeout: 300
# The XDMF index opens in VTK's reader, the one of ParaView 5.11, without a screen: all times, all arrays, the values, of
# discs and of a continuum.
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

# ---- a continuum: cells with their corners, arrays of nodes and of cells ----
"$POROGRAIN" -options_file "$SOURCE_DIR/options/up_mandel.opts" -up_cells 12,6 -end_time 2 -output_every 1 -output mesh.h5 >mesh.log 2>&1 ||
  fail "up_mandel: $(tail -n 3 mesh.log)"
h5ls mesh.h5/snapshots/000002 | sed 's/ *Dataset {\([0-9]*\).*/ \1/' >rows.txt
for k in 0 1 2; do h5dump -a /snapshots/00000$k/time mesh.h5 | sed -n 's/.*(0): //p'; done >times.txt
for name in pressure volumetric_strain displacement; do h5dump -w 1 -y -o $name.txt -d /snapshots/000002/$name mesh.h5 >dump.out; done

cat >mesh.py <<'PYTHON'
import sys
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

reader = vtkXdmfReader()
reader.SetFileName("mesh.xmf")
reader.UpdateInformation()
times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
written = [float(w) for w in open("times.txt")]
# six digits in either
if len(times) != 3 or len(written) != 3 or any(abs(t - w) > 1e-5 * w for t, w in zip(times, written)) or times[1] == times[2]:
    sys.exit("times %s" % (times,))
reader.UpdateTimeStep(times[-1])
grid = reader.GetOutputDataObject(0)
if grid.GetNumberOfPoints() != 13 * 7 or grid.GetNumberOfCells() != 12 * 6:
    sys.exit("%d points, %d cells" % (grid.GetNumberOfPoints(), grid.GetNumberOfCells()))
area = 0.0
for c in range(grid.GetNumberOfCells()):
    corner = [grid.GetPoint(grid.GetCell(c).GetPointId(k)) for k in range(grid.GetCell(c).GetNumberOfPoints())]
    if len(corner) != 4:
        sys.exit("cell %d has %d corners" % (c, len(corner)))
    turn = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corner, corner[1:] + corner[:1])) / 2
    if turn <= 0:
        sys.exit("cell %d runs the wrong way" % c)
    area += turn
low, high = grid.GetBounds()[0:4:2], grid.GetBounds()[1:4:2]
# sums of 72 products in double precision
if abs(area - (high[0] - low[0]) * (high[1] - low[1])) > 1e-12 * area:
    sys.exit("the cells cover %g m2" % area)
rows = dict(line.split() for line in open("rows.txt"))
if len(rows) != 6:
    sys.exit("datasets %s" % sorted(rows))
for name, count in rows.items():
    data = grid.GetPointData() if int(count) == 13 * 7 else grid.GetCellData()
    array = data.GetArray(name)
    if not array or array.GetNumberOfTuples() != int(count):
        sys.exit("%s: no array with %s values" % (name, count))
for name in "pressure", "volumetric_strain", "displacement":
    data = grid.GetPointData() if grid.GetPointData().GetArray(name) else grid.GetCellData()
    array = data.GetArray(name)
    dumped = [float(w) for w in open(name + ".txt").read().replace(",", " ").split()]
    parts = 2 if name == "displacement" else 1  # a third component, 0, is the reader's
    read = [array.GetComponent(i, k) for i in range(array.GetNumberOfTuples()) for k in range(parts)]
    # h5dump prints six digits; what is nothing but rounding of the largest has fewer
    if len(read) != len(dumped) or any(abs(a - b) > 1e-5 * abs(a) + 1e-12 * max(map(abs, read)) for a, b in zip(dumped, read)):
        sys.exit("%s of the last snapshot differs" % name)
PYTHON
"$python" mesh.py >mesh.out 2>&1 || fail "VTK, continuum: $(tail -n 3 mesh.out)"
! grep -iq error mesh.out || fail "VTK says: $(grep -i error mesh.out | head -n 3)"

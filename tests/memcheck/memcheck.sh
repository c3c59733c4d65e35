#!/usr/bin/env bash
# Memcheck of valgrind over the unit tests on one rank and short runs of the panel: no read or write outside of what was
# allocated, no decision from a value that was never set. Started by the target memcheck:
#
#   cmake --build build --target memcheck
#
# Arguments: names of unit tests; none: all. Reports stay in build/memcheck.
set -euo pipefail
mkdir -p "$WORK_DIR"
cd "$WORK_DIR"
rm -rf ./*
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 CMOCKA_TEST_ABORT=1 PETSC_OPTIONS=

suppressions=(--suppressions="$SOURCE_DIR/tests/memcheck/libraries.supp")
# OpenMPI brings a list of its own.
for file in /usr/share/openmpi/openmpi-valgrind.supp "$(dirname "$(command -v mpiexec)")/../share/openmpi/openmpi-valgrind.supp"; do
  if [ -r "$file" ]; then
    suppressions+=(--suppressions="$file")
    break
  fi
done

# check NAME program...: in a folder of its own; at most two at a time
check() {
  local name=$1 status=0
  shift
  mkdir "$name"
  (cd "$name" && exec valgrind --quiet --error-exitcode=99 --num-callers=30 "${suppressions[@]}" --log-file=valgrind.log \
    "$@" >out 2>&1 </dev/null) || status=$?
  if [ "$status" -ne 0 ] || [ -s "$name/valgrind.log" ]; then
    echo "$name: status $status" >"$name/failed"
    echo "FAIL $name (status $status): $WORK_DIR/$name/valgrind.log"
  else
    echo "pass $name"
  fi
}

started=0
start() {
  check "$@" &
  started=$((started + 1))
  if [ $((started % 2)) -eq 0 ]; then wait; fi
}

if [ $# -eq 0 ]; then
  for source in "$SOURCE_DIR"/tests/unit/*.c; do
    name=$(basename "$source" .c)
    ranks=$(sed -n '1,5s/.*ranks: *\([0-9 ]*\).*/\1/p' "$source")
    [[ " ${ranks:-1} " == *' 1 '* ]] || continue # it needs several
    start "test-unit-$name" "$BUILD_DIR/tests/test-unit-$name"
  done
  panel=(-case panel -panel_columns 4 -dt 2e-6 -end_time 6e-5 -output_every 2e-5 -history_every 1e-5 -neighbors_skin 1e-4
    -output run.h5 -checkpoint run.pgc -checkpoint_every 2e-5)
  start panel-dry "$POROGRAIN" "${panel[@]}" -fluid none -dem_local_damping 0.7 -dem_energy
  start panel-darcy "$POROGRAIN" "${panel[@]}" -fluid darcy -pressure explicit
  start panel-ns "$POROGRAIN" "${panel[@]}" -fluid ns -pressure implicit -ns_continuity averaged \
    -coupling drag_and_pressure -sph_gradient corrected -bc_tracking surface
  wait
  start panel-restart "$POROGRAIN" "${panel[@]}" -fluid none -dem_local_damping 0.7 -dem_energy \
    -restart "$WORK_DIR/panel-dry/run.pgc.1"
else
  for name in "$@"; do start "test-unit-$name" "$BUILD_DIR/tests/test-unit-$name"; done
fi
wait
failed=$(find . -name failed | wc -l)
echo "$started programs, $failed with errors"
[ "$failed" -eq 0 ]

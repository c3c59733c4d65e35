# processors: 2
# timeout: 180
# The continuum goes on from a checkpoint: on as many ranks with the same bits in results, history and the checkpoints that
# follow, whatever the solver; on other numbers of ranks within the tolerance of the solver. What does not fit is refused.
. "$SOURCE_DIR/tests/support/regress.sh"
options="$SOURCE_DIR/options"

# simulate NAME RANKS options...: NAME.h5, NAME.pgc; status 0
simulate() {
  local name=$1 n=$2
  shift 2
  run "$n" "$POROGRAIN" "$@" -output "$name.h5" -checkpoint "$name.pgc" >"$name.log" 2>&1 || { cat "$name.log" >&2; fail "$name"; }
}

# exact NAME RANKS END options...: a checkpoint at half of END, 10 snapshots, a row for each step
exact() {
  local name=$1 n=$2 end=$3 object times
  shift 3
  times="-end_time $end -checkpoint_every $(awk "BEGIN { print $end/2 }")"
  # shellcheck disable=SC2086
  simulate whole "$n" "$@" $times
  cp whole.h5 again.h5
  # shellcheck disable=SC2086
  simulate again "$n" "$@" $times -restart whole.pgc.1
  expect_match '^continued from whole.pgc.1, step [1-9]' again.log
  expect_same_results whole.h5 again.h5
  expect_same_results whole.pgc again.pgc /state
  cmp whole.csv again.csv || fail "$name: the history as text differs"
  # ParaView opens as many snapshots, each with fields of nodes and of cells
  for object in '<Grid Name="0' 'Center="Node"' 'Center="Cell"' 'TopologyType="Quadrilateral"'; do
    [ "$(grep -c "$object" again.xmf)" = "$(grep -c "$object" whole.xmf)" ] || fail "$name: again.xmf differs in $object"
  done
  [ "$(csv_column whole.csv time | wc -l)" -gt 20 ] || fail "$name: a short run"
}

# the first steps are of backward Euler: the matrix changes on the way, before and after the checkpoint
beside within terzaghi exact terzaghi 1 3 -case up_terzaghi -up_cells 1,20 -up_theta 0.5 -up_start_steps 5
beside within late exact late 1 3 -case up_terzaghi -up_cells 1,20 -up_theta 0.5 -up_start_steps 20
beside within mandel exact mandel 2 4 -options_file "$options/up_mandel.opts" -up_element q2q1 -up_cells 10,7
beside within direct exact direct 1 4 -options_file "$options/up_mandel.opts" -options_file "$options/up_direct.opts" -up_cells 10,8
beside within minres exact minres 2 3 -case up_terzaghi -up_cells 2,20 -options_file "$options/up_minres.opts"
# waves: velocities and accelerations are part of the state
beside within inertia exact inertia 1 2e-2 -case up_footing -up_cells 8,8 -up_inertia -up_theta 0.6 -up_damping 3 -dt 5e-4
together

# ---- other numbers of ranks: pressures of some 1e4 Pa, displacements of 1e-3 m, solved to 1e-10 of the loads ----
mandel=(-options_file "$options/up_mandel.opts" -up_element q2q1 -up_cells 10,7 -end_time 4 -checkpoint_every 2)
other() {
  cp ../mandel/whole.h5 ranks.h5
  simulate ranks "$1" "${mandel[@]}" -restart ../mandel/whole.pgc.1
  h5diff -d 1e-3 ../mandel/whole.h5 ranks.h5 /snapshots/000010/pressure /snapshots/000010/pressure || fail "$1 ranks: pressure"
  h5diff -d 1e-10 ../mandel/whole.h5 ranks.h5 /snapshots/000010/displacement /snapshots/000010/displacement || fail "$1 ranks: displacement"
}
for n in 1 4; do beside within ranks-$n other $n; done

# ---- what does not fit ----
# refused STATUS PATTERN options...: nothing is written
refused() {
  local status=$1 pattern=$2
  shift 2
  expect_error "$status" "^porograin: error: $pattern" "$POROGRAIN" "$@" -output bad.h5
  [ "$(grep -c 'porograin: error' expect_error.out)" -eq 1 ] || { cat expect_error.out >&2; fail "not one message: $*"; }
  if compgen -G 'bad.*' >/dev/null; then fail "written in spite of: $*"; fi
}
terzaghi=(-case up_terzaghi -up_cells 1,20 -end_time 3 -restart ../terzaghi/whole.pgc)
wrong="checkpoint '../terzaghi/whole.pgc': cannot go on from it:"
beside within other-case refused 4 "$wrong option -case is 'up_terzaghi' in the checkpoint and 'up_footing' now" "${terzaghi[@]}" -case up_footing
beside within discs refused 4 "$wrong option -case is 'up_terzaghi' in the checkpoint and 'panel' now" -case panel -panel_columns 4 -restart ../terzaghi/whole.pgc
beside within other-step refused 4 "$wrong the time step \(option -dt\)" "${terzaghi[@]}" -dt 0.01
beside within other-cells refused 4 "$wrong the number of nodes or cells of the mesh is 42 in the checkpoint and 44 now" "${terzaghi[@]}" -up_cells 1,21
beside within other-place refused 4 "$wrong a coordinate of a node of the mesh \[m\] is 0\.1 in the checkpoint and 0\.2 now" "${terzaghi[@]}" -up_terzaghi_height 2 -dt 0.09000000999999999
beside within other-element refused 4 "$wrong option -up_element is 'q1q1' in the checkpoint and 'q2q1' now" "${terzaghi[@]}" -up_element q2q1
beside within absent refused 4 "cannot restart from 'none.pgc': No such file" -case up_terzaghi -restart none.pgc
together

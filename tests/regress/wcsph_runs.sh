# timeout: 180
# The weakly compressible liquid by the program: shipped files, the same bits on 1, 2 and 3 ranks, results that ParaView
# opens; what is wrong with a liquid is said by name, and nothing is written.
. "$SOURCE_DIR/tests/support/regress.sh"
options="$SOURCE_DIR/options"

# last FILE COLUMN: the last value of a column
last() { csv_column "$1" "$2" | tail -n 1; }

# ---- shipped files ----
for case in poiseuille couette hydrostatic; do
  end=()
  [ $case != hydrostatic ] || end=(-end_time 0.2) # two periods of sound
  "$POROGRAIN" -options_file "$options/wcsph_$case.opts" "${end[@]}" -output "$case.h5" >"$case.out" 2>&1 ||
    { cat "$case.out" >&2; fail "wcsph_$case.opts"; }
  expect_match "wrote $case.h5" "$case.out"
done
# 20 particles across: 2e-3, 2e-3 and 4e-3 are measured
for case in poiseuille couette hydrostatic; do
  expect_close "$(last $case.csv error_l2)" 2.5e-3 2.5e-3
done
[ "$(find "$options" -name 'wcsph_*.opts' | wc -l)" -eq 3 ] || fail "not 3 files wcsph_*.opts"
expect_match 'poiseuille.h5:/snapshots/000010/pressure<' poiseuille.xmf

# ---- 1, 2 and 3 ranks: the same bits, with particles that migrate ----
for wall in mirror adjoint; do
  for n in 1 $([ $wall = mirror ] && echo 3 || echo 2); do
    run $n "$POROGRAIN" -case wcsph_hydrostatic -wcsph_hydrostatic_tank true -wcsph_cells 10 -wcsph_columns 14 -wcsph_jitter 0.2 \
      -wcsph_wall $wall -end_time 0.1 -output $wall$n.h5 >$wall$n.out 2>&1 || { cat $wall$n.out >&2; fail "$n ranks"; }
    h5diff $wall$n.h5 ${wall}1.h5 /snapshots /snapshots || fail "$wall: $n ranks are not 1"
    cmp $wall$n.csv ${wall}1.csv || fail "$wall: the history of $n ranks"
  done
done
cmp -s mirror1.csv adjoint1.csv && fail 'walls make no difference'
run 2 "$POROGRAIN" -case wcsph_couette -wcsph_cells 10 -wcsph_columns 12 -wcsph_wall own -output couette2.h5 >couette2.out 2>&1
"$POROGRAIN" -case wcsph_couette -wcsph_cells 10 -wcsph_columns 12 -wcsph_wall own -output couette1.h5 >couette1.out 2>&1
h5diff couette2.h5 couette1.h5 /snapshots /snapshots || fail 'a periodic flow on 2 ranks is not that on 1'

# ---- a damping that takes all velocity in each step is no instability: what is left is the last half of a kick, in
# 9.4e-4 s, by what is not balanced, at most twice gravity ----
"$POROGRAIN" -case wcsph_hydrostatic -wcsph_hydrostatic_from_rest true -wcsph_cells 8 -wcsph_columns 12 -wcsph_damping 1e6 \
  -wcsph_damping_end 1 -end_time 0.05 -output damped.h5 >damped.out 2>&1 || { cat damped.out >&2; fail 'a strong damping'; }
expect_close "$(last damped.csv speed_max)" 0 9.2e-3

# ---- what is wrong, by name ----
# bad PATTERN options...: status 2 and one message, on $ranks; nothing written
ranks='1'
bad() {
  local pattern=$1 n
  shift
  for n in $ranks; do
    expect_error 2 "^porograin: error: .*$pattern" run $n "$POROGRAIN" "$@" -output bad.h5
    [ "$(grep -c 'porograin: error' expect_error.out)" -eq 1 ] || { cat expect_error.out >&2; fail "not one message: $*"; }
  done
  if compgen -G 'bad.*' >/dev/null; then fail "written in spite of: $*"; fi
}
bad 'option -wcsph_sound_speed: 0 m/s is out of range' -case wcsph_couette -wcsph_sound_speed 0
bad 'option -wcsph_smoothing: 0.5 is out of range' -case wcsph_couette -wcsph_smoothing 0.5
bad "option -wcsph_kernel: 'gauss' is not one of cubic_spline, quintic_spline" -case wcsph_couette -wcsph_kernel gauss
bad 'option -wcsph_gravity: a flow between plates needs a force along x alone, not \(0, 0\)' -case wcsph_poiseuille -wcsph_gravity 0,0
bad 'option -wcsph_gravity: the flow under a moving plate has no other force' -case wcsph_couette -wcsph_gravity 1,0
bad 'option -wcsph_gravity: a liquid at rest needs a gravity downward' -case wcsph_hydrostatic -wcsph_gravity 0,9.81
bad 'option -wcsph_viscosity: a flow between plates needs a viscosity' -case wcsph_poiseuille -wcsph_viscosity 0
bad 'option -wcsph_couette_speed: the plate must move' -case wcsph_couette -wcsph_couette_speed 0
bad 'option -wcsph_sound_speed: with 5 m/s a column of 1 m is compressed by 0.392, more than 0.1' -case wcsph_hydrostatic -wcsph_sound_speed 5
bad 'option -dt: 1 s is more than the largest stable time step of this liquid, 0.0075 s' -case wcsph_couette -dt 1
bad 'option -wcsph_diffusion 0.2 has no effect with -wcsph_density summation: Eq. 26 leaves nothing to diffuse' \
  -case wcsph_couette -wcsph_density summation -wcsph_diffusion 0.2
bad 'option -wcsph_contact 2 has no effect in a run without bodies' -case wcsph_couette -wcsph_contact 2
bad 'option -wcsph_damping 3 has no effect without -wcsph_damping_end' -case wcsph_couette -wcsph_damping 3
bad 'option -wcsph_seed 3 has no effect without -wcsph_jitter' -case wcsph_couette -wcsph_seed 3
bad 'unknown option -wcsph_viscosty 1; did you mean -wcsph_viscosity' -case wcsph_couette -wcsph_viscosty 1
bad 'option -wcsph_couette_speed 1 is not read in this run, it needs -case wcsph_couette' -case wcsph_poiseuille -wcsph_couette_speed 1
bad 'option -checkpoint x.pgc is of no use to this case' -case wcsph_couette -checkpoint x.pgc
ranks='1 2'
bad 'the period of 0.004 m in x must hold at least three cells of width' -case wcsph_couette -wcsph_columns 8
# a liquid that blows up says which particle, and the run ends as failed
expect_error 3 'porograin: error: (the density of particle|particle) [0-9]+ .*' run 2 "$POROGRAIN" -case wcsph_hydrostatic -wcsph_density summation \
  -wcsph_cells 10 -end_time 1

# processors: 2
# No step divides by zero, takes the root of a negative number or overflows, in whatever scheme: 500 steps of a small
# panel each, with list builds, lost contacts and output, and floating-point exceptions trapped. So with the continuum, the
# liquid and bodies in it.
. "$SOURCE_DIR/tests/support/regress.sh"

runs=0
# trapped options...: two at a time
trapped() {
  runs=$((runs + 1))
  {
    "$POROGRAIN" "$@" -output "run-$runs.h5" -fp_trap >"run-$runs.log" 2>&1 || echo "$*" >"run-$runs.failed"
  } &
  if [ $((runs % 2)) -eq 0 ]; then wait; fi
}
panel="-case panel -panel_columns 10 -dt 2e-6 -end_time 1e-3 -neighbors_skin 0.01 -output_every 5e-4"

documented="-ns_continuity averaged -coupling drag_and_pressure -sph_gradient corrected -sph_laplacian_eta 0.01 \
  -bc_tracking surface"
# shellcheck disable=SC2086
{
  trapped $panel -fluid none
  trapped $panel -fluid none -dem_local_damping 0.7 -dem_c_n 100 -dem_c_theta 1e-3 -dem_k_s 0
  trapped $panel -fluid darcy -pressure explicit -coupling drag -porosity_rate sampled
  trapped $panel -fluid darcy -dem_local_damping 0.7 -coupling drag_and_pressure -porosity kernel -bc_top flux -bc_top_flux -0.13
  trapped $panel -fluid ns -pressure explicit -coupling drag -ns_continuity solenoidal -sph_operators paper
  trapped $panel -fluid ns -pressure explicit -dem_local_damping 0.7 -ns_theta 0.7 -ns_smoothing 0.02 -porosity kinematic
  trapped $panel -fluid ns -dem_local_damping 0.7 $documented
  trapped $panel -fluid ns -fluid_every 25 $documented -pressure_pc_type gamg
  trapped $panel -fluid ns -sph_operators corrected -gravity 0,-9.81
  trapped $panel -fluid ns -bc_left impermeable -bc_right impermeable -bc_top impermeable -bc_bottom impermeable
}
trapped -case up_terzaghi -end_time 3
trapped -case up_mandel -up_cells 10,7 -end_time 2
trapped -case up_footing -up_cells 8,8
trapped -case wcsph_couette -end_time 0.1
trapped -case wcsph_hydrostatic -wcsph_hydrostatic_tank true -wcsph_cells 10 -wcsph_columns 14 -wcsph_jitter 0.2 -end_time 0.1
trapped -case tak_two_elements -end_time 0.1
trapped -case tak_block -end_time 0.1
wait
if ls run-*.failed >failed.txt 2>/dev/null; then
  cat run-*.failed >&2
  fail "$(wc -l <failed.txt) of $runs runs"
fi

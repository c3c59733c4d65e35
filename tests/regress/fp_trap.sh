# processors: 2
# No step divides by zero, takes the root of a negative number or overflows, in whatever scheme: 500 steps of a small
# panel each, with list builds, lost contacts and output, and floating-point exceptions trapped.
. "$SOURCE_DIR/tests/support/regress.sh"

runs=0
# trapped options...: two at a time
trapped() {
  runs=$((runs + 1))
  {
    "$POROGRAIN" -case panel -panel_columns 10 -dt 2e-6 -end_time 1e-3 -neighbors_skin 0.01 -output_every 5e-4 \
      -output "run-$runs.h5" -fp_trap "$@" >"run-$runs.log" 2>&1 || echo "$*" >"run-$runs.failed"
  } &
  if [ $((runs % 2)) -eq 0 ]; then wait; fi
}

documented="-ns_continuity averaged -coupling drag_and_pressure -sph_gradient corrected -sph_laplacian_eta 0.01 \
  -bc_tracking surface"
# shellcheck disable=SC2086
{
  trapped -fluid none
  trapped -fluid none -dem_local_damping 0.7 -dem_c_n 100 -dem_c_theta 1e-3 -dem_k_s 0
  trapped -fluid darcy -pressure explicit -coupling drag -porosity_rate sampled
  trapped -fluid darcy -dem_local_damping 0.7 -coupling drag_and_pressure -porosity kernel -bc_top flux -bc_top_flux -0.13
  trapped -fluid ns -pressure explicit -coupling drag -ns_continuity solenoidal -sph_operators paper
  trapped -fluid ns -pressure explicit -dem_local_damping 0.7 -ns_theta 0.7 -ns_smoothing 0.02 -porosity kinematic
  trapped -fluid ns -dem_local_damping 0.7 $documented
  trapped -fluid ns -fluid_every 25 $documented -pressure_pc_type gamg
  trapped -fluid ns -sph_operators corrected -gravity 0,-9.81
  trapped -fluid ns -bc_left impermeable -bc_right impermeable -bc_top impermeable -bc_bottom impermeable
}
wait
if ls run-*.failed >failed.txt 2>/dev/null; then
  cat run-*.failed >&2
  fail "$(wc -l <failed.txt) of $runs runs"
fi

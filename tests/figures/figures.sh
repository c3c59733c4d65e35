#!/usr/bin/env bash
# figures.sh FOLDER: runs the cases in FOLDER and makes all pictures of docs/figures anew; called by
#   cmake --build build --target figures
# Environment: POROGRAIN, POROGRAIN_STUDY, POROGRAIN_PLOT, SOURCE_DIR. It takes about five minutes on one core.
# FIGURES_KEEP=yes draws results that are in FOLDER again without computing them anew.
set -euo pipefail
mkdir -p -- "$1"
cd -- "$1"
pictures=$SOURCE_DIR/docs/figures
export OMP_NUM_THREADS=1

command -v gnuplot >/dev/null || { echo "figures: gnuplot is not installed (Debian: gnuplot-nox)" >&2; exit 1; }

# run NAME options...: a run, unless its results are to be kept
run() {
  local name=$1
  shift
  [ "${FIGURES_KEEP:-}" = yes ] && [ -s "$name.h5" ] && return
  echo "figures: $name"
  "$@" >"$name.log"
}

# The panel of the paper, both cases; and with one explicit sweep in each fluid step.
for name in case1_dry case1_darcy case1_ns case2_darcy case2_ns; do
  run "$name" "$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_$name.opts" -output "$name.h5"
done
run explicit "$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -pressure explicit -output explicit.h5
cp case1_ns.h5 implicit.h5

# A continuum.
run footing "$POROGRAIN" -options_file "$SOURCE_DIR/options/up_footing.opts" -output footing.h5

# Solvers of the pressure equation, and explicit against implicit.
run solvers "$POROGRAIN_STUDY" -study_sizes 1249,4999,19999 -study_solvers "$SOURCE_DIR/options/solvers/all.txt" \
  -study_only richardson-jacobi,cg-jacobi,cg-icc,cg-gamg,cg-hypre -study_repeats 1 -study_output solvers
run sweeps "$POROGRAIN_STUDY" -study explicit -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -study_output sweeps

rm -rf case1 case2 tour film continuum
"$POROGRAIN_PLOT" case1_dry.h5 case1_darcy.h5 case1_ns.h5 solvers.h5 sweeps.h5 -figures case1 -plot_format png -plot_size 0.75
"$POROGRAIN_PLOT" case2_darcy.h5 case2_ns.h5 -figures case2 -plot_format png -plot_size 0.75
"$POROGRAIN_PLOT" implicit.h5 explicit.h5 -figures tour -plot_fields pressure -plot_format png -plot_size 0.75
"$POROGRAIN_PLOT" case1_ns.h5 -figures film -plot_fields porosity -plot_film porosity -plot_format png -plot_size 0.5

"$POROGRAIN_PLOT" footing.h5 -figures continuum -plot_fields pressure,displacement -plot_format png -plot_size 0.75

mkdir -p "$pictures"
cp case1/load.png "$pictures/case1_load.png"
cp case2/load.png "$pictures/case2_load.png"
cp case1/case1_{dry,darcy,ns}-fields.png case1/case1_ns-history.png "$pictures/"
cp case2/case2_{darcy,ns}-fields.png "$pictures/"
cp case1/solvers-{growth,residuals-3}.png "$pictures/"
cp case1/sweeps-sweeps.png "$pictures/explicit-sweeps.png"
cp case1/sweeps-cost.png "$pictures/explicit-cost.png"
cp tour/load.png "$pictures/tour_load.png"
cp continuum/footing-fields.png "$pictures/"
frames=(film/case1_ns-film-porosity-*.png)
cp "${frames[0]}" "$pictures/film-1.png"
cp "${frames[$((${#frames[@]} / 2))]}" "$pictures/film-2.png"
cp "${frames[-1]}" "$pictures/film-3.png"

# ParaView draws without a screen what docs/output.md says.
if command -v pvpython >/dev/null && command -v xvfb-run >/dev/null; then
  rm -rf paraview && mkdir paraview && cd paraview
  cp ../case1_ns.h5 panel.h5
  sed 's/case1_ns[.]h5/panel.h5/g' ../case1_ns.xmf >panel.xmf
  awk '/^```/ { inside = 0 } /^# view.py/ { inside = 1 } inside' "$SOURCE_DIR/docs/output.md" >view.py
  xvfb-run -a -s '-noreset -screen 0 1280x1024x24' pvpython view.py
  cp paraview.png "$pictures/"
  cd ..
else
  echo "figures: pvpython or xvfb-run is not installed: the picture of ParaView stays as it is" >&2
fi

# Half of the bytes: 256 colours do not bend the scales.
if command -v pngquant >/dev/null; then
  pngquant --force --ext .png --strip --speed 1 --nofs 256 -- "$pictures"/*.png
else
  echo "figures: pngquant is not installed: the pictures are twice as big as they need be" >&2
fi

# The examples of Tak, Park & Park; they come small already.
bash "$SOURCE_DIR/tests/figures/tak.sh" tak
ls -l "$pictures"

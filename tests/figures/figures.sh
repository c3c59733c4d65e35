#!/usr/bin/env bash
# figures.sh FOLDER: runs the cases in FOLDER and makes all pictures of docs/figures anew; called by
#   cmake --build build --target figures
# Environment: POROGRAIN, POROGRAIN_STUDY, POROGRAIN_PLOT, SOURCE_DIR. It takes some minutes on one core.
set -euo pipefail
mkdir -p -- "$1"
cd -- "$1"
pictures=$SOURCE_DIR/docs/figures
export OMP_NUM_THREADS=1

command -v gnuplot >/dev/null || { echo "figures: gnuplot is not installed (Debian: gnuplot-nox)" >&2; exit 1; }

# The panel of the paper, both cases.
for name in case1_dry case1_darcy case1_ns case2_darcy case2_ns; do
  echo "figures: panel_$name"
  "$POROGRAIN" -options_file "$SOURCE_DIR/options/panel_$name.opts" -output "$name.h5" >"$name.log"
done

# Solvers of the pressure equation, and explicit against implicit.
echo "figures: studies"
"$POROGRAIN_STUDY" -study_sizes 1249,4999,19999 -study_solvers "$SOURCE_DIR/options/solvers/all.txt" \
  -study_only richardson-jacobi,cg-jacobi,cg-icc,cg-gamg,cg-hypre -study_repeats 1 -study_output solvers >solvers.log
"$POROGRAIN_STUDY" -study explicit -options_file "$SOURCE_DIR/options/panel_case1_ns.opts" -study_output explicit >explicit.log

rm -rf case1 case2
"$POROGRAIN_PLOT" case1_dry.h5 case1_darcy.h5 case1_ns.h5 solvers.h5 explicit.h5 -figures case1 -plot_format png -plot_size 0.75
"$POROGRAIN_PLOT" case2_darcy.h5 case2_ns.h5 -figures case2 -plot_format png -plot_size 0.75

mkdir -p "$pictures"
cp case1/load.png "$pictures/case1_load.png"
cp case2/load.png "$pictures/case2_load.png"
cp case1/case1_{dry,darcy,ns}-fields.png case1/case1_ns-history.png "$pictures/"
cp case2/case2_{darcy,ns}-fields.png "$pictures/"
cp case1/solvers-{growth,residuals-3}.png case1/explicit-{sweeps,cost}.png "$pictures/"

# A quarter of the bytes: 48 colours are enough for these pictures.
if command -v pngquant >/dev/null; then
  pngquant --force --ext .png --strip --speed 1 --nofs 48 -- "$pictures"/*.png
else
  echo "figures: pngquant is not installed: the pictures are four times as big as they need be" >&2
fi
ls -l "$pictures"

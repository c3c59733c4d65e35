# timeout: 300
# All memory that PETSc handed out is given back at the end of a run: dry, with water of both kinds, with results,
# checkpoints and a restart, on one rank and on two; continuum, liquid, bodies, and runs that end early. (Runs that are refused end without tidying up.)
. "$SOURCE_DIR/tests/support/regress.sh"

panel="-case panel -panel_columns 6 -dt 2e-6 -end_time 1e-4 -output_every 5e-5 -neighbors_skin 1e-3 -checkpoint_every 5e-5"

# PETSc's list of what is left goes to standard output with exit status 0, one line "[rank] BYTES bytes FUNCTION() ..."
# nothing_left STATUS NAME RANKS options...
nothing_left() {
  local status=$1 name=$2 n=$3 got=0
  shift 3
  run "$n" "$POROGRAIN" "$@" -output "$name.h5" -malloc_dump >"$name.log" 2>&1 || got=$?
  [ "$got" = "$status" ] || { cat "$name.log" >&2; fail "$name: status $got"; }
  if grep -aE '^ *\[ ?[0-9]+\] ?[0-9]+ bytes' "$name.log" >left.txt; then
    head -n 20 left.txt >&2
    fail "$name: $(wc -l <left.txt) pieces of memory are left"
  fi
}

# clean NAME RANKS options...: a panel with checkpoints
clean() {
  local name=$1 n=$2
  shift 2
  # shellcheck disable=SC2086
  nothing_left 0 "$name" "$n" $panel "$@" -checkpoint "$name.pgc"
}

# The list would be seen: one program that leaks, by an object of PETSc's that is never destroyed.
"$SUPPORT/leak" -malloc_dump >leak.log 2>&1 || fail 'leak'
expect_match '^ *\[ ?0\] ?[0-9]+ bytes' leak.log

for n in 1 2; do
  clean dry$n $n -fluid none -dem_energy
  clean darcy$n $n -fluid darcy -pressure explicit
  clean ns$n $n -fluid ns -pressure implicit -ns_continuity averaged -coupling drag_and_pressure -sph_gradient corrected \
    -bc_tracking surface
  cp ns$n.h5 again$n.h5
  clean again$n $n -fluid ns -pressure implicit -ns_continuity averaged -coupling drag_and_pressure \
    -sph_gradient corrected -bc_tracking surface -restart ns$n.pgc.1
done
nothing_left 0 up 2 -case up_terzaghi -up_cells 2,10 -dt 0.5 -end_time 3 -checkpoint up.pgc
nothing_left 0 up 2 -case up_terzaghi -up_cells 2,10 -dt 0.5 -end_time 4 -output_every 0.5 -restart up.pgc
nothing_left 5 stopped 1 -case up_terzaghi -dt 1e-4 -end_time 1000 -checkpoint stopped.pgc -wall_time 1
nothing_left 0 liquid 2 -case wcsph_couette -wcsph_cells 10 -wcsph_columns 12 -end_time 0.1
nothing_left 0 elements 1 -case tak_two_elements -end_time 0.05
nothing_left 0 block 1 -case tak_block -end_time 0.05
"$POROGRAIN_STUDY" -study mms -study_mms_levels 2 -malloc_dump >mms.log 2>&1 || { cat mms.log >&2; fail 'study'; }
if grep -aE '^ *\[ ?[0-9]+\] ?[0-9]+ bytes' mms.log; then fail 'porograin-study leaves memory behind'; fi

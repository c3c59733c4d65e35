# processors: 2
# timeout: 180
# The continuum by the program: shipped files, the same results on 1, 2 and 4 ranks, results that ParaView opens, meshes
# of Gmsh; what is wrong with a mesh, a material or a boundary is said by name, and nothing is written.
. "$SOURCE_DIR/tests/support/regress.sh"
options="$SOURCE_DIR/options"

# last FILE COLUMN: the last value of a column
last() { csv_column "$1" "$2" | tail -n 1; }

# simulate NAME RANKS options...: NAME.h5 and NAME.out
simulate() {
  local name=$1 n=$2
  shift 2
  run "$n" "$POROGRAIN" "$@" -output "$name.h5" >"$name.out" 2>&1 || { cat "$name.out" >&2; fail "$name"; }
  expect_match "wrote $name.h5" "$name.out"
}

beside simulate terzaghi 1 -options_file "$options/up_terzaghi.opts" -end_time 18 # T = 0.2
beside simulate mandel 1 -options_file "$options/up_mandel.opts" -end_time 10
for name in footing footing_locking; do beside simulate $name 1 -options_file "$options/up_$name.opts"; done
for solver in up_direct up_minres; do
  beside simulate $solver 1 -options_file "$options/up_footing.opts" -options_file "$options/$solver.opts" -up_cells 24,24
done
for n in 1 2 4; do
  beside simulate ranks$n $n -options_file "$options/up_mandel.opts" -up_element q2q1 -up_cells 10,7 -end_time 2
done
for n in 1 4; do # ranks without a cell
  beside simulate few$n $n -case up_terzaghi -up_cells 1,2 -end_time 0.2
  beside simulate block$n $n -case tak_block -tak_block_cells 1,1 -dt 4e-3 -end_time 0.02
done
together
expect_close "$(last few4.csv displacement)" "$(last few1.csv displacement)" 1e-12 # of 1e-4 m, by a solver to 1e-10
expect_close "$(last block4.csv pressure_liquid)" "$(last block1.csv pressure_liquid)" 1e-9

# ---- shipped files ----
# ten seconds are no multiple of Mandel's step: the last one is cut
expect_close "$(last mandel.csv time)" 10 1e-9
# q H/M U(0.2), U from the series; 40 cells and steps of T = 0.002 are good for 1e-3
expect_close "$(last terzaghi.csv displacement)" "$(awk 'BEGIN { print 1e4 / 1.11111e7 * 0.504088 }')" 1e-6
# the pressure in the middle has risen above its first value
[ "$(csv_column mandel.csv pressure_probe | sort -g | tail -n 1 | cut -d. -f1)" -gt \
  "$(csv_column mandel.csv pressure_probe | sed -n 6p | cut -d. -f1)" ] || fail 'no effect of Mandel and Cryer'
# 16 x 16 cells that lock, against 64 x 64 that do not
expect_close "$(awk -v a="$(last footing_locking.csv displacement)" -v b="$(last footing.csv displacement)" 'BEGIN { print a/b }')" 0.32 0.01

[ "$(find "$options" -name 'up_*.opts' | wc -l)" -eq 6 ] || fail "not 6 files up_*.opts"

# ---- solvers ----
expect_match 'iterations 1$' up_direct.out
# MINRES stops on another norm
expect_close "$(last up_minres.csv displacement)" "$(last up_direct.csv displacement)" 1e-10

# ---- 1, 2 and 4 ranks: the same mesh in the file, and results within the tolerance of the solver, 1e-10 of some 1e4 Pa
# and 1e-3 m, times what is left of the condition ----
for n in 2 4; do
  h5diff ranks1.h5 ranks$n.h5 /mesh /mesh || fail "$n ranks: another mesh"
  for snapshot in 000001 000005 000010; do
    h5diff -d 1e-3 ranks1.h5 ranks$n.h5 /snapshots/$snapshot/pressure /snapshots/$snapshot/pressure || fail "$n ranks: pressure"
    h5diff -d 1e-10 ranks1.h5 ranks$n.h5 /snapshots/$snapshot/displacement /snapshots/$snapshot/displacement ||
      fail "$n ranks: displacement"
    h5diff -d 1e-2 ranks1.h5 ranks$n.h5 /snapshots/$snapshot/effective_stress /snapshots/$snapshot/effective_stress ||
      fail "$n ranks: stress"
  done
done
expect_match 'TopologyType="Quadrilateral" NumberOfElements="70"' ranks1.xmf
expect_match 'ranks1.h5:/snapshots/000010/pressure<' ranks1.xmf
expect_match 'Name="effective_stress" AttributeType="Matrix" Center="Cell"' ranks1.xmf

# ---- a mesh of Gmsh: three columns, the middle one slanted ----
mesh() { # NAME-OF-TOP CORNER-NODE: 3 x 2 cells on 1 m x 1 m
  cat <<MESH
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$PhysicalNames
5
1 1 "bottom"
1 2 "right"
1 3 "$1"
1 4 "left"
2 1 "ground"
\$EndPhysicalNames
\$Nodes
12
1 0 0 0
2 0.3 0 0
3 0.7 0 0
4 1 0 0
5 0 0.5 0
6 $2 0
7 0.6 0.45 0
8 1 0.5 0
9 0 1 0
10 0.3 1 0
11 0.7 1 0
12 1 1 0
\$EndNodes
\$Elements
16
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 1 1 3 4
4 1 2 2 2 4 8
5 1 2 2 2 8 12
6 1 2 3 3 9 10
7 1 2 3 3 10 11
8 1 2 3 3 11 12
9 1 2 4 4 1 5
10 1 2 4 4 5 9
11 3 2 1 1 1 2 6 5
12 3 2 1 1 2 3 7 6
13 3 2 1 1 3 4 8 7
14 3 2 1 1 5 6 10 9
15 3 2 1 1 6 7 11 10
16 3 2 1 1 7 8 12 11
\$EndElements
MESH
}
mesh top '0.35 0.55' >good.msh
beside simulate gmsh 2 -case up_terzaghi -up_mesh good.msh -up_permeability 0

# ---- what is wrong, by name ----
# refused STATUS RANKS PATTERN options...: in a folder of its own, with all meshes
refused() {
  local status=$1 n=$2 pattern=$3
  shift 3
  cp ../*.msh .
  expect_error "$status" "^porograin: error: .*$pattern" run "$n" "$POROGRAIN" "$@" -output bad.h5
  [ "$(grep -c 'porograin: error' expect_error.out)" -eq 1 ] || { cat expect_error.out >&2; fail "not one message: $*"; }
  if compgen -G 'bad.*' >/dev/null; then fail "written in spite of: $*"; fi
}
# bad PATTERN options...: $status and one message, on $ranks; nothing written
tried=0
bad() {
  local n
  tried=$((tried + 1))
  for n in $ranks; do beside within "bad$tried-$n" refused "$status" "$n" "$@"; done
}
ranks='1'
status=2
bad "Poisson's ratio is 0.5, it must be > -1 and < 0.5" -case up_footing -up_poisson 0.5
bad 'option -up_poisson: 0.6 is out of range' -case up_footing -up_poisson 0.6
bad 'option -up_permeability: -1e-12 m2 is out of range' -case up_footing -up_permeability -1e-12
bad "Biot's constant is 0.1, it must be between the porosity 0.3 and 1" -case up_footing -up_biot 0.1
bad 'porosity is 1, it must be' -case up_footing -up_porosity 1
bad 'option -up_theta: 0.4 is out of range' -case up_terzaghi -up_theta 0.4
bad 'option -up_damping needs -up_inertia' -case up_terzaghi -up_damping 1
bad 'option -up_cells: 2.5 is no number of cells' -case up_terzaghi -up_cells 2.5,3
bad 'unknown option -up_yung 1e7; did you mean -up_young' -case up_terzaghi -up_yung 1e7
bad 'option -up_mandel_force 1 is not read in this run, it needs -case up_mandel' -case up_terzaghi -up_mandel_force 1
bad 'option -guard_every 5 is of no use to this case' -case up_terzaghi -guard_every 5
bad "option -up_pc_type: 'fieldsplitt' is not one of" -case up_terzaghi -up_pc_type fieldsplitt
ranks='1 2'
status=4
bad "mesh file 'no.msh': No such file" -case up_terzaghi -up_mesh no.msh
status=2
bad 'options -up_mesh and -up_cells contradict' -case up_terzaghi -up_mesh good.msh -up_cells 2,3
echo 'x,y,r' >text.msh
bad "mesh file 'text.msh': it does not begin with .MeshFormat" -case up_terzaghi -up_mesh text.msh
mesh lid '0.35 0.55' >lid.msh
bad "mesh file 'lid.msh' has no boundary 'top'; its boundaries: bottom, right, lid, left" -case up_terzaghi -up_mesh lid.msh
# what else may be wrong with a mesh: tests/unit/fem_meshes.c
mesh top '0.95 0.95' >folded.msh
bad "mesh file 'folded.msh': element 1[0-9], the cell at .*, is not a convex quadrilateral" -case up_terzaghi -up_mesh folded.msh
# a strip that the ground does not have under it
ranks='2'
sed 's/^8 1 2 3 3 11 12$/8 1 2 2 2 8 12/' good.msh >short.msh
bad "strip of half width 1 m lies on x = 0, but boundary 'top' has 0 m of it to the left of x = 0 and 0.7 m to the right" \
  -case up_footing -up_mesh short.msh
together
expect_match '^up: 12 nodes, 6 elements Q1-Q1 of mesh file good.msh' gmsh.out

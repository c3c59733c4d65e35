# processors: 2
# timeout: 600
# Bad input of every kind, given to the programs: each is refused with its status and one message that names the file,
# the same on one rank and on two, in bounded time, and nothing is written. What was said must be what the table in
# docs/bad_inputs.md says; WRITE_TABLE=1 writes it anew. (Every twelfth on two ranks; bad_inputs_long.sh all of them.)
. "$SOURCE_DIR/tests/support/regress.sh"

every=${EVERY:-12}

count=0
table() { printf '\n## %s\n\n| input | status | message |\n| --- | --- | --- |\n' "$1" >"row-$(printf %03d $count)-z"; }

# one NUMBER STATUS NAME LABEL command...: runs it on one rank and perhaps on two; row-NUMBER is its line of the table
one() {
  local number=$1 status=$2 name=$3 label=$4 n got message ranks=1
  shift 4
  # porograin-plot runs on one
  if [ $((10#$number % every)) -eq 0 ] && [ "$1" != "$POROGRAIN_PLOT" ]; then ranks='1 2'; fi
  for n in $ranks; do
    got=0
    run "$n" timeout 60 "$@" >"out-$number.$n" 2>&1 </dev/null || got=$?
    {
      [ "$got" = "$status" ] || echo "exit status $got instead of $status"
      [ "$(grep -acE '^porograin(-study|-plot)?: error: ' "out-$number.$n")" = 1 ] || echo "not one message"
      grep -aE '^porograin(-study|-plot)?: error: ' "out-$number.$n" | grep -aqF -- "$name" || echo "the message does not name '$name'"
      ! grep -aE 'HDF5-DIAG|HDF5: infinite|PETSC ERROR|MPI_ABORT|Segmentation|signal' "out-$number.$n" || echo "more than a message"
      ! compgen -G "result-$number*" || echo "something was written"
    } >"wrong-$number.$n"
    if [ -s "wrong-$number.$n" ]; then
      { echo "-- $label, $n ranks" && sed 's/^/   /' "wrong-$number.$n" && head -n 8 "out-$number.$n"; } >>"failed-$number"
    fi
    grep -aE '^porograin(-study|-plot)?: error: ' "out-$number.$n" >"message-$number.$n"
  done
  [ "$ranks" = 1 ] || cmp -s "message-$number.1" "message-$number.2" || echo "-- $label: another message on two ranks" >>"failed-$number"
  # sizes and places inside of a file, in HDF5's words, change with its version
  message=$(sed -E 's/^porograin(-study|-plot)?: error: //; s/\|/\\|/g; s/((eof|base_addr|offset|size) = )[0-9]+/\1.../g' "message-$number.1" | head -n 1)
  printf '| %s | %s | %s |\n' "$label" "$status" "$message" >"row-$number-a"
}

# bad STATUS NAME LABEL command...: NAME must be in the message, NUMBER in the command becomes the row's
bad() {
  local number
  count=$((count + 1))
  number=$(printf %03d $count)
  beside one "$number" "${@//NUMBER/$number}"
}

# made NAME TEXT: a file of that text, with printf's escapes, which the table shows.
declare -A what
# shellcheck disable=SC2059
made() {
  printf "$2" >"$1.csv"
  what[$1.csv]="\`$2\`"
}

# packing STATUS FILE [OPTION...]: with NAME the message names that, and not the file
packing() {
  local status=$1 file=$2
  shift 2
  bad "$status" "${NAME:-$file}" "${what[$file]:-\`$file\`}${*:+ with \`$*\`}" "$POROGRAIN" -case packing -packing "$file" -dt 1e-7 -end_time 1e-6 \
    -output result-NUMBER.h5 -packing_export result-NUMBER-export.csv "$@"
}

# ---- packings, CSV ----
table 'Packings, CSV'
made empty ''
what[empty.csv]='an empty file'
packing 2 empty.csv
made comment '# nothing\n\n'
packing 2 comment.csv
made names 'x,y,r\n'
packing 2 names.csv
made cut '0,0,1\n2,0,1'
packing 2 cut.csv
made edited '#! discs 3\nx,y,r\n0,0,1\n2,0,1\n'
packing 2 edited.csv
made few '0,0,1\n2,0\n'
packing 2 few.csv
made many '0,0,1\n2,0,1,0\n'
packing 2 many.csv
made wide 'x,y,r,vx,vy,mass\n0,0,1,0,0,1\n'
packing 2 wide.csv
made semicolons '0;0;1\n'
packing 2 semicolons.csv
made unknown 'x,y,diameter\n0,0,1\n'
packing 2 unknown.csv
made missing_r 'x,y,vx,vy\n0,0,1,1\n'
packing 2 missing_r.csv
made twice 'x,y,r,y\n0,0,1,1\n'
packing 2 twice.csv
made unit 'x [cm],y,r\n0,0,1\n'
packing 2 unit.csv
made word '0,0,1\n2,two,1\n'
packing 2 word.csv
made hexadecimal '0,0,0x1p-4\n'
packing 2 hexadecimal.csv
made nothing '0,,1\n'
packing 2 nothing.csv
made nan '0,0,nan\n'
packing 2 nan.csv
made infinite 'inf,0,1\n'
packing 2 infinite.csv
made overflow '0,0,1\n1e400,0,1\n'
packing 2 overflow.csv
made zero '0,0,1\n2,0,0\n'
packing 2 zero.csv
made negative '0,0,-0.5\n'
packing 2 negative.csv
made tiny '0,0,1e-20\n'
packing 2 tiny.csv
made far '1e40,0,1\n'
packing 2 far.csv
made fast 'x,y,r,vx,vy\n0,0,1,0,1e12\n'
packing 2 fast.csv
made binary '0,0,1\n\000\001\002,3\n'
packing 2 binary.csv
made old_mac '0,0,1\r2,0,1\r'
packing 2 old_mac.csv
head -c 100000 /dev/zero | tr '\0' '7' >endless.csv
what[endless.csv]='100000 digits'
packing 2 endless.csv
made coincident '0,0,1\n2,0,1\n5,5,1\n2,0,1\n'
packing 2 coincident.csv
made overlapping '0,0,1\n3,0,1\n3.9,0,0.5\n'
packing 2 overlapping.csv
made ratio '0,0,1\n3,0,0.001\n'
packing 2 ratio.csv
made outside '0,0,1\n3,0,1\n'
packing 2 outside.csv -packing_box -1,2,-1,1
made period '#! periodic_x 1 1\n0,0,1\n3,0,1\n'
packing 2 period.csv
made narrow '0,0,1\n2,0,1\n'
NAME='period of 4 m' packing 2 narrow.csv -packing_periodic -packing_box -1,3,-1,1
what[absent.csv]='no file of this name'
packing 4 absent.csv
mkdir folder.csv
what[folder.csv]='a directory'
packing 4 folder.csv
packing 4 /dev/null


# ---- packings, HDF5 ----
table 'Packings, HDF5'
made good 'x,y,r\n0,0,1\n2.5,0,1\n'
"$POROGRAIN" -case packing -packing good.csv -dt 1e-7 -end_time 1e-6 -packing_export good.h5 >good.out
# spoilt NAME LABEL: name.h5 is a copy of the good one, which the next line may change
spoilt() {
  cp good.h5 "$1.h5"
  what[$1.h5]=$2
}
spoilt text 'a table with the name of an HDF5 file'
cp good.csv text.h5
packing 4 text.h5
size=$(stat -c %s good.h5)
spoilt cut 'the first half'
truncate -s $((size / 2)) cut.h5
packing 4 cut.h5
spoilt head 'the first 20 bytes'
truncate -s 20 head.h5
packing 4 head.h5
spoilt table 'a bit changed in the superblock'
printf '\377' | dd of=table.h5 bs=1 seek=36 conv=notrunc status=none
packing 4 table.h5
offset=$(LC_ALL=C grep -obUaP '\x00\x00\x00\x00\x00\x00\x04\x40' good.h5 | head -n 1 | cut -d: -f1)
spoilt value 'a bit changed in a coordinate'
printf '\001' | dd of=value.h5 bs=1 seek="$offset" conv=notrunc status=none
packing 4 value.h5
spoilt no_radius 'no dataset `radius`'
"$SUPPORT/damage" no_radius.h5 remove /radius
packing 2 no_radius.h5
spoilt short_radius '`radius` has one row'
"$SUPPORT/damage" short_radius.h5 rows /radius 1
packing 2 short_radius.h5
spoilt huge '`position` with 2^40 rows'
"$SUPPORT/damage" huge.h5 rows /position 1099511627776
packing 2 huge.h5
spoilt none '`position` with no row'
"$SUPPORT/damage" none.h5 rows /position 0
packing 2 none.h5
spoilt flat '`position` in one dimension'
"$SUPPORT/damage" flat.h5 flat /position
packing 2 flat.h5
spoilt letters '`radius` holds text'
"$SUPPORT/damage" letters.h5 type /radius text
packing 2 letters.h5
spoilt nan '`position` with nan'
"$SUPPORT/damage" nan.h5 value /position 3 nan
packing 2 nan.h5
spoilt negative '`radius` with -1'
"$SUPPORT/damage" negative.h5 value /radius 1 -1
packing 2 negative.h5
spoilt group '`position` is a group'
"$SUPPORT/damage" group.h5 group /position
packing 4 group.h5
packing 2 good.h5 -packing_group snapshots
packing 2 good.csv -packing_group /

# ---- checkpoints ----
table 'Checkpoints'
panel="-case panel -panel_columns 4 -dt 2e-6 -end_time 2e-5"
# shellcheck disable=SC2086
"$POROGRAIN" $panel -checkpoint good.pgc >good.out
# checkpoint FILE LABEL [OPTION...]
checkpoint() {
  local file=$1 label=$2
  shift 2
  # shellcheck disable=SC2086
  bad "${STATUS:-4}" "$file" "$label${*:+ with \`$*\`}" "$POROGRAIN" $panel -end_time 4e-5 -output result-NUMBER.h5 -restart "$file" "$@"
}
# sealed NAME LABEL ACT...: a good checkpoint in which one thing was changed, with a good seal
sealed() {
  local name=$1 label=$2
  shift 2
  head -c -32 good.pgc >"$name.pgc"
  "$SUPPORT/damage" "$name.pgc" "$@"
  "$SUPPORT/damage" "$name.pgc" seal
  checkpoint "$name.pgc" "$label"
}
size=$(stat -c %s good.pgc)
checkpoint absent.pgc 'no file of this name'
: >empty.pgc
checkpoint empty.pgc 'an empty file'
checkpoint good.csv 'a table'
head -c $((size / 2)) good.pgc >half.pgc
checkpoint half.pgc 'the first half'
head -c -1 good.pgc >last.pgc
checkpoint last.pgc 'the last byte is missing'
{ cat good.pgc && printf 'x'; } >more.pgc
checkpoint more.pgc 'a byte more'
bits=0
for at in 40 $((size / 2)) $((size - 40)) $((size - 4)); do
  cp good.pgc "bit.pgc"
  byte=$(od -An -tu1 -j "$at" -N 1 bit.pgc)
  # shellcheck disable=SC2059
  printf "\\$(printf %o $((byte ^ 4)))" | dd of=bit.pgc bs=1 seek="$at" conv=notrunc status=none
  mv bit.pgc "bit$((++bits)).pgc"
done
checkpoint bit1.pgc 'a bit changed in the superblock'
checkpoint bit2.pgc 'a bit changed in the middle'
checkpoint bit3.pgc 'a bit changed at the end'
checkpoint bit4.pgc 'a bit changed in the seal'
mkdir nothing
cp good.csv nothing
checkpoint nothing 'a directory without a checkpoint'
checkpoint 'none*.pgc' 'a pattern that fits no file'
sealed missing '`velocity` is missing' remove /fields/velocity
sealed state '`simulation_step` is missing' remove /state/simulation_step
sealed rows '`velocity` has 3 rows' rows /fields/velocity 3
sealed huge '`velocity` has 2^40 rows' rows /fields/velocity 1099511627776
sealed flat '`velocity` in one dimension' flat /fields/velocity
sealed integers '`velocity` holds integers' type /fields/velocity int
sealed singles '`velocity` in single precision' type /fields/velocity float
sealed text '`velocity` holds text' type /fields/velocity text
sealed nan '`position` with nan' value /fields/position 5 nan
sealed infinite '`velocity` with -inf' value /fields/velocity 8 -inf
sealed time '`simulation_time` is nan' value /state/simulation_time 0 nan
STATUS=2 sealed other_time '`simulation_time` is 1 s' value /state/simulation_time 0 1
sealed other_dt '`simulation_dt` is 1e-6 s' value /state/simulation_dt 0 1e-6
sealed radius '`radius` of disc 2 is -1 m' value /fields/radius 2 -1
sealed count 'disc 4 has -1 contacts' value /ragged/contact_history/count 4 -1
sealed counts 'disc 4 has 2^31 - 1 contacts' value /ragged/contact_history/count 4 2147483647
sealed contact 'disc 4 has one contact more' value /ragged/contact_history/count 4 7
sealed group '`velocity` is a group' group /fields/velocity
sealed discs 'says that it has 1000 discs' attribute discs 1000
sealed version 'of a later layout' attribute format_version 99
checkpoint good.pgc 'a good one' -dt 1e-6
checkpoint good.pgc 'a good one' -panel_columns 5
checkpoint good.pgc 'a good one' -fluid darcy

# ---- pressure systems ----
table 'Systems of -pressure_dump'
"$POROGRAIN" -case panel -panel_columns 3 -fluid darcy -pressure implicit -end_time 1e-6 -pressure_dump good.petsc >good.out
echo 'cg-jacobi -ksp_type cg -pc_type jacobi' >solvers.txt
# dump FILE LABEL
dump() {
  bad 4 "$1" "$2" "$POROGRAIN_STUDY" -study_load "$1" -study_solvers solvers.txt -study_output result-NUMBER
}
# number NAME LABEL OFFSET BYTES: a good one with these bytes (printf's escapes) at the offset
number() {
  cp good.petsc "$1.petsc"
  # shellcheck disable=SC2059
  printf "$4" | dd of="$1.petsc" bs=1 seek="$3" conv=notrunc status=none
  dump "$1.petsc" "$2"
}
size=$(stat -c %s good.petsc)
rows=$(od -An -td4 --endian=big -j 4 -N 4 good.petsc | tr -d ' ')
nonzeros=$(od -An -td4 --endian=big -j 12 -N 4 good.petsc | tr -d ' ')
columns=$((16 + 4 * rows))
values=$((columns + 4 * nonzeros))
vector=$((values + 8 * nonzeros))
dump absent.petsc 'no file of this name'
: >empty.petsc
dump empty.petsc 'an empty file'
dump good.csv 'a table'
head -c $((size / 2)) good.petsc >half.petsc
dump half.petsc 'the first half'
{ cat good.petsc && printf 'x'; } >more.petsc
dump more.petsc 'a byte more'
number oblong 'one column more than rows' 8 '\000\000\000\377'
number rows '2^31 - 1 rows' 4 '\177\377\377\377\177\377\377\377'
number negative 'a negative number of nonzeros' 12 '\377\377\377\377'
number row 'a row with a negative number of nonzeros' 16 '\377\377\377\377'
number long 'a row that is too long' 16 '\177\377\377\377'
number column 'a column that is not there' "$columns" '\000\001\000\000'
number twice 'a column twice' "$((columns + 4))" '\000\000\000\000'
number nan 'nan in the matrix' "$values" '\177\370\000\000\000\000\000\000'
number head 'no vector after the matrix' "$vector" '\000\000\000\000'
number length 'a vector of another length' "$((vector + 4))" '\000\000\000\001'
number infinite 'inf in the right-hand side' "$((vector + 8))" '\177\360\000\000\000\000\000\000'

# ---- the continuum ----
table 'Continuum'
# 2 x 1 cells on 2 m x 1 m, as Gmsh writes them
cat >good.msh <<'MESH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "bottom"
1 2 "right"
1 3 "top"
1 4 "left"
2 1 "ground"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
8
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 2 2 3 6
4 1 2 3 3 6 5
5 1 2 3 3 5 4
6 1 2 4 4 4 1
7 3 2 1 1 1 2 5 4
8 3 2 1 1 2 3 6 5
$EndElements
MESH
up='-case up_terzaghi -dt 1 -end_time 4'
# shellcheck disable=SC2086
{
  "$POROGRAIN" $up -up_mesh good.msh >good.out
  "$POROGRAIN" $up -up_cells 1,4 -checkpoint up.pgc >good.out
}
# continuum STATUS NAME LABEL OPTION...
continuum() {
  local status=$1 name=$2 label=$3
  shift 3
  # shellcheck disable=SC2086
  bad "$status" "$name" "$label" "$POROGRAIN" $up -output result-NUMBER.h5 "$@"
}
# mesh NAME LABEL SED: good.msh, edited
mesh() {
  sed "$3" good.msh >"$1.msh"
  ! cmp -s good.msh "$1.msh" || fail "mesh $1 is the good one"
  continuum 2 "$1.msh" "$2" -up_mesh "$1.msh"
}
continuum 4 absent.msh 'no mesh of this name' -up_mesh absent.msh
# nobody writes into it: who opens it waits for ever
mkfifo pipe.msh pipe.h5
continuum 4 pipe.msh 'a named pipe as a mesh' -up_mesh pipe.msh
continuum 2 empty.csv 'an empty file as a mesh' -up_mesh empty.csv
continuum 2 good.csv 'a table as a mesh' -up_mesh good.csv
mesh old_format 'a mesh of MSH version 1' 's/^2.2 0 8/1.0 0 8/'
mesh half_mesh 'a mesh that ends after its nodes' '/EndNodes/q'
mesh many_nodes 'a mesh that says it has 10^8 nodes' 's/^6$/99999999/'
mesh nan_node 'a mesh with a node at nan' 's/^5 1 1 0/5 nan 1 0/'
mesh same_node 'a mesh with node 4 twice' 's/^5 1 1 0/4 1 1 0/'
mesh no_node 'a mesh whose cell has node 9' 's/^8 3 2 1 1 2 3 6 5/8 3 2 1 1 2 3 6 9/'
mesh triangle 'a mesh with triangles' 's/^8$/9/; s/^8 3 2 1 1 2 3 6 5/8 2 2 1 1 2 3 6\n9 2 2 1 1 2 6 5/'
mesh folded 'a mesh with a cell that is folded' 's/^5 1 1 0/5 -1 0.5 0/'
mesh no_top 'a mesh without the boundary `top`' 's/"top"/"lid"/'
continuum 2 Poisson '`-up_poisson 0.5`' -up_poisson 0.5
continuum 2 'porosity' '`-up_porosity 1`' -up_porosity 1
continuum 2 'Biot' '`-up_biot 0.1`' -up_biot 0.1
continuum 2 -up_theta '`-up_theta 0.4`' -up_theta 0.4
continuum 2 -up_cells '`-up_cells 2.5,3`' -up_cells 2.5,3
continuum 2 -up_permeability '`-up_permeability nan`' -up_permeability nan
head -c 3000 up.pgc >half_up.pgc
continuum 4 half_up.pgc 'a checkpoint, the first 3000 bytes' -up_cells 1,4 -restart half_up.pgc
head -c -32 up.pgc >nan_up.pgc
"$SUPPORT/damage" nan_up.pgc value /state/up_nodes 9 nan
"$SUPPORT/damage" nan_up.pgc seal
continuum 4 nan_up.pgc 'a checkpoint with nan in `up_nodes`' -up_cells 1,4 -restart nan_up.pgc
continuum 4 up.pgc 'a checkpoint of a mesh of another size' -up_cells 1,5 -restart up.pgc
continuum 4 good.pgc 'a checkpoint of discs' -up_cells 1,4 -restart good.pgc

# ---- results ----
table 'Results'
"$POROGRAIN" -panel_columns 4 -end_time 1e-5 -output good_run.h5 >good.out
head -c 3000 good_run.h5 >half_run.h5
# result STATUS NAME LABEL: to be recovered, and to be drawn
result() {
  bad "$1" "$2" "$3, \`-recover\`" "$POROGRAIN" -recover "$2"
  bad "${4:-$1}" "$2" "$3, in porograin-plot" "$POROGRAIN_PLOT" "$2" -figures result-NUMBER -plot_gnuplot none
}
result 4 absent.h5 'no file of this name'
result 4 pipe.h5 'a named pipe'
result 4 empty.csv 'an empty file'
result 4 good.csv 'a table'
result 4 half_run.h5 'the first 3000 bytes'
result 4 good.pgc 'a checkpoint' 2

# ---- options files ----
table 'Options files'
# options STATUS NAME LABEL TEXT: a file of that name and text (printf's escapes)
options() {
  # shellcheck disable=SC2059
  [ $# -lt 4 ] || printf -- "$4" >"$2"
  bad "$1" "${NAME:-$2}" "$3" "$POROGRAIN" -panel_columns 4 -end_time 1e-5 -output result-NUMBER.h5 -options_file "$2"
}
# lines STATUS NAME TEXT: the text is shown
lines() { options "$1" "$2" "\`$3\`" "$3"; }
options 4 absent.opts 'no file of this name'
mkdir folder.opts
options 4 folder.opts 'a directory'
options 4 /dev/zero '`/dev/zero`'
head -c 2000000 /dev/zero | tr '\0' '#' >large.opts
options 4 large.opts 'two megabytes'
lines 2 zero.opts '-fluid none\000\n-dt 1e-6\n'
lines 2 binary.opts '\001\002\003\n'
lines 2 no_option.opts 'fluid none\n'
lines 2 words.opts '-dt 1e-6 2e-6\n'
lines 2 together.opts '-fluid none -dt 1e-6\n'
lines 2 quotes.opts '-output "result.h5\n'
lines 2 alias.opts 'alias -thickness\n'
lines 2 pop.opts '-prefix_pop\n'
lines 2 push.opts '-prefix_push\n'
lines 2 itself.opts '-options_file itself.opts\n'
lines 2 nameless.opts '-options_file\n'
NAME=nowhere.opts lines 4 further.opts '-options_file nowhere.opts\n'
lines 2 malformed.yaml 'fluid: [none\n'
lines 2 zero.yaml 'fluid: none\000\n'

# ---- options ----
table 'Options'
# option NAME WORDS...: refused with status 2
option() {
  local name=$1
  shift
  bad 2 "$name" "\`$*\`" "$POROGRAIN" -panel_columns 4 -end_time 1e-5 -output result-NUMBER.h5 "$@"
}
option -dt -dt nan
option -dt -dt -1e-6
option -dt -dt 1e-6s
option -dt -dt 1e400
option -dt -dt 1e-3
option -panel_radius -panel_radius 0
option -panel_rows -panel_rows 2.5
option -panel_rows -panel_rows 99999999999
option -gravity -gravity 0
option -fluid -fluid water
option -dem_mu_s -dem_mu_s
option -permeabilty -fluid darcy -permeabilty 1e-6
option -dem_energy -dem_energy maybe
option clash.csv -output clash.h5 -checkpoint ./clash.csv
option clash.h5 -output ./clash.h5 -checkpoint clash.h5

together
if compgen -G 'failed-*' >/dev/null; then
  cat failed-* >&2
  fail "$(find . -maxdepth 1 -name 'failed-*' | wc -l) of $count inputs"
fi
[ "$count" -ge 150 ] || fail "only $count bad inputs"
[ "$(find . -maxdepth 1 -name 'row-*-a' -size +0 | wc -l)" = "$count" ] || fail 'not one line for each input'
{
  printf '# Bad input, and what is said about it\n\n'
  printf 'Written by `WRITE_TABLE=1 ctest --test-dir build -R bad_inputs` and compared with what is said by the same test\n'
  printf '(tests/regress/bad_inputs.sh): %s inputs, each on one rank and, with -DPOROGRAIN_LONG_TESTS=ON, each but those of porograin-plot on two, with\n' "$count"
  printf 'the same message and exit status. In text `\\n` is the end of a line. Sizes inside of HDF5 files, in words of HDF5, are left out (...).\n'
  cat row-*
} >table.md
if [ "${WRITE_TABLE:-}" = 1 ]; then cp table.md "$SOURCE_DIR/docs/bad_inputs.md"; fi
diff "$SOURCE_DIR/docs/bad_inputs.md" table.md || fail 'docs/bad_inputs.md says something else: WRITE_TABLE=1 writes it anew'
echo "$count bad inputs refused"

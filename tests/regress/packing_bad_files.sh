# timeout: 300
# preset: long
# processors: 2
# Packing files that are no packings, given to the program: each is refused with its status and one message, on one
# rank and on two, and nothing is written. bad_files.md in the working folder lists what was said.
. "$SOURCE_DIR/tests/support/regress.sh"

count=0
printf '| file | status | message |\n| --- | --- | --- |\n' >bad_files.md

# refused FILE STATUS PATTERN [OPTION...]
refused() {
  local file=$1 status=$2 pattern=$3 n
  shift 3
  for n in 1 2; do
    expect_error "$status" "^porograin: error: .*$pattern" run "$n" "$POROGRAIN" -case packing -packing "$file" \
      -dt 1e-7 -end_time 1e-6 -output result.h5 -packing_export export.csv "$@"
    [ "$(grep -c 'porograin: error: ' expect_error.out)" -eq 1 ] || fail "not one message on $n ranks: $file"
    if grep -Eq 'HDF5-DIAG|HDF5: infinite|PETSC ERROR|MPI_ABORT|Segmentation' expect_error.out; then
      cat expect_error.out >&2
      fail "more than a message on $n ranks: $file"
    fi
    if [ -e result.h5 ] || [ -e export.csv ] || [ -e result.csv ]; then fail "something was written: $file"; fi
  done
  awk -v file="$file" -v status="$status" 'sub(/^porograin: error: /, "") { print "| `" file "` | " status " | " $0 " |" }' \
    expect_error.out >>bad_files.md
  count=$((count + 1))
}
# made NAME TEXT: a file of that text, with printf's escapes.
# shellcheck disable=SC2059
made() { printf "$2" >"$1.csv"; }

made empty ''
refused empty.csv 2 'it is empty'
made comment '# nothing\n\n'
refused comment.csv 2 'it holds no disc'
made names 'x,y,r\n'
refused names.csv 2 'it holds no disc'
made cut '0,0,1\n2,0,1'
refused cut.csv 2 'line 2: the last line has no end'
made edited '#! discs 3\nx,y,r\n0,0,1\n2,0,1\n'
refused edited.csv 2 "2 discs, but the note '#! discs 3'"
made few '0,0,1\n2,0\n'
refused few.csv 2 'line 2: 2 values separated by commas, the table has 3 columns'
made many '0,0,1\n2,0,1,0\n'
refused many.csv 2 'line 2: 4 values separated by commas, the table has 3 columns'
made wide 'x,y,r,vx,vy,mass\n0,0,1,0,0,1\n'
refused wide.csv 2 'line 1: 6 columns'
made semicolons '0;0;1\n'
refused semicolons.csv 2 'line 1: 1 values separated by commas'
made unknown 'x,y,diameter\n0,0,1\n'
refused unknown.csv 2 "line 1: unknown column 'diameter'"
made missing_r 'x,y,vx,vy\n0,0,1,1\n'
refused missing_r.csv 2 'line 1: there is no column r'
made twice 'x,y,r,y\n0,0,1,1\n'
refused twice.csv 2 'columns 2 and 4 have the same name y'
made unit 'x [cm],y,r\n0,0,1\n'
refused unit.csv 2 "column x is in 'cm'"
made word '0,0,1\n2,two,1\n'
refused word.csv 2 "line 2: y = 'two' is not a number"
made hexadecimal '0,0,0x1p-4\n'
refused hexadecimal.csv 2 "r = '0x1p-4' is not a number"
made nothing '0,,1\n'
refused nothing.csv 2 "y = '' is empty"
made nan '0,0,nan\n'
refused nan.csv 2 "r = 'nan' is not a finite number"
made infinite 'inf,0,1\n'
refused infinite.csv 2 "x = 'inf' is not a finite number"
made overflow '0,0,1\n1e400,0,1\n'
refused overflow.csv 2 "line 2: x = '1e400' is not a finite number"
made zero '0,0,1\n2,0,0\n'
refused zero.csv 2 'line 2: r = 0 m is not positive'
made negative '0,0,-0.5\n'
refused negative.csv 2 'r = -0.5 m is not positive'
made tiny '0,0,1e-20\n'
refused tiny.csv 2 'r = 1e-20 m is not between'
made far '1e40,0,1\n'
refused far.csv 2 'x = 1e\+40 m is more than 1e\+09 radii from the origin'
made fast 'x,y,r,vx,vy\n0,0,1,0,1e12\n'
refused fast.csv 2 'vy = 1e\+12 m/s is faster'
made binary '0,0,1\n\000\001\002,3\n'
refused binary.csv 2 'line 2: a zero byte'
made old_mac '0,0,1\r2,0,1\r'
refused old_mac.csv 2 'line 1: the last line has no end'
head -c 100000 /dev/zero | tr '\0' '7' >endless.csv
refused endless.csv 2 'line 1: longer than 4096 bytes'
made coincident '0,0,1\n2,0,1\n5,5,1\n2,0,1\n'
refused coincident.csv 2 'discs 1 and 3 .* have the same centre'
made overlapping '0,0,1\n3,0,1\n3.9,0,0.5\n'
refused overlapping.csv 2 'discs 1 and 2 .* overlap by 1.2 of the smaller radius'
made ratio '0,0,1\n3,0,0.001\n'
refused ratio.csv 2 "packing 'ratio.csv': the largest radius, 1. m, is more than 100 times the smallest"
made outside '0,0,1\n3,0,1\n'
refused outside.csv 2 'disc 1 .* reaches out of the box' -packing_box -1,2,-1,1
made period '#! periodic_x 1 1\n0,0,1\n3,0,1\n'
refused period.csv 2 'line 1: the upper end of the period'
made narrow '0,0,1\n2,0,1\n'
refused narrow.csv 2 'must hold at least three cells' -packing_periodic -packing_box -1,3,-1,1
refused absent.csv 4 'cannot be opened: No such file or directory'
mkdir folder.csv
refused folder.csv 4 'cannot be opened: Is a directory'
refused /dev/null 4 'cannot be opened: it is not a regular file'

# HDF5: a good file, and what can be done to it
made good 'x,y,r\n0,0,1\n2.5,0,1\n'
"$POROGRAIN" -case packing -packing good.csv -dt 1e-7 -end_time 1e-6 -packing_export good.h5 >good.out
printf 'x,y,r\n0,0,1\n' >text.h5
refused text.h5 4 'it does not begin like an HDF5 file'
size=$(stat -c %s good.h5)
head -c $((size / 2)) good.h5 >cut.h5
refused cut.h5 4 'cannot open the file: .*truncated'
head -c 20 good.h5 >head.h5
refused head.h5 4 'cannot open the file'
# a byte in the superblock, and the first byte of the values 2.5
cp good.h5 table.h5
printf '\377' | dd of=table.h5 bs=1 seek=36 conv=notrunc status=none
refused table.h5 4 'cannot open the file: .*checksum'
offset=$(LC_ALL=C grep -obUaP '\x00\x00\x00\x00\x00\x00\x04\x40' good.h5 | head -n 1 | cut -d: -f1)
cp good.h5 value.h5
printf '\001' | dd of=value.h5 bs=1 seek="$offset" conv=notrunc status=none
refused value.h5 4 "cannot read dataset '/position': .*(checksum|filter)"
refused good.h5 2 "there is no group '/snapshots'" -packing_group snapshots
refused good.csv 2 "option -packing_group '/' belongs to HDF5 files" -packing_group /

[ "$count" -ge 40 ] || fail "only $count bad files"
[ "$(wc -l <bad_files.md)" -eq $((count + 2)) ] || fail 'bad_files.md has not one line for each file'
echo "$count bad files refused"

#!/usr/bin/env bash
# timeout: 300
# What cmake --install lays out works from any folder and without the source: programs, option files, manual pages, and
# the library through pkg-config; and so does the Debian package that cpack makes. The commands are those of
# docs/install.md, as they stand.
. "$SOURCE_DIR/tests/support/regress.sh"
. "$SOURCE_DIR/tests/support/page_blocks.sh"

build=$(dirname -- "$POROGRAIN")
cached() { sed -n "s/^$1:[^=]*=//p" "$build/CMakeCache.txt"; }
cmake=$(cached CMAKE_COMMAND)
version=$(sed -n 's/^#define PG_VERSION "\(.*\)"/\1/p' "$SOURCE_DIR/include/porograin/base.h")
[ -n "$version" ] || fail 'no version in base.h'

# works FOLDER PREFIX: what lies below FOLDER is complete and runs; it was installed for PREFIX.
works() {
  local root=$1 file
  for file in bin/porograin bin/porograin-study bin/porograin-plot share/porograin/options/panel_case1_ns.opts \
    share/porograin/options/solvers/all.txt include/porograin/simulation.h share/doc/porograin/README.md \
    share/doc/porograin/LICENSE share/doc/porograin/CITATION.cff share/doc/porograin/docs/theory.md; do
    [ -s "$root/$file" ] || fail "$root has no $file"
  done
  for file in porograin porograin-study porograin-plot; do
    gzip -dc "$root/share/man/man1/$file.1.gz" | grep -q "\"porograin $version\"" || fail "manual page of $file"
  done
  gzip -dc "$root/share/man/man1/porograin.1.gz" | grep -Fq "options_file $2/share/porograin/options/panel_case1_ns.opts" ||
    fail "the manual page does not name $2/share/porograin/options"
  ! find "$root" -name '*.in' -o -name '*~' | grep . || fail 'rubbish is installed'
  # Links of the documentation lead to files that are there, too.
  grep -o ']([^)#]*' "$root/share/doc/porograin/README.md" | sed 's/^](//' | grep -v '^http\|^\.ci/' | while read -r file; do
    [ -e "$root/share/doc/porograin/$file" ] || fail "the installed README.md links to $file"
  done
  mkdir elsewhere
  (
    cd elsewhere
    "$root/bin/porograin" -options_file "$root/share/porograin/options/panel_case1_ns.opts" -panel_displacement 2e-5 \
      -output panel.h5 >panel.log
    "$root/bin/porograin-plot" panel.h5 -plot_gnuplot none >plot.log
    [ -s figures/panel-pressure.gp ] || fail 'porograin-plot of the installed program'
    # a shipped file that is named as in the source or without its folder
    for file in options/panel_case1_ns.opts panel_case1_ns.opts; do
      expect_error 4 "file '$file': No such file or directory; did you mean '$root/share/porograin/options/panel_case1_ns.opts'" \
        "$root/bin/porograin" -options_file "$file"
    done
    # the list of solvers is found although there is no folder options here
    "$root/bin/porograin-study" -study_sizes 199 -study_only cg-jacobi -study_repeats 1 >study.log
    grep -q '^ *199 .*cg-jacobi' study.log || fail 'porograin-study of the installed program'
  )
  rm -r elsewhere
}

take_blocks docs/install.md
export HOME=$WORK_DIR
# The programs of this build, and a folder build that cpack may write to.
mkdir programs build
sanitize=$(cached POROGRAIN_SANITIZE)
ln -s "$cmake" programs/cmake
printf '#!/usr/bin/env bash\nexec %q -Wall -Werror %s "$@"\n' "$(cached MPI_C_COMPILER)" "${sanitize:+-fsanitize=$sanitize}" >programs/mpicc
printf '#!/usr/bin/env bash\nexec %q "$@"\n' "$(dirname -- "$cmake")/cpack" >programs/cpack
chmod +x programs/mpicc programs/cpack
PATH=$WORK_DIR/programs:$PATH
cp "$build"/{cmake_install.cmake,CPackConfig.cmake} build/

run_block 1 >install.log
mv porograin 'moved here'
works "$WORK_DIR/moved here" "$WORK_DIR/porograin"
mv 'moved here' porograin

# The ten lines of docs/install.md, compiled as it says.
awk '/^```c$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$SOURCE_DIR/docs/install.md" >onestep.c
[ -s onestep.c ] || fail 'docs/install.md has no program in C'
export PKG_CONFIG_PATH=${PKG_CONFIG_PATH:-}
[ -z "${PETSC_DIR:-}" ] || PKG_CONFIG_PATH=$PKG_CONFIG_PATH:$PETSC_DIR/${PETSC_ARCH:-}/lib/pkgconfig
(
  PKG_CONFIG_PATH=$(dirname "$(find "$WORK_DIR/porograin" -name porograin.pc)"):$PKG_CONFIG_PATH
  [ "$(pkg-config --modversion porograin)" = "$version" ] || fail 'version of porograin.pc'
  [ -s "$(pkg-config --variable=options porograin)/panel_case1_ns.opts" ] || fail 'options of porograin.pc'
)
run_block 3 >onestep.log
expect_match '^porograin .*: case panel, 49 discs' onestep.log

# The package.
command -v dpkg-shlibdeps >/dev/null && command -v dpkg-deb >/dev/null || skip 'no dpkg-shlibdeps (Debian: dpkg-dev): the package is not tested'
run_block 2 >cpack.log 2>&1 || { tail -n 20 cpack.log >&2; fail 'cpack'; }
no_block_left
deb=$(echo build/porograin_"$version"_*.deb)
[ -s "$deb" ] || fail "no package: $(ls build)"
depends=$(dpkg-deb -f "$deb" Depends)
for library in libc6 libpetsc libhdf5 libopenmpi; do
  # an own PETSc comes with its own libraries
  [ -n "${PETSC_DIR:-}" ] || [[ $depends == *$library* ]] || fail "the package does not depend on $library: $depends"
done
! [[ $depends == *-dev* ]] || fail "to run, nothing is needed to compile: $depends"
dpkg-deb -c "$deb" | awk '{ print $6 }' >contents
! grep -v '^\./\(usr\(/.*\)\?\)\?$' contents || fail 'files outside of /usr'
! dpkg-deb -c "$deb" | awk '$2 != "root/root"' | grep . || fail 'files that do not belong to root'
dpkg-deb -x "$deb" unpacked
works "$WORK_DIR/unpacked/usr" /usr
ls "unpacked/usr/$(cached CMAKE_INSTALL_LIBDIR)" | grep -q '^libporograin[.]' || fail 'the library is not in its folder'

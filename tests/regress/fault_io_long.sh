# processors: 2
# timeout: 3000
# preset: long
# All calls, with five errors.
EVERY=1
. "$SOURCE_DIR/tests/regress/fault_io.sh"

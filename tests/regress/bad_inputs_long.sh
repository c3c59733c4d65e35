# processors: 2
# timeout: 1800
# preset: long
# All bad inputs on two ranks, too.
EVERY=1
. "$SOURCE_DIR/tests/regress/bad_inputs.sh"

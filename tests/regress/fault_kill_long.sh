# processors: 2
# timeout: 3000
# preset: long
# Fifty kills instead of five.
KILLS=50
. "$SOURCE_DIR/tests/regress/fault_kill.sh"

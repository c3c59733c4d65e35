#!/usr/bin/env bash
# processors: 2
# preset: long
# timeout: 21600
# The commands of the documentation as they stand, none shortened, and those of the README in a new clone.
export DOCS_LONG=yes
exec bash "$SOURCE_DIR/tests/regress/docs_commands.sh"

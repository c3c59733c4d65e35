#!/usr/bin/env bash
# Runs a test script in its own empty folder, $WORK_DIR.
set -euo pipefail
rm -rf -- "$WORK_DIR"
mkdir -p -- "$WORK_DIR"
cd -- "$WORK_DIR"
exec bash "$1"

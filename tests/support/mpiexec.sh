#!/usr/bin/env bash
# mpiexec, which needs the daemon and the folders that a program on its own does without (tests/CMakeLists.txt).
unset OMPI_MCA_ess_singleton_isolated OMPI_MCA_orte_create_session_dirs
exec "$MPIEXEC_ITSELF" "$@"

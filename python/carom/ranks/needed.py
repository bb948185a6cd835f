"""The packages that bring MPI and PETSc, which carom does without until they are asked for."""

from __future__ import annotations

from typing import Any

from carom.system.extras import needed

MPI: Any = needed("mpi4py.MPI", of="--engine petsc", extra="mpi")
needed("petsc4py", of="--engine petsc", extra="mpi").init([])
PETSc: Any = needed("petsc4py.PETSc", of="--engine petsc", extra="mpi")

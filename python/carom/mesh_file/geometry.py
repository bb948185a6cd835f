"""Gmsh's geometry scripts, meshed by Gmsh if it is installed."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from carom.mesh_file.arrays import Refused

GEOMETRY = (".geo", ".step", ".stp", ".brep")
"""Endings of the files that Gmsh meshes."""


@contextmanager
def meshed(path: Path, space: int) -> Iterator[Path]:
    """Mesh a geometry with Gmsh and give the file of the mesh.

    Cells are quadratic unless the script says otherwise, since linear tetrahedra lock.

    Raises
    ------
    Refused
        Gmsh is not installed, or cannot mesh this.
    """
    try:
        import gmsh  # noqa: PLC0415 (an extra, and slow to load)
    except (ImportError, OSError) as error:  # its library may lack one of the system
        raise Refused(
            f'is a geometry, which needs Gmsh ({error}): pip install "carom[gmsh]"'
        ) from None
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory) / "mesh.msh"
        gmsh.initialize(readConfigFiles=False, interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("Mesh.ElementOrder", 2)
            gmsh.option.setNumber("Mesh.HighOrderOptimize", 1)
            gmsh.logger.start()
            gmsh.open(str(path))
            gmsh.model.mesh.generate(space)
            gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
            gmsh.write(str(file))
        except Exception as error:  # Gmsh raises nothing else
            said = [line for line in gmsh.logger.get() if line.startswith(("Error", "Warning"))]
            reason = said[-1] if said else str(error)
            raise Refused(f"Gmsh cannot mesh it: {' '.join(reason.split())}") from None
        finally:
            gmsh.finalize()
        yield file

"""Meshes and triangulated surfaces from files, as the arrays that the native core reads."""

from carom.mesh_file.arrays import MeshArrays, Note
from carom.mesh_file.body import body_dimension, read_body_mesh
from carom.mesh_file.surface import SurfaceArrays, read_surface

__all__ = [
    "MeshArrays",
    "Note",
    "SurfaceArrays",
    "body_dimension",
    "read_body_mesh",
    "read_surface",
]

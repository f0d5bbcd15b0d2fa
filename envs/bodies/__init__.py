"""What a gripper may grasp: shapes, meshes, materials, parts and contents."""

from .assembly import Assembly
from .library import ObjectPreset, library_object, load_objects, objects
from .mesh_files import read_surface
from .meshes import MeshShape, load_mesh
from .object_solids import object_solid
from .object_spec import DEFAULT_FRICTION, DEFAULT_MASS, ObjectSpec, placeless, scaled
from .parts import Part, checked_size

__all__ = [
    "DEFAULT_FRICTION",
    "DEFAULT_MASS",
    "Assembly",
    "MeshShape",
    "ObjectPreset",
    "ObjectSpec",
    "Part",
    "checked_size",
    "library_object",
    "load_mesh",
    "load_objects",
    "object_solid",
    "objects",
    "placeless",
    "read_surface",
    "scaled",
]

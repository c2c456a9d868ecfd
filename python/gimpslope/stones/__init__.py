"""Stones: as data, drawn at random, from an image or from a mesh."""

from .collection import Stones
from .draw import ellipses, polygons, rounds
from .ellipse import Ellipse
from .image import from_image
from .mesh import from_mesh
from .placing import StonesDoNotFit
from .section import Section
from .sizes import Law, LogNormal, PowerLaw, Uniform
from .stone import Shape, Stone

__all__ = [
    "Ellipse",
    "Law",
    "LogNormal",
    "PowerLaw",
    "Section",
    "Shape",
    "Stone",
    "Stones",
    "StonesDoNotFit",
    "Uniform",
    "ellipses",
    "from_image",
    "from_mesh",
    "polygons",
    "rounds",
]

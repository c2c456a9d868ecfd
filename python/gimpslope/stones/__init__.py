"""Stones: as data, drawn at random, from an image or from a mesh."""

from .collection import Stones
from .drawing.draw import ellipses, polygons, rounds
from .drawing.placing import StonesDoNotFit
from .drawing.sizes import Law, LogNormal, PowerLaw, Uniform
from .ellipse import Ellipse
from .sources.image import from_image
from .sources.mesh import from_mesh
from .sources.section import Section
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

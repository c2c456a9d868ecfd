"""Stones: as data, drawn at random, from an image or from a mesh."""

from .collection import Stones
from .ellipse import Ellipse
from .stone import Stone

__all__ = ["Ellipse", "Stone", "Stones"]

"""A plain NumPy GIMP in two dimensions, plane strain: slow, short and obviously right.

It shares no code with the compiled kernel, so that agreement of the two means something.
SI units, angles in degrees, tension positive.
"""

from .drucker_prager import Material
from .gimp import Reference

__all__ = ["Material", "Reference"]

"""Results of a run: functions of its states and energies. `Run` has a method for each."""

from .bands import LEAST_BAND, Bands, plastic_bands
from .displacement import max_displacement
from .fastest import FastestPoint, fastest_of, fastest_point
from .peak import SmoothPeak, smooth_peak
from .percentile import mass_percentile
from .phases import REST_SHARE, Phases, phases_of
from .plastic import PLASTIC_THRESHOLD, PlasticShare, plastic_share, plastic_zone
from .rigid import RigidMotion, rigid_motion
from .run_out import run_out
from .stones import StoneMotion, first_outlines, stone_motion, stone_outlines
from .surface import ROUGHNESS_LENGTH, Surface, surface_of

__all__ = [
    "LEAST_BAND",
    "PLASTIC_THRESHOLD",
    "REST_SHARE",
    "ROUGHNESS_LENGTH",
    "Bands",
    "FastestPoint",
    "Phases",
    "PlasticShare",
    "RigidMotion",
    "SmoothPeak",
    "StoneMotion",
    "Surface",
    "fastest_of",
    "fastest_point",
    "first_outlines",
    "mass_percentile",
    "max_displacement",
    "phases_of",
    "plastic_bands",
    "plastic_share",
    "plastic_zone",
    "rigid_motion",
    "run_out",
    "smooth_peak",
    "stone_motion",
    "stone_outlines",
    "surface_of",
]

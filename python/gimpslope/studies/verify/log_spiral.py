"""The log-spiral bound of limit analysis: a rigid body of soil turns on a logarithmic spiral.

Chen 1975, Limit analysis and soil plasticity, chapter 9, for a slip through the toe.
"""

from __future__ import annotations

import numpy as np


def stability_number(friction: float, angle: float) -> tuple[float, float, float]:
    """Least gamma H / c at which a slope falls, and the angles of the radii to crest and toe.

    The body turns on r = r0 exp((theta - theta0) tan(phi)), theta from the horizontal downwards.

    `friction` and `angle` of the face in radians, both > 0.
    """
    first, last = np.meshgrid(*np.radians([np.linspace(1, 89, 177), np.linspace(61, 149, 177)]))
    tan, grown = np.tan(friction), np.exp((last - first) * np.tan(friction))
    height = grown * np.sin(last) - np.sin(first)  # in r0, as all lengths here
    crest = np.sin(last - first) - height * np.sin(last + angle) / np.sin(angle)
    crest /= np.sin(last)
    whole = (3 * tan * np.cos(last) + np.sin(last)) * grown**3
    whole -= 3 * tan * np.cos(first) + np.sin(first)
    above = crest * (2 * np.cos(first) - crest) * np.sin(first)
    before = grown * (np.sin(last - first) - crest * np.sin(last))
    before *= np.cos(first) - crest + np.cos(last) * grown
    moment = whole / (3 * (1 + 9 * tan**2)) - (above + before) / 6
    real = (height > 0) & (crest > 0) & (moment > 0)
    moment[~real] = 1.0
    number = np.where(real, (grown**2 - 1) / (2 * tan) * height / moment, np.inf)
    least = number.argmin()
    return float(number.flat[least]), float(first.flat[least]), float(last.flat[least])

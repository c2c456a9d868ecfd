"""Laws of random sizes, sampled by inversion: a share in [0, 1] of the stones is smaller."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
import numpy.typing as npt

from ... import _check
from ..._check import FloatArray
from ..._record import Record


@dataclass(frozen=True)
class Law(Record, ABC):
    """A law of random numbers between two limits; not made by itself, see `Uniform`, `LogNormal`
    and `PowerLaw`."""

    @abstractmethod
    def quantile(self, share: npt.ArrayLike) -> FloatArray:
        """The values that the shares, shape (n,) in [0, 1], of all values do not exceed, (n,)."""

    def _check_limits(self, low: float, high: float) -> None:
        low, high = _check.positive("low", low), _check.positive("high", high)
        if low >= high:
            raise ValueError(f"high must be a finite number > low, got {high} with low {low}")
        self._store(low=low, high=high)


@dataclass(frozen=True)
class Uniform(Law):
    """All values between `low` > 0 and `high` > low alike."""

    low: float
    high: float

    def __post_init__(self) -> None:
        self._check_limits(self.low, self.high)

    def quantile(self, share: npt.ArrayLike) -> FloatArray:
        """low + share (high - low)."""
        return self.low + _shares(share) * (self.high - self.low)


@dataclass(frozen=True)
class LogNormal(Law):
    """A log-normal law cut off at both ends.

    Parameters
    ----------
    median : of the law before it is cut off, > 0
    sigma : standard deviation of the natural logarithm before it is cut off, > 0
    low, high : least and largest value, 0 < low < high

    Raises
    ------
    TypeError, ValueError
        If a parameter is no such number, or the limits hold less than 1e-6 of the law.
    """

    median: float
    sigma: float
    low: float
    high: float

    def __post_init__(self) -> None:
        self._store(
            median=_check.positive("median", self.median),
            sigma=_check.positive("sigma", self.sigma),
        )
        self._check_limits(self.low, self.high)
        below, above = self._tails
        if above - below < _LEAST_SHARE:
            raise ValueError(
                f"median must be near the limits {self.low} and {self.high}, got {self.median} "
                f"with sigma {self.sigma}, which puts {above - below:.3g} of the law between them"
            )

    def quantile(self, share: npt.ArrayLike) -> FloatArray:
        """exp(ln median + sigma z), with z where the standard normal law reaches the share of what
        it has between the limits."""
        below, above = self._tails
        normal = NormalDist(math.log(self.median), self.sigma)
        inner = below + _shares(share) * (above - below)
        values = [math.exp(normal.inv_cdf(p)) if 0 < p < 1 else math.inf * (p - 0.5) for p in inner]
        return np.clip(values, self.low, self.high)

    @property
    def _tails(self) -> tuple[float, float]:
        """Shares of the law below the lower and below the upper limit."""
        normal = NormalDist(math.log(self.median), self.sigma)
        return normal.cdf(math.log(self.low)), normal.cdf(math.log(self.high))


@dataclass(frozen=True)
class PowerLaw(Law):
    """A power law N(> d) ~ d^-D between limits, as in studies of block sizes.

    Parameters
    ----------
    dimension : the fractal dimension D, > 0
    low, high : least and largest value, 0 < low < high
    """

    dimension: float
    low: float
    high: float

    def __post_init__(self) -> None:
        self._store(dimension=_check.positive("dimension", self.dimension))
        self._check_limits(self.low, self.high)

    def quantile(self, share: npt.ArrayLike) -> FloatArray:
        """low (1 - share (1 - (low / high)^D))^(-1/D), the inverse of the share of smaller values
        (low^-D - d^-D) / (low^-D - high^-D)."""
        most = 1 - (self.low / self.high) ** self.dimension
        values: FloatArray = self.low * (1 - _shares(share) * most) ** (-1 / self.dimension)
        return np.clip(values, self.low, self.high)


_LEAST_SHARE = 1e-6


def _shares(share: npt.ArrayLike) -> FloatArray:
    shares = _check.array("share", share, ("n",))
    if len(shares) and not 0 <= shares.min() <= shares.max() <= 1:
        raise ValueError(f"share must be in [0, 1], got {shares.min()} to {shares.max()}")
    return shares

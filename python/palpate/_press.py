# SPDX-License-Identifier: Apache-2.0
"""A force-deflection curve of a vertex."""
import math
from typing import NamedTuple

import numpy as np

from ._errors import ArgumentError
from ._status import Status

_HOLE = 2
_TOUCH = 1e-12  # m: the force is that of the depth below the tip of the first step inside the body


class PressCurve(NamedTuple):
    """A press along the inward normal n of a vertex, one row a depth."""

    depth: np.ndarray
    """(N,) m, of the tip below the vertex, along n."""
    force: np.ndarray
    """(N,) N, of the tool on the body along n; not negative."""
    vector: np.ndarray
    """(N, 3) N, of the body on the tool."""
    energy: np.ndarray
    """(N,) J, stored in the body."""
    status: np.ndarray
    """(N,) uint32, bits of Status; BEYOND_DEPTH where the force is a guess."""


def _depths_of(depths):
    depths = np.asarray(depths)
    if depths.dtype.kind not in "fiu":
        raise TypeError(f"press: depths: has dtype {depths.dtype}; give real numbers, in m")
    depths = depths.astype(np.float64)
    if depths.ndim != 1 or depths.size == 0:
        raise ArgumentError(f"press: depths: has shape {depths.shape}; give an array of shape (N,)")
    if not np.all(np.isfinite(depths)) or depths[0] < 0 or np.any(np.diff(depths) < 0):
        raise ArgumentError("press: depths: must be finite, from 0 on and not decreasing; give them in m")
    return depths


def _positive(value, name, unit):
    if not (value > 0 and math.isfinite(value)):
        raise ArgumentError(f"press: {name} is {value}; give a number above 0, in {unit}")
    return float(value)


def press(library, vertex, depths, *, friction=None, speed=0.01, rate=1000.0):
    """press(library, vertex, depths, *, friction=None, speed=0.01, rate=1000.0) -> PressCurve

    The force at depths (m, not decreasing) below a vertex, along its inward normal.

    The tip comes from outside at `speed` (m/s) in steps of at most 1/`rate` (s): where the library relaxes, the
    force depends on the speed; elsewhere it does not. friction: as in Library.state. A tool with friction shears the
    skin where the response leans; with 0 the force is the normal response alone.

    Raises ArgumentError where the vertex has no response or no triangle that can be touched.
    """
    response = library.response(vertex)
    if response.status == _HOLE:
        raise ArgumentError(f"press: vertex {vertex} has no response; choose one whose vertex_status is not {_HOLE}")
    depths = _depths_of(depths)
    longest = _positive(speed, "speed", "m/s") / _positive(rate, "rate", "Hz")
    # From a step above the skin to the touch and on to each depth, in equal steps.
    ends = np.concatenate([[-longest, _TOUCH], np.maximum(depths, _TOUCH)])
    counts = np.maximum(1, np.ceil(np.diff(ends) / longest - 1e-6)).astype(int)
    z = np.concatenate([[-longest]] + [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(ends, ends[1:], counts)])
    dt = np.maximum(np.diff(z, prepend=-2 * longest), _TOUCH) / speed
    center, normal = library.vertices[vertex], library.normals[vertex]
    run = library.state(friction=friction).run(center + z[:, None] * normal, dt=dt)
    rows = np.cumsum(counts)[1:]
    status = run.status[rows]
    if np.any(status & Status.CONTACT == 0):
        raise ArgumentError(f"press: vertex {vertex} cannot be touched; choose one with triangles whose vertices all "
                            "have a response")
    vector = run.force[rows].copy()
    return PressCurve(depths, -vector @ normal, vector, run.energy[rows].copy(), status.copy())

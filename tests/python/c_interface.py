# SPDX-License-Identifier: AGPL-3.0-or-later
"""The C interface by ctypes, as a second way to the same forces."""
import ctypes

import numpy as np

Vector = ctypes.c_double * 3


class Settings(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("friction", ctypes.c_double), ("tank_cap", ctypes.c_double),
                ("lipschitz_bound", ctypes.c_double), ("search_rate", ctypes.c_double)]


class Seen(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("status", ctypes.c_uint32), ("element", ctypes.c_int32),
                ("contact_point", Vector), ("natural", Vector), ("normal", Vector), ("depth", ctypes.c_double),
                ("lateral", ctypes.c_double), ("offset", ctypes.c_double), ("energy", ctypes.c_double),
                ("tank", ctypes.c_double), ("absorbed", ctypes.c_double), ("force_on_body", Vector),
                ("lateral_offset", Vector), ("dissipated", ctypes.c_double), ("relaxed_fraction", ctypes.c_double),
                ("relaxed_lateral_force", Vector)]


SCALARS = ("depth", "lateral", "offset", "energy", "tank", "absorbed", "dissipated", "relaxed_fraction")
VECTORS = ("contact_point", "normal")


def trajectory(libpalpate, file, positions, velocities, times, friction=-1.0):
    """Columns of the steps: force, status, element, and the names above."""
    c = ctypes.CDLL(libpalpate)
    library, state = ctypes.c_void_p(), ctypes.c_void_p()
    settings = Settings()
    assert c.palpate_library_load(str(file).encode(), ctypes.byref(library)) == 0
    c.palpate_settings_default(ctypes.byref(settings))
    settings.friction = friction
    assert c.palpate_state_create(library, ctypes.byref(settings), ctypes.byref(state)) == 0
    count = len(positions)
    made = {name: np.empty(count) for name in SCALARS}
    made.update({name: np.empty((count, 3)) for name in VECTORS + ("force",)})
    made.update(status=np.empty(count, np.uint32), element=np.empty(count, np.int32))
    seen, force = Seen(ctypes.sizeof(Seen)), Vector()
    c.palpate_step.restype = ctypes.c_uint32
    for i, (x, v, dt) in enumerate(zip(positions, velocities, times)):
        made["status"][i] = c.palpate_step(state, Vector(*x), Vector(*v), ctypes.c_double(dt), force)
        c.palpate_observe(state, ctypes.byref(seen))
        made["force"][i], made["element"][i] = force[:], seen.element
        for name in SCALARS:
            made[name][i] = getattr(seen, name)
        for name in VECTORS:
            made[name][i] = getattr(seen, name)[:]
    c.palpate_state_destroy(state)
    c.palpate_library_destroy(library)
    return made

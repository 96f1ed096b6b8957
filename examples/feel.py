# SPDX-License-Identifier: Apache-2.0
"""Feel a library from Python, with nothing but ctypes: feel.py LIBPALPATE LIBRARY"""
import ctypes
import sys

Vector = ctypes.c_double * 3


class Settings(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("friction", ctypes.c_double), ("tank_cap", ctypes.c_double),
                ("steepness", ctypes.c_double), ("search_rate", ctypes.c_double)]


def main(path, library_file):
    palpate = ctypes.CDLL(path)
    palpate.palpate_last_error.restype = ctypes.c_char_p
    library, state, settings = ctypes.c_void_p(), ctypes.c_void_p(), Settings()
    palpate.palpate_settings_default(ctypes.byref(settings))
    settings.friction = 0.3
    if palpate.palpate_library_load(library_file.encode(), ctypes.byref(library)) or \
            palpate.palpate_state_create(library, ctypes.byref(settings), ctypes.byref(state)):
        sys.exit(palpate.palpate_last_error().decode())
    force = Vector()
    for i in range(40):
        position = Vector(0.031, 0.042, 0.0005 - 1e-4 * i)
        palpate.palpate_step(state, position, Vector(0, 0, -0.1), ctypes.c_double(1e-3), force)
    print(f"{force[2]:.4f} N at {3.4} mm")
    palpate.palpate_state_destroy(state)
    palpate.palpate_library_destroy(library)


if __name__ == "__main__":
    main(*sys.argv[1:])

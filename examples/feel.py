# SPDX-License-Identifier: Apache-2.0
"""Feel a library from Python, with nothing but ctypes: feel.py LIBPALPATE LIBRARY X Y Z

A tip goes to the middle of the body from the side that is given, at 0.1 m/s, until it is 3 mm deep.
"""
import ctypes
import sys

Vector = ctypes.c_double * 3


class Info(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("vertices", ctypes.c_int32), ("triangles", ctypes.c_int32),
                ("stick", ctypes.c_double), ("slip", ctypes.c_double), ("friction", ctypes.c_double),
                ("depth", ctypes.c_double), ("low", Vector), ("high", Vector)]


class Observation(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("status", ctypes.c_uint32), ("element", ctypes.c_int32),
                ("contact_point", Vector), ("natural", Vector), ("normal", Vector), ("depth", ctypes.c_double),
                ("lateral", ctypes.c_double), ("offset", ctypes.c_double), ("energy", ctypes.c_double),
                ("tank", ctypes.c_double), ("absorbed", ctypes.c_double), ("force_on_body", Vector)]


def main(path, library_file, *side):
    palpate = ctypes.CDLL(path)
    palpate.palpate_last_error.restype = ctypes.c_char_p
    library, state = ctypes.c_void_p(), ctypes.c_void_p()
    if palpate.palpate_library_load(library_file.encode(), ctypes.byref(library)) or \
            palpate.palpate_state_create(library, None, ctypes.byref(state)):
        sys.exit(palpate.palpate_last_error().decode())
    info, seen, force = Info(ctypes.sizeof(Info)), Observation(ctypes.sizeof(Observation)), Vector()
    palpate.palpate_library_describe(library, ctypes.byref(info))
    velocity = Vector(*(-0.1 * float(s) for s in side))
    for i in range(-2000, 2000):  # your force loop, 1 kHz
        position = Vector(*((low + high) / 2 + 1e-3 * i * v
                            for low, high, v in zip(info.low, info.high, velocity)))
        palpate.palpate_step(state, position, velocity, ctypes.c_double(1e-3), force)
        palpate.palpate_observe(state, ctypes.byref(seen))
        if seen.depth >= 0.003:
            break
    print("({:.4f}, {:.4f}, {:.4f}) N, {:.3f} mm deep".format(*force, 1e3 * seen.depth))
    palpate.palpate_state_destroy(state)
    palpate.palpate_library_destroy(library)


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit("feel.py: give LIBPALPATE LIBRARY X Y Z")
    main(*sys.argv[1:])

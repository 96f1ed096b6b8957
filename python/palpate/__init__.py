# SPDX-License-Identifier: Apache-2.0
"""palpate: forces of a soft body under a tool, from a response library, at haptic rates.

    import palpate

    library = palpate.Library("library.h5")
    library.vertices, library.triangles, library.certificate.guarantee

Units are SI: m, m/s, s, N, N/m, J, Hz. Vectors have three components in the frame of the world.
Failures are exceptions derived from palpate.Error, whose text says where, what is wrong and what to do about it.
"""
from ._errors import ArgumentError, BusyError, CommandError, Error, FileError, FormatError, MismatchError
from ._palpate import Certificate, DeviceCertificate, Library, Response, ResponseCurve, __version__

__all__ = [
    "ArgumentError",
    "BusyError",
    "Certificate",
    "CommandError",
    "DeviceCertificate",
    "Error",
    "FileError",
    "FormatError",
    "Library",
    "MismatchError",
    "Response",
    "ResponseCurve",
    "__version__",
]

# SPDX-License-Identifier: Apache-2.0
"""palpate: forces of a soft body under a tool, from a response library, at haptic rates.

    import palpate

    palpate.build("liver.toml", "out/liver")               # from a case to library.h5
    library = palpate.Library("out/liver/library.h5")
    state = library.state()
    force, status = state.step(position, velocity, dt)     # one step of a force loop
    run = state.run(positions, dt=1e-3)                    # a whole trajectory
    curve = palpate.press(library, 17, [0.001, 0.002])     # a force-deflection curve

Units are SI: m, m/s, s, N, N/m, J, Hz. Vectors have three components in the frame of the world.
Failures are exceptions derived from palpate.Error, whose text says where, what is wrong and what to do about it.
"""
from ._command import Build, build, run_command
from ._errors import ArgumentError, BusyError, CommandError, Error, FileError, FormatError, MismatchError
from ._palpate import (Body, Certificate, CurvePath, Curves, Deformation, DeviceCertificate, Library, Observation,
                       ProvenanceStep, Recording, Response, ResponseCurve, Run, SiteCurves, State, Tool, __version__,
                       read_body, read_curves, read_recording, read_session)
from ._press import PressCurve, press
from ._status import Status

__all__ = [
    "ArgumentError",
    "Body",
    "Build",
    "BusyError",
    "Certificate",
    "CommandError",
    "CurvePath",
    "Curves",
    "Deformation",
    "DeviceCertificate",
    "Error",
    "FileError",
    "FormatError",
    "Library",
    "MismatchError",
    "Observation",
    "PressCurve",
    "ProvenanceStep",
    "Recording",
    "Response",
    "ResponseCurve",
    "Run",
    "SiteCurves",
    "State",
    "Status",
    "Tool",
    "__version__",
    "build",
    "press",
    "read_body",
    "read_curves",
    "read_recording",
    "read_session",
    "run_command",
]

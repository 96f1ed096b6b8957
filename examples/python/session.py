# SPDX-License-Identifier: Apache-2.0
"""Look at a recorded session: what was felt, and, with its library, whether the same forces come again.

    python3 session.py out/liver/recording.h5 [--library out/liver/library.h5] [--plot session.png]
"""
import argparse

import numpy as np

import palpate


def repeated(session, library):
    """The force of the recorded motion in a state with the recorded settings, (N, 3) N."""
    state = library.state(friction=session.friction, tank_cap=session.tank_cap, lipschitz_bound=session.lipschitz_bound)
    state.set_pose(session.body_position)
    return state.run(session.position, session.velocity, 1 / session.rate, strict=False).force


def plot(session, file):
    import matplotlib
    matplotlib.use("Agg")  # no window
    from matplotlib import pyplot
    figure, (above, below) = pyplot.subplots(2, sharex=True)
    above.plot(session.time, session.force, label=["x", "y", "z"])
    above.set(ylabel="force (N)")
    above.legend()
    below.plot(session.time, 1e3 * session.depth)
    below.set(xlabel="time (s)", ylabel="depth (mm)")
    figure.savefig(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", help="recording.h5, or the journal of a session")
    parser.add_argument("--library")
    parser.add_argument("--plot", metavar="FILE", help="needs matplotlib")
    options = parser.parse_args()

    session = palpate.read_session(options.recording)
    status = palpate.Status
    print(f"{len(session)} steps on {session.device} in {session.time[-1]:.2f} s, at mu = {session.friction:g}")
    for bit in (status.CONTACT, status.SLIDING, status.BEYOND_DEPTH, status.BAD_INPUT):
        print(f"  {bit.name}: {np.count_nonzero(session.status & bit)} steps")
    print(f"largest force {np.linalg.norm(session.force, axis=1).max():.4f} N, deepest {1e3 * session.depth.max():.2f} mm, "
          f"absorbed {1e3 * session.absorbed[-1]:.4f} mJ")
    for gap in session.gaps:
        print("lost:", gap)
    if options.library and session.guarded:
        print("a force loop acted on the forces: `palpate replay` repeats it")
    elif options.library:
        same = np.array_equal(repeated(session, palpate.Library(options.library)), session.force)
        print("the same forces come again, to the bit" if same else "other forces come: is it the library of the session?")
    if options.plot:
        plot(session, options.plot)


if __name__ == "__main__":
    main()

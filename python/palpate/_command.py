# SPDX-License-Identifier: Apache-2.0
"""The palpate command, which makes bodies, curves and libraries from a case."""
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple, Optional

from ._errors import ArgumentError, CommandError, FileError, MismatchError
from ._palpate import __version__

_STAGES = ("mesh", "precompute", "fit", "certify")
_INCOMPLETE = 4
_checked = set()  # (path, time of change) of executables of this version


class Build(NamedTuple):
    """What `palpate.build` made. A path is None where there is no such file."""

    folder: Path
    """The folder of the artifacts."""
    body: Optional[Path]
    """body.h5, for read_body."""
    curves: Optional[Path]
    """curves.h5, for read_curves."""
    library: Optional[Path]
    """library.h5, for Library."""
    deformation: Optional[Path]
    """deformation.pdef, for Library.deformation, where the case asks for it."""
    warnings: tuple
    """One line each, with the remedy."""


def _executable():
    """The command of the prefix that the package is installed in, else the first of PATH."""
    beside = Path(__file__).resolve().parents[4] / "bin" / "palpate"
    found = str(beside) if os.access(beside, os.X_OK) else shutil.which("palpate")
    if found is None:
        raise FileError(f"palpate: the command is neither {beside} nor in PATH; install it, or add its folder to PATH")
    here = found, os.stat(found).st_mtime_ns
    if here not in _checked:
        said = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout
        version = re.search(r"palpate (\d+\.\d+\.\d+)", said)
        if version is None or version.group(1) != __version__:
            raise MismatchError(f"{found}: is not of version {__version__}, as this package is; install both from one build")
        _checked.add(here)
    return found


def _text(value):
    """An argument of the command: a path, a text or a number."""
    return str(value) if isinstance(value, (int, float)) else os.fspath(value)


def _failure(code, text):
    """The exception for what the command said as it failed."""
    lines = [line for line in text.splitlines() if line.strip()]
    errors = [line[len("error: "):] for line in lines if line.startswith("error: ")]
    if errors:
        message = errors[-1]
    elif code == _INCOMPLETE:
        message = "the command finished, but is incomplete: " + (lines[-1] if lines else "run it in a terminal")
    else:
        message = "palpate: ended with code " + str(code) + (": " + lines[-1] if lines else "; run it in a terminal")
    return CommandError(message, code)


def run_command(*arguments):
    """run_command(*arguments) -> str

    Runs the palpate command, e.g. run_command("simulate", case, "--out", folder), and returns what it prints. Raises
    CommandError with its message where it fails, FileError where it is not installed, and MismatchError where it is of
    another version.
    """
    done = subprocess.run([_executable(), *map(_text, arguments)], stdin=subprocess.DEVNULL, capture_output=True,
                          encoding="utf-8", errors="replace", check=False)
    if done.returncode != 0:
        raise _failure(done.returncode, done.stderr)
    return done.stdout


def _follow(process, see):
    """Gives each event of the command to `see`; ends the command where that raises, or Ctrl-C does.

    Returns its exit code, and the last line that was no event: a command that dies leaves one.
    """
    broken = None
    try:
        for line in process.stdout:
            try:
                event = json.loads(line)
            except ValueError:
                broken = line
                continue
            see(event)
        return process.wait(), broken
    except BaseException:
        process.terminate()
        process.wait()
        raise
    finally:
        process.stdout.close()


def _artifacts(folder, warnings):
    def made(name):
        return folder / name if (folder / name).is_file() else None

    return Build(folder, made("body.h5"), made("curves.h5"), made("library.h5"), made("deformation.pdef"),
                 tuple(warnings))


def build(case, out=None, *, until="certify", threads=None, memory=None, strict=False, progress=None):
    """build(case, out=None, *, until="certify", threads=None, memory=None, strict=False, progress=None) -> Build

    Runs `palpate build` on a case file: the stages "mesh", "precompute", "fit" and "certify" that are not up to date,
    the last of which is `until`. out: folder of the artifacts, None: as the case says; threads: a number, None: one for
    each processor; memory: e.g. "8GB"; strict: any site that ended early makes the campaign incomplete.

    progress: called with each event, a dict with the key "event" (docs/campaigns.md lists them), in the calling thread;
    {"event": "progress", "done": 3, "total": 16, ...} counts sites. An exception in it, and Ctrl-C, end the command;
    finished sites are kept and not repeated.

    Raises CommandError with the message of the command; `exit_code` 4: the campaign is incomplete, and what it made is
    the attribute `build`.
    """
    if until not in _STAGES:
        raise ArgumentError(f"build: until is {until!r}; give one of {', '.join(_STAGES)}")
    command = [_executable(), "build", os.fspath(case), "--json", "--until", until]
    for option, value in (("--out", out), ("--threads", threads), ("--memory", memory)):
        if value is not None:
            command += [option, _text(value)]
    command += ["--strict"] if strict else []
    folder, warnings = [], []

    def see(event):
        if event.get("file"):
            folder.append(Path(event["file"]).parent)
        if event["event"] == "warning":
            warnings.append(event["text"])
        if progress is not None:
            progress(event)

    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as said:
        with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said, encoding="utf-8",
                              errors="replace") as process:
            code, broken = _follow(process, see)
        said.seek(0)
        text = said.read()
    made = _artifacts(folder[0], warnings) if folder else None
    if code != 0 or broken:
        failure = _failure(code, text) if code != 0 else CommandError(f"palpate: printed what is no event: {broken!r}")
        failure.build = made
        raise failure
    return made

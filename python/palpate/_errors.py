# SPDX-License-Identifier: Apache-2.0
"""The exceptions of palpate. The extension raises them by name."""


class Error(Exception):
    """A failure of palpate. Its text is one line: where, what is wrong, and what to do about it.

    `where`, `problem` and `remedy` are the parts of the text; where it has none, `problem` is all of it.
    """

    def __init__(self, message=""):
        super().__init__(message)
        self.where = ""
        self.problem = message
        self.remedy = ""


class ArgumentError(Error, ValueError):
    """A value out of range, not finite, or an array of the wrong shape."""


class FileError(Error, OSError):
    """A file that cannot be opened, or is no regular file."""


class FormatError(Error, ValueError):
    """A file that is not what it should be."""


class MismatchError(Error, ValueError):
    """Files that do not belong together."""


class BusyError(Error, RuntimeError):
    """A state that another thread uses."""


class CommandError(Error, RuntimeError):
    """The palpate command failed, with this message.

    `exit_code`: 1 internal, 2 usage or configuration, 3 geometry, 4 incomplete. `build`: what `palpate.build` made all
    the same, or None.
    """

    def __init__(self, message="", exit_code=1):
        super().__init__(message)
        self.exit_code = exit_code
        self.build = None


for _kind in (Error, ArgumentError, FileError, FormatError, MismatchError, BusyError, CommandError):
    _kind.__module__ = "palpate"  # as a traceback names it

# SPDX-License-Identifier: Apache-2.0
"""Status bits of a step."""
import enum
import operator

from ._palpate import _status_bits


class _Flag(enum.IntFlag):
    @classmethod
    def _missing_(cls, value):
        return super()._missing_(operator.index(value))  # also integers of numpy


Status = _Flag("Status", _status_bits, module="palpate")
Status.__doc__ = """Status bits of a step; palpate.h says what each means, and its remedy.

The force of a step with BAD_INPUT is zero; beyond the deepest sample (BEYOND_DEPTH) it is a guess. The LOOP_ bits are
set by force loops, in recordings. Of an array: `run.status & Status.SLIDING != 0`, `Status(run.status[i])`.
"""

#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""No C++ function is longer than 60 lines, and no doc comment opens with "Of".

Usage: check_style.py [ROOT] | --self-test
"""
import re
import sys

from source_check import main

ROOMS = ("format", "mesher", "fem", "fitting", "runtime", "app", "python", "tests", "bench", "examples")
SOURCES = (".hpp", ".h", ".cpp", ".c")
MAX_LINES = 60  # from the line of the opening brace to that of the closing one

# Comments, raw strings, strings, characters and preprocessor lines: braces in them mean nothing. A digit
# before a quote is a digit separator (1'000).
OPAQUE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
SCOPE = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b[^()]*$")
OF = re.compile(r"^\s*///\s+Of\b")


def blanked(text):
    """The text with everything opaque replaced by blanks, line by line."""
    return OPAQUE.sub(lambda match: re.sub(r"[^\n]", " ", match.group(0)), text)


def long_functions(text):
    """(line, length) of each function body that is too long."""
    line, head, open_braces = 1, "", []  # of each open brace: its line, or None where it opens no function
    for character in blanked(text):
        if character == "\n":
            line += 1
        if character == "{":
            inside = any(start is not None for start, _ in open_braces)
            is_function = not inside and ")" in head and not SCOPE.search(head)
            open_braces.append((line if is_function else None, head))
            head = ""
        elif character == "}" and open_braces:
            start, before = open_braces.pop()
            if start is not None and line - start + 1 > MAX_LINES:
                yield start, line - start + 1
            # A brace in a list of member initialisers closes no statement.
            head = before + "{}" if start is None and ")" in before and not SCOPE.search(before) else ""
        elif character == ";":
            head = ""
        else:
            head += character


def faults(root):
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in SOURCES or not path.is_file() or "vendor" in path.parts:
                continue
            text = path.read_text(encoding="utf-8")
            place = path.relative_to(root)
            for line, length in long_functions(text):
                yield f"{place}:{line}: a function of {length} lines; divide it into functions of one idea"
            for line, words in enumerate(text.splitlines(), 1):
                if OF.match(words):
                    yield f"{place}:{line}: a doc comment opens with \"Of\"; begin with its subject"


# The check must see each kind of fault, and nothing in sound files.
_LINES = "  call();\n"
SAMPLES = {
    "fem/good.cpp": "namespace a {\nclass B {\n  int f() const {\n" + _LINES * 58 + "  }\n};\n" + _LINES * 90 + "}\n",
    "fem/good.hpp": "/// The face of a body. Of the three, one.\nconst char* kText = R\"({{{)\"; // {\n"
                    "int k = 1'000;\nstruct S {\n" + "  int x = 0;\n" * 80 + "};\n",
    "fem/long.cpp": "namespace {\n\nint f(int a)\n    noexcept {\n" + _LINES * 59 + "}\n}\n",
    "fem/method.hpp": "struct S {\n  S() : a{1}, b(2) {\n" + _LINES * 59 + "  }\n};\n",
    "tests/long.cpp": "TEST(A, B) {\n  for (;;) {\n" + _LINES * 58 + "  }\n}\n",
    "app/of.hpp": "int a;\n  /// Of the face: its area.\n",
}
FAULTY = ["app/of.hpp:2", "fem/long.cpp:4", "fem/method.hpp:2", "tests/long.cpp:1"]

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], faults, SAMPLES, FAULTY))

#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""The type stubs name every public name of the package, with its members and arguments, and no other; all have a docstring.

Usage: test_stubs.py
"""
import ast
import enum
import inspect
import re
import unittest
from pathlib import Path

import palpate

STUB = Path(palpate.__file__).with_name("__init__.pyi")
SPECIAL = {"__call__", "__len__"}  # the operators that users see
BASES = (object, tuple, Exception, ValueError, OSError, RuntimeError, enum.IntFlag)


def arguments_of(node):
    spec = node.args
    names = [a.arg for a in spec.posonlyargs + spec.args] + ([f"*{spec.vararg.arg}"] if spec.vararg else [])
    return [name for name in names if name != "self"] + [a.arg for a in spec.kwonlyargs]


def said_arguments(name, text):
    """The names between the brackets of the first line(s) of a docstring: "run(positions, dt=0.001, *, strict=True)"."""
    inside = re.match(re.escape(name) + r"\(([^)]*)\)", text)
    names = [part.split("=")[0].strip() for part in inside.group(1).split(",")] if inside else None
    return names and [part for part in names if part not in ("", "*")]


def members_of(kind):
    """Public members of a class that its own bases of Python do not have."""
    inherited = set()
    for base in BASES:
        if issubclass(kind, base):
            inherited |= set(dir(base))
    own = {name for name in dir(kind) if not name.startswith("_") and name not in inherited}
    return own | {name for name in SPECIAL & set(vars(kind))}


class Stubs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.nodes = {}
        for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                cls.nodes[node.name] = node
            elif isinstance(node, ast.AnnAssign):
                cls.nodes[node.target.id] = node

    def stub_members(self, name):
        members = {}
        for node in self.nodes[name].body:
            if isinstance(node, ast.FunctionDef):
                members[node.name] = node
            elif isinstance(node, ast.AnnAssign):
                members[node.target.id] = node
            elif isinstance(node, ast.Assign):
                members[node.targets[0].id] = node
        return members

    def test_the_package_is_marked_as_typed(self):
        self.assertTrue(STUB.with_name("py.typed").is_file())

    def test_every_public_name_is_there_and_no_other(self):
        public = {name for name in palpate.__all__}
        self.assertEqual(sorted(public), sorted(set(public)))
        visible = {name for name, value in vars(palpate).items()
                   if not name.startswith("_") and not inspect.ismodule(value)}
        self.assertEqual(visible | {"__version__"}, public)
        self.assertEqual(set(self.nodes) - {"__all__"}, public)

    def test_members_of_classes(self):
        for name in palpate.__all__:
            kind = getattr(palpate, name)
            if not inspect.isclass(kind):
                continue
            in_stub = {member for member in self.stub_members(name) if member in SPECIAL or not member.startswith("_")}
            in_package = members_of(kind)
            if issubclass(kind, palpate.Error):  # attributes are set when it is made
                in_package = set(vars(kind())) - {attribute for base in kind.__mro__[1:] if issubclass(base, palpate.Error)
                                                  for attribute in vars(base())}
            self.assertEqual(in_stub, in_package, name)

    def test_arguments(self):
        checked = 0
        for name in palpate.__all__:
            value = getattr(palpate, name)
            if inspect.isfunction(value):
                self.assertEqual(arguments_of(self.nodes[name]),
                                 [("*" if p.kind is p.VAR_POSITIONAL else "") + p.name
                                  for p in inspect.signature(value).parameters.values()], name)
                checked += 1
            elif callable(value) and not inspect.isclass(value):
                self.assertEqual(arguments_of(self.nodes[name]), said_arguments(name, value.__doc__), name)
                checked += 1
            elif inspect.isclass(value) and value.__module__ == "palpate._palpate":
                for member, node in self.stub_members(name).items():
                    if isinstance(node, ast.FunctionDef) and not node.decorator_list and not member.startswith("__"):
                        said = said_arguments(member, getattr(value, member).__doc__)
                        self.assertEqual(arguments_of(node), said or [], f"{name}.{member}")
                        checked += 1
        self.assertGreaterEqual(checked, 20)

    def test_everything_has_a_docstring(self):
        self.assertIn("SI", palpate.__doc__)
        for name in palpate.__all__:
            value = getattr(palpate, name)
            if name == "__version__":
                continue
            self.assertTrue(value.__doc__ and len(value.__doc__) > 10, name)
            if inspect.isclass(value) and value.__module__ == "palpate._palpate":
                for member in members_of(value) - {"__len__"}:
                    self.assertTrue(getattr(value, member).__doc__, f"{name}.{member}")

    def test_properties_are_properties(self):
        for name in palpate.__all__:
            value = getattr(palpate, name)
            if not inspect.isclass(value) or value.__module__ != "palpate._palpate":
                continue
            for member, node in self.stub_members(name).items():
                if any(getattr(d, "id", "") == "property" for d in getattr(node, "decorator_list", [])):
                    self.assertTrue(inspect.isdatadescriptor(getattr(value, member)), f"{name}.{member}")
                elif not member.startswith("__"):
                    self.assertTrue(callable(getattr(value, member)), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()

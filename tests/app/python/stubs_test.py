"""The stubs: each class, member and parameter is that of the module; examples and stubs pass mypy --strict."""
import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys
import unittest

import roomradar as rr

PACKAGE = pathlib.Path(os.environ["ROOMRADAR_PACKAGE"])
STUBS = ast.parse((PACKAGE / "roomradar" / "__init__.pyi").read_text())
IMPLICIT = {"__init__", "__module__", "__doc__", "__hash__", "__repr__", "__str__", "__eq__", "__ne__", "__new__",
            "__weakref__", "__pybind11_module_local_v4_gcc_libstdcpp_cxxabi1014__"}


def parameters_of_stub(function):
    arguments = function.args
    positional = [a.arg for a in arguments.args if a.arg != "self"]
    return positional, [a.arg for a in arguments.kwonlyargs]


def parameters_of_module(function):
    """Returns the parameters in the first line of a docstring of pybind11."""
    signature = re.match(r"\w+\((.*)\) -> ", inspect.getdoc(function).splitlines()[0]).group(1)
    names, depth, part = [], 0, ""
    for letter in signature + ",":
        depth += letter in "([{"
        depth -= letter in ")]}"
        if letter == "," and depth == 0:
            names.append(part.strip().split(":")[0])
            part = ""
        else:
            part += letter
    names = [name for name in names if name not in ("", "self")]
    if "*" not in names:
        return names, []
    at = names.index("*")
    return names[:at], names[at + 1:]


class Stubs(unittest.TestCase):
    def test_names_are_those_of_the_module(self):
        stubs = {item.name for item in STUBS.body if isinstance(item, (ast.ClassDef, ast.FunctionDef))}
        module = {name for name in dir(rr) if not name.startswith("_")}
        self.assertEqual({name for name in stubs if not name.startswith("_")}, module)

    def test_members_and_parameters_are_those_of_the_module(self):
        for item in STUBS.body:
            if isinstance(item, ast.FunctionDef):
                self.assertEqual(parameters_of_stub(item), parameters_of_module(getattr(rr, item.name)), item.name)
            if not isinstance(item, ast.ClassDef) or item.name.startswith("_"):
                continue
            cls = getattr(rr, item.name)
            if item.bases and getattr(item.bases[0], "id", "") in ("_Enum", "RuntimeError", "Error"):
                named = {part.target.id for part in item.body if isinstance(part, ast.AnnAssign)}
                self.assertEqual(named, set(getattr(cls, "__members__", ())), item.name)
                continue
            functions = {part.name: part for part in item.body if isinstance(part, ast.FunctionDef)}
            own = {name for name in vars(cls) if name not in IMPLICIT and not name.startswith("_pybind")}
            self.assertEqual(set(functions) - IMPLICIT, own, item.name)
            for name, function in functions.items():
                where = f"{item.name}.{name}"
                decorators = [getattr(d, "id", "") for d in function.decorator_list]
                if "property" in decorators:
                    self.assertIsInstance(vars(cls)[name], property, where)
                elif not name.startswith("__") or name == "__init__":
                    self.assertEqual(parameters_of_stub(function), parameters_of_module(getattr(cls, name)), where)

    def test_everything_has_a_docstring_without_names_of_cpp(self):
        for name in dir(rr):
            item = getattr(rr, name)
            if name.startswith("_"):
                continue
            self.assertTrue(inspect.getdoc(item), name)
            for member_name, member in vars(item).items() if isinstance(item, type) else ():
                if not member_name.startswith("__") or member_name == "__init__":
                    self.assertNotIn("::", inspect.getdoc(member) or "", f"{name}.{member_name}")
            self.assertNotIn("::", inspect.getdoc(item), name)

    def test_mypy_accepts_stubs_and_examples(self):
        examples = sorted((PACKAGE / "examples").glob("*.py"))
        self.assertGreaterEqual(len(examples), 4)
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull, PACKAGE / "roomradar" / "__init__.pyi",
             *examples],
            capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(PACKAGE)})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: MIT
"""glint/_abi.py says the same as glint.h: a C compiler is the judge."""

import ctypes
import enum
import os
import itertools
import re
import shutil
import subprocess
import sys
import unittest

from glint import _abi
from support import SOURCE, TestCase

CC = os.environ.get("CC", "gcc")
HEADER = SOURCE / "include" / "glint" / "glint.h"
TYPES = [kind for kind in vars(_abi).values() if isinstance(kind, type)]
STRUCTS = [k for k in TYPES if issubclass(k, ctypes.Structure) and k.__name__.startswith("Glint")]
ENUMS = [k for k in TYPES if issubclass(k, enum.IntEnum) and k is not enum.IntEnum]
CALLBACKS = {k: name for name, k in vars(_abi).items() if name.endswith("Fn")}
NAMES = {
    ctypes.c_bool: "bool",
    ctypes.c_int: "int",
    ctypes.c_uint: "unsigned",
    ctypes.c_long: "long",
    ctypes.c_ulong: "unsigned long",
    ctypes.c_float: "float",
    ctypes.c_double: "double",
    ctypes.c_char_p: "char *",
    ctypes.c_void_p: "void *",  # stands for any pointer
    ctypes.POINTER(ctypes.c_void_p): "void *",
    ctypes.POINTER(ctypes.c_char_p): "const char * *",
    **CALLBACKS,
}


def c_name(kind):
    if kind in NAMES:
        return NAMES[kind]
    if issubclass(kind, ctypes._Pointer):
        return c_name(kind._type_) + " *"
    return kind.__name__


def c_constant(kind, member):
    """GLINT_SHADER_PHONG for ShaderType.PHONG."""
    text = HEADER.read_text()
    words = [word.upper() for word in re.findall(r"[A-Z][a-z0-9]*", kind.__name__)]
    short = member.name[1:] if re.match(r"Y\d", member.name) else member.name
    listed = re.search(rf"\bX\({short}\b", text)
    for count in range(len(words), -1, -1):
        for part in itertools.combinations(words, count):
            prefix = "_".join(["GLINT", *part, ""])
            if re.search(rf"\b{prefix}{short}\b", text) or (listed and prefix + "##" in text):
                return prefix + short
    return "GLINT_" + short


def layout_program():
    """Prints what the compiler knows of the types, in the words of python_layout()."""
    yield "#include <glint/glint.h>\n#include <stdio.h>\nint main(void) {"
    for kind in STRUCTS:
        name = kind.__name__
        yield f'printf("{name} %zu\\n", sizeof({name}));'
        for field, *_ in kind._fields_:
            size = f"sizeof((({name} *)0)->{field})"
            yield f'printf("{name}.{field} %zu %zu\\n", offsetof({name}, {field}), {size});'
    for kind in ENUMS:
        for member in kind:
            text = f"{kind.__name__}.{member.name}"
            yield f'printf("{text} %d\\n", (int){c_constant(kind, member)});'
    yield "return 0; }"


def python_layout():
    for kind in STRUCTS:
        yield f"{kind.__name__} {ctypes.sizeof(kind)}"
        for field, *_ in kind._fields_:
            place = getattr(kind, field)
            yield f"{kind.__name__}.{field} {place.offset} {place.size}"
    for kind in ENUMS:
        for member in kind:
            yield f"{kind.__name__}.{member.name} {member.value}"


def call_program():
    """Does not compile where a function takes or returns something else."""
    yield "#include <glint/glint.h>\nvoid call(void);\nvoid call(void) {"
    for name, (returned, taken) in _abi.FUNCTIONS.items():
        call = f"{name}({', '.join(f'*({c_name(kind)} *)0' for kind in taken)})"
        if returned is None:
            yield f"{call};"
        else:
            const = "const " if c_name(returned).endswith("*") else ""
            yield f"{{ {const}{c_name(returned)} r = {call}; (void)r; }}"
    yield "}"


class Abi(TestCase):
    def compile(self, lines, *arguments):
        source = self.folder / "check.c"
        source.write_text("\n".join(lines))
        command = [CC, "-std=c11", "-I", SOURCE / "include", source, *arguments]
        made = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)

    def test_up_to_date(self):
        script = SOURCE / "python" / "make_abi.py"
        made = subprocess.run([sys.executable, script, "--check"], capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stdout + made.stderr)

    def test_every_struct_and_function_is_there(self):
        text = HEADER.read_text()
        functions = re.findall(r"^GLINT_API .*?(\w+)\(", text, flags=re.M)
        functions += re.findall(r"^GLINT_API [^(]*\n[^(]*?(\w+)\(", text, flags=re.M)
        self.assertEqual(set(functions), set(_abi.FUNCTIONS))
        structs = re.findall(r"^typedef struct (\w+) \{", text, flags=re.M)
        self.assertEqual(structs, [kind.__name__ for kind in STRUCTS])
        enums = re.findall(r"typedef enum Glint(\w+) \{", text)
        self.assertEqual(enums, [kind.__name__ for kind in ENUMS])

    @unittest.skipUnless(shutil.which(CC), "there is no C compiler")
    def test_layouts(self):
        self.compile(layout_program(), "-o", self.folder / "check")
        says = subprocess.run([self.folder / "check"], capture_output=True, text=True, check=True)
        self.assertEqual(says.stdout.splitlines(), list(python_layout()))

    @unittest.skipUnless(shutil.which(CC), "there is no C compiler")
    def test_functions(self):
        flags = ["-Wall", "-Wconversion", "-Wsign-conversion", "-Werror", "-Wno-null-dereference"]
        self.compile(call_program(), "-fsyntax-only", *flags)

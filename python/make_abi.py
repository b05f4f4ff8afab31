#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Writes glint/_abi.py, what ctypes has to know, from include/glint/glint.h.

    python/make_abi.py            writes the file
    python/make_abi.py --check    says whether it is up to date

Reads the C that the header is written in, not all C: enums, structs of plain members, pointers to
functions, and functions marked GLINT_API. What it does not understand stops it; that it understood
the rest correctly is what tests/python/test_abi.py asks a compiler."""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent
HEADER = HERE.parent / "include" / "glint" / "glint.h"
TARGET = HERE / "glint" / "_abi.py"

PLAIN = {
    "bool": "c_bool",
    "double": "c_double",
    "float": "c_float",
    "int": "c_int",
    "int32_t": "c_int32",
    "int64_t": "c_int64",
    "size_t": "c_size_t",
    "uint8_t": "c_uint8",
    "uint32_t": "c_uint32",
    "uint64_t": "c_uint64",
    "unsigned": "c_uint",
}


HEAD = '''\
# SPDX-License-Identifier: MIT
"""The types and functions of glint.h as ctypes sees them. Made by python/make_abi.py from the
header: do not change it by hand."""

from __future__ import annotations

from ctypes import {imports}
from enum import IntEnum
from typing import Any

VERSION = "{version}"'''


def stop(what: str) -> SystemExit:
    return SystemExit(f"make_abi.py does not understand: {what}")


class Header:
    """What was found in the text so far; blocks is the Python made of it."""

    def __init__(self, text: str) -> None:
        self.enums: set[str] = set()
        self.constants: dict[str, str] = {}
        self.structs: set[str] = set()
        self.callbacks: set[str] = set()
        self.blocks: list[str] = []
        self.functions: list[str] = []
        self.version = ".".join(
            re.findall(r"#define GLINT_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", text)
        )
        text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
        # #define GLINT_X_LIST(X) X(A, "...") X(B, "...") stands for its names.
        self.lists = {
            name: re.findall(r"\bX\((\w+)", body)
            for name, body in re.findall(r"#define (\w+_LIST)\(X\)((?:.*\\\n)*.*\n)", text)
        }
        # #define GLINT_X_ENUM(name, text) GLINT_X_##name, is what is made of them.
        self.prefixes = dict(re.findall(r"#define (\w+)\([^)]*\) (\w+?)##", text))
        text = re.sub(r"#(?:.*\\\n)*.*\n", "", text)
        text = text.replace('extern "C" {', "")
        for statement in self.statements(text):
            self.read(statement)

    @staticmethod
    def statements(text: str) -> list[str]:
        """Cut at the semicolons outside of braces."""
        result, depth, start = [], 0, 0
        for i, letter in enumerate(text):
            depth += (letter == "{") - (letter == "}")
            if letter == ";" and depth == 0:
                result.append(" ".join(text[start:i].split()))
                start = i + 1
        return result

    def read(self, statement: str) -> None:
        if match := re.fullmatch(r"typedef enum (\w+) \{(.*)\} \1", statement):
            self.read_enum(match[1], match[2])
        elif match := re.fullmatch(r"typedef struct (\w+) \{(.*)\} \1", statement):
            self.read_struct(match[1], match[2])
        elif match := re.fullmatch(r"typedef (.+?)\(\*(\w+)\)\((.*)\)", statement):
            self.callbacks.add(match[2])
            self.blocks.append(f"{match[2]} = {self.callback(match[1], match[3])}")
        elif match := re.fullmatch(r"GLINT_API (.+?)(\w+)\((.*)\)", statement):
            self.read_function(match[1], match[2], match[3])
        elif match := re.fullmatch(r"enum \{ GLINT_(\w+) = (\d+) \}", statement):
            self.blocks.append(f"{match[1]} = {match[2]}")
            self.constants["GLINT_" + match[1]] = match[2]
        elif not re.fullmatch(r"typedef struct (\w+) \1", statement):  # its address is enough
            raise stop(statement)

    # ------------------------------------------------------------ enums

    def read_enum(self, name: str, body: str) -> None:
        for macro, names in self.lists.items():
            for maker in re.findall(rf"{macro}\((\w+)\)", body):
                made = ", ".join(self.prefixes[maker] + name for name in names) + ", "
                body = body.replace(f"{macro}({maker})", made)
        members = [member.strip() for member in body.split(",") if member.strip()]
        prefix = self.prefix(name, members)
        lines, value = [f"class {name[5:]}(IntEnum):", f'    """{name} of glint.h."""\n'], -1
        for member in members:
            match = re.fullmatch(r"(\w+)(?: = (-?\w+)(?: << (\d+))?)?", member)
            if match is None:
                raise stop(member)
            value = int(match[2], 0) << int(match[3] or 0) if match[2] else value + 1
            short = match[1][len(prefix) :]
            lines.append(f"    {'Y' if short[0].isdigit() else ''}{short} = {value}")
        self.enums.add(name)
        self.blocks.append("\n".join(lines))

    @staticmethod
    def prefix(name: str, members: list[str]) -> str:
        """What goes away: GLINT_LIGHT_POINT of GlintLightType is called POINT."""
        prefix = "GLINT_"
        for word in re.findall(r"[A-Z][a-z0-9]*", name)[1:]:
            longer = prefix + word.upper() + "_"
            if all(member.startswith(longer) for member in members):
                prefix = longer
        return prefix

    # ------------------------------------------------------------ structs

    def read_struct(self, name: str, body: str) -> None:
        for constant, value in self.constants.items():
            body = re.sub(rf"\b{constant}\b", value, body)
        declarations = [part.strip() for part in body.split(";")]
        fields = [field for declaration in declarations for field in self.fields(declaration)]
        lines = [f'        ("{field}", {kind}),' for field, kind in fields]
        lines = [f"class {name}(Structure):", "    _fields_ = [", *lines, "    ]"]
        # For ctypes an enum is an int; this remembers which.
        enums = [d.split() for d in declarations if d.split(" ")[0] in self.enums]
        if enums:
            members = ", ".join(f'"{field}": {kind[5:]}' for kind, field in enums)
            lines.append(f"    _enums_ = {{{members}}}")
        self.structs.add(name)
        self.blocks.append("\n".join(lines))

    def fields(self, declaration: str) -> list[tuple[str, str]]:
        """Of `const double a[3], *b`: name and kind of each."""
        if not declaration:
            return []
        if match := re.fullmatch(r"(.+?)\(\*(\w+)\)\((.*)\)", declaration):
            return [(match[2], self.callback(match[1], match[3]))]
        match = re.fullmatch(r"((?:const )?\w+) ?(.*)", declaration)
        if match is None:
            raise stop(declaration)
        result = []
        for declarator in match[2].split(","):
            part = re.fullmatch(r"((?:\*|const )*)(\w+)((?:\[\d+\])*)", declarator.strip())
            if part is None:
                raise stop(declaration)
            kind = self.kind(match[1] + part[1])
            for size in reversed(re.findall(r"\d+", part[3])):
                kind = f"{kind} * {size}"
            result.append((part[2], kind))
        return result

    # ------------------------------------------------------------ types and functions

    def kind(self, c_type: str) -> str:
        """The name that ctypes has for a C type."""
        stars = c_type.count("*")
        (base,) = [word for word in re.findall(r"\w+", c_type) if word != "const"]
        if base == "char":
            kinds = ["c_char", "c_char_p", "POINTER(c_char_p)"]
        elif base in self.structs:
            kinds = [base, f"POINTER({base})", f"POINTER(POINTER({base}))"]
        else:
            # Numbers are handed over by their address; an opaque struct is its address.
            plain = "c_int" if base in self.enums else base if base in self.callbacks else ""
            plain = plain or ("None" if base == "void" else PLAIN.get(base, ""))
            kinds = [plain, "c_void_p", "POINTER(c_void_p)"]
        if stars >= len(kinds) or not kinds[stars]:
            raise stop(c_type)
        return kinds[stars]

    def parameters(self, text: str) -> list[str]:
        if text == "void":
            return []
        result = []
        for part in text.split(","):
            match = re.fullmatch(r"(.*?)\w+(\[\d*\])?", part.strip())
            if match is None:
                raise stop(part)
            result.append(self.kind(match[1] + ("*" if match[2] else "")))
        return result

    def callback(self, returned: str, parameters: str) -> str:
        return f"CFUNCTYPE({', '.join([self.kind(returned), *self.parameters(parameters)])})"

    def read_function(self, returned: str, name: str, parameters: str) -> None:
        taken = ", ".join(self.parameters(parameters))
        self.functions.append(f'    "{name}": ({self.kind(returned)}, [{taken}]),')

    # ------------------------------------------------------------ the file

    def python(self) -> str:
        table = [
            "# name: what it returns, what it takes",
            "FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {",
            *(wrapped(line) for line in self.functions),
            "}\n",
        ]
        body = "\n\n\n".join([*self.blocks, "\n".join(table)])
        used = sorted(set(re.findall(r"\b(CFUNCTYPE|POINTER|Structure|c_\w+)\b", body)))
        imports = "(\n" + "".join(f"    {name},\n" for name in used) + ")"
        return HEAD.format(imports=imports, version=self.version) + "\n\n\n" + body


def wrapped(line: str) -> str:
    lines = textwrap.wrap(line.strip(), 99, initial_indent="    ", subsequent_indent=" " * 8)
    return "\n".join(lines)


def main() -> int:
    made = Header(HEADER.read_text()).python()
    if sys.argv[1:] == ["--check"]:
        if made == TARGET.read_text():
            return 0
        print("python/glint/_abi.py is not what glint.h says; run python/make_abi.py")
        return 1
    TARGET.write_text(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())

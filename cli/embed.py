# SPDX-License-Identifier: MIT
# Makes a C file of a page: what stands before the line @DATA@ and what stands behind it.
#   embed.py NAME PAGE C_FILE
import sys

name, source, target = sys.argv[1:]
with open(source, "rb") as file:
    parts = file.read().split(b"@DATA@\n")
if len(parts) != 2:
    sys.exit(f"{source}: the line @DATA@ must stand in it once")
with open(target, "w", encoding="ascii") as file:
    file.write("#include \"why_page.h\"\n")
    for part, data in zip(("head", "tail"), parts):
        file.write(f"const size_t {name}_{part}_size = {len(data)};\n")
        file.write(f"const char {name}_{part}[] = {{\n")
        for i in range(0, len(data), 24):
            row = ",".join(str(byte if byte < 128 else byte - 256) for byte in data[i:i + 24])
            file.write(f"{row},\n")
        file.write("};\n")

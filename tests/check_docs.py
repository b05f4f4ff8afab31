#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs what the documentation tells people to run.

    check_docs.py BUILD SOURCE [--slow] [PAGE...]

Each page of README.md and docs/*.md gets a folder of its own, in which `build/glint` is the program and
`scenes`, `docs`, `include` and `bench` are copies. Its blocks are done in order:

    ```sh       must succeed
    ```console  the lines after "$ " are run, one by one; what they print, on both outputs, must be what
                follows. A line "..." stands for any number of lines
    others      are read by people only, unless a comment before them says more

A comment in the line before a block (or with one empty line between) says what readers need not know:

    <!-- file: NAME -->      the block is the content of a file
    <!-- run: status 1 -->   the commands end with that status; `any`: with whatever
    <!-- run: on -->         commands may fail, but not the last
    <!-- run: like -->       numbers and the length of blanks may be others
    <!-- run: slow -->       only with --slow
    <!-- run: never, WHY --> not here, for a reason that the comment tells
    <!-- before: COMMAND --> is run first, so that the block finds what it needs

and <!-- page: slow --> anywhere in a page makes all of its blocks slow.

Ends with "N passed, N failed[, N skipped]".
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^( *)```(\w*)\s*$")
COMMENT = re.compile(r"<!--\s*(file|run|before):\s*(.*?)\s*-->")
SECONDS = 600


class Block:
    def __init__(self, kind, line, notes):
        self.kind, self.line, self.notes, self.lines = kind, line, notes, []

    def note(self, key):
        return [value for name, value in self.notes if name == key]


def blocks_of(text):
    """The fenced blocks of a page, each with the comments right before it."""
    found, notes, block, indent = [], [], None, ""
    for number, line in enumerate(text.split("\n"), 1):
        fence = FENCE.match(line)
        if block is not None:
            if fence and not fence.group(2):
                found.append(block)
                block, notes = None, []
            else:
                block.lines.append(line[len(indent):] if line.startswith(indent) else line)
        elif fence:
            indent = fence.group(1)
            block = Block(fence.group(2), number, notes)
        elif COMMENT.search(line):
            notes += COMMENT.findall(line)
        elif line.strip():
            notes = []
    return found


def squeezed(line):
    return re.sub(r"\s+", " ", re.sub(r"[0-9][0-9.,]*", "0", line)).strip()


def matches(printed, expected):
    """Whether lines are as expected, where "..." stands for any of them."""
    if not expected:
        return not printed
    if expected[0] == "...":
        return any(matches(printed[i:], expected[1:]) for i in range(len(printed) + 1))
    return bool(printed) and printed[0] == expected[0] and matches(printed[1:], expected[1:])


class Page:
    def __init__(self, name, folder, slow):
        self.name, self.folder, self.slow = name, folder, slow
        self.passed = self.failed = self.skipped = 0

    def run(self, command):
        return subprocess.run(["bash", "-c", command], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS,
                              text=True, errors="replace")

    def judge(self, block, good, *told):
        if good:
            self.passed += 1
            return
        self.failed += 1
        print(f"FAIL docs: {self.name}:{block.line}: {block.lines[0]}")
        for text in told:
            for line in text.rstrip().split("\n")[:40]:
                print("  " + line)

    def shell(self, block, status):
        stop = "" if "on" in block.note("run") else "set -e\n"
        done = self.run(stop + "\n".join(block.lines))
        good = status in (None, done.returncode)
        self.judge(block, good, f"status {done.returncode}", done.stdout)

    def console(self, block, status):
        calls = []
        for line in block.lines:
            if line.startswith("$ "):
                calls.append((line[2:], []))
            elif calls:
                calls[-1][1].append(line)
        like = "like" in block.note("run")
        for command, expected in calls:
            done = self.run(command)
            printed = done.stdout.rstrip("\n").split("\n") if done.stdout.strip() else []
            while expected and not expected[-1].strip():
                expected.pop()
            wanted = expected
            if like:
                printed, wanted = [squeezed(x) for x in printed], [squeezed(x) for x in expected]
            printed = [x.rstrip() for x in printed]
            good = status in (None, done.returncode)
            good = good and matches(printed, [x.rstrip() for x in wanted])
            self.judge(block, good, f"$ {command}", f"status {done.returncode}, printed:",
                       done.stdout, "and not:", "\n".join(expected))

    def do(self, block):
        notes = block.note("run")
        for name in block.note("file"):
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("\n".join(block.lines) + "\n", encoding="utf-8")
        if block.kind not in ("sh", "console"):
            return
        if any(note.startswith("never") for note in notes) or ("slow" in notes and not self.slow):
            self.skipped += 1
            return
        status = next((note.split()[1] for note in notes if note.startswith("status")), "0")
        status = None if status == "any" else int(status)
        for command in block.note("before"):
            self.run(command)
        (self.shell if block.kind == "sh" else self.console)(block, status)


def make_folder(parent, name, build, source):
    folder = parent / name
    folder.mkdir()
    (folder / "build").symlink_to(build)
    for part in ("scenes", "docs", "include", "bench", "tests"):
        shutil.copytree(source / part, folder / part, symlinks=True,
                        ignore=shutil.ignore_patterns("gallery"))
    for part in ("README.md", "CONTRIBUTING.md"):
        shutil.copy(source / part, folder)
    return folder


def main():
    slow = "--slow" in sys.argv
    words = [word for word in sys.argv[1:] if word != "--slow"]
    if len(words) < 2:
        sys.exit(__doc__)
    build, source = (pathlib.Path(word).resolve() for word in words[:2])
    pages = [source / word for word in words[2:]]
    pages = pages or [source / "README.md", *sorted((source / "docs").glob("*.md"))]
    os.environ.pop("NO_COLOR", None)
    total = [0, 0, 0]
    with tempfile.TemporaryDirectory(prefix="glint-docs-") as scratch:
        for number, path in enumerate(pages):
            text = path.read_text(encoding="utf-8")
            blocks = blocks_of(text)
            if "<!-- page: slow -->" in text:
                for block in blocks:
                    block.notes.append(("run", "slow"))
            if not any(block.kind in ("sh", "console") for block in blocks):
                continue
            folder = make_folder(pathlib.Path(scratch), str(number), build, source)
            page = Page(str(path.relative_to(source)), folder, slow)
            for block in blocks:
                page.do(block)
            total = [total[0] + page.passed, total[1] + page.failed, total[2] + page.skipped]
    print("{} passed, {} failed, {} skipped".format(*total))
    sys.exit(total[1] > 0)


main()

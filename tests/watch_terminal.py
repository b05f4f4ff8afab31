# SPDX-License-Identifier: MIT
"""Plays terminal for `glint watch`: answers its questions, presses its keys, sends it signals, and
decodes what it draws.

    watch_terminal.py PATH/TO/glint

Runs in an empty folder. Ends with "N passed, N failed"."""
import base64
import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
import zlib

GLINT = sys.argv[1]
SLOW = 20.0  # seconds that nothing takes, on no machine
SCENE = """<scene dialect="glint">
  <image>60 40</image>
  <!-- < the > camera -->
  <camera type="PerspectiveCamera">
    <viewPoint>0 0 4</viewPoint>  <!-- in front -->
    <viewHeight>0.6667</viewHeight>
  </camera>
  <light><position>4 5 6</position></light>
  <surface type="Sphere">%s</surface>
</scene>
"""
QUESTION = b"\x1b[c"
ENTER, LEAVE = b"\x1b[?1049h", b"\x1b[?1049l"
ANSWERS = {
    "kitty": b"\x1b_Gi=31;OK\x1b\\\x1b[6;16;8t\x1b[?62;c",
    "sixel": b"\x1b[6;16;8t\x1b[?62;1;4;22c",
    "plain": b"\x1b[?1;2c",
    "none": b"",
}
END_UPDATE = b"\x1b[?2026l"

passed = failed = 0


def check(what, good):
    global passed, failed
    if good:
        passed += 1
    else:
        failed += 1
        print("FAIL watch_terminal: " + what)


def write(name, text):
    with open(name + ".new", "w") as file:
        file.write(text)
    os.rename(name + ".new", name)


class Terminal:
    def __init__(self, answer, *arguments, colors="truecolor", size=(24, 80)):
        environment = dict(os.environ, TERM="xterm-256color", COLORTERM=colors)
        for name in ("DISPLAY", "WAYLAND_DISPLAY", "COLUMNS", "LINES"):
            environment.pop(name, None)
        self.output = b""
        self.seen = 0
        self.status = None
        self.process, self.end = pty.fork()
        if self.process == 0:
            time.sleep(0.05)  # the size is set meanwhile
            os.execve(GLINT, [GLINT, "watch"] + list(arguments), environment)
        self.resize(*size)
        self.mode = termios.tcgetattr(self.end)
        if answer is not None and self.wait(QUESTION):
            self.send(ANSWERS[answer])

    def resize(self, rows, columns):
        fcntl.ioctl(self.end, termios.TIOCSWINSZ, struct.pack("4H", rows, columns, 0, 0))

    def send(self, keys):
        os.write(self.end, keys)

    def read(self, seconds):
        """Whether something came; not when the program has closed its end."""
        if self.end is None:
            time.sleep(seconds)
            return False
        if not select.select([self.end], [], [], seconds)[0]:
            return False
        try:
            data = os.read(self.end, 65536)
        except OSError:
            return False
        self.output += data
        return bool(data)

    def wait(self, pattern, regular=False):
        """Waits until the pattern stands behind what was waited for before; returns the match."""
        pattern = pattern if regular else re.escape(pattern)
        limit = time.time() + SLOW
        while time.time() < limit:
            match = re.compile(pattern, re.S).search(self.output, self.seen)
            if match:
                self.seen = match.end()
                return match
            if not self.read(0.1) and self.ended():
                while self.read(0):
                    pass
                limit = min(limit, time.time() + 0.05)
        return None

    def ended(self):
        if self.status is None:
            process, status = os.waitpid(self.process, os.WNOHANG)
            self.status = status if process else None
        return self.status is not None

    def finish(self):
        """What waitpid has to say, once the program has ended by itself."""
        limit = time.time() + SLOW
        while not self.ended() and time.time() < limit:
            self.read(0.05)
        if not self.ended():
            os.kill(self.process, signal.SIGKILL)
            self.status = os.waitpid(self.process, 0)[1]
            return None
        while self.read(0):
            pass
        return self.status

    def restored(self):
        return termios.tcgetattr(self.end) == self.mode and \
            self.output.rfind(LEAVE) > self.output.rfind(ENTER)

    def close(self):
        os.close(self.end)
        self.end = None


def read_png(data):
    """(width, height, RGB bytes) of a PNG with 8 bits a channel."""
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    rows, out, before = zlib.decompress(packed), b"", bytes(3 * width)
    for y in range(height):
        at = y * (3 * width + 1)
        line = bytearray(rows[at + 1:at + 1 + 3 * width])
        for x in range(3 * width):
            a, b = (line[x - 3] if x > 2 else 0), before[x]
            c = before[x - 3] if x > 2 else 0
            p = a + b - c
            paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else \
                b if abs(p - b) <= abs(p - c) else c
            line[x] = (line[x] + (0, a, b, (a + b) // 2, paeth)[rows[at]]) & 255
        before = bytes(line)
        out += before
    return width, height, out


def picture(scene):
    """What `glint render` draws of it."""
    subprocess.run([GLINT, "render", "-q", "-o", "expected.png", scene], check=True)
    with open("expected.png", "rb") as file:
        return read_png(file.read())


def read_blocks(text, width):
    """The RGB bytes of rows of half blocks."""
    upper, lower, rows = [0] * 3, [0] * 3, []
    for token in re.findall(rb"\x1b\[([34])8;2;(\d+);(\d+);(\d+)m|(\xe2\x96\x80)", text):
        if token[4]:
            if not rows or len(rows[-1]) == 3 * width:
                rows += [b"", b""]
            rows[-2] += bytes(upper)
            rows[-1] += bytes(lower)
        else:
            color = [int(value) for value in token[1:4]]
            upper, lower = (color, lower) if token[0] == b"3" else (upper, color)
    return b"".join(rows)


def read_kitty(text):
    chunks = re.findall(rb"\x1b_G[^;\x1b]*m=[01];([A-Za-z0-9+/=]*)\x1b\\", text)
    return read_png(base64.b64decode(b"".join(chunks)))


# ---------------------------------------------------------------- pictures

def pictures():
    write("a.xml", SCENE % "")
    width, height, expected = picture("a.xml")
    frame = rb"\x1b\[\?2026h(.*?60 x 40  1 sample  [^.]*? ms   .*?)\x1b\[\?2026l"

    terminal = Terminal("plain", "a.xml")
    match = terminal.wait(frame, True)
    check("blocks show the picture", match and read_blocks(match[1], width) == expected)
    terminal.send(b"q")
    check("q ends well", terminal.finish() == 0 and terminal.restored())
    terminal.close()

    terminal = Terminal("kitty", "a.xml")
    match = terminal.wait(frame, True)
    check("kitty's protocol is found, and shows the picture",
          match and read_kitty(match[1]) == (width, height, expected))
    terminal.send(b"\x1b")
    check("Escape ends well", terminal.finish() == 0 and terminal.restored())
    terminal.close()

    terminal = Terminal("sixel", "a.xml")
    check("sixel is found", terminal.wait(b'\x1bP0;1q"1;1;60;40'))
    terminal.send(b"q")
    check("sixel ends well", terminal.finish() == 0)
    terminal.close()

    # Whoever never answers gets blocks all the same.
    terminal = Terminal("none", "a.xml", colors="")
    check("256 colours without an answer", terminal.wait(rb"\x1b\[38;5;\d+m\x1b\[48;5;\d+m\xe2", True))
    check("... and no others", b"[38;2;" not in terminal.output)
    terminal.send(b"q")
    check("... and an end", terminal.finish() == 0)
    terminal.close()

    for kind in ("kitty", "sixel", "blocks"):
        terminal = Terminal(None, "--once", "--terminal=" + kind, "a.xml")
        check("--once with " + kind, terminal.finish() == 0)
        check("--once stays on the screen", ENTER not in terminal.output)
        terminal.close()


# ---------------------------------------------------------------- keys and saves

def keys():
    write("k.xml", SCENE % "")
    terminal = Terminal("plain", "k.xml")
    check("a first picture", terminal.wait(b"1 sample"))
    terminal.send(b"h")
    check("h tells the keys", terminal.wait(b"arrows turn"))
    for key in (b"\x1b[C", b"\x1b[A", b"\x1b[1;2D", b"+", b"-"):
        terminal.send(key)
        check("%r draws anew" % key, terminal.wait(rb"\x1b\[H\x1b\[38;2.*?1 sample  \S+ ms   ", True))
    terminal.send(b"v")
    check("v shows another view", terminal.wait(b"  normal"))
    terminal.send(b"1")
    check("1 shows the picture", terminal.wait(END_UPDATE))
    terminal.send(b"s")
    check("s writes the camera", terminal.wait(b"camera written to k.xml"))
    with open("k.xml") as file:
        text = file.read()
    first, second = (SCENE % "").split("\n"), text.split("\n")
    changed = [i for i in range(len(first)) if first[i] != second[i]]
    check("... into the camera alone", len(first) + 1 == len(second) and changed[0] == 4 and
          second[7:] == first[6:] and "<!-- in front -->" in second[4])
    terminal.send(b"r")
    terminal.send(b"q")
    check("q ends", terminal.finish() == 0 and terminal.restored())
    terminal.close()


def saves():
    write("e.xml", SCENE % "")
    terminal = Terminal("plain", "e.xml")
    check("a first picture", terminal.wait(b"1 sample"))
    write("e.xml", SCENE % "<raduis>2</raduis>")
    check("an error is told", terminal.wait(b"e.xml:9:26: error: unknown element `raduis`"))
    check("... with its line and place", terminal.wait(rb"<raduis>2</raduis>.*?\^~~~", True))
    check("... beside the picture", terminal.wait(b"errors") and terminal.wait(END_UPDATE))
    write("e.xml", SCENE % "<radius>0.6</radius>")
    match = terminal.wait(rb"\x1b\[2J\x1b\[H(.*?)1 sample  \S+ ms   ", True)
    check("a good scene shows", match and read_blocks(match[1], 60) == picture("e.xml")[2])
    times = []
    for i in range(8):
        time.sleep(0.05)
        terminal.read(0)
        terminal.seen = len(terminal.output)
        begin = time.time()
        write("e.xml", SCENE % ("<radius>0.%d</radius>" % (50 + i)))
        check("a save shows", terminal.wait(rb"\x1b\[H\x1b\[38.*?\x1b\[\?2026l", True))
        times.append(1000 * (time.time() - begin))
    print("  %.1f ms from a save to its picture in the terminal" % min(times))
    check("a save shows within 100 ms: %.1f" % min(times),
          min(times) < 100 or "GLINT_SLOW" in os.environ)
    terminal.send(b"q")
    check("q ends", terminal.finish() == 0)
    terminal.close()


def resizes():
    write("r.xml", SCENE.replace("60 40", "300 200") % "")
    terminal = Terminal("plain", "r.xml")
    terminal.wait(b"1 sample")
    for rows, columns in ((12, 30), (40, 120), (2, 3), (1, 1), (24, 80)):
        while terminal.read(0.3):  # what is under way is of the size before
            pass
        terminal.seen = len(terminal.output)
        terminal.resize(rows, columns)
        match = terminal.wait(rb"\x1b\[2J(.*?)\x1b\[%d;1H" % rows, True)
        lines = re.sub(rb"\x1b\[[0-9;]*[a-zA-Z]", b"", match[1] if match else b"").split(b"\n")
        widest = max(len(line.decode("utf-8", "replace").rstrip("\r")) for line in lines)
        check("%d x %d cells hold the picture" % (columns, rows),
              match and len(lines) <= rows and widest <= columns)
        terminal.wait(END_UPDATE)
    terminal.send(b"q")
    check("q ends", terminal.finish() == 0)
    terminal.close()


# ---------------------------------------------------------------- ends

def ends():
    write("s.xml", SCENE % "")
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGSEGV):
        terminal = Terminal("plain", "s.xml")
        terminal.wait(b"1 sample")
        os.kill(terminal.process, number)
        status = terminal.finish()
        check("%s ends it, and the terminal is as it was" % number.name,
              status is not None and os.WIFSIGNALED(status) and os.WTERMSIG(status) == number and
              terminal.restored())
        terminal.close()

    terminal = Terminal("plain", "s.xml")
    terminal.wait(b"1 sample")
    terminal.send(b"\x1a")
    check("Ctrl-Z gives the screen back", terminal.wait(LEAVE))
    status = os.waitpid(terminal.process, os.WUNTRACED)[1]
    check("... and stops", os.WIFSTOPPED(status) and termios.tcgetattr(terminal.end) == terminal.mode)
    os.kill(terminal.process, signal.SIGCONT)
    check("... and goes on", terminal.wait(ENTER) and terminal.wait(b"1 sample"))
    terminal.send(b"\x03")
    status = terminal.finish()
    check("Ctrl-C ends it", status is not None and os.WIFSIGNALED(status) and terminal.restored())
    terminal.close()

    terminal = Terminal("plain", "s.xml")
    terminal.wait(b"1 sample")
    terminal.close()  # the window of the terminal goes away
    check("it does not outlive its terminal", terminal.finish() is not None)


for test in (pictures, keys, saves, resizes, ends):
    test()
print("%d passed, %d failed" % (passed, failed))
sys.exit(failed > 0)

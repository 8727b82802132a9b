"""The full screen of `footfall tune` in a pseudo terminal, beside a run: tune_screen_test.py BINARY."""
import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import time

import tune_test
from command import BINARY, main

SEQUENCE = re.compile(rb"\x1b\[([?\d;]*)([A-Za-z])|\x1b[()][0-9A-B]|\x1b[=>78]|[\x0e\x0f\x07]|\$<\d+[*/]*>")


class Terminal:
    """As much of a vt100 as ncurses uses."""

    def __init__(self, rows, columns):
        self.resize(rows, columns)

    def resize(self, rows, columns):
        self.rows, self.columns = rows, columns
        self.cells = [[" "] * columns for _ in range(rows)]
        self.row = self.column = 0
        self.pending = b""

    def text(self):
        return "\n".join("".join(row) for row in self.cells)

    def feed(self, data):
        data = self.pending + data
        self.pending = b""
        while data:
            sequence = SEQUENCE.match(data)
            if sequence:
                if sequence[2]:
                    self.control(sequence[1].decode(), sequence[2].decode())
                data = data[sequence.end():]
            elif data[:1] == b"\x1b" and len(data) < 16:
                self.pending = data  # not whole yet
                return
            else:
                data = self.sign(data)

    def sign(self, data):
        first = data[0]
        length = 1 if first < 0x80 else 2 if first < 0xE0 else 3 if first < 0xF0 else 4
        if len(data) < length:
            self.pending = data
            return b""
        if first == 0x0D:
            self.column = 0
        elif first == 0x0A:
            self.row = min(self.row + 1, self.rows - 1)
        elif first == 0x08:
            self.column = max(0, self.column - 1)
        elif first >= 0x20:
            if self.column >= self.columns:
                self.column, self.row = 0, min(self.row + 1, self.rows - 1)
            self.cells[self.row][self.column] = data[:length].decode()
            self.column += 1
        return data[length:]

    def control(self, numbers, what):
        values = [int(n) for n in numbers.replace("?", "").split(";") if n]
        one = max(1, values[0]) if values else 1
        if what == "H":
            self.row, self.column = (values + [1, 1])[0] - 1, (values + [1, 1])[1] - 1
        elif what in "ABCD":
            self.row += {"A": -one, "B": one}.get(what, 0)
            self.column += {"C": one, "D": -one}.get(what, 0)
        elif what == "K":
            begin, end = {0: (self.column, self.columns), 1: (0, self.column + 1)}.get(
                values[0] if values else 0, (0, self.columns))
            self.cells[self.row][begin:end] = [" "] * (end - begin)
        elif what == "J":
            first = self.row if not values or values[0] == 0 else 0
            if first == self.row:
                self.cells[self.row][self.column:] = [" "] * (self.columns - self.column)
                first += 1
            for row in range(first, self.rows):
                self.cells[row] = [" "] * self.columns
        self.row = min(max(self.row, 0), self.rows - 1)
        self.column = min(max(self.column, 0), self.columns - 1)


class Screen(tune_test.Live):
    def open(self, rows=24, columns=80, url=None):
        self.master, slave = pty.openpty()
        self.terminal = Terminal(rows, columns)
        self.set_size(rows, columns)
        self.before = termios.tcgetattr(slave)
        self.slave = slave
        self.program = subprocess.Popen(
            [BINARY, "tune", "--url", url or self.url, "--who", "tester", "--timeout", "20s"],
            stdin=slave, stdout=slave, stderr=subprocess.PIPE, env=dict(self.environment, TERM="vt100"),
            start_new_session=True, cwd=self.folder,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        self.addCleanup(self.close, self.program, self.master, slave)

    @staticmethod
    def close(program, *files):
        if program.poll() is None:
            program.kill()
        program.communicate()
        for file in files:
            os.close(file)

    def set_size(self, rows, columns):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def read(self, seconds):
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            if select.select([self.master], [], [], left)[0]:
                self.terminal.feed(os.read(self.master, 65536))
                return

    def wait_for(self, pattern, seconds=20.0):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if re.search(pattern, self.terminal.text()):
                return
            self.read(0.2)
        self.fail(f"no {pattern!r} in\n{self.terminal.text()}")

    def type(self, text):
        os.write(self.master, text.encode())

    def leave(self, how):
        """Leaves; the terminal must be as it was."""
        how()
        deadline = time.monotonic() + 10.0
        while self.program.poll() is None and time.monotonic() < deadline:
            self.read(0.1)
        self.assertEqual(self.program.wait(timeout=1), 0)
        self.assertEqual(termios.tcgetattr(self.slave), self.before)

    def test_a_session(self):
        self.open()
        self.wait_for(r"balance_best on hume .* running  revision 0")
        self.wait_for(r"feet   right_foot +\d+ N   left_foot +\d+ N")
        self.type("/lift_t\r")
        self.wait_for(r"> lift_time +145 ms +145 ms")
        self.wait_for(r"80 to 200 ms, step 5 ms")
        self.type("++")
        self.wait_for(r"> lift_time +155 ms +145 ms")
        self.wait_for(r"tester  lift_time = ")
        self.assertEqual(self.good("get", "lift_time"), "lift_time=155 ms\n")
        self.type("=\x7f\x7f\x7f\x7f\x7f\x7f0.16\r")
        self.wait_for(r"> lift_time +160 ms +145 ms")
        self.type("=9\r")
        self.wait_for(r"expected a time")
        self.type("\x1b")
        # Somebody else's edit is seen, and undone.
        self.good("set", "lift_time=170ms")
        self.wait_for(r"> lift_time +170 ms +145 ms")
        self.type("u")
        self.wait_for(r"> lift_time +160 ms +145 ms")
        self.type("r")
        self.wait_for(r"> lift_time +170 ms +145 ms")
        self.type("c")
        self.wait_for(r"file  145 ms\s+now   170 ms")
        self.type("q")
        before = self.file.read_text()
        self.type("s")
        self.wait_for(r"\+  lift_time: \{value: 170 ms")
        self.type("n")
        self.wait_for(r"nothing was written")
        self.assertEqual(self.file.read_text(), before)
        self.type("s")
        self.wait_for(r"\+  lift_time: \{value: 170 ms")
        self.type("y")
        self.wait_for(r"> lift_time +170 ms +170 ms")
        self.assertIn("lift_time: {value: 170 ms", self.file.read_text())
        self.type("pbase.rpy.pitch\r")
        self.wait_for(r"base.rpy.pitch  -?[\d.e-]+")
        self.type("?")
        self.wait_for(r"undo, redo")
        self.type("x")
        for rows, columns in ((40, 140), (16, 60), (10, 30), (24, 80)):
            self.terminal.resize(rows, columns)
            self.set_size(rows, columns)
            self.wait_for(r"> lift_time" if columns >= 60 else r"window is too small")
        self.leave(lambda: self.type("q"))

    def test_it_leaves_on_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                self.open()
                self.wait_for(r"running")
                self.leave(lambda: self.program.send_signal(number))

    def test_it_says_when_the_engine_falls_silent_and_when_another_begins(self):
        self.open()
        self.wait_for(r"running")
        self.stop()
        self.wait_for(r"no word for")
        self.start()
        self.wait_for(r"another run began")
        self.type("/lift_t\r+")
        self.wait_for(r"revision 1")
        self.leave(lambda: self.type("\x03"))


if __name__ == "__main__":
    main(skipped=None if tune_test.multicast_works() else tune_test.NO_MULTICAST)

# SPDX-License-Identifier: MIT
"""What Darkroom raises, and how files are written."""

import contextlib
import difflib
import os


class Error(Exception):
    """Something was wrong: one line that says where, what, its value and what is allowed.

    text: that line. fault: "user" where a value, a file or a stack is wrong, "machine" where a Vulkan call or a file
    failed. code: "device_lost", "out_of_memory", "unsupported" or "other", for programs that go on by themselves. What
    is raised is also a ValueError (fault "user"), an OSError (fault "machine"), or a FileNotFoundError where a file that
    was named is not there.
    """

    def __new__(cls, text: str, fault: str = "user", code: str = "other"):
        if cls is Error:
            cls = RequestError if fault == "user" else MachineError
        return super().__new__(cls, text)

    def __init__(self, text: str, fault: str = "user", code: str = "other"):
        super().__init__(text)
        self.text = text
        self.fault = fault
        self.code = code

    def __str__(self):
        return self.text

    def __reduce__(self):
        return type(self), (self.text, self.fault, self.code)


class RequestError(Error, ValueError):
    """What was asked for is wrong."""


class MachineError(Error, OSError):
    """The machine failed: Vulkan, a file, a program."""


class MissingFileError(Error, FileNotFoundError):
    """A file that was named is not there."""


@contextlib.contextmanager
def of_file(path):
    """That there is no such file is an error of that kind."""
    try:
        yield
    except Error as error:
        if isinstance(error, OSError) or os.path.exists(path) or "no such file" not in error.text.lower():
            raise
        raise MissingFileError(error.text, error.fault, error.code) from None


def store(path, data):
    """Writes the whole file or none: what was there stays where it cannot be."""
    path = os.fspath(path)
    real = os.path.realpath(path)
    part = f"{real}.{os.getpid()}.part"
    try:
        try:
            with open(part, "wb") as file:
                file.write(data)
            os.replace(part, real)
        finally:
            with contextlib.suppress(FileNotFoundError):
                os.remove(part)
    except OSError as error:
        raise Error(f"{path}: {error.strerror}", "machine") from None


def nearest(wrong, names) -> str:
    """", did you mean 'x'?" or nothing."""
    found = difflib.get_close_matches(str(wrong), list(names), 1, 0.6)
    return f", did you mean '{found[0]}'?" if found else ""

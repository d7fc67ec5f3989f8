# SPDX-License-Identifier: MIT
"""What Darkroom raises."""


class Error(Exception):
    """Something was wrong: one line that says where, what, its value and what is allowed.

    text: that line. fault: "user" where a value, a file or a stack is wrong, "machine" where a Vulkan call or a file
    failed. code: "device_lost", "out_of_memory", "unsupported" or "other", for programs that go on by themselves.
    """

    def __init__(self, text: str, fault: str = "user", code: str = "other"):
        super().__init__(text)
        self.text = text
        self.fault = fault
        self.code = code

    def __reduce__(self):
        return Error, (self.text, self.fault, self.code)

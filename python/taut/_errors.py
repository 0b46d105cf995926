# SPDX-License-Identifier: GPL-3.0-or-later
"""The exceptions. A path that is not proved is not an error: it has a verdict."""


class InputError(ValueError):
    """A case, path, certificate, key or option is wrong.

    The message says where, what was seen and what was expected: "crane.yaml:12:9: load.mass: got 'NaN', expected …".
    """

    def __init__(self, message: str, file: str = "", line: int = 0, field: str = "",
                 code: str = "E1") -> None:
        super().__init__(message)
        self.file = file    #: may be empty
        self.line = line    #: from 1; 0: unknown, or the whole file
        self.field = field  #: "load.mass", or a column; may be empty
        self.code = code    #: such as "E3", which `taut explain` explains

    def __reduce__(self):
        return InputError, (str(self), self.file, self.line, self.field, self.code)


class Interrupted(RuntimeError):
    """The caller asked to stop the work."""


class UntrustworthyMachine(RuntimeError):
    """Directed rounding fails on this machine, so nothing can be proved."""


class InternalError(RuntimeError):
    """Something failed in taut itself."""

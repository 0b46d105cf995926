# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors. A path that is not proved is a verdict, not an error."""


class InputError(ValueError):
    """A case, path, certificate, key or option is wrong in some way. The message names the place, what was seen and
    what was expected: "crane.yaml:12:9: load.mass: got 'NaN', expected …"."""

    def __init__(self, message: str, file: str = "", line: int = 0, field: str = "",
                 code: str = "E1") -> None:
        super().__init__(message)
        self.file = file    #: may be empty
        self.line = line    #: from 1; 0: unknown, or the file as a whole
        self.field = field  #: "load.mass", or a column; may be empty
        self.code = code    #: "E3": `taut explain` has more about it

    def __reduce__(self):
        return InputError, (str(self), self.file, self.line, self.field, self.code)


class Interrupted(RuntimeError):
    """The work was asked to stop."""


class UntrustworthyMachine(RuntimeError):
    """This machine does not round as told: nothing can be proved on it."""


class InternalError(RuntimeError):
    """Something failed in taut itself."""

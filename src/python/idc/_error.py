"""The exception of this package."""

from __future__ import annotations


class Error(ValueError):
    """Bad input, a job that cannot be done, or a file that cannot be written.

    The message says what was found, what was expected and what to do. Nothing half written is left behind.
    """

    message: str
    """The whole message."""
    file: str | None
    """The file that it is about; `<dict>` of a scenario that was given as one."""
    key: str | None
    """The dotted key that it is about, as in `process.force_n`."""
    line: int | None
    """Its line in the file, from 1; none of a value that no file holds."""
    column: int | None
    """Its column there, from 1."""

    def __init__(
        self,
        message: str,
        file: str | None = None,
        key: str | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.key = key
        self.line = line
        self.column = column

    # As users name it.
    __module__ = "idc"

    def __reduce__(self) -> tuple[type[Error], tuple[object, ...]]:
        return Error, (self.message, self.file, self.key, self.line, self.column)

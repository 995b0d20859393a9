"""The program `idc`: `python -m idc` is the same."""

from __future__ import annotations

import os
import shutil
import sys

from idc import _idc


def main() -> int:
    """Do what the command line asks for, in this process, and return the exit code."""
    beside = os.path.dirname(sys.executable)
    program = shutil.which("idc", path=beside) or shutil.which(sys.argv[0])
    return _idc.main(["idc", *sys.argv[1:]], program)


if __name__ == "__main__":
    sys.exit(main())

"""Where the tests of the Python package run, and what they compare with."""

import os
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
# The program as it is built apart from the package: the other route to every number.
PROGRAM = Path(os.environ.get("IDC", PROJECT / "target/release/idc"))


@pytest.fixture(autouse=True)
def in_the_project(monkeypatch):
    monkeypatch.chdir(PROJECT)


@pytest.fixture
def program():
    """Calls the program and gives its outcome."""

    def call(*arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)

    return call

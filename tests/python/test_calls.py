"""Errors, progress, interruption, and the program in the process of Python."""

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import pytest

import idc

BENCH = "scenarios/paper_step.toml"


@pytest.mark.parametrize(
    ("make", "file", "key", "line"),
    [
        (lambda p: {"kind": "bench", "title": "mine", "bench": {"duration_z": 1.0}}, "<dict>", "bench.duration_z", None),
        (lambda p: p.write_text(open(BENCH).read().replace("duration_s", "duration_z").replace("../models", os.path.abspath("models"))) and p, None, "bench.duration_z", True),
        (lambda p: p.parent / "absent.toml", None, None, None),
    ],
)
def test_bad_input_is_one_error_with_its_facts_and_nothing_is_written(tmp_path, make, file, key, line):
    path = tmp_path / "mine.toml"
    out = tmp_path / "out"
    with pytest.raises(idc.Error) as refused:
        idc.run(make(path), out=out)
    error = refused.value
    assert isinstance(error, ValueError)
    assert error.key == key
    assert error.file == file if file else error.file.startswith(str(tmp_path))
    assert (error.line is not None) == bool(line)
    assert str(error) == error.message and "\n" not in error.message
    assert not out.exists()
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.message, copy.file, copy.key, copy.line) == (error.message, error.file, error.key, error.line)


def test_a_line_is_that_of_the_program(program, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(open(BENCH).read().replace("duration_s", "duration_z"))
    printed = json.loads(program("run", path, "--json").stderr)["error"]
    with pytest.raises(idc.Error) as refused:
        idc.run(path)
    assert (refused.value.message, refused.value.line, refused.value.column) == (printed["message"], printed["line"], printed["column"])


@pytest.mark.parametrize("value", [object(), {"a": 1}, None])
def test_a_value_that_is_none_is_refused_by_its_key(value):
    with pytest.raises(idc.Error) as refused:
        idc.run(BENCH, set={"bench.duration_s": value})
    assert refused.value.key == "bench.duration_s"


def test_progress_is_called_to_the_end_and_its_exception_ends_the_work(tmp_path):
    calls = []
    idc.run("scenarios/plate_edge_ideal.toml", progress=lambda done, total: calls.append((done, total)))
    assert calls == sorted(calls) and calls[-1][0] == calls[-1][1]

    class Enough(Exception):
        pass

    def refuse(done, total):
        raise Enough

    out = tmp_path / "out"
    with pytest.raises(Enough):
        idc.run("scenarios/plate_edge_ideal.toml", progress=refuse, out=out)
    assert not out.exists() or list(out.iterdir()) == []
    with pytest.raises(Enough):
        idc.vary(BENCH, {"simulation.seed": range(1, 500)}, progress=refuse)


def test_a_bar_is_taken_for_the_progress():
    tqdm = pytest.importorskip("tqdm")
    with tqdm.tqdm(disable=False, file=open(os.devnull, "w")) as bar:
        idc.run(BENCH, set={"bench.duration_s": 2.0}, progress=bar)
    assert bar.n == bar.total > 0


def test_ctrl_c_ends_a_call():
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    begin = time.monotonic()
    # A shell lets what it starts in the background ignore Ctrl-C, and Python leaves that so.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            idc.vary(BENCH, {"simulation.seed": range(1, 2_000)}, jobs=1)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - begin < 20.0


def test_other_threads_go_on_meanwhile():
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begin = time.monotonic()
    idc.run("scenarios/plate_edge_ideal.toml")
    seconds = time.monotonic() - begin
    before, _ = counted, done.set()
    thread.join()
    assert before > 50 * seconds


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "idc", *map(str, arguments)], capture_output=True, text=True, check=False)


def test_the_program_in_python_ends_with_the_same_codes(program, tmp_path):
    short = "--set=bench.duration_s=2.0"
    for arguments in (
        ["run", BENCH, short, "--quiet", "--force", "--out", tmp_path / "a"],
        ["run", BENCH, short, "--set=expect.stroke_max_mm={ max = 1 }", "--quiet", "--force", "--out", tmp_path / "b"],
        ["run", BENCH, "--set=bench.duration_z=2.0", "--quiet"],
        ["no_command"],
        ["--version"],
    ):
        own, other = command(*arguments), program(*arguments)
        assert own.returncode == other.returncode, (arguments, own.stderr)
        if arguments != ["--version"]:
            assert (own.stdout, own.stderr) == (other.stdout, other.stderr)


def test_ctrl_c_ends_the_program_in_python_as_it_ends_the_program(tmp_path):
    arguments = [sys.executable, "-m", "idc", "vary", BENCH, "--set=simulation.seed=1..5000", "--quiet", "--out", tmp_path / "v"]
    process = subprocess.Popen([*map(str, arguments)], stderr=subprocess.PIPE, text=True)
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    _, words = process.communicate(timeout=30)
    assert process.returncode == -signal.SIGINT
    assert "interrupted: " in words and "--resume" in words


@pytest.mark.parametrize(
    ("limits", "words"), [({"limit_s": -1.0}, "limit_s is -1.0"), ({"effort": 0}, "effort is 0"), ({"effort": 1, "limit_s": 1.0}, "one of the two")]
)
def test_limits_that_are_none_are_refused(limits, words):
    with pytest.raises(idc.Error, match=words):
        idc.diagnose("assets/proof/cases/case-03", **limits)

#!/usr/bin/env python3
"""Mutants: small faults of the source, drawn by a seed, and the tests that fail by them.

`cargo mutants --list` names every mutant of the source; a number of them is drawn, as many from each part. A build for each would take a day, so that all are put into
ONE copy of the source, each behind `crate::mutant::on(n)`, which is true where the environment says IDC_MUTANT=n: programs that tests start take it over. A test is run once
without a mutant and notes which of them it comes by; a mutant is then given to those tests alone, the fastest first, until one fails. What no test comes by survives.

    cargo install cargo-mutants
    python3 -m venv build/venv && build/venv/bin/pip install tree-sitter tree-sitter-rust
    build/venv/bin/python tests/studies/mutants.py --work build/mutants [--count 300] [--seed 1] [--jobs 2]

Resumes where it stopped: what is in WORK/results.jsonl is not done again. `--table` writes what survived as Markdown.
Left out: mutants that do not compile, and those that overlap one that was drawn before; in their place the next one is drawn. A test that takes longer than ten times
its own time, and 20 s, has noticed the mutant (timeouts are counted apart, as cargo mutants does).
"""

import argparse
import concurrent.futures
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import tree_sitter_rust
from tree_sitter import Language, Parser

PARTS = ["physics", "device", "effects", "metrics", "diagnosis", "removal", "import", "tasks", "fleet"]
PROFILE = """[profile.release]
incremental = true
[profile.release.package.idc-cell]
opt-level = 1
codegen-units = 128
"""
MODULE = """//! Mutants of a study, each off unless the environment names it.

use std::io::Write as _;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

static WANTED: LazyLock<u32> =
    LazyLock::new(|| std::env::var("IDC_MUTANT").ok().and_then(|n| n.parse().ok()).unwrap_or(0));
static NOTED: LazyLock<Option<String>> = LazyLock::new(|| std::env::var("IDC_MUTANTS_MET").ok());
static MET: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];
const COUNT: usize = 2000;

#[doc(hidden)]
#[must_use]
pub fn on(n: u32) -> bool {
    if let Some(file) = &*NOTED
        && !MET[n as usize].swap(true, Ordering::Relaxed)
        && let Ok(mut file) = std::fs::OpenOptions::new().create(true).append(true).open(file)
    {
        let _ = file.write_all(format!("{n}\\n").as_bytes());
    }
    *WANTED == n
}
"""
RUST = Parser(Language(tree_sitter_rust.language()))
# Tests of the text of the source, which the copy does not keep.
OF_THE_TEXT = re.compile(r"^(source|functions|layers|imports|terms|documents|help|pointed|manual|schemas|scenario_comments|paper_page|examples)(::|$)")


def offset(text, place):
    """Byte of a line and column, both from one, columns in characters."""
    lines = text.split("\n")
    before = sum(len(line.encode()) + 1 for line in lines[: place["line"] - 1])
    return before + len(lines[place["line"] - 1][: place["column"] - 1].encode())


class Edit:
    """A mutant as a replacement of bytes of one file, or nothing where the form is not known."""

    def __init__(self, number, mutant, text, tree):
        self.number, self.mutant = number, mutant
        start, end = (offset(text, mutant["span"][side]) for side in ("start", "end"))
        on = f"crate::mutant::on({number})"
        raw = text.encode()
        self.parts = None
        node = tree.root_node.descendant_for_byte_range(start, max(start, end - 1))
        genre = mutant["genre"]
        if genre == "FnValue":
            replacement = mutant["replacement"]
            self.span, self.parts = (start, start), f"if {on} {{ return {replacement}; }} "
        elif genre in ("BinaryOperator", "UnaryOperator"):
            kinds = ("binary_expression", "compound_assignment_expr") if genre == "BinaryOperator" else ("unary_expression",)
            while node is not None and node.type not in kinds:
                node = node.parent
            if node is None:
                return
            self.span = (node.start_byte, node.end_byte)
            if genre == "UnaryOperator":
                inner = raw[end : node.end_byte].decode()
                self.parts = f"(if {on} {{ {inner} }} else {{ {raw[node.start_byte:node.end_byte].decode()} }})"
                return
            left = raw[node.start_byte : start].decode()
            right = raw[end : node.end_byte].decode()
            operator, other = raw[start:end].decode(), mutant["replacement"]
            if node.type == "compound_assignment_expr":
                self.parts = f"if {on} {{ {left} {other} {right} }} else {{ {left} {operator} {right} }}"
            else:
                self.parts = f"(if {on} {{ ({left}) {other} ({right}) }} else {{ {left} {operator} {right} }})"
        elif genre == "MatchArmGuard":
            value = mutant["replacement"]
            self.span = (start, end)
            self.parts = f"(if {on} {{ {value} }} else {{ {raw[start:end].decode()} }})"
        elif genre == "MatchArm":
            while node is not None and node.type != "match_arm":
                node = node.parent
            if node is None:
                return
            pattern = node.child_by_field_name("pattern")
            condition = pattern.child_by_field_name("condition")
            if condition is None:
                self.span, self.parts = (pattern.end_byte, pattern.end_byte), f" if !{on}"
            elif condition.type != "let_condition" and condition.type != "let_chain":
                self.span = (condition.start_byte, condition.end_byte)
                self.parts = f"!{on} && ({raw[condition.start_byte:condition.end_byte].decode()})"

    def overlaps(self, other):
        if self.mutant["file"] != other.mutant["file"]:
            return False
        (a, b), (c, d) = self.span, other.span
        return a < d and c < b or (a, b) == (c, d)


def draw(source, count, seed):
    listed = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=source, capture_output=True, text=True, check=True)
    by_part = {part: [] for part in PARTS}
    for mutant in json.loads(listed.stdout):
        part = mutant["file"].split("/")[1].removesuffix(".rs")
        if part in by_part:
            del mutant["diff"]
            by_part[part].append(mutant)
    order = {}
    for part, mutants in by_part.items():
        mutants.sort(key=lambda m: m["name"])
        random.Random(f"{seed} {part}").shuffle(mutants)
        order[part] = mutants
    each = [count // len(PARTS) + (place < count % len(PARTS)) for place in range(len(PARTS))]
    return order, dict(zip(PARTS, each))


def prepare(source, work, count, seed):
    """Copies the source, puts mutants in until as many as asked for compile; returns them."""
    copy = work / "source"
    order, wanted = draw(source, count, seed)
    texts, trees = {}, {}
    refused, number = set(), 0
    taken = {part: [] for part in PARTS}
    place = dict.fromkeys(PARTS, 0)
    while True:
        for part in PARTS:
            while len(taken[part]) < wanted[part] and place[part] < len(order[part]):
                mutant = order[part][place[part]]
                place[part] += 1
                file = mutant["file"]
                if file not in texts:
                    texts[file] = (source / file).read_text()
                    trees[file] = RUST.parse(texts[file].encode())
                number += 1
                edit = Edit(number, mutant, texts[file], trees[file])
                others = (other for part in PARTS for other in taken[part])
                if edit.parts is not None and not any(edit.overlaps(other) for other in others):
                    taken[part].append(edit)
        edits = [edit for part in PARTS for edit in taken[part]]
        write(source, copy, texts, edits)
        wrong = unviable(copy, edits)
        if not wrong:
            return copy, edits, len(refused)
        print(f"{len(wrong)} mutants do not compile, drawn anew", flush=True)
        refused |= wrong
        for part in PARTS:
            taken[part] = [edit for edit in taken[part] if edit.number not in wrong]


def write(source, copy, texts, edits):
    if not copy.exists():
        kept = shutil.ignore_patterns("target", ".git", "build", "mutants")
        shutil.copytree(source, copy, symlinks=True, ignore=kept)
        (copy / "src/mutant.rs").write_text(MODULE)
        library = copy / "src/lib.rs"
        text = library.read_text()
        first = re.search(r"^(pub )?mod ", text, re.M).start()
        library.write_text(text[:first] + "#[doc(hidden)]\npub mod mutant;\n" + text[first:])
    for file in texts:
        raw = texts[file].encode()
        own = sorted((e for e in edits if e.mutant["file"] == file), key=lambda e: e.span, reverse=True)
        for edit in own:
            raw = raw[: edit.span[0]] + edit.parts.encode() + raw[edit.span[1] :]
        path = copy / file
        if path.read_bytes() != raw:
            path.write_bytes(raw)
    places = {}
    for file in texts:
        text = (copy / file).read_text()
        for match in re.finditer(r"mutant::on\((\d+)\)", text):
            line = text.count("\n", 0, match.start()) + 1
            places.setdefault(int(match.group(1)), []).append((file, line))
    for edit in edits:
        edit.places = places.get(edit.number, [])


def unviable(copy, edits):
    """Numbers of mutants at which the compiler refuses the copy."""
    command = ["cargo", "check", "--release", "--lib", "--message-format=json", "--config", str(copy.parent / "quick.toml")]
    (copy.parent / "quick.toml").write_text(PROFILE)
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True)
    wrong = set()
    for line in done.stdout.splitlines():
        message = json.loads(line).get("message") or {}
        if message.get("level") != "error":
            continue
        for span in message["spans"] + [s for child in message.get("children", []) for s in child["spans"]]:
            for edit in edits:
                for file, at in edit.places:
                    if file == span["file_name"] and span["line_start"] <= at <= span["line_end"]:
                        wrong.add(edit.number)
        if message["spans"] and not wrong:
            # Elsewhere in a function that has one.
            span = message["spans"][0]
            near = [e for e in edits if e.mutant["file"] == span["file_name"]]
            near.sort(key=lambda e: min(abs(at - span["line_start"]) for _, at in e.places))
            wrong |= {e.number for e in near[:1]}
    if done.returncode and not wrong:
        sys.exit(f"the copy does not compile, and no mutant is to blame:\n{done.stderr[-3000:]}")
    return wrong


def build(copy, jobs):
    """Builds tests and program; returns the test programs by name."""
    config = str(copy.parent / "quick.toml")
    command = ["cargo", "test", "--release", "--no-run", "--lib", "--test", "cell", "--message-format=json", "--config", config]
    done = subprocess.run(command, cwd=copy, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit("the tests do not build")
    programs = {}
    for line in done.stdout.splitlines():
        artifact = json.loads(line)
        if artifact.get("executable") and artifact.get("profile", {}).get("test"):
            programs[artifact["target"]["name"]] = artifact["executable"]
    return programs


def run(copy, program, test, limit, **environment):
    """Whether a test passes, or nothing where it takes too long, and its time [s]."""
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        own = os.environ | {"TMPDIR": folder} | environment
        child = subprocess.Popen(
            [program, "--exact", test, "--test-threads=1"], cwd=copy, env=own, start_new_session=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        try:
            passed = child.wait(limit) == 0
        except subprocess.TimeoutExpired:
            passed = None
        if passed is None:
            os.killpg(child.pid, signal.SIGKILL)
            child.wait()
    return passed, time.monotonic() - started


class Progress:
    def __init__(self, what, count):
        self.what, self.count, self.done, self.started = what, count, 0, time.monotonic()

    def step(self):
        self.done += 1
        if self.done % 25 == 0 or self.done == self.count:
            left = (time.monotonic() - self.started) / self.done * (self.count - self.done)
            print(f"{self.what}: {self.done} of {self.count}, {left / 60:.0f} min left", flush=True)


def meet(copy, programs, work, jobs, longest):
    """Runs each test once; returns for each its time and the mutants that it comes by."""
    kept = work / "tests.jsonl"
    known = {}
    if kept.exists():
        known = {tuple(row["test"]): row for row in map(json.loads, kept.read_text().splitlines())}
    tests = []
    for name, program in programs.items():
        listed = subprocess.run([program, "--list"], cwd=copy, capture_output=True, text=True).stdout
        for line in listed.splitlines():
            if line.endswith(": test") and not (name == "cell" and OF_THE_TEXT.match(line)):
                tests.append((name, line.removesuffix(": test")))
    left = [test for test in tests if test not in known]
    progress = Progress("tests", len(left))

    def one(test):
        with tempfile.NamedTemporaryFile("r") as met:
            passed, took = run(copy, programs[test[0]], test[1], longest, IDC_MUTANTS_MET=met.name)
            numbers = sorted({int(n) for n in met.read().split()})
        return {"test": list(test), "passed": passed, "s": round(took, 3), "met": numbers}

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool, kept.open("a") as file:
        for row in pool.map(one, left):
            known[tuple(row["test"])] = row
            print(json.dumps(row), file=file, flush=True)
            progress.step()
    rows = [known[test] for test in tests]
    for row in rows:
        if row["passed"] is False:
            print(f"left out, fails without a mutant: {' '.join(row['test'])}")
        if row["passed"] is None:
            print(f"left out, takes longer than {longest} s: {' '.join(row['test'])}")
    return [row for row in rows if row["passed"]]


def judge(copy, programs, rows, edits, work, jobs, budget):
    kept = work / "results.jsonl"
    known = {}
    if kept.exists():
        known = {row["name"]: row for row in map(json.loads, kept.read_text().splitlines())}
    left = [edit for edit in edits if edit.mutant["name"] not in known]
    progress = Progress("mutants", len(left))

    def one(edit):
        met = sorted((row for row in rows if edit.number in row["met"]), key=lambda row: row["s"])
        result = {"name": edit.mutant["name"], "part": edit.mutant["file"].split("/")[1], "met": len(met), "tried": 0, "by": None, "outcome": "missed"}
        spent = 0.0
        for row in met:
            limit = max(20.0, 10.0 * row["s"])
            passed, took = run(copy, programs[row["test"][0]], row["test"][1], limit, IDC_MUTANT=str(edit.number))
            result["tried"] += 1
            spent += took
            if not passed:
                result |= {"outcome": "caught" if passed is False else "timeout", "by": row["test"][1]}
                break
            if spent > budget:
                result["outcome"] = "missed within the time"
                break
        return result | {"s": round(spent, 1)}

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool, kept.open("a") as file:
        for row in pool.map(one, left):
            known[row["name"]] = row
            print(json.dumps(row), file=file, flush=True)
            progress.step()
    return [known[edit.mutant["name"]] for edit in edits]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--longest", type=float, default=30.0, help="tests that take longer are left out [s]")
    parser.add_argument("--budget", type=float, default=300.0, help="time for one mutant [s]")
    asked = parser.parse_args()
    source = Path(__file__).resolve().parents[2]
    work = asked.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    copy, edits, refused = prepare(source, work, asked.count, asked.seed)
    print(f"{len(edits)} mutants, {refused} did not compile", flush=True)
    programs = build(copy, asked.jobs)
    rows = meet(copy, programs, work, asked.jobs, asked.longest)
    results = judge(copy, programs, rows, edits, work, asked.jobs, asked.budget)
    caught = missed = timeouts = 0
    for part in PARTS:
        own = [row for row in results if row["part"] == part]
        of = [sum(row["outcome"].startswith(kind) for row in own) for kind in ("caught", "missed", "timeout")]
        caught, missed, timeouts = caught + of[0], missed + of[1], timeouts + of[2]
        print(f"{part:10} caught {of[0]:3} of {of[0] + of[1]:3}, timeouts {of[2]}")
    share = 100.0 * caught / max(caught + missed, 1)
    print(f"caught {caught} of {caught + missed} ({share:.1f} %), timeouts {timeouts}, did not compile {refused}")
    for row in results:
        if row["outcome"].startswith("missed"):
            print(f"  {row['outcome']}: {row['name']} (met by {row['met']} tests)")


if __name__ == "__main__":
    main()

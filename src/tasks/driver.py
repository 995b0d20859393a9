"""Lets Dask's workers do the tasks of a plan; `idc` runs this and reads what it prints, a JSON object a line.

What to do is the first line of standard input. When standard input ends, whoever asked is gone, and so is this.
"""

import asyncio
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import uuid
from collections import deque
from pathlib import Path

RESULTS = (0, 1, 2, 3)
TRIES = 3
# Time that a batch takes, about, and most tasks of one: a worker that is lost loses no more.
LONG = 1.0
MOST = 64


def say(**words):
    print(json.dumps(words), flush=True)


def version_here(program, mark):
    """What a worker is asked before it is given anything: the version of its program, and whether it sees the driver's folder."""
    try:
        done = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=60)
        version = done.stdout.strip() or done.stderr.strip()
    except OSError as error:
        version = f"cannot run {program}: {error.strerror}"
    return version, os.path.exists(mark)


def perform(program, plan, names):
    """Does tasks where plan and store can be reached. A signal is an error, and so tried again; an exit code is an answer."""
    quiet = {**os.environ, "RAYON_NUM_THREADS": "1"}
    start = time.monotonic()
    done = subprocess.run([program, "task", plan, *names], capture_output=True, text=True, env=quiet)
    if done.returncode < 0:
        raise RuntimeError(f"ended by signal {-done.returncode}")
    return done.returncode, done.stderr.strip(), time.monotonic() - start


def perform_carried(program, shared, plan, head, batch, files, before):
    """The same where nothing is shared: files come with the tasks, their folders are the answer."""
    names = [json.loads(line)["id"] for line in batch]
    with tempfile.TemporaryDirectory(prefix="idc-task-") as root:
        place = lambda path: Path(root + os.path.abspath(path))
        here = place(plan)
        here.parent.mkdir(parents=True, exist_ok=True)
        here.write_text(head + "".join(batch))
        results = here.parent / "tasks"
        for path, content in {**shared, **files}.items():
            place(path).parent.mkdir(parents=True, exist_ok=True)
            place(path).write_bytes(content)
        for name, content in before.items():
            for path, text in content.items():
                (results / name).mkdir(parents=True, exist_ok=True)
                (results / name / path).write_bytes(text)
        answer = perform(program, str(here), names)
        folders = {name: results / name for name in names if (results / name).is_dir()}
        return *answer, {name: content_of(folder) for name, folder in folders.items()}


def content_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


class Work:
    def __init__(self, order, client):
        self.client = client
        self.program = order["program"]
        self.plan = order["plan"]
        self.folder = Path(self.plan).parent
        self.tasks = self.folder / "tasks"
        self.carry = order["carry"]
        self.lines = open(self.plan)
        self.head = next(self.lines)
        self.waiting = {}
        self.lost = set()
        self.ready = deque()
        self.halves = deque()
        self.seconds = None
        self.done = 0
        self.shared = None

    def stands(self, name):
        return (self.tasks / name / "result.json").is_file()

    def read(self, files):
        paths = [os.path.normpath(self.folder / file["file"]) for file in files]
        return {path: Path(path).read_bytes() for path in paths}

    def next(self):
        """The next task that is not done and can be begun, with its line."""
        if self.ready:
            return self.ready.popleft()
        for line in self.lines:
            task = json.loads(line)
            if self.stands(task["id"]):
                self.done += 1
                say(done=self.done)
            elif task.get("after") in self.lost:
                self.fail(task["id"], f"the task that it begins with failed: {task['after']}")
            elif "after" in task and not self.stands(task["after"]):
                self.waiting.setdefault(task["after"], []).append((task, line))
            else:
                return task, line
        return None

    def batch(self):
        """Tasks that one process does one after the other: as many as take a while together, by the time of those before."""
        if self.halves:
            return self.halves.popleft()
        size = min(max(int(LONG / self.seconds), 1), MOST) if self.seconds else 1
        tasks = []
        while len(tasks) < size and (task := self.next()):
            tasks.append(task)
        return tasks

    async def submit(self, batch):
        # A batch that is lost is halved: only a task by itself is worth more tries.
        options = {"retries": TRIES - 1 if len(batch) == 1 else 0, "pure": False}
        if not self.carry:
            names = [task["id"] for task, _ in batch]
            return self.client.submit(perform, self.program, self.plan, names, **options)
        if self.shared is None:
            files = self.read(json.loads(self.head)["files"])
            self.shared = await self.client.scatter(files, broadcast=True)
        before = {task["after"]: content_of(self.tasks / task["after"]) for task, _ in batch if "after" in task}
        files = self.read([file for task, _ in batch for file in task.get("files", [])])
        lines = [line for _, line in batch]
        return self.client.submit(
            perform_carried, self.program, self.shared, self.plan, self.head, lines, files, before, **options
        )

    def keep(self, name, files):
        """Puts a folder that came back in its place, whole."""
        if "result.json" not in files or self.stands(name):
            return
        unfinished = self.tasks / f".unfinished-{uuid.uuid4().hex}"
        unfinished.mkdir()
        try:
            for path, content in files.items():
                (unfinished / path).write_bytes(content)
            unfinished.rename(self.tasks / name)
        except OSError:
            shutil.rmtree(unfinished, ignore_errors=True)
            raise

    def fail(self, name, why):
        say(failed=name, why=why)
        self.lost.add(name)
        for task, _ in self.waiting.pop(name, []):
            self.fail(task["id"], why)

    async def finish(self, batch, future):
        try:
            code, message, seconds, *results = await future
            self.seconds = seconds / len(batch)
        except Exception as error:
            code, message, results = None, f"{type(error).__name__}: {error}".splitlines()[0], []
        for name, files in (results[0] if results else {}).items():
            self.keep(name, files)
        # A file system that is shared may show a folder late.
        for _ in range(20):
            if code not in RESULTS or all(self.stands(task["id"]) for task, _ in batch):
                break
            await asyncio.sleep(0.1)
        left = []
        for task, line in batch:
            # Also a worker that was lost may have put its result in place before.
            if self.stands(task["id"]):
                self.done += 1
                self.ready.extend(self.waiting.pop(task["id"], []))
            elif len(batch) > 1:
                left.append((task, line))
            else:
                self.fail(task["id"], message.splitlines()[-1] if message else f"exit code {code}")
        # Which of them it was, and why, is found by halves.
        middle = (len(left) + 1) // 2
        self.halves.extend(half for half in (left[:middle], left[middle:]) if half)
        say(done=self.done)


def refuse(reason):
    say(refused=reason)
    raise SystemExit(0)


async def check(client, order):
    """Refuses workers that would do something else, each by its name."""
    mark = os.path.join(os.path.dirname(order["plan"]), f".unfinished-seen-{uuid.uuid4().hex}")
    Path(mark).touch()
    try:
        workers = await client.run(version_here, order["program"], mark)
    finally:
        os.remove(mark)
    for worker, (version, sees) in sorted(workers.items()):
        if version != order["version"]:
            refuse(f"the worker {worker} has `{version.partition(chr(10))[0]}`, expected {order['version']} on every worker, at {order['program']} (--program names another place)")
        if not sees and not order["carry"]:
            refuse(
                f"the worker {worker} does not see {os.path.dirname(order['plan'])}; expected a folder that all workers share (--out), or --carry, "
                "which sends files and results through Dask"
            )


async def drive(order):
    import dask
    from distributed import Client, LocalCluster

    if order["address"].startswith("tls://") and not dask.config.get("distributed.comm.tls.ca-file", None):
        refuse(
            "the address is tls://, and Dask has no certificate here; expected distributed.comm.tls.ca-file, .client.cert and .client.key in its configuration "
            "or environment (docs/CLUSTER.md)"
        )

    if order["workers"]:
        cluster = LocalCluster(
            n_workers=order["workers"], threads_per_worker=1, processes=True, asynchronous=True, dashboard_address=order["dashboard"]
        )
    else:
        cluster = order["address"]
    if order["workers"]:
        async with cluster, Client(cluster, asynchronous=True) as client:
            await work_through(client, order)
    else:
        async with Client(cluster, asynchronous=True, timeout=20) as client:
            await work_through(client, order)


async def work_through(client, order):
    say(dashboard=client.dashboard_link)
    await client.wait_for_workers(1, timeout=120)
    await check(client, order)
    work = Work(order, client)
    running = {}
    threads = sum(info["nthreads"] for info in client.scheduler_info(n_workers=-1)["workers"].values())
    # As many as keep every worker busy: what a scheduler holds does not grow with the plan.
    window = max(4, 2 * threads)
    while True:
        while len(running) < window and (batch := work.batch()):
            future = await work.submit(batch)
            running[asyncio.ensure_future(work.finish(batch, future))] = future
        if not running:
            return
        finished, _ = await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)
        for one in finished:
            del running[one]
            one.result()


def end_with(parent):
    parent.read()
    os._exit(1)


def main():
    try:
        import distributed  # noqa: F401
    except ImportError as error:
        say(python=str(error))
        return
    order = json.loads(sys.stdin.readline())
    threading.Thread(target=end_with, args=(sys.stdin,), daemon=True).start()
    try:
        asyncio.run(drive(order))
    except (OSError, asyncio.TimeoutError) as error:
        say(refused=f"{error or type(error).__name__}")


if __name__ == "__main__":
    main()

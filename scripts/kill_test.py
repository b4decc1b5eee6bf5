#!/usr/bin/env python3
"""Breaks runs off in every way that machines know, and sees that what is left can be used.

    scripts/kill_test.py PROGRAM [--times 200] [--seed 1] [--keep DIR]

--times N  kills with SIGKILL on one rank and on two, N at random moments each, and a quarter of it of one rank of two
After every one: each file that is there can be read, at most the load step that ran is lost, `--resume` goes on to the bits (on two ranks: the digits) of the run
that nobody broke off, and leaves nothing behind. Then SIGHUP, a full disk (a small tmpfs; needs the right to mount), memory that runs out in the factorisation, a
directory of results that is deleted, and a standard output that is closed, full or a pipe that ends: the exit codes are those of docs/problem-file.md.
"""
import argparse
import csv
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml
from pathlib import Path

PROBLEM = """
[mesh]
generate = "rectangle"
size = [2, 1]
cells = [CELLS]
[fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 1
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.1
young = 1.2
poisson = 0
mu_c = 0.5
L_c = 0.01
[[loads]]
type = "traction"
field = "m"
on = "right"
value = [0, 0, "4e-6*t"]
[[dirichlet]]
on = "left"
support = "clamped"
[continuation]
steps = 12
[[probes]]
name = "tip"
field = "m"
at = [2, 0.5, 0]
[output]
report = false
"""
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1")
EXIT_CODES = {0, 1, 2, 3, 130}


class Broken(Exception):
    pass


def require(condition, sentence):
    if not condition:
        raise Broken(sentence)


class Shop:
    """A directory with a problem, its unbroken run, and a program."""

    def __init__(self, program, directory, cells):
        self.program, self.directory = program, directory
        self.problem = directory / "problem.toml"
        self.problem.write_text(PROBLEM.replace("CELLS", cells))

    def command(self, results, ranks=1, *more):
        return [self.program, "run", str(self.problem), "-q", "-o", str(results), *(["-n", str(ranks)] if ranks > 1 else []), *more]

    def start(self, results, ranks=1, *more, **options):
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True, "env": ENVIRONMENT, "start_new_session": True} | options
        return subprocess.Popen(self.command(results, ranks, *more), **options)

    def run(self, results, ranks=1, *more, **options):
        process = self.start(results, ranks, *more, **options)
        _, err = process.communicate(timeout=300)
        return process.returncode, err or ""


def energies(results):
    file = results / "load_steps.jsonl"
    return [json.loads(line)["energy"] for line in file.read_text().splitlines()] if file.exists() else []


def read_everything(results):
    """Every file as its readers take it."""
    for file in results.iterdir():
        if file.name.startswith("."):
            continue
        if file.suffix == ".json":
            json.loads(file.read_text())
        elif file.suffix == ".jsonl":
            text = file.read_text()
            require(text == "" or text.endswith("\n"), f"{file.name} ends in half a row")
            for line in text.splitlines():
                json.loads(line)
        elif file.suffix == ".csv":
            text = file.read_text()
            require(text.endswith("\n"), f"{file.name} ends in half a row")
            rows = list(csv.reader(text.splitlines()))
            require(all(len(row) == len(rows[0]) for row in rows), f"{file.name} has rows of several lengths")
        elif file.suffix in (".vtu", ".pvd"):
            xml.parse(file)
    collection = results / "solution.pvd"
    if collection.exists():
        for entry in xml.parse(collection).iter("DataSet"):
            require((results / entry.get("file")).exists(), f"solution.pvd names {entry.get('file')}, which is not there")


def ranks_of(process):
    """The processes of the program below this one."""
    below, found = {process.pid}, []
    for _ in range(4):
        for status in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = status.read_text().rsplit(")", 1)
            except OSError:
                continue
            pid, parent = int(status.parent.name), int(fields[1].split()[1])
            if parent in below and pid not in below:
                below.add(pid)
                if fields[0].endswith("(karcher"):
                    found.append(pid)
    return found


def wait_for_end(session):
    """Until no process of a session is left: ranks notice the death of their launcher."""
    for _ in range(300):
        alive = False
        for status in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = status.read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            alive = alive or (int(fields[3]) == session and fields[0] != "Z")
        if not alive:
            return
        time.sleep(0.1)
    raise Broken("ranks go on 30 s after their launcher was killed")


def resumes(shop, results, ranks, whole, steps_before):
    """Goes on to the end of the unbroken run, and leaves nothing behind."""
    more = ["--resume"] if (results / "checkpoint.bin").exists() else []
    code, err = shop.run(results, ranks, *more)
    require(code == 0, f"the run that goes on ends with {code}: {err.strip()}")
    end = energies(results)
    require(len(end) == len(whole), f"{len(end)} load steps after all, not {len(whole)}")
    # The last row may be of a load step that the checkpoint does not count yet; it is made again.
    require(not more or end[: max(0, len(steps_before) - 1)] == steps_before[:-1], "finished load steps have changed")
    for a, b in zip(end, whole):
        require(a == b if ranks == 1 else abs(a - b) <= 1e-9 * abs(b), f"the energy {a!r} is not that of the unbroken run, {b!r}")
    read_everything(results)
    left = [f.name for f in results.iterdir() if f.name.endswith(".part") or f.name == ".lock"]
    require(not left, f"left behind: {', '.join(left)}")


def kill_at(shop, results, moment, ranks, one_rank, whole):
    shutil.rmtree(results, ignore_errors=True)
    process = shop.start(results, ranks)
    time.sleep(moment)
    victims = ranks_of(process) if one_rank else []
    if one_rank:
        if victims:
            try:
                os.kill(random.choice(victims), signal.SIGKILL)
            except ProcessLookupError:
                pass
        _, err = process.communicate(timeout=60)
        require(process.returncode in EXIT_CODES, f"exit code {process.returncode} after one rank was killed")
        if victims and process.returncode != 0:
            require(process.returncode == 3 and err.strip(), f"a killed rank is told by exit code {process.returncode} and {err.strip()!r}")
    else:
        os.killpg(process.pid, signal.SIGKILL) if random.random() < 0.5 else process.kill()
        process.wait()
    wait_for_end(process.pid)
    if not results.exists():
        return 0
    read_everything(results)
    before = energies(results)
    resumes(shop, results, ranks, whole, before)
    return len(before)


def kills(shop, times):
    results = shop.directory / "results"
    for ranks, one_rank, count in ((1, False, times), (2, False, times), (2, True, max(1, times // 4))):
        shutil.rmtree(results, ignore_errors=True)
        begin = time.monotonic()
        code, err = shop.run(results, ranks)
        length = time.monotonic() - begin
        require(code == 0, f"the unbroken run ends with {code}: {err}")
        whole = energies(results)
        reached = []
        for k in range(count):
            moment = random.uniform(0, 1.05 * length)
            try:
                reached.append(kill_at(shop, results, moment, ranks, one_rank, whole))
            except Broken as fault:
                raise Broken(f"{'one rank of ' if one_rank else ''}{ranks} rank(s), killed after {moment:.4f} s: {fault}")
        what = "one rank of two" if one_rank else f"a run on {ranks} rank{'s' if ranks > 1 else ''}"
        print(f"SIGKILL for {what}, {count} times: between 0 and {max(reached)} load steps were finished; nothing else was lost", flush=True)


def hang_up(shop, whole):
    results = shop.directory / "results"
    for ranks in (1, 2):
        shutil.rmtree(results, ignore_errors=True)
        process = shop.start(results, ranks)
        while process.poll() is None and len(energies(results)) < 2:
            time.sleep(0.005)
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=60)
        require(process.returncode in (0, 130), f"SIGHUP gives {process.returncode}")
        read_everything(results)
        resumes(shop, results, ranks, whole, energies(results))
    print("SIGHUP on one and two ranks: interrupted as by Ctrl-C, resumed", flush=True)


def disk_full(shop, whole):
    disk = shop.directory / "disk"
    disk.mkdir()
    tried = 0
    for kilobytes in (8, 24, 40, 64, 100):
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(disk)], stderr=subprocess.DEVNULL).returncode != 0:
            print("disk full: not tried, since mount is not allowed", flush=True)
            return
        try:
            results = disk / "results"
            code, err = shop.run(results)
            require(code in (0, 3), f"a disk of {kilobytes} kB gives {code}: {err}")
            require(code == 0 or "cannot be written" in err, f"a full disk is told as {err.strip()!r}")
            if results.exists():
                read_everything(results)
            subprocess.run(["mount", "-o", "remount,size=50m", str(disk)], check=True)
            if code == 3:
                resumes(shop, results, 1, whole, energies(results) if results.exists() else [])
            tried += code == 3
        finally:
            subprocess.run(["umount", str(disk)], check=True)
    require(tried >= 3, "the disks were large enough")
    print(f"disk full, {tried} sizes: exit code 3, files readable, resumed with room again", flush=True)


def memory_ends(program, directory):
    (directory / "large").mkdir()
    shop = Shop(program, directory / "large", "120, 60")
    results = shop.directory / "results"

    def limited():
        megabytes = 400
        resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))

    code, err = shop.run(results, 1, preexec_fn=limited, env=ENVIRONMENT | {"OPENBLAS_NUM_THREADS": "1"})
    require(code == 3 and "memory" in err, f"memory that runs out gives {code}: {err.strip()[-300:]!r}")
    if results.exists():
        read_everything(results)
    print("memory limit in the factorisation: exit code 3, told", flush=True)


def directory_deleted(shop):
    results = shop.directory / "results"
    shutil.rmtree(results, ignore_errors=True)
    process = shop.start(results)
    while process.poll() is None and len(energies(results)) < 2:
        time.sleep(0.005)
    shutil.rmtree(results, ignore_errors=True)
    _, err = process.communicate(timeout=60)
    require(process.returncode in (0, 3), f"a deleted directory gives {process.returncode}")
    require(process.returncode == 0 or "cannot be" in err, f"a deleted directory is told as {err.strip()!r}")
    print("directory of results deleted: exit code", process.returncode, flush=True)


def standard_output(shop):
    for name, redirection, codes in (("closed", ">&-", {0}), ("full", ">/dev/full", {0}), ("a pipe that ends", "| head -n 3 >/dev/null; exit ${PIPESTATUS[0]}", {0})):
        results = shop.directory / "results"
        shutil.rmtree(results, ignore_errors=True)
        command = " ".join(f"'{word}'" for word in shop.command(results) if word != "-q")
        done = subprocess.run(["bash", "-c", f"{command} {redirection}"], stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, timeout=120)
        require(done.returncode in codes, f"a standard output that is {name} gives {done.returncode}: {done.stderr.strip()}")
        read_everything(results)
    print("standard output closed, full, a pipe that ends: the run does not notice", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program")
    options.add_argument("--times", type=int, default=200)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--keep", type=Path, help="work there and leave everything")
    options = options.parse_args()
    random.seed(options.seed)
    directory = options.keep or Path(tempfile.mkdtemp(prefix="karcher-kill-"))
    directory.mkdir(parents=True, exist_ok=True)
    try:
        shop = Shop(str(Path(options.program).resolve()), directory, "6, 3")
        kills(shop, options.times)
        results = directory / "whole"
        require(shop.run(results)[0] == 0, "the unbroken run fails")
        whole = energies(results)
        hang_up(shop, whole)
        disk_full(shop, whole)
        memory_ends(shop.program, directory)
        directory_deleted(shop)
        standard_output(shop)
    except Broken as fault:
        print(f"kill_test: {fault}.{f' The directory is {directory}.' if options.keep else ' --keep DIR leaves the directory.'}", file=sys.stderr)
        return 1
    finally:
        if not options.keep:
            shutil.rmtree(directory, ignore_errors=True)
    print("kill_test: passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Plants faults of one line, one after the other, and tells which of them the tests catch. A fault that survives is a rule that no test checks.

    scripts/planted_faults.py --list [WORD ...]   the faults of scripts/planted_faults.toml whose file, name or meaning contains every word
    scripts/planted_faults.py [WORD ...]          plant them (all, without words); exit code 1 if one survives or does not compile
    --jobs N      faults at a time, each in a copy of the sources with a build of its own (default 1)
    --build DIR   where the copies and builds are (default: build-faults); the sources themselves are never touched
    --check       only see that the text of every fault stands in its file exactly once

A fault is caught when a test fails, crashes or does not end. Its tests are run on one rank, and if they pass there, on the numbers of ranks that `ranks` names.
"""
import argparse
import os
import queue
import shutil
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "scripts/planted_faults.toml"
KEYS = {"file", "name", "old", "new", "breaks", "tests", "ranks", "filter"}
# Room of a file -> the tests that are to catch its faults, unless the fault names others.
TESTS = {"solve": ["solve_test"], "field": ["field_test"], "assembly": ["assembly_test"], "problem": ["problem_test"]}
LONGEST_TEST = 300  # seconds


class Wrong(Exception):
    pass


def read_table():
    """All faults, checked: a fault whose text does not stand in its file exactly once is no fault."""
    faults = tomllib.loads(TABLE.read_text())["fault"]
    for number, fault in enumerate(faults, 1):
        what = f"Fault {number} ({fault.get('name', 'no name')})"
        if unknown := fault.keys() - KEYS:
            raise Wrong(f"{what} has unknown keys: {', '.join(unknown)}.")
        if missing := {"file", "name", "old", "new", "breaks"} - fault.keys():
            raise Wrong(f"{what} lacks {', '.join(sorted(missing))}.")
        path = ROOT / fault["file"]
        if not path.is_file():
            raise Wrong(f"{what}: there is no file {fault['file']}.")
        found = path.read_text().count(fault["old"])
        if found != 1:
            raise Wrong(f"{what}: its text stands in {fault['file']} {found} times, not once: {fault['old']!r}")
        if fault["old"] == fault["new"]:
            raise Wrong(f"{what} changes nothing.")
        room = [part for part in Path(fault["file"]).parts if part in TESTS]
        fault.setdefault("tests", TESTS[room[0]] if room else None)
        if not fault["tests"]:
            raise Wrong(f"{what} must say which tests are to catch it.")
        fault.setdefault("ranks", [2, 3] if fault["tests"] == ["solve_test"] else [])
    names = [f["name"] for f in faults]
    if twice := {n for n in names if names.count(n) > 1}:
        raise Wrong(f"Faults need names of their own: {', '.join(sorted(twice))}.")
    return faults


def chosen(faults, words):
    return [f for f in faults if all(any(w.lower() in f[k].lower() for k in ("file", "name", "breaks")) for w in words)]


class Copy:
    """A copy of the sources with a build of its own."""

    def __init__(self, directory, compilers):
        self.sources, self.build, self.compilers = directory / "sources", directory / "build", compilers
        self.environment = os.environ | {"CCACHE_BASEDIR": str(directory), "CCACHE_NOHASHDIR": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                                         "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                                         "OMPI_MCA_mpi_yield_when_idle": "1"}

    def renew(self):
        """The sources as they are now; files that are the same keep their times, so that little is built again."""
        listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
        wanted = {name for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
        for name in wanted:
            source, target = ROOT / name, self.sources / name
            if target.is_file() and target.read_bytes() == source.read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
            os.utime(target)
        for old in [p for p in self.sources.rglob("*") if p.is_file() and str(p.relative_to(self.sources)) not in wanted]:
            old.unlink()
        self.run(["cmake", "-S", self.sources, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1",
                  "-DKARCHER_TESTS=ON"], must=True)

    def run(self, command, must=False, seconds=None):
        """Exit code, or None after `seconds`."""
        process = subprocess.Popen(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            output, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.communicate()
            return None
        if must and process.returncode:
            raise Wrong(f"{' '.join(map(str, command))} failed:\n{output.decode(errors='replace')[-4000:]}")
        self.output = output.decode(errors="replace")
        return process.returncode

    def compile(self, tests, must=False):
        return self.run(["ninja", "-C", self.build, "-j", str(self.compilers), *tests], must) == 0

    def test(self, fault):
        """What catches the fault; None if nothing does."""
        for test in fault["tests"]:
            program = [self.build / "tests" / test, "--gtest_color=no"] + ([f"--gtest_filter={fault['filter']}"] if "filter" in fault else [])
            for ranks in [1, *fault["ranks"]]:
                where = f"{test} on {ranks} rank{'' if ranks == 1 else 's'}"
                # A test may fail on one rank alone: if that rank ended there, the others would wait for it in the next test.
                code = self.run((["mpiexec", "-n", str(ranks)] + program if ranks > 1 else program + ["--gtest_fail_fast"]), seconds=LONGEST_TEST)
                if code is None:
                    return f"{where} does not end"
                if code:
                    failed = [line.split("FAILED  ]", 1)[1].split(",")[0].split("(")[0].strip() for line in self.output.splitlines() if "FAILED  ]" in line and "." in line]
                    return failed[0] + (f" on {ranks} ranks" if ranks > 1 else "") if failed else f"{where} crashes"
        return None

    def plant(self, fault):
        """(verdict, what caught it)"""
        path = self.sources / fault["file"]
        text = path.read_text()
        path.write_text(text.replace(fault["old"], fault["new"]))
        try:
            if not self.compile(fault["tests"]):
                return "DOES NOT COMPILE", ""
            by = self.test(fault)
            return ("caught", by) if by else ("SURVIVED", "")
        finally:
            path.write_text(text)


def plant_all(faults, directory, jobs):
    todo, results, lock = queue.Queue(), [], threading.Lock()
    for fault in faults:
        todo.put(fault)
    tests = sorted({t for f in faults for t in f["tests"]})
    trouble = []

    def work(number):
        try:
            copy = Copy(directory / str(number), max(1, (os.cpu_count() or 1) // jobs))
            copy.renew()
            copy.compile(tests, must=True)
            for test, selection in sorted({(t, f.get("filter")) for f in faults for t in f["tests"]}, key=str):
                alike = [f for f in faults if test in f["tests"] and f.get("filter") == selection]
                without = {"tests": [test], "ranks": sorted({r for f in alike for r in f["ranks"]})} | ({"filter": selection} if selection else {})
                if by := copy.test(without):
                    raise Wrong(f"Without any fault, the tests fail: {by}.")
            while not trouble:
                fault = todo.get_nowait()
                begin = time.monotonic()
                verdict, by = copy.plant(fault)
                with lock:
                    results.append(verdict)
                    print(f"{verdict:8}  {fault['file']}: {fault['name']} ({time.monotonic() - begin:.0f} s){' by ' + by if by else ''}", flush=True)
        except queue.Empty:
            pass
        except Wrong as e:
            trouble.append(e)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(min(jobs, len(faults)))]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    if trouble:
        raise trouble[0]
    caught = results.count("caught")
    print(f"{caught} of {len(results)} faults are caught.")
    return caught == len(results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--build", type=Path, default=ROOT / "build-faults")
    options = parser.parse_args()
    try:
        faults = chosen(read_table(), options.words)
        if options.list:
            for fault in faults:
                print(f"{fault['file']}: {fault['name']}: {fault['breaks']}")
        if options.list or options.check:
            print(f"{len(faults)} faults.")
            return 0
        if not faults:
            raise Wrong("No fault is of that kind.")
        return 0 if plant_all(faults, options.build.resolve(), max(1, options.jobs)) else 1
    except Wrong as e:
        print(e, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())

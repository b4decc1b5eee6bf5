#!/usr/bin/env python3
"""Runs examples and compares their summaries with expected.toml. Usage: check_examples.py PROGRAM EXAMPLE..."""

import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"


def look_up(summary, path):
    """The entry "load_steps.-1.probes.tip.0" of a summary."""
    for key in path.split("."):
        summary = summary[int(key)] if isinstance(summary, list) else summary[key]
    return summary


def failures_of(program, name, run, directory):
    command = [program, "run", EXAMPLES / name / "problem.toml", "--quiet", "--output", directory]
    for override in run.get("set", []):
        command += ["--set", override]
    if "ranks" in run:
        command += ["-n", str(run["ranks"])]
    subprocess.run(command, check=False)
    summary = json.loads((Path(directory) / "summary.json").read_text())
    last = summary["load_steps"][-1]
    if summary["status"] != run["status"]:
        yield f"status is {summary['status']}, expected {run['status']}"
    if "negative_eigenvalues" in run and last["negative_eigenvalues"] != run["negative_eigenvalues"]:
        yield f"{last['negative_eigenvalues']} negative eigenvalues, expected {run['negative_eigenvalues']}"
    for value in run.get("value", []):
        found, expected = look_up(summary, value["path"]), value["value"]
        allowed = value.get("absolute", value.get("relative", 0) * abs(expected))
        print(f"  {value['path']} = {found:.12g}, expected {expected:.12g} within {allowed:.2g} ({value['source']})")
        if not abs(found - expected) <= allowed:
            yield f"{value['path']} is {found!r}, expected {expected!r} within {allowed:g}"


def main():
    program, *names = sys.argv[1:]
    failed = 0
    for name in names:
        for run in tomllib.loads((EXAMPLES / name / "expected.toml").read_text())["run"]:
            print(name, *run.get("set", []), flush=True)
            with tempfile.TemporaryDirectory() as directory:
                for failure in failures_of(program, name, run, directory):
                    print(f"  FAILED: {failure}")
                    failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Keeps documents and comments true to the files they quote and name.

A code block after a line `<!-- file: tutorials/hello_sphere.cpp -->` must be that file, letter by letter; after `<!-- lines: FILE FIRST LAST -->` it must be
the lines from the first that contains FIRST to the next that contains LAST. Relative links must lead to a file that exists. CITATION.cff names the version of
CMakeLists.txt. Every source that a document or a comment names must be there, by the end of its path ("solve/norm.hpp"); NAME stands for any.

The rows of a table after `<!-- program: doc --markdown solver -->` are what the program prints with these arguments; a test proves it where there is a program, here it
is looked at where one is named.

    scripts/check_documents.py                   report what is wrong (exit code 1)
    scripts/check_documents.py --update          write the quoted files into the blocks
    scripts/check_documents.py --update PROGRAM  the tables, too: PROGRAM is for instance build/karcher
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
QUOTE = re.compile(r"(<!-- (file|lines): (\S+)(?: \"(.*?)\" \"(.*?)\")? -->\n```\w*\n)(.*?)(^```$)", re.DOTALL | re.MULTILINE)
TABLE = re.compile(r"(<!-- program: (.*?) -->\n)((?:\|.*\n)*)")
SOURCE = re.compile(r"(?<![\w./<>*\\-])((?:[\w-]+/)*[\w-]+\.(?:hpp|cpp|ts|mjs|py))\b(?![\w/])")
CODE_BLOCK = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


def quoted(kind, name, first, last):
    """Text of the file, or of its lines from the one that contains `first` to the next one that contains `last`."""
    text = (ROOT / name).read_text()
    if kind == "file":
        return text
    lines = text.splitlines(keepends=True)
    begin = next(i for i, line in enumerate(lines) if first in line)
    end = next(i for i, line in enumerate(lines[begin:], begin) if last in line)
    return "".join(lines[begin : end + 1])


def versions_that_differ():
    """Sentences, one if CITATION.cff and the project of CMakeLists.txt have not the same version."""
    project = re.search(r"^project\(\w+ VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
    cited = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1]
    return [] if cited == project else [f"CITATION.cff: cites version {cited}, but CMakeLists.txt makes {project}."]


def files_of_project(*patterns):
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]
    names = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    return [name for name in names if (ROOT / name).is_file()]


def sources_that_are_missing():
    """Sentences, one for each name of a source in a document or a comment that no source has."""
    names = [name.removesuffix(".in") for name in files_of_project()]
    known = {name[i:] for name in names for i in [0, *(m.end() for m in re.finditer("/", name))]}
    sentences = []
    for place in files_of_project("*.md", "*.hpp", "*.cpp", "viewer/src/*.ts", "viewer/test/*.mjs"):
        text = (ROOT / place).read_text()
        if place.endswith(".md"):
            text = CODE_BLOCK.sub(lambda block: "\n" * block[0].count("\n"), text)
        for number, line in enumerate(text.splitlines(), 1):
            said = line if place.endswith(".md") else line.partition("//")[2]
            sentences += [f"{place}:{number}: names {name}, which does not exist." for name in SOURCE.findall(said) if name not in known and "NAME" not in name]
    return sentences


def main(update, program):
    wrong = versions_that_differ() + sources_that_are_missing()
    documents = [ROOT / name for name in files_of_project("*.md")]
    for document in documents:
        text = document.read_text()
        here = document.relative_to(ROOT)

        def renew(match):
            head, kind, name, first, last, body, end = match.groups()
            try:
                truth = quoted(kind, name, first, last)
            except (FileNotFoundError, StopIteration):
                wrong.append(f"{here}: quotes {name}, which is missing or has no such lines.")
                return match.group(0)
            if body != truth and not update:
                wrong.append(f"{here}: the block quoted from {name} differs from the file; `scripts/check_documents.py --update` renews it.")
            return head + truth + end

        def renew_table(match):
            head, words, table = match.groups()
            run = subprocess.run([program, *words.split()], capture_output=True, text=True)
            if run.returncode != 0:
                wrong.append(f"{here}: the program has nothing to print for `{words}`: {run.stderr.strip()}")
                return match.group(0)
            if table != run.stdout and not update:
                wrong.append(f"{here}: the table of `{words}` differs from the program's; `scripts/check_documents.py --update {program}` renews it.")
            return head + run.stdout

        renewed = QUOTE.sub(renew, text)
        if program:
            renewed = TABLE.sub(renew_table, renewed)
        if update and renewed != text:
            document.write_text(renewed)
        for link in LINK.findall(CODE_BLOCK.sub("", renewed)):
            if "://" not in link and not link.startswith("mailto:") and not (document.parent / link).exists():
                wrong.append(f"{here}: links to {link}, which does not exist.")
    print("\n".join(wrong) if wrong else f"{len(documents)} documents agree with the files they quote and link.")
    return 1 if wrong else 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    update = arguments[:1] == ["--update"]
    sys.exit(main(update, next(iter(arguments[update:]), None)))

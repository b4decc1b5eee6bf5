#!/usr/bin/env python3
"""Proves that the rooms of the code use each other only in the direction of docs/architecture.md, and that no code knows a manifold or an energy by its name.

    scripts/check_dependencies.py [ROOT]      check the tree (default: the one that holds this script); exit code 1 if something is wrong
    scripts/check_dependencies.py --self-test check that the checker finds each kind of mistake in a tree made for it
"""
import re
import sys
import tempfile
from pathlib import Path

# Room -> the rooms it uses directly; what those use it may use, too.
USES = {
    "math": [],
    "expression": ["math"],
    "manifold": ["math"],
    "interpolation": ["manifold"],
    "energy": ["manifold"],
    "mesh": ["math"],
    "field": ["mesh", "manifold"],
    "assembly": ["interpolation", "energy", "field", "expression"],
    "catalogue": ["assembly"],
    "solve": ["assembly"],
    "io": ["solve"],
    "problem": ["io", "catalogue"],
    "app": ["problem"],
    "testing": ["io"],  # laws and checks for users' own types; only tests use it
}

# The library's front door, for programs: it may use every room but app, and no file of the library may use it.
FRONT_DOOR = Path("include/karcher/karcher.hpp")

# Foreign headers that are the business of few (and of tests, which may use all). A pattern is matched against the path of the included header, a place against the path of the including file.
FOREIGN = [
    ("PETSc, MPI and MUMPS", r"(petsc.*|mpi|dmumps_c)\.h$", r"src/(solve|field)/|src/mesh/partition"),
    ("METIS", r"metis\.h$", r"src/mesh/partition"),
    ("TOML", r"toml\+\+/|toml\.hpp$", r"src/app/|src/main\.cpp"),
    ("the oracle muParser", r"muParser", r"(?!)"),
    ("the command line (CLI11)", r"CLI/", r"src/app/|src/main\.cpp"),
    ("compression and JSON", r"zlib\.h$|nlohmann/", r"(include/karcher|src)/(io|app)/|src/main\.cpp"),
    ("the oracle ADOL-C", r"adolc/", r"bench/"),
    ("GoogleTest", r"gtest/|gmock/", r"include/karcher/testing/"),
    ("Google Benchmark", r"benchmark/", r"bench/"),
]

# A name is for people: it stands where a manifold or an energy is entered, and code asks the type or ManifoldOps instead. Where names are entered (the folder, and
# the text around them), by kind. Types of loads are common words, so their ending is looked for instead.
ENTERED = {
    "manifold": [(r"include/karcher/manifold/", r"string_view name\s*=([^;]*);")],
    "energy": [(r"(include/karcher|src)/energy/", r"\btype\s*=\s*(\"[^\"]+\")")],
}
LOADS, LOAD_ENDING = {"volume", "traction", "line", "point"}, "-load"

# Names that still stand elsewhere: file -> names, or COMPARED for the name of a ManifoldOps that is looked into.
COMPARED = "name of a manifold"
EXCEPTIONS = {
    "src/io/checkpoint.cpp": {COMPARED},  # the name in the file must be that of the field
}

TOKEN = re.compile(r'"((?:\\.|[^"\\\n])*)"|//[^\n]*|/\*.*?\*/', re.DOTALL)
OPS_NAME = r"\b(?:manifold\w*(?:\(\))?|ops|m|M)(?:->|\.|::)name\b"
LOOKED_INTO = re.compile(rf"{OPS_NAME}\s*(?:==|!=|\.\w+\(|\[)|(?:==|!=)\s*[\w.>()\[\]*&-]*{OPS_NAME}")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
SUFFIXES = {".hpp", ".cpp", ".h", ".inc"}


def reachable(room):
    """The room and all rooms it may use."""
    found, todo = set(), [room]
    while todo:
        r = todo.pop()
        if r not in found:
            found.add(r)
            todo += USES[r]
    return found


def room_of(path):
    """Room of a file of include/karcher or src, or None (src/main.cpp, include/karcher/error.hpp, tests, bench, tutorials)."""
    parts = path.parts
    inside = parts[2:] if parts[:2] == ("include", "karcher") else parts[1:] if parts[0] == "src" else ()
    return inside[0] if len(inside) > 1 else None


def target_of(root, path, quote, name):
    """The file of this tree that the include means (NAME.in, where CMake makes NAME of it), relative to root, or None for a foreign header."""
    candidates = [path.parent / name] if quote == '"' else []
    candidates += [Path("include") / name, Path("src") / name, Path("include") / (name + ".in")]
    return next((c for c in candidates if (root / c).is_file()), None)


def wrong_includes(root):
    """Sentences, one for each include that breaks a rule."""
    sentences = []
    files = [p.relative_to(root) for folder in ("include", "src", "tests", "bench", "tutorials") for p in sorted((root / folder).rglob("*"))
             if p.suffix in SUFFIXES]
    for path in files:
        text = (root / path).read_text()
        room = room_of(path)
        in_library = path.parts[0] in ("include", "src")
        if room is not None and room not in USES:
            sentences.append(f"{path}: {room}/ is no room; the rooms are {', '.join(USES)}.")
            continue
        for match in INCLUDE.finditer(text):
            quote, name = match.groups()
            place = f"{path}:{text.count(chr(10), 0, match.start(2)) + 1}"
            for what, header, allowed in FOREIGN if path.parts[0] != "tests" else []:
                if re.match(header, name) and not re.match(allowed, str(path)):
                    sentences.append(f"{place}: includes {name}, but this place does not know {what}.")
            target = target_of(root, path, quote, name)
            if target is None:
                if name.startswith("karcher/"):
                    sentences.append(f"{place}: includes {name}, which does not exist.")
                continue
            if ".." in Path(name).parts:
                sentences.append(f"{place}: includes {name}; say it from include/ or src/ on.")
                continue
            if in_library and target == FRONT_DOOR:
                sentences.append(f"{place}: the front door is for programs; include the headers that are needed.")
                continue
            used = room_of(target)
            if not in_library or used is None:
                if path.parts[0] == "tutorials" and target.parts[0] == "src":
                    sentences.append(f"{place}: a tutorial includes {name}, which is not installed.")
                continue
            if path.parts[0] == "include" and target.parts[0] == "src":
                sentences.append(f"{place}: a public header includes {name}, which is not installed.")
            elif room is None:
                if path != Path("src/main.cpp") and (path != FRONT_DOOR or used == "testing"):
                    sentences.append(f"{place}: a header that every room may use includes {name} of the room {used}.")
            elif used not in reachable(room):
                sentences.append(f"{place}: {room} uses {used} ({name}); it may use {', '.join(sorted(reachable(room) - {room})) or 'no other room'}.")
            elif target.parts[0] == "src" and used != room:
                sentences.append(f"{place}: {room} includes {name}, which is private to {used}.")
    return sentences


def entered_names(root):
    """Name -> what has it, of all manifolds and energies."""
    names = {LOAD_ENDING: "load"}
    for what, places in ENTERED.items():
        for folder, text in places:
            for path in sources(root):
                if re.match(folder, str(path)):
                    for match in re.finditer(text, (root / path).read_text()):
                        names.update((name, what) for name in re.findall(r'"([^"]+)"', match.group(1)) if name not in LOADS)
    return names


def sources(root):
    return [p.relative_to(root) for folder in ("include", "src") for p in sorted((root / folder).rglob("*")) if p.suffix in SUFFIXES]


def known_by_name(root, exceptions):
    """Sentences, one for each name of a manifold or an energy that code knows outside the place where it is entered, and for each exception that is not needed."""
    names, sentences, used = entered_names(root), [], {path: set() for path in exceptions}
    for path in sources(root):
        text = (root / path).read_text()
        found = [(m.start(), m.group(1)) for m in TOKEN.finditer(text) if m.group(1) in names]
        code = TOKEN.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
        if room_of(path) != "manifold":
            found += [(m.start(), COMPARED) for m in LOOKED_INTO.finditer(code)]
        for at, name in sorted(found):
            what = names.get(name)
            if what and any(re.match(folder, str(path)) for folder, _ in ENTERED.get(what, ENTERED["energy"])):
                continue
            if name in exceptions.get(str(path), ()):
                used[str(path)].add(name)
                continue
            place = f"{path}:{text.count(chr(10), 0, at) + 1}"
            sentences.append(f"{place}: looks into the name of a manifold; ask its type or ManifoldOps." if name == COMPARED else
                             f"{place}: knows the {what} \"{name}\" by its name; ask its type or its description instead.")
    for path, allowed in exceptions.items():
        sentences += [f"{path}: {name} does not stand there any more; take it out of EXCEPTIONS." for name in sorted(allowed - used[path])]
    return sentences


def self_test():
    """Every rule must object to its own violation and to nothing else."""
    good = {
        "include/karcher/error.hpp": "#pragma once\n",
        "include/karcher/version.hpp.in": "#pragma once\n",
        "include/karcher/math/tensor.hpp": '#include "karcher/error.hpp"\n#include "karcher/version.hpp"\n',
        "include/karcher/manifold/sphere.hpp": '#include "karcher/math/tensor.hpp"\nstatic constexpr std::string_view name = N == 1 ? "S1" : "S2";\n',
        "src/energy/texts.cpp": 'info.type = "frank-oseen";\ninfo.type = "line";\n',
        "src/manifold/table.cpp": "if (M::name == name) return;\n",
        "src/app/words.cpp": '// name == "S2"\nf("a point of S2", "line", a.name == name);\ng(field.manifold->name, m.name);\n',
        "src/io/known.cpp": 'if (type == "frank-oseen") draw();\n',
        "include/karcher/mesh/mesh.hpp": '#include "karcher/math/tensor.hpp"\n',
        "include/karcher/field/field.hpp": '#include "karcher/mesh/mesh.hpp"\n#include "karcher/manifold/sphere.hpp"\n',
        "include/karcher/testing/laws.hpp": '#include <gtest/gtest.h>\n#include "karcher/manifold/sphere.hpp"\n',
        "include/karcher/karcher.hpp": '#include "karcher/field/field.hpp"\n',
        "tutorials/hello.cpp": '#include "karcher/karcher.hpp"\n',
        "src/mesh/partition.cpp": "#include <petscmat.h>\n",
        "src/solve/solve.cpp": '#include <petscksp.h>\n#include <mpi.h>\n#include "linear.hpp"\n#include "solve/linear.hpp"\n#include "karcher/field/field.hpp"\n',
        "src/solve/linear.hpp": "",
        "src/io/vtu.cpp": "#include <zlib.h>\n",
        "src/app/reader.cpp": '#include <toml++/toml.h>\n#include <CLI/CLI.hpp>\n#include "karcher/expression/symbols.hpp"\n',
        "include/karcher/expression/symbols.hpp": '#include "karcher/math/tensor.hpp"\n',
        "tests/expression/oracle_test.cpp": "#include <muParser.h>\n",
        "tests/solve/solve_test.cpp": '#include <gtest/gtest.h>\n#include <nlohmann/json.hpp>\n#include "solve/linear.hpp"\n',
    }
    bad = [
        ("include/karcher/math/bad.hpp", '#include "karcher/manifold/sphere.hpp"', "math uses manifold"),
        ("include/karcher/energy/bad.hpp", '#include "karcher/mesh/mesh.hpp"', "energy uses mesh"),
        ("include/karcher/mesh/bad.hpp", '#include "karcher/manifold/sphere.hpp"', "mesh uses manifold"),
        ("src/assembly/bad.cpp", "#include <petscvec.h>", "does not know PETSc"),
        ("src/io/bad.cpp", "#include <mpi.h>", "does not know PETSc"),
        ("src/mesh/bad.cpp", "  #  include <mpi.h>", "does not know PETSc"),
        ("include/karcher/solve/bad.hpp", "#include <petscsys.h>", "does not know PETSc"),
        ("src/mesh/bad.cpp", "#include <metis.h>", "does not know METIS"),
        ("src/io/bad.cpp", "#include <toml++/toml.h>", "does not know TOML"),
        ("src/solve/bad.cpp", "#include <nlohmann/json.hpp>", "does not know compression and JSON"),
        ("src/app/bad.cpp", "#include <muParser.h>", "does not know the oracle muParser"),
        ("src/expression/bad.cpp", "#include <muParser.h>", "does not know the oracle muParser"),
        ("src/expression/bad.cpp", '#include "karcher/mesh/mesh.hpp"', "expression uses mesh"),
        ("src/field/bad.cpp", '#include "solve/linear.hpp"', "field uses solve"),
        ("src/io/bad.cpp", '#include "solve/linear.hpp"', "private to solve"),
        ("src/io/bad.cpp", '#include "../solve/linear.hpp"', "say it from include/"),
        ("include/karcher/solve/bad.hpp", '#include "solve/linear.hpp"', "not installed"),
        ("tutorials/bad.cpp", '#include "solve/linear.hpp"', "not installed"),
        ("src/manifold/bad.cpp", '#include "karcher/testing/laws.hpp"', "manifold uses testing"),
        ("src/manifold/bad.cpp", "#include <gtest/gtest.h>", "does not know GoogleTest"),
        ("src/energy/bad.cpp", "#include <adolc/adolc.h>", "does not know the oracle"),
        ("src/energy/bad.cpp", '#include "karcher/math/absent.hpp"', "does not exist"),
        ("include/karcher/bad.hpp", '#include "karcher/math/tensor.hpp"', "every room may use"),
        ("src/field/bad.cpp", '#include "karcher/karcher.hpp"', "front door"),
        ("src/kitchen/bad.cpp", "", "kitchen/ is no room"),
        ("src/solve/bad.cpp", 'if (f.manifold->name == wanted) {}', "looks into the name"),
        ("src/solve/bad.cpp", 'if (wanted != field.manifold->name) {}', "looks into the name"),
        ("src/solve/bad.cpp", 'x = m.name.starts_with("R") ? 1 : 2;', "looks into the name"),
        ("src/solve/bad.cpp", "x = field.manifold->name[0];", "looks into the name"),
        ("src/io/bad.cpp", '// why\nif (stored == "S1") {}', "src/io/bad.cpp:2: knows the manifold"),
        ("src/io/bad.cpp", 'draw(text == "frank-oseen");', 'knows the energy "frank-oseen"'),
        ("src/io/bad.cpp", 'const bool load = term.ends_with("-load");', "knows the load"),
        ("src/io/known.cpp", "", "frank-oseen does not stand there any more"),
    ]
    failures = []
    for extra in [None] + bad:
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            for path, text in list(good.items()) + ([extra[:2]] if extra else []):
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            found = wrong_includes(root) + known_by_name(root, {"src/io/known.cpp": {"frank-oseen"}})
            if (extra is None and found) or (extra and not (len(found) == 1 and extra[2] in found[0])):
                failures.append(f"{extra}: {found}")
    print("\n".join(failures) or f"Self-test: {len(bad)} mistakes found, a good tree accepted.")
    return 1 if failures else 0


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    found = wrong_includes(root) + known_by_name(root, EXCEPTIONS)
    print("\n".join(found) if found else "All includes point in the design's direction, and no code knows a manifold or an energy by its name.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

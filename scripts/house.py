"""How heavy the package is: lines, files, imports, and what the main command loads and calls.

    python scripts/house.py

The figures have ceilings, which tests/static/test_house.py holds them to. Lines are those of all
Python files below src/epicyclic, the core is all but `plugins` and `validation`.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from itertools import combinations
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "src" / "epicyclic"
ADDED_TO_THE_CORE = {
    "friction of rough flanks": 340,
    "tapered bearings, rolling contained": 290,
    "the first screen, points to check, warnings of maps": 450,
    "tables as rigs write them, scatter and models in fits, sheets of maps": 1180,
    "equal results for equal cases, hostile files and names": 530,
    "drag at any speed": 450,
    "bearings by designation, pairs of bearings, plain pins, rollers that turn": 1650,
    "oil level of a housing, tables of heat, fast bearings, grease": 365,
    "default tips, every mistake at once, formulas without a case": 655,
    "bands and pictures of one size, arrangement of a train": 535,
    "test rigs, seals of sets, open clutches, rollers without a cage": 590,
    "a first run in two processes, sizes of units": 185,
    "points of a sweep that share a machine": 150,
    "points of a sweep solved together, their heat networks too": 1_290,
    "friction, loads and rollers in vector code": 190,
    "temperatures that do not settle, limits of uncertain inputs, ranges of drag": 50,
    "keys and library of strength, odds over a cycle": 170,
    "ball and thrust bearings by film, cold bearings": 390,
}
ADDED = {
    **ADDED_TO_THE_CORE,
    "losses that others measured": 640,
    "chapter 2 and every printed result of the dissertation": 470,
    "the app's charts, bands, groups, exports and designs": 360,
    "tools and a skill for agents": 335,
    "strength, relief and a search for designs": 3_740,
}
ADDED_TO_CASE = {
    "keys of drag at any speed": 50,
    "keys of bearings and pins": 130,
    "keys of seals, clutches and rollers without a cage": 70,
    "keys of strength": 80,
    "cases that share a machine": 65,
    "oil level of a housing, keys that replace others, tips, every mistake at once": 210,
}
"""Lines of what was added since the house was built, which the changelog counts apart."""
CEILINGS = {
    "lines": 68_805 + sum(ADDED.values()),
    "lines of the core": 53_510 + sum(ADDED_TO_THE_CORE.values()),
    "lines of case": 4_305 + sum(ADDED_TO_CASE.values()),
    "files": 260,
    "longest chain of imports": 25,
    "modules loaded by epicyclic.case.case": 45,
    "kernels loaded by epicyclic.case.case": 0,
    "functions of one solution": 500,
    "pairs of classes with the same fields": 5,
    "tests of the kind of a set": 0,
}
APART = ("plugins", "validation")
KINDS = ("PlanetaryCase", "GearPairCase", "PlanetarySet", "PairSet", "ListedSet", "ComputedSet")
TESTS = ("isinstance", "issubclass")
KIND_ROOMS = ("case", "build")
"""Where the form in which a set is stated may matter."""
ALIKE, COMMON = 0.6, 4
"""Classes count as the same from this share of common fields on, and this number of them."""
LOADED = "import sys, json, epicyclic.case.case; print(json.dumps(sorted(sys.modules)))"
# Of the main thread, as for the 690 that the ceiling is compared with; threads solve pockets.
CALLED = """
import sys, epicyclic
functions = set()
def note(frame, event, _):
    code = frame.f_code
    if event == "call" and code.co_filename.startswith(sys.argv[1]) and code.co_flags & 1:
        if "<" not in code.co_qualname.split(".")[-1]:
            functions.add((code.co_filename, code.co_qualname))
sys.setprofile(note)
from epicyclic.case.case import read_case
from epicyclic.study.solve import solve
solve(read_case("talbot-2012"))
sys.setprofile(None)
print(len(functions))
"""


def files() -> list[Path]:
    """All modules of the package."""
    return sorted(SOURCE.rglob("*.py"))


@cache
def tree(path: Path) -> ast.Module:
    """What a module says."""
    return ast.parse(path.read_text(encoding="utf-8"))


def room(path: Path) -> str:
    """The folder of a module below the package; of a module beside them its name."""
    return path.relative_to(SOURCE).parts[0]


def lines(*rooms: str, but: tuple[str, ...] = ()) -> int:
    """Lines of the modules in some rooms, or in all, but for some."""
    return sum(
        len(path.read_text(encoding="utf-8").splitlines())
        for path in files()
        if (not rooms or room(path) in rooms) and room(path) not in but
    )


def name_of(path: Path) -> str:
    """Dotted name of a module."""
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def imports() -> dict[str, frozenset[str]]:
    """What each module imports of the package when it is loaded."""
    modules = {name_of(path): tree(path) for path in files()}

    def found(tree: ast.Module) -> Iterator[str]:
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    name = f"{node.module}.{alias.name}"
                    yield name if name in modules else node.module

    return {name: frozenset({*found(tree)} & modules.keys()) for name, tree in modules.items()}


@cache
def chain(module: str) -> tuple[str, ...]:
    """The longest chain of imports that begins with a module."""
    below = (chain(name) for name in imports()[module] if name != module)
    return (module, *max(below, key=len, default=()))


def classes() -> Iterator[tuple[str, frozenset[str]]]:
    """Every class with fields, and their names."""
    for path in files():
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.ClassDef):
                names = frozenset(
                    ast.unparse(item.target)
                    for item in node.body
                    if isinstance(item, ast.AnnAssign) and "ClassVar" not in ast.unparse(item)
                )
                if len(names) >= COMMON - 1:
                    yield f"{name_of(path)}.{node.name}", names


def mirrors() -> list[tuple[str, str]]:
    """Pairs of classes that share most of their fields."""
    return [
        (one, two)
        for (one, first), (two, second) in combinations(classes(), 2)
        if len(first & second) >= COMMON and len(first & second) >= ALIKE * len(first | second)
    ]


def kind_tests() -> list[str]:
    """Where code outside `KIND_ROOMS` asks in which form a set is stated."""
    found = []
    for path in files():
        if room(path) in KIND_ROOMS:
            continue
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in TESTS:
                asked = {item.id for item in ast.walk(node.args[1]) if isinstance(item, ast.Name)}
                if asked & {*KINDS}:
                    found.append(f"{name_of(path)}:{node.lineno}")
    return found


def output(code: str) -> str:
    """What a program prints in a process of its own."""
    command = [sys.executable, "-c", code, str(SOURCE)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def figures() -> dict[str, int]:
    """Every figure that has a ceiling."""
    loaded = [name for name in json.loads(output(LOADED)) if name.startswith("epicyclic")]
    kernels = [name for name in loaded if name.startswith("epicyclic.kernels.")]
    return {
        "lines": lines(),
        "lines of the core": lines(but=APART),
        "lines of case": lines("case"),
        "files": len(files()),
        "longest chain of imports": max(len(chain(name)) for name in imports()),
        "modules loaded by epicyclic.case.case": len(loaded),
        "kernels loaded by epicyclic.case.case": len(kernels),
        "functions of one solution": int(output(CALLED)),
        "pairs of classes with the same fields": len(mirrors()),
        "tests of the kind of a set": len(kind_tests()),
    }


def main() -> None:
    """Print the figures, and what those consist of that are lists."""
    for name, value in figures().items():
        print(f"{name:40} {value:>7,} of {CEILINGS[name]:>7,}")
    print("\nlongest chain:", *max(map(chain, imports()), key=len), sep="\n  ")
    print("\nsame fields:", *(" ~ ".join(pair) for pair in mirrors()), sep="\n  ")
    print("\ntests of the kind of a set:", *kind_tests(), sep="\n  ")
    print("\nlines by room:")
    for name in sorted({room(path) for path in files()}, key=lines, reverse=True):
        print(f"  {name:20} {lines(name):>7,}")


if __name__ == "__main__":
    main()

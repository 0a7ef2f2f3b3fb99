"""Writes what is frozen at commit 93d3dc1: results.json.xz and texts.json.xz.

Run by hand, from the folder of the tests, with an installation of that commit only: what other
commits compute and say is to be compared with the files and not written into them.

    python -m frozen.make_frozen results
    python -m frozen.make_frozen texts

Frozen as results are the built-in cases with some of their variants, cases chosen by hand, trains
of listed sets, 300 cases drawn at random, two small loss maps and sweeps, and the bands of some
cases. Frozen as texts is what is said of broken cases, commands and files, and of some sound ones.
Each case is kept with its tables, and each text with its inputs, so that the files can be used
without this script.

    python -m frozen.make_frozen differences

works with any commit: it prints the words of texts that are not the frozen ones, and one word
before and after them, as candidates for improved_texts.toml. Those that stand elsewhere too must be
made longer.
"""

from __future__ import annotations

import json
import lzma
import math
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import epicyclic as ep
from frozen.broken_cases import bases, broken_cases
from frozen.broken_commands import broken_commands, sound_commands
from frozen.chosen_cases import BANDS, BUILT_IN, COARSE, chosen_cases, start_of
from frozen.command import run_command, toml_of
from frozen.drawn_cases import drawn_cases, value
from frozen.entries import Maker, outcome_of
from frozen.texts import TEXTS, changed_words, differing, frozen_texts

RESULTS = Path(__file__).with_name("results.json.xz")
FOUND = Path(__file__).with_name("found_inputs.json")
COMMIT = "93d3dc1"
QUICK = 40
"""Drawn cases that the default test run solves."""
LONG = 1.0
"""A case that takes longer is not solved by the default test run, unless it is built in. [s]"""
SOON = 0.4
"""An entry that takes longer is not tried by the default test run. [s]"""
DIGITS = 12
"""Of frozen numbers."""

Tables = dict[str, Any]


def frozen(case: Any) -> Tables:
    """What a case gives: its result as JSON and its numbers, or the message of the error."""
    try:
        result = ep.solve(case)
    except ep.ConvergenceError as error:
        return {"error": str(error)}
    found = result.to_dict()
    del found["versions"]
    numbers = {item.key: finite(item.value) for item in result.numbers()}
    return {"tied": tied_azimuths(result), "result": found, "numbers": numbers}


def tied_azimuths(result: Any) -> list[float]:
    """Where the rollers stand that are loaded most, if there are several: often left and right.

    Rounding decides which of them the result names. [deg]
    """
    if result.bearing is None:
        return []
    loads = result.bearing.loads.intensity.sum(axis=2)
    _, most = (loads >= (1 - 1e-9) * loads.max()).nonzero()
    turns = {float(result.bearing.loads.azimuth[roller]) for roller in most}
    return sorted(math.degrees(math.remainder(turn, 2 * math.pi)) for turn in turns)


def finite(number: float) -> float | None:
    """None for NaN, which JSON does not know."""
    return None if math.isnan(number) else number


def frozen_data(data: Any) -> Tables:
    """A data set as lists."""
    arrays = {**data.coords, **data.data_vars}
    arrays.pop("planet_bearing_roller_azimuth", None)  # which cannot be compared if rollers tie
    return {
        str(name): {"dims": list(array.dims), "values": plain_values(array.values.tolist())}
        for name, array in arrays.items()
    }


def plain_values(values: Any) -> Any:
    if isinstance(values, list):
        return [plain_values(item) for item in values]
    return finite(values) if isinstance(values, float) else values


def small_data() -> Iterator[tuple[str, Tables]]:
    """A loss map and a sweep of each built-in case, with what they were asked for."""
    coarse = COARSE | {"numerics.mesh_positions": 6, "numerics.contact_segments": 6}
    asked: dict[str, Tables] = {
        "talbot-2012": {
            "operation.torque": ["-300 N*m", "40 N*m"],
            "planet.roughness": ["0.1 um", "0.5 um"],
            "planet.count": [3, 5],
        },
        "talbot-2012-pair": {
            "operation.torque": ["0 N*m", "120 N*m"],
            "models.friction": ["schlenk", "mixed-ehl"],
            "lubricant.oil": ["atf-talbot-2012", "iso-vg-100-pao"],
        },
    }
    for name, vary in asked.items():
        axes = {
            "speed": ["-1500 rpm", "0 rpm", "3200 rpm"],
            "torque": ["-210 N*m", "0 N*m", "330 N*m"],
            "temperature": ["50 degC", "95 degC"],
        }
        case = ep.load_case(name).updated(coarse)
        base = {"case": name, "changes": coarse}
        data = ep.loss_map(case, **axes, jobs=1)
        yield f"map {name}", base | {"kind": "loss_map", "asked": axes, "data": frozen_data(data)}
        data = ep.sweep(case, vary, jobs=1)
        yield f"sweep {name}", base | {"kind": "sweep", "asked": vary, "data": frozen_data(data)}


def traits(tables: Tables) -> Iterator[str]:
    """The keys of a case, those that choose among words with their choice, and signs."""
    for section, table in tables.items():
        for key, item in table.items() if isinstance(table, dict) else ():
            word = isinstance(item, str) and not item[0].isdigit() and item[0] != "-"
            sign = ""
            if key in ("torque", "speed", "second_speed"):
                sign = str((value(item) > 0) - (value(item) < 0))
            count = item if key == "count" else ""
            yield f"{section}.{key} {item if word else sign or count}"


def quick_share(cases: dict[str, Tables]) -> list[str]:
    """Cases of coarse resolution in which every trait of those appears, and more up to `QUICK`."""
    left = {name: set(traits(tables)) for name, tables in cases.items() if "numerics" in tables}
    chosen: list[str] = []
    missing = set().union(*left.values())
    while missing:
        best = max(left, key=lambda name: len(left[name] & missing))
        missing -= left[best]
        chosen.append(best)
        del left[best]
    rest = list(left)
    step = max(1, len(rest) // max(1, QUICK - len(chosen)))
    return sorted([*chosen, *rest[::step][: QUICK - len(chosen)]])


def bands() -> Iterator[tuple[str, Tables]]:
    """The bands of some cases and what is said about them, as the command writes them."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for key, (base, changes) in BANDS.items():
            case = ep.load_case(start_of(base)).updated(changes)
            tables = case.given()
            yield key, {"case": tables, "result": band_of(tables, folder)}


def band_of(tables: Tables, folder: Path) -> Tables:
    """What the command says of a case besides its result."""
    (folder / "case.toml").write_text(toml_of(tables), encoding="utf-8")
    done = run_command(["run", "case.toml", "--json", "-"], folder)
    assert not done.errors, done.errors
    result = json.loads(done.output)
    return {key: result[key] for key in ("band", "advice")}


def all_results() -> Tables:
    """Everything that the file of results holds."""
    drawn = dict(drawn_cases())
    quick = quick_share(drawn)
    given: dict[str, tuple[Any, Any]] = {name: (name, ep.load_case(name)) for name in BUILT_IN}
    for name, base, changes in chosen_cases():
        case = ep.load_case(base).updated(changes)
        given[name] = case.given(), case
    given |= {name: (tables, ep.load_case(tables)) for name, tables in drawn.items()}
    cases = {}
    for name, (tables, case) in given.items():
        start = time.perf_counter()
        found = frozen(case)
        seconds = time.perf_counter() - start
        is_quick = name in BUILT_IN or (seconds < LONG and (name not in drawn or name in quick))
        if not is_quick:
            found.pop("numbers", None)  # which are those of the result, and make the file larger
        cases[name] = {"case": tables, "quick": is_quick} | rounded(found)
        print(f"{name} {seconds:.2f} s {found.get('error', '')}")
    data, banded = dict(small_data()), dict(bands())
    return {"commit": COMMIT, "cases": cases} | rounded({"data": data, "bands": banded})


def rounded(content: Any) -> Any:
    """The same with numbers of as many digits as are compared, and a few more."""
    match content:
        case float():
            return float(f"{content:.{DIGITS}g}")
        case dict():
            return {key: rounded(item) for key, item in content.items()}
        case list() | tuple():
            return [rounded(item) for item in content]
        case _:
            return content


def all_texts() -> Tables:
    """Everything that the file of texts holds."""
    found = json.loads(FOUND.read_text(encoding="utf-8"))
    tables = bases()
    entries: dict[str, Tables] = {}
    with tempfile.TemporaryDirectory() as name:
        maker = Maker(Path(name))
        for entry in (*broken_cases(), *broken_commands(), *sound_commands(), *found):
            key = entry["name"]
            assert key not in entries, key
            tried(entry, tables, maker)  # what it needs is made, and the first time takes longer
            start = time.perf_counter()
            outcome = tried(entry, tables, maker)
            seconds = time.perf_counter() - start
            entries[key] = entry | {"quick": seconds < SOON, "outcome": outcome}
            print(f"{key} {seconds:.2f} s")
    return {"commit": COMMIT, "bases": tables, "entries": entries}


def tried(entry: Tables, tables: Tables, maker: Maker) -> Tables:
    """The outcome of an entry in a folder of its own."""
    with tempfile.TemporaryDirectory() as name:
        return outcome_of(entry, tables, Path(name), maker)


def print_differences() -> None:
    """Words that are not the frozen ones, as entries of improved_texts.toml."""
    texts, results = frozen_texts(), json.loads(lzma.decompress(RESULTS.read_bytes()))
    pairs: dict[tuple[str, str], str] = {}  # with the first place of each
    with tempfile.TemporaryDirectory() as name:
        maker = Maker(Path(name))
        for key, entry in texts["entries"].items():
            for pair in differing(entry["outcome"], tried(entry, texts["bases"], maker)):
                pairs.setdefault(changed_words(*pair), key)
    for key, entry in results["cases"].items():
        if "result" in entry:
            now = ep.solve(ep.load_case(entry["case"])).to_dict()
            for pair in differing(entry["result"]["warnings"], now["warnings"]):
                pairs.setdefault(changed_words(*pair), key)
    for (old, new), key in pairs.items():
        print(f"# {key}\n[[text]]\nold = {json.dumps(old, ensure_ascii=False)}")
        print(f"new = {json.dumps(new, ensure_ascii=False)}\n")


def write(file: Path, content: Tables) -> None:
    """A compressed file of JSON."""
    text = json.dumps(content, separators=(",", ":"))
    file.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))
    print(f"{file.name}: {file.stat().st_size} bytes")


def main() -> None:
    """Freeze or compare what is asked for."""
    warnings.simplefilter("error")
    match sys.argv[1:]:
        case ["results"]:
            write(RESULTS, all_results())
        case ["texts"]:
            write(TEXTS, all_texts())
        case ["differences"]:
            print_differences()
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()

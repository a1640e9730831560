"""Format every XML file of robots, and compare with other formatters: ``python -m measure.layout``.

Each file of the collection and of the installed packages is formatted: the XML must be equal,
comments and blank lines included, and formatting twice must change nothing. Each xacro robot of the
collection is expanded before and after. Other formatters get the xacro files of the collection, if
they are installed: ``--xmllint``, ``--xmlformat`` and ``--prettier`` name their programs.
"""

from __future__ import annotations

import argparse
import csv
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

from measure.benchmarks.robots import CORPUS, example_folder, manifest
from urdftool import expand
from urdftool.errors import UrdftoolError
from urdftool.fmt.layout import format_xml
from urdftool.fmt.run import format_file, list_events
from urdftool.source.document import parse
from urdftool.source.location import SourceFile

ENDINGS = (".urdf", ".xacro", ".sdf", ".srdf", ".world", ".mjcf", ".xml", ".launch")
_BLANK = re.compile(rb"^[ \t]*\r?$", re.MULTILINE)


def list_folders() -> list[Path]:
    """Return the collections and packages that are there."""
    spec = find_spec("pybullet_data")
    packages = [Path(place) for place in (spec.submodule_search_locations or ())] if spec else []
    share = example_folder()
    found = [CORPUS, CORPUS.with_name("corpus-meshes"), *packages, *([share] if share else [])]
    return [folder for folder in found if folder.is_dir()]


def list_xml(folders: list[Path]) -> list[Path]:
    """Return the files that are XML, each once."""
    paths = {
        Path(os.path.realpath(os.path.join(root, name)))
        for folder in folders
        for root, _, names in os.walk(folder)
        for name in names
        if name.endswith(ENDINGS)
    }
    return [path for path in sorted(paths) if is_xml(path.read_bytes())]


def is_xml(data: bytes) -> bool:
    """Tell whether bytes are well-formed XML."""
    try:
        list_events(SourceFile("file", data))
    except UrdftoolError:
        return False
    return True


def measure_layout(paths: list[Path]) -> str:
    """Return the line about all files."""
    found: Counter[str] = Counter()
    begin = time.process_time()
    for path in paths:
        format_file(SourceFile(str(path), path.read_bytes()))
    seconds = time.process_time() - begin
    for path in paths:
        before = path.read_bytes()
        after = format_xml(before)
        events = [list_events(SourceFile(str(path), data)) for data in (before, after)]
        found["differ"] += events[0] != events[1]
        found["twice"] += format_xml(after) != after
        found["unchanged"] += before == after
        found["bytes"] += len(before)
    return (
        f"{len(paths)} files, {found['bytes'] / 1e6:.1f} MB: {found['differ']} differ as XML with "
        f"comments and blank lines, {found['twice']} change when formatted twice, "
        f"{found['unchanged']} unchanged; {seconds:.2f} s of processor time with the proof"
    )


def measure_expansions() -> str:
    """Return the line about the xacro robots of the collection."""
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "corpus")
        shutil.copytree(CORPUS, copy, symlinks=True)
        for path in list_xml([copy]):
            path.write_bytes(format_xml(path.read_bytes()))
        for entry in manifest():
            if entry["kind"] == "xacro":
                texts = [expand_entry(entry, root) for root in (CORPUS, copy)]
                found["runs"] += 1
                found["failed"] += texts[0] is None
                found["blanks"] += texts[0] != texts[1]
                first, second = (text and summarize(text.encode()) for text in texts)
                found["differ"] += first != second
    return (
        f"{found['runs']} runs of xacro, of which {found['failed']} fail before and after: "
        f"{found['differ']} differ in elements, texts or comments, "
        f"{found['blanks'] - found['differ']} only in the white space of empty elements"
    )


def expand_entry(entry: dict[str, str], root: Path) -> str | None:
    """Return what an entry expands to, without the folder; None if it fails."""
    with open(root / "PACKAGE_ROOTS.tsv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table, delimiter="\t"))
    packages = {row["package"]: root / row["dir"] for row in rows}
    arguments = dict(word.split(":=", 1) for word in entry["xacro_args"].split() if ":=" in word)
    try:
        text = expand(root / entry["path"], args=arguments, packages=packages)
    except UrdftoolError:
        return None
    return re.sub(r" +\| -->", " | -->", text.replace(str(root), ""))


# Other formatters -------------------------------------------------------------------------------


def list_peers(options: argparse.Namespace) -> Iterator[tuple[str, Callable[[Path], object]]]:
    """Yield each formatter that is there, with a function that formats a file in place."""

    def run(*words: str) -> Callable[[Path], object]:
        def format_path(path: Path) -> None:
            data = path.read_bytes()
            done = subprocess.run([*words, str(path)], capture_output=True, check=False)
            out = done.stdout if done.returncode == 0 and done.stdout.strip() else data
            path.write_bytes(out)

        return format_path

    yield "urdftool fmt", lambda path: path.write_bytes(format_xml(path.read_bytes()))
    if options.xmllint:
        yield "xmllint --format", run(options.xmllint, "--format")
    if options.xmlformat:
        yield "xmlformat", run(options.xmlformat, "--indent", "2")
    if options.prettier:
        words = (options.prettier, "--plugin=@prettier/plugin-xml", "--parser=xml")
        yield "prettier", run(*words)
        yield "prettier, ignore", run(*words, "--xml-whitespace-sensitivity=ignore")


def compare_peers(options: argparse.Namespace) -> Iterator[str]:
    """Yield a row of a table for each formatter."""
    files = [path for path in list_xml([CORPUS]) if path.suffix == ".xacro"]
    before = {path: path.read_bytes() for path in files}
    blank = sum(len(_BLANK.findall(data)) for data in before.values())
    yield f"{len(files)} xacro files"
    yield f"| formatter | XML differs | blank lines kept of {blank} | unchanged |"
    yield "|---|---|---|---|"
    for name, format_path in list_peers(options):
        found: Counter[str] = Counter()
        with tempfile.TemporaryDirectory() as folder:
            for number, data in enumerate(before.values()):
                copy = Path(folder, f"{number}.xacro")
                copy.write_bytes(data)
                format_path(copy)
                after = copy.read_bytes()
                found["differ"] += summarize(data) != summarize(after)
                found["blank"] += len(_BLANK.findall(after))
                found["unchanged"] += after == data
        yield f"| {name} | {found['differ']} | {found['blank']} | {found['unchanged']} |"


def summarize(data: bytes) -> object:
    """Return elements, attributes and texts, without white space around texts, and comments."""
    try:
        document = parse(SourceFile("file", data))
    except UrdftoolError:
        return None
    texts = [
        (one.tag, sorted(one.attributes.items()), one.text.strip()) for one in document.root.walk()
    ]
    return texts, [comment.text for comment in document.comments]


def main() -> None:
    """Print the lines."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("xmllint", "xmlformat", "prettier"):
        parser.add_argument(f"--{name}", metavar="PROGRAM")
    options = parser.parse_args()
    print(measure_layout(list_xml(list_folders())), flush=True)
    print(measure_expansions(), flush=True)
    for line in compare_peers(options):
        print(line, flush=True)


if __name__ == "__main__":
    main()

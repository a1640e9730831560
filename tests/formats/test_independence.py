"""What the formats may share: writers by ``common`` alone, and a proof nothing of a writer."""

import ast
from pathlib import Path

import pytest

from urdftool.source.description_formats import NAMES as FOLDERS

PACKAGE = Path(__file__).parents[2] / "urdftool"
FORMATS = PACKAGE / "formats"
MODULES = sorted(FORMATS.rglob("*.py"))
PROOFS = [
    path
    for path in MODULES
    if path.stem.startswith("verify") or path.parent.name == "verify" or path.stem == "mechanics"
]

READERS = [path for path in MODULES if path.stem == "read" or path.stem.startswith("read_")]

# What a proof may import of the exporter: it repeats an export to see that it is the same, reads
# what was chosen and what was declared, compiles a copy, and steps what was read back.
OPEN = (
    *("check", "mechanics", "written", "common.losses", "common.directory", "verify", "detect"),
    *("common.actuator_config", "common.force_fallbacks"),
    *("sdf.options", "sdf.write", "sdf.verify", "sdf.read"),
    *("usd.options", "usd.verify", "usd.read", "reading", "common.srdf"),
    *(
        "mjcf.options",
        "mjcf.write",
        "mjcf.compiled",
        "mjcf.copied",
        "mjcf.declared_losses",
        "mjcf.model_motion",
        "common.additions",
        "mjcf.verify",
    ),
    "usd.declared_losses",
    "mjcf.read",
    "step_read_back",
)


def imports(path):
    """The modules of ``formats`` that a file imports, relative to it."""
    parts = path.relative_to(FORMATS).with_suffix("").parts
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = parts[: len(parts) - node.level]
        if node.level > len(parts):
            continue
        names = [node.module] if node.module else [alias.name for alias in node.names]
        yield from (".".join((*base, name)) for name in names)


def shown(path):
    return str(path.relative_to(FORMATS))


@pytest.mark.parametrize("path", PROOFS, ids=shown)
def test_a_proof_shares_nothing_with_the_writers(path):
    for name in imports(path):
        assert name.startswith(OPEN), f"{shown(path)} imports {name}"


@pytest.mark.parametrize("path", READERS, ids=shown)
def test_a_reader_shares_nothing_with_the_writers(path):
    allowed = ("reading", f"{path.parent.name}.read")
    for name in imports(path):
        assert name.startswith(allowed), f"{shown(path)} imports {name}"


def test_the_proofs_are_found():
    assert len(PROOFS) > 15
    assert len(READERS) > 6


@pytest.mark.parametrize("path", MODULES, ids=shown)
def test_a_format_imports_no_other(path):
    own = path.relative_to(FORMATS).parts[0]
    for name in imports(path):
        room = name.partition(".")[0]
        if own in (*FOLDERS, "common") and room in FOLDERS:
            assert room == own, f"{shown(path)} imports {name}"

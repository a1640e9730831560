"""``bundle.json``: the files of a bundle with their digests and sources."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from .. import __version__
from .origin import Repository

MANIFEST = "bundle.json"
VERSION = 1
"""Version of the form of ``bundle.json``."""


@dataclass
class Manifest:
    """Content of ``bundle.json``. It has no absolute path, time or user name.

    Attributes:
        robot: Name of the robot.
        description: Path of the description in the bundle.
        source: Name of the source description.
        arguments: xacro arguments.
        options: Options that differ from their defaults.
        files: Digest, size [bytes] and sources of each file, and its references to files that the
            source does not have (``missing``), by path.
        licenses: Licenses that the packages of the sources declare.
        repositories: Git commits of the sources.
        changes: Changes of the description other than URIs.
        missing: References without a file.
    """

    robot: str
    description: str
    source: str
    arguments: dict[str, str] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
    files: dict[str, dict[str, Any]] = field(default_factory=dict)
    licenses: dict[str, list[str]] = field(default_factory=dict)
    repositories: list[Repository] = field(default_factory=list)
    changes: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)

    def to_json(self) -> bytes:
        """Return the content of ``bundle.json``."""
        document = {
            "version": VERSION,
            "tool": f"urdftool {__version__}",
            "robot": self.robot,
            "description": self.description,
            "source": self.source,
            "arguments": self.arguments,
            "options": self.options,
            "repositories": [asdict(repository) for repository in self.repositories],
            "licenses": self.licenses,
            "changes": self.changes,
            "missing": self.missing,
            "files": [{"path": path, **self.files[path]} for path in sorted(self.files)],
        }
        return (json.dumps(document, indent=2, ensure_ascii=False) + "\n").encode()


def compute_digest(content: bytes | Path) -> str:
    """Return the SHA-256 of a content in hexadecimal digits."""
    if isinstance(content, bytes):
        return sha256(content).hexdigest()
    result = sha256()
    with open(content, "rb") as stream:
        while block := stream.read(1 << 20):
            result.update(block)
    return result.hexdigest()


def read_digests(data: bytes) -> dict[str, str] | None:
    """Return the digests by path of a ``bundle.json``; None if it is not one."""
    document = parse_manifest(data)
    if document is None:
        return None
    return {entry["path"]: entry["sha256"] for entry in document["files"]}


def list_known_missing(document: Mapping[str, Any]) -> dict[str, set[str]]:
    """Return the references that had no file in the source either, by path of the file."""
    known_missing = {}
    for entry in document["files"]:
        missing = entry.get("missing")
        if isinstance(missing, list):
            known_missing[entry["path"]] = {name for name in missing if isinstance(name, str)}
    return known_missing


def parse_manifest(data: bytes) -> Mapping[str, Any] | None:
    """Return the document of a ``bundle.json``; None if it is not one."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):
        return None
    if not isinstance(document, dict) or document.get("version") != VERSION:
        return None
    files = document.get("files")
    if not isinstance(files, list) or not isinstance(document.get("description"), str):
        return None
    for entry in files:
        if not isinstance(entry, dict):
            return None
        if not isinstance(entry.get("path"), str) or not isinstance(entry.get("sha256"), str):
            return None
    return document

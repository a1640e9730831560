"""The same operations by scikit-robot: what moves, what is lost."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from urdftool.model.elements import Robot

from .engine import Case, measure
from .operations import Operation, list_moving, list_operations
from .run import compare_links, open_robot

OPERATIONS = ("root", "merge-fixed", "sign")
"""Operations that both tools have."""
BEYOND = 1e-6
"""Largest relative difference of mass and inertia; one of scikit-robot's texts with 9 digits."""
HEAD = (
    "| operation | made | failed | link frames moved | robots with such | other inertia "
    "| comments lost | blocks lost |"
)
TAGS = ("gazebo", "transmission", "ros2_control")


@dataclass
class Sums:
    """What was measured of one tool and operation."""

    made: int = 0
    failed: int = 0
    moved: int = 0
    links: int = 0
    robots_moved: int = 0
    inertia: int = 0
    comments: int = 0
    with_comments: int = 0
    blocks: int = 0

    def format(self, name: str) -> str:
        """Return the row of the table."""
        return (
            f"| {name} | {self.made} | {self.failed} | {self.moved} of {self.links} | "
            f"{self.robots_moved} | {self.inertia} | {self.comments} of {self.with_comments} | "
            f"{self.blocks} |"
        )


def measure_peer(paths: Sequence[Path], python: str, folder: Path) -> list[str]:
    """Make the operations with both tools, and return the rows of the table."""
    jobs = []
    for number, path in enumerate(paths):
        opened = open_robot(path)
        for operation in [] if opened is None else list_operations(opened[0]):
            if operation.name in OPERATIONS:
                target = folder / f"{number}-{operation.name}.urdf"
                jobs.append((path, operation, *opened, target))
    errors = _run(jobs, python)
    sums = {(tool, name): Sums() for name in OPERATIONS for tool in ("urdftool", "scikit-robot")}
    for (path, operation, robot, text, target), error in zip(jobs, errors, strict=True):
        peer = sums["scikit-robot", operation.name]
        if error or not target.exists():
            peer.failed += 1
            print(f"{path.name}: {operation.name}: scikit-robot: {error}", file=sys.stderr)
        else:
            _add(peer, operation, (robot, text), target.read_text())
        own = sums["urdftool", operation.name]
        try:
            made = _make(operation, robot)
        except Exception:  # refused; counted
            own.failed += 1
            continue
        _add(own, operation, (robot, text), made)
    rows = [row.format(f"{name}, {tool}") for (tool, name), row in sums.items()]
    return [HEAD, "|---" * HEAD.count(" | ") + "|---|", *rows]


def _make(operation: Operation, robot: Robot) -> str:
    if operation.name == "sign":  # scikit-robot does one joint at a time
        return robot.reverse_sign([operation.argument]).data.decode()
    return operation.make(robot).data.decode()


def _run(jobs: Sequence[tuple], python: str) -> list[str]:
    lines = [
        json.dumps([operation.name, str(path), operation.argument, str(target)])
        for path, operation, _, _, target in jobs
    ]
    script = Path(__file__).with_name("peer.py")
    done = subprocess.run(
        [python, str(script)], input="\n".join(lines), capture_output=True, text=True, check=True
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


def _add(sums: Sums, operation: Operation, source: tuple[Robot, str], after: str) -> None:
    robot, before = source
    names = set(re.findall(r"<link\s[^<>]*?name=[\"']([^\"']+)", after))
    first = [operation.argument] if operation.name == "root" else []  # its frame stays
    links = {name: name for name in (*first, *robot.link) if name in names}
    moving = list_moving(robot)
    turned = operation.argument if operation.name == "sign" else ""

    def move(positions):
        return {n: -v if n == turned else v for n, v in positions.items()}

    case = Case(links, moving, move, np.eye(4), has_matrix=False)
    try:
        found = measure(before, after, case)
    except Exception as error:
        sums.failed += 1
        print(f"{robot.name}: {operation.name}: not measured: {error}", file=sys.stderr)
        return
    sums.made += 1
    moved, count = compare_links(found)
    sums.moved += moved
    sums.links += count
    sums.robots_moved += moved > 0
    sums.inertia += found.inertia > BEYOND
    comments = re.findall(r"<!--.*?-->", before, re.DOTALL)
    sums.with_comments += bool(comments)
    sums.comments += any(comment not in after for comment in comments)
    sums.blocks += any(after.count(f"<{tag}") < before.count(f"<{tag}") for tag in TAGS)

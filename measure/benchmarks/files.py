"""How cost grows with files: ``lint``"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator

from . import peers
from .lint import PEERS, add_pile
from .robots import bullet_robots, example_robots
from .table import Pairs, Table

COUNTS = (1, 10, 100)
ABOUT = """\
The first files of example-robot-data and pybullet_data, with the meshes they name. urdftool and
simcheck get all in one command, check_urdf one at a time."""


def rows() -> Iterator[Table | str]:
    """A row for each number of files."""
    robots = [*example_robots(), *bullet_robots()]
    if len(robots) < COUNTS[-1]:
        yield peers.missing("example-robot-data")
        return
    pairs = Pairs("files", [name for name in PEERS if peers.tool(name)])
    with tempfile.TemporaryDirectory() as folder:
        for count in COUNTS:
            files = robots[:: len(robots) // count][:count]
            add_pile(pairs, str(count), files, folder, rounds=5, budget=20, most=99)
    yield pairs.table(
        "Without a cache, meshes are most of the work: check_urdf does not open them."
    )

"""Export every robot of a collection to MJCF and compare MuJoCo's model with another reader's.

    python measure/benchmarks/export_mjcf.py                 # example-robot-data against Pinocchio
    python measure/benchmarks/export_mjcf.py --pybullet-data # pybullet_data against PyBullet
    python measure/benchmarks/export_mjcf.py --time          # against the time of import mujoco

Each table is Markdown, on standard output.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pybullet-data", action="store_true")
    parser.add_argument("--time", action="store_true")
    parser.add_argument("--drop", action="store_true")
    parser.add_argument("--only", default="", help="part of the path of the robots wanted")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if arguments.time:
            from mjcf_time import table
        elif arguments.drop:
            from mjcf_drop import table
        elif arguments.pybullet_data:
            from mjcf_pybullet_data import table
        else:
            from mjcf_pinocchio import table
        print(table(Path(folder), arguments.only))


if __name__ == "__main__":
    main()

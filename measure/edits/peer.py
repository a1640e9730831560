"""Operations of scikit-robot, run by a Python that has it: ``PYTHON peer.py < JOBS > RESULTS``.

A job is a line of JSON: operation, input, argument, output. A result is its error; empty for none.
"""

from __future__ import annotations

import json
import sys
import warnings


def run(operation: str, source: str, argument: str, target: str) -> None:
    """Make an operation of scikit-robot on a file."""
    if operation == "root":
        from skrobot.urdf.xml_root_link_changer import change_urdf_root_link

        change_urdf_root_link(source, argument, target)
    elif operation == "merge-fixed":
        from skrobot.urdf.merge_fixed_links import merge_fixed_links_file

        merge_fixed_links_file(source, target)
    else:
        from skrobot.urdf.flip_axis import flip_joint_axis_file

        flip_joint_axis_file(source, argument, target)


def main() -> None:
    """Run all jobs."""
    warnings.simplefilter("ignore")
    results, sys.stdout = sys.stdout, sys.stderr
    for line in sys.stdin:
        try:
            run(*json.loads(line))
            error = ""
        except Exception as failure:
            error = f"{type(failure).__name__}: {failure}"
        print(json.dumps(error), file=results, flush=True)


if __name__ == "__main__":
    main()

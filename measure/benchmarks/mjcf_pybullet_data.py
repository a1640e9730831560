"""pybullet_data: which robots PyBullet loads, and whether MuJoCo's model has their frames."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pybullet_data
from mjcf_robots import export

from urdftool.formats.mjcf.compiled import Compiled

SAMPLED = 50
"""Every how many of the random objects are taken."""

LOADER = """
import json, sys, pybullet as p
p.connect(p.DIRECT)
body = p.loadURDF(sys.argv[1], useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE)
links = {}
for index in range(p.getNumJoints(body)):
    name = p.getJointInfo(body, index)[12].decode()
    state = p.getLinkState(body, index, computeForwardKinematics=True)
    links[name] = [state[4], state[5]]
base = p.getBasePositionAndOrientation(body)
local = p.getDynamicsInfo(body, -1)[3:5]
inverse = p.invertTransform(*local)
print("JSON" + json.dumps([p.multiplyTransforms(*base, *inverse), links]))
"""


def table(folder: Path, only: str) -> str:
    """Counts, and one line for each robot that is not simply equal."""
    root = Path(pybullet_data.getDataPath())
    files = sorted(path for path in root.rglob("*.urdf") if only in str(path))
    random = [path for path in files if "random_urdfs" in path.parts]
    files = [path for path in files if path not in random] + random[::SAMPLED]
    counts = dict.fromkeys(("accepted", "exported", "forced", "compiled", "frames", "refused"), 0)
    lines = []
    for number, path in enumerate(files):
        name = str(path.relative_to(root))
        expected = _in_pybullet(path)
        counts["accepted"] += expected is not None
        made = export(path, folder / str(number), {}, base="fixed")
        if made.model is None or made.robot is None:
            counts["refused"] += 1
            accepted = "accepts" if expected is not None else "refuses"
            lines.append(f"- {name}: PyBullet {accepted} it; {made.message.rpartition('/')[2]}")
            continue
        counts["exported"] += 1
        if made.forced:
            counts["forced"] += 1
            lines.append(f"- {name}: {', '.join(sorted(made.rules))}")
        try:
            compiled = Compiled(made.model, made.robot.tree.roots[0].name)
        except Exception as error:  # the table says what happened
            lines.append(f"- {name}: DOES NOT COMPILE: {error}")
            continue
        counts["compiled"] += not compiled.warnings
        apart = 0.0 if expected is None else _apart(expected, compiled)
        counts["frames"] += expected is not None and apart < 1e-5
        if apart >= 1e-5:
            lines.append(f"- {name}: frames differ by {apart:.1e}")
    head = (
        f"Of {len(files)} files PyBullet loads {counts['accepted']}; {counts['exported']} export "
        f"({counts['forced']} of them with --force), {counts['compiled']} compile without a "
        f"warning, {counts['frames']} have PyBullet's frames, {counts['refused']} are refused."
    )
    return "\n".join([head, "", *lines])


def _in_pybullet(path: Path) -> dict[str, list] | None:
    """The frame of every link at zero, in the root's frame; None where PyBullet fails."""
    run = subprocess.run(
        [sys.executable, "-c", LOADER, str(path)], capture_output=True, text=True, check=False
    )
    text = next((line[4:] for line in run.stdout.splitlines() if line.startswith("JSON")), None)
    if run.returncode or text is None:
        return None
    root, links = json.loads(text)
    inverse = np.linalg.inv(_matrix(root))
    return {name: inverse @ _matrix(pose) for name, pose in links.items()}


def _matrix(pose):
    import pybullet

    matrix = np.eye(4)
    matrix[:3, :3] = np.array(pybullet.getMatrixFromQuaternion(pose[1])).reshape(3, 3)
    matrix[:3, 3] = pose[0]
    return matrix


def _apart(expected, compiled):
    compiled.pose({})
    worst = 0.0
    for name, frame in expected.items():
        found = compiled.frame(name)
        worst = max(worst, np.inf if found is None else abs(found - frame).max())
    return worst

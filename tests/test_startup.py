"""What a command imports, not how long it takes: a test on ``sys.modules``."""

import subprocess
import sys

import pytest

from tests.conftest import FIXTURES

HEAVY = [
    *("numpy", "scipy", "trimesh", "yourdfpy", "pybullet", "coacd", "mujoco", "lxml", "rich"),
    *("importlib.metadata", "yaml", "urllib.request"),
]

ROBOT = str(FIXTURES / "robots" / "ten_links.urdf")
SOUND = str(FIXTURES / "rules" / "axis-not-unit" / "good.urdf")
XACRO = str(FIXTURES / "robots" / "demo_arm" / "urdf" / "arm_sound.urdf.xacro")

PROBE = """
import sys
from urdftool import cli
code = cli.call(sys.argv[1:])
print("LOADED", *(name for name in {heavy!r} if type(sys.modules.get(name)) is type(sys)))
"""


def loaded(*words):
    done = subprocess.run(
        [sys.executable, "-c", PROBE.format(heavy=HEAVY), *words], capture_output=True, text=True
    )
    last = [line for line in done.stdout.splitlines() if line.startswith("LOADED")]
    assert last, done.stderr
    return last[-1].split()[1:]


@pytest.mark.parametrize(
    "words",
    [
        ("--version",),
        ("--help",),
        ("expand", "--help"),
        ("view", "--help"),
        ("simulate", "--help"),
        ("lint", "--help"),
        ("lint", ROBOT),
        ("lint", ROBOT, "--no-cache"),
        *(("lint", ROBOT, "--format", s) for s in ("json", "sarif", "github", "junit", "html")),
        ("lint", "--list-rules"),
        ("lint", "--explain", "zero-axis"),
        ("lint", XACRO),
        ("expand", XACRO),
        ("expand", ROBOT),
    ],
    ids=lambda words: " ".join(w.rpartition("/")[2] for w in words),
)
def test_the_light_commands_stay_light(words):
    assert loaded(*words) == []


def test_simulate_does_not_wait_for_scipy():
    pytest.importorskip("pybullet")
    meshes = FIXTURES / "robots" / "my_robot" / "urdf" / "robot_base.urdf.xacro"
    assert "scipy" not in loaded("-q", "simulate", str(meshes))


def test_lint_of_a_plain_urdf_needs_no_xacro():
    heavy = ["xacro", "urdftool_xacro", "multiprocessing"]
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            PROBE.format(heavy=heavy),
            "lint",
            ROBOT,
        ],
        capture_output=True,
        text=True,
    )
    assert done.stdout.splitlines()[-1].split() == ["LOADED"]


@pytest.mark.parametrize("style", ["full", "concise", "json"])
def test_lint_of_a_sound_robot_imports_no_fix(style):
    heavy = ["urdftool.lint.fix", "urdftool.source.edit"]
    words = ["lint", SOUND, "--no-cache", "--format", style]
    done = subprocess.run(
        [sys.executable, "-c", PROBE.format(heavy=heavy), *words], capture_output=True, text=True
    )
    assert done.stdout.splitlines()[-1].split() == ["LOADED"]


def test_importing_the_package_imports_nothing_of_it():
    code = (
        "import sys; before = set(sys.modules); import urdftool; urdftool.__version__\n"
        "print(sorted(n for n in set(sys.modules) - before if n.startswith('urdftool.')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "[]"


def test_a_cached_report_is_read_without_rules_and_robots(tmp_path):
    heavy = [
        *("urdftool.lint.run", "urdftool.model.elements", "urdftool.source.packages"),
        *("urdftool.lint.robot_search", "urdftool.rules.fix"),
    ]
    words = ["lint", ROBOT, "--cache-dir", str(tmp_path)]
    probe = [sys.executable, "-c", PROBE.format(heavy=heavy), *words]
    first, second = (
        subprocess.run([*probe, *more], capture_output=True, text=True, check=True).stdout
        for more in ([], ["--statistics"])  # another run, with the same reports
    )
    assert "urdftool.lint.run" in first.splitlines()[-1].split()
    assert second.splitlines()[-1].split() == ["LOADED"]


def test_a_run_is_printed_again_without_reports(tmp_path):
    heavy = [
        *("urdftool.finding", "urdftool.lint.outcome", "urdftool.lint.settings"),
        *("urdftool.output", "urdftool.workspace"),
    ]
    words = ["lint", ROBOT, "--cache-dir", str(tmp_path)]
    probe = [sys.executable, "-c", PROBE.format(heavy=heavy), *words]
    first, second = (subprocess.run(probe, capture_output=True, text=True) for _ in range(2))
    assert "urdftool.finding" in first.stdout.splitlines()[-1].split()
    assert second.stdout.splitlines()[-1].split() == ["LOADED"]
    assert second.stdout.splitlines()[:-1] == first.stdout.splitlines()[:-1]

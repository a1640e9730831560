"""MJCF that the installed MuJoCo does not compile, and the release that a project asks for."""

import pytest

from urdftool.api.lint import check

pytestmark = pytest.mark.library("mujoco")

MODEL = "<mujoco><worldbody><body><oval/></body></worldbody></mujoco>"


@pytest.mark.parametrize(
    ("file", "text", "severity"),
    [
        ("requirements.txt", "mujoco==2.3.7\n", "warning"),
        ("requirements.txt", "numpy\nmujoco-py\n", "warning"),
        ("pyproject.toml", 'dependencies = ["mujoco<3.0"]', "warning"),
        ("a.dist-info/METADATA", "Requires-Dist: mujoco (~=2.2)\n", "warning"),
        ("requirements.txt", "mujoco>=2.3\n", "error"),
        ("requirements.txt", "mujoco==99.1\nmy-mujoco==1.0\n", "error"),
        ("notes.txt", "mujoco==2.3.7\n", "error"),
        ("env.py", "import pybullet\n", "warning"),
        ("env.py", "import mujoco\n", "error"),
    ],
)
def test_an_older_release_that_the_project_asks_for_may_compile_a_model(
    tmp_path, file, text, severity
):
    (tmp_path / "setup.py").write_text("")
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).write_text(text)
    path = tmp_path / "a.xml"
    path.write_text(MODEL)
    (one,) = check(path)
    assert one.code == "unreadable-model"
    assert one.severity.label == severity
    assert one.hint.startswith("MuJoCo ")
    assert ("which may compile it" in one.hint) is (severity == "warning" and file != "env.py")

"""The Python lines and the example of the page on ``inertia`` run."""

import re

from tests.conftest import FIXTURES, ROOT

PAGE = (ROOT / "docs" / "commands" / "inertia.md").read_text("utf-8")


def test_the_python_lines_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.urdf.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="forearm">'
        '<visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>'
    )
    (tmp_path / "link3.stl").write_bytes((FIXTURES / "meshes" / "cube.stl").read_bytes())
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(code, "inertia.md", "exec"), {})
    assert "2700" in capsys.readouterr().out


def test_the_example_is_what_is_printed(urdftool):
    example = re.search(r"\$ urdftool (inertia cylinder .*?)\n(.*?)```", PAGE, re.DOTALL)
    done = urdftool(*example[1].split())
    assert done.out + done.err == example[2]

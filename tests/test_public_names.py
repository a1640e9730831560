import urdftool


def test_every_public_name_exists_and_is_documented():
    for name in urdftool.__all__:
        value = getattr(urdftool, name)
        assert name == "__version__" or value.__doc__, name


def test_there_is_no_other():
    assert set(urdftool.__all__) - {"__version__"} == set(urdftool._HOMES)
    assert dir(urdftool) == sorted(urdftool.__all__)


def test_the_lines_of_the_package_docstring_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.urdf.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="prefix" default=""/><link name="$(arg prefix)base"/></robot>'
    )
    robot = urdftool.load("arm.urdf.xacro", args={"prefix": "left_"})
    assert [link.name for link in robot.links] == ["left_base"]
    assert '<link name="left_base"/>' in urdftool.expand("arm.urdf.xacro", args={"prefix": "left_"})
    assert urdftool.check("arm.urdf.xacro", select=["zero-axis"]) == []

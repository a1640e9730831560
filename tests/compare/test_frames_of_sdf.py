"""Frames of SDF in another body, missing, and exported."""

MODEL = """<sdf version="1.9"><model name="m">
<link name="a"><inertial><mass>1</mass></inertial></link>
<link name="b"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
</joint>{}</model></sdf>"""
FRAME = '<frame name="f" attached_to="{}"><pose>{} 0 0 0 0 0</pose></frame>'


def make(tmp_path, name, frame):
    path = tmp_path / name
    path.write_text(MODEL.format(frame))
    return path


def test_a_frame_on_another_link_and_a_missing_one_are_differences(urdftool, tmp_path):
    one = make(tmp_path, "one.sdf", FRAME.format("a", 1))
    for name, frame in (("b", FRAME.format("b", 1)), ("x", FRAME.format("a", 2)), ("none", "")):
        two = make(tmp_path, f"{name}.sdf", frame)
        result = urdftool("verify", one, two)
        assert result.code == 1
        assert "'f'" in result.out
    assert urdftool("verify", one, one).code == 0


def test_a_frame_is_exported_to_sdf_and_a_link_of_urdf_is_compared_with_it(urdftool, tmp_path):
    one = make(tmp_path, "one.sdf", FRAME.format("a", 1))
    other = make(tmp_path, "other.sdf", FRAME.format("b", 1))
    out, urdf = tmp_path / "out.sdf", tmp_path / "out.urdf"
    assert urdftool("export", "sdf", one, "-o", out, "--verify", "--strict").code == 0
    assert '<frame name="f" attached_to="a">' in out.read_text()
    assert urdftool("verify", one, out).code == 0
    assert urdftool("verify", other, out).code == 1
    assert urdftool("export", "urdf", one, "-o", urdf).code == 0
    assert urdftool("verify", one, urdf).code == 0
    moved = urdftool("verify", other, urdf)
    assert moved.code == 1
    assert "'f'" in moved.out


def test_sdf_before_1_7_has_no_frames(urdftool, tmp_path):
    one = make(tmp_path, "one.sdf", FRAME.format("a", 1))
    out = tmp_path / "out.sdf"
    result = urdftool(
        "export", "sdf", one, "-o", out, "--target", "gazebo-classic", "--sdf-version", "1.6", "-v"
    )
    assert result.code == 0
    assert "frame 'f' is dropped" in result.err
    assert "<frame" not in out.read_text()

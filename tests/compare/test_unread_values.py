"""A value that a reader rejects is a part that was not read."""

MODEL = """<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><sphere><radius>1</radius></sphere></geometry><surface><contact>
<collide_bitmask>{}</collide_bitmask></contact></surface></collision></link></model></sdf>"""


def test_a_rejected_value_is_compared_as_not_read(urdftool, tmp_path):
    files = []
    for number, value in enumerate(("ball", "65535")):
        files.append(tmp_path / f"{number}.sdf")
        files[-1].write_text(MODEL.format(value))
    for command in ("verify", "diff"):
        result = urdftool(command, *files)
        assert result.code in (0, 1)
        assert "bug in urdftool" not in result.err
        assert "collide_bitmask" in result.out + result.err

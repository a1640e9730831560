"""The page of verdicts is what the verdicts say."""

from measure.precision.__main__ import PAGE, VERDICTS, judged, page
from measure.precision.robots import is_robot


def test_the_page_shows_the_verdicts():
    rows = judged()
    assert {row["verdict"] for row in rows} <= set(VERDICTS)
    assert all(row["reason"] for row in rows)
    assert PAGE.read_text("utf-8") == page(rows)


def test_robots_move_and_are_in_no_folder_of_tests(write):
    joint = '<joint name="j" type="{}"><parent link="a"/><child link="b"/></joint>'
    text = f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'
    arm = write("arm.urdf", text.format("revolute"))
    assert is_robot("corpus/arms/urdf/arm.urdf", arm)
    for folder in ("test", "arm_tests", "urdf_parser_test", "ros__urdf_tutorial"):
        assert not is_robot(f"corpus/arms/{folder}/arm.urdf", arm)
    assert is_robot("corpus/arms/contest/test.urdf", arm)
    assert not is_robot("corpus/table/table.urdf", write("table.urdf", text.format("fixed")))
    broken = write("broken.urdf", text.format("revolute").replace("</robot>", ""))
    assert is_robot("corpus/arms/broken.urdf", broken)
